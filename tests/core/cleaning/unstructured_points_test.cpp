// Points of a volume and blades of grass are told from surfaces, noisy, thin and coarse ones as well.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "outlier_rejection.h"
#include "outlier_result.h"
#include "point_cloud.h"
#include "unstructured_points.h"

namespace curvature_lines::test {
namespace {

using Eigen::Vector3d;

struct Labelled {
	PointCloud        cloud; // in about the unit frame
	std::vector<char> hair;  // per point

	void add(const Vector3d& position, const Vector3d& normal, bool isHair)
	{
		const Index n = cloud.positions.cols();
		cloud.positions.conservativeResize(3, n + 1);
		cloud.normals.conservativeResize(3, n + 1);
		cloud.positions.col(n) = position;
		cloud.normals.col(n)   = normal;
		hair.push_back(isHair);
	}
	// Share of the hair that is marked, or of the rest.
	double marked(const std::vector<char>& marks, bool ofHair) const
	{
		double sum = 0.0, count = 0.0;
		for (std::size_t i = 0; i < hair.size(); ++i)
			if ((hair[i] != 0) == ofHair) {
				sum += marks[i] != 0;
				count += 1.0;
			}
		return sum / count;
	}
};

// 3000 points on a sphere of radius .2, and a ball of 1000 random points as dense beside it.
Labelled sphereAndBall(double noise)
{
	Labelled        result;
	samples::Random random(4, 9);
	const double    spacing = 0.2 * std::sqrt(4.0 * EIGEN_PI / 3000.0);
	for (int i = 0; i < 3000; ++i) {
		const Vector3d n = random.normal3().normalized();
		result.add((0.2 + noise * spacing * random.normal3().x()) * n, n, false);
	}
	const double radius = spacing * std::cbrt(1000.0 * 3.0 / (4.0 * EIGEN_PI));
	while (result.hair.size() < 4000) {
		const Vector3d p(
			random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
		if (p.norm() < 1.0)
			result.add(
				radius * p + Vector3d(0.2 + radius + 2.0 * spacing, 0.0, 0.0),
				random.normal3().normalized(),
				true);
	}
	return result;
}

// 80 blades of 20 points, eight spacings high, on the middle of a flat ground of 3000 points.
Labelled grass()
{
	Labelled        result;
	samples::Random random(6, 2);
	const double    spacing = 1.0 / std::sqrt(3000.0);
	for (int i = 0; i < 3000; ++i)
		result.add(
			{random.uniform(0.0, 1.0), random.uniform(0.0, 1.0), 0.0}, Vector3d::UnitZ(), false);
	for (int blade = 0; blade < 80; ++blade) {
		const Vector3d foot(random.uniform(0.3, 0.7), random.uniform(0.3, 0.7), 0.0);
		const Vector3d lean = Vector3d(0.35, 0.35, 0.0).cwiseProduct(random.normal3());
		for (int k = 0; k < 20; ++k) {
			const double height = 8.0 * spacing * random.uniform(0.0, 1.0);
			result.add(
				foot + height * (Vector3d::UnitZ() + lean) + 0.15 * spacing * random.normal3(),
				random.normal3().normalized(),
				height > spacing);
		}
	}
	return result;
}

OutlierResult rejected(const PointCloud& cloud, bool unstructured)
{
	OutlierOptions options;
	options.rejectUnstructured = unstructured;
	return rejectOutliers(cloud, options);
}

TEST(UnstructuredPoints, AVolumeOfPointsIsNoSurface)
{
	for (const double noise : {0.0, 0.1, 0.3}) {
		SCOPED_TRACE(noise);
		const Labelled made  = sphereAndBall(noise);
		const auto     found = findUnstructured(made.cloud);
		EXPECT_GT(made.marked(found, true), 0.98);
		EXPECT_LT(made.marked(found, false), 0.02); // beside the ball; the votes accept them
		EXPECT_NEAR(unstructuredShare(made.cloud), 0.25, 0.05);
	}
}

TEST(UnstructuredPoints, AreKeptAndToldOrRejected)
{
	for (const double noise : {0.1, 0.3}) {
		SCOPED_TRACE(noise);
		const Labelled made = sphereAndBall(noise);
		const auto     kept = rejected(made.cloud, false), gone = rejected(made.cloud, true);
		EXPECT_LT(made.marked(kept.outlier, true), 0.2);
		EXPECT_NEAR(kept.unstructuredShare, 0.25, 0.05);
		EXPECT_GT(made.marked(gone.outlier, true), 0.98);
		EXPECT_LT(made.marked(gone.outlier, false), 0.002);
		EXPECT_NEAR(gone.unstructuredShare, 0.25, 0.01);
	}
}

TEST(UnstructuredPoints, GrassGoesAndItsGroundStays)
{
	const Labelled made = grass();
	const auto     gone = rejected(made.cloud, true);
	EXPECT_GT(made.marked(gone.outlier, true), 0.7);
	EXPECT_LT(made.marked(gone.outlier, false), 0.1); // feet of the blades among them
	for (Index i = 0; i < 3000; ++i)
		ASSERT_EQ(gone.outlier[i], 0) << i;
	EXPECT_LT(made.marked(rejected(made.cloud, false).outlier, true), 0.3);
}

TEST(UnstructuredPoints, NoiseEdgesAndRimsAreSurfaces)
{
	const struct {
		const char* surface;
		int         points;
		double      noise;
	} cases[] = {
		{"torus", 6000, 0.0},
		{"torus", 6000, 0.01},
		{"torus", 1600, 0.005},
		{"cube", 6000, 0.0},
		{"cube", 600, 0.005},
		{"helicoid", 1730, 0.005}};
	for (const auto& c : cases) {
		SCOPED_TRACE(std::string(c.surface) + " " + std::to_string(c.noise));
		samples::SampleRequest request;
		request.surface      = c.surface;
		request.points       = c.points;
		request.noise        = c.noise;
		const auto       all = samples::generate(request);
		const PointCloud cloud{all.positions / samples::surface(c.surface).diagonal(), all.normals};
		const auto       found = findUnstructured(cloud);
		EXPECT_EQ(std::count(found.begin(), found.end(), char(1)), 0);
		EXPECT_LT(unstructuredShare(cloud), 0.03);
	}
}

TEST(UnstructuredPoints, TheSameInAnyOrderAndOnAnyNumberOfThreads)
{
	const Labelled     made = grass();
	std::vector<Index> order(made.hair.size());
	std::iota(order.begin(), order.end(), 0);
	std::shuffle(order.begin(), order.end(), std::mt19937(1));
	const int threads = omp_get_max_threads();
	omp_set_num_threads(1);
	const auto found = findUnstructured(made.cloud);
	omp_set_num_threads(3);
	const auto other = findUnstructured({columnsOf(made.cloud, order)});
	omp_set_num_threads(threads);
	for (std::size_t k = 0; k < order.size(); ++k)
		ASSERT_EQ(other[k], found[order[k]]);
}

TEST(UnstructuredPoints, SurvivesDegenerateClouds)
{
	PointCloud point, line, same;
	point.positions = point.normals = Vector3d::UnitX();
	line.positions                  = Eigen::Matrix3Xd::Zero(3, 200);
	line.positions.row(0).setLinSpaced(0.0, 1.0);
	line.normals   = Vector3d::UnitZ().replicate(1, 200);
	same.positions = Eigen::Matrix3Xd::Zero(3, 200);
	same.normals   = line.normals;
	for (const PointCloud& cloud : {PointCloud(), point, line, same}) {
		const auto found = findUnstructured(cloud);
		EXPECT_EQ(static_cast<Index>(found.size()), cloud.size());
		EXPECT_EQ(std::count(found.begin(), found.end(), char(1)), 0);
		EXPECT_EQ(unstructuredShare(cloud), 0.0);
	}
}

} // namespace
} // namespace curvature_lines::test
