// Lines are found with their gap and direction; clouds without any have none.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "cloud_index.h"
#include "point_cloud.h"
#include "scan_lines.h"
#include "shuffled_cloud.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

ScanLines linesOf(const CloudIndex& index)
{
	return scanLines(index.arrangedPositions(), index.arrangedSearch(), index.order());
}

// 1 x 1, lines along x `gap` apart with points `gap / ratio` apart, each line begun anywhere; noise along z.
Matrix3Xd scanned(double gap, double ratio, double noise)
{
	samples::Random       random(3, 1);
	const double          step = gap / ratio;
	std::vector<Vector3d> points;
	for (double y = 0.0; y < 1.0; y += gap) {
		const double begin = random.uniform(0.0, step);
		for (double x = 0.0; x < 1.0; x += step)
			points.emplace_back(x + begin, y, noise * random.normal3().x());
	}
	Matrix3Xd positions(3, points.size());
	for (std::size_t i = 0; i < points.size(); ++i)
		positions.col(i) = points[i];
	return positions;
}

PointCloud upward(Matrix3Xd positions)
{
	const Matrix3Xd normals = Vector3d::UnitZ().replicate(1, positions.cols());
	return {std::move(positions), normals};
}

TEST(ScanLines, HaveTheirGapAndDirection)
{
	constexpr double         gap = 0.04;
	const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.8, Vector3d(1.0, -2.0, 0.5).normalized()));
	for (const double ratio : {5.0, 8.0, 12.0, 30.0}) {
		SCOPED_TRACE(ratio);
		const CloudIndex index(
			upward(turn.toRotationMatrix() * scanned(gap, ratio, 0.1 * gap / ratio)));
		const ScanLines lines = linesOf(index);
		ASSERT_TRUE(lines.any());
		const Vector3d along = turn * Vector3d::UnitX();
		for (Index i = 0; i < index.size(); ++i) {
			ASSERT_NEAR(lines.gap[i], gap, 0.1 * gap);
			ASSERT_GT(std::abs(lines.direction.col(i).dot(along)), 0.99);
		}
	}
}

TEST(ScanLines, AreNotFoundWhereThereAreNone)
{
	for (const double ratio : {1.0, 2.0, 3.0})
		EXPECT_FALSE(linesOf(upward(scanned(0.02, ratio, 0.0))).any()) << ratio;
	for (const char* surface : {"torus", "cube", "helicoid"})
		for (const int points : {0, 1, 5, 300, 5000}) {
			SCOPED_TRACE(std::string(surface) + " " + std::to_string(points));
			const PointCloud cloud =
				points > 0 ? shuffledCloud(surface, points, 0.003) : PointCloud();
			EXPECT_FALSE(linesOf(cloud).any());
		}
}

// A scan with lines beside an even one: each as it is alone, but for where they meet.
TEST(ScanLines, EndWhereTheSamplingIsEven)
{
	const Matrix3Xd lines = scanned(0.06, 12.0, 0.0), even = scanned(0.02, 1.0, 0.0);
	Matrix3Xd       both(3, lines.cols() + even.cols());
	both << lines, even.colwise() + Vector3d(1.1, 0.0, 0.0);
	const CloudIndex index(upward(both));
	const ScanLines  found = linesOf(index);
	ASSERT_TRUE(found.any());
	for (Index place = 0; place < index.size(); ++place) {
		const double x = index.arrangedPositions()(0, place);
		if (x < 0.8) {
			EXPECT_NEAR(found.gap[place], 0.06, 0.006);
		}
		else if (x > 1.4) {
			EXPECT_EQ(found.gap[place], 0.0);
		}
	}
}

TEST(ScanLines, AreTheSameForAnyOrderAndAnyNumberOfThreads)
{
	const PointCloud   cloud = upward(scanned(0.05, 9.0, 0.001));
	std::vector<Index> order(cloud.size());
	for (Index i = 0; i < cloud.size(); ++i)
		order[i] = i;
	std::shuffle(order.begin(), order.end(), std::mt19937(2));
	const int threads = omp_get_max_threads();
	omp_set_num_threads(1);
	const ScanLines one = linesOf(cloud);
	omp_set_num_threads(3);
	const ScanLines three = linesOf(columnsOf(cloud, order));
	omp_set_num_threads(threads);
	EXPECT_EQ(one.gap, three.gap);
	EXPECT_EQ(one.direction, three.direction);
}

} // namespace
} // namespace curvature_lines::test
