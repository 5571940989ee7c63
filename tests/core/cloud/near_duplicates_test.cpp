// Copies are found, and put together as a search of all pairs does; clouds without any stay as they are.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "cloud_index.h"
#include "near_duplicates.h"
#include "point_cloud.h"
#include "shuffled_cloud.h"

namespace curvature_lines::test {
namespace {

// The points, then `copies` of the first `copied` of them with a Gaussian error of `jitter` spacings in each coordinate.
PointCloud repeated(const PointCloud& cloud, Index copied, int copies, double jitter)
{
	const CloudIndex    single(cloud);
	std::vector<double> spacing = single.spacing();
	std::nth_element(spacing.begin(), spacing.begin() + spacing.size() / 2, spacing.end());
	const double    error = jitter * spacing[spacing.size() / 2];
	samples::Random random(7, 2);
	PointCloud      all{
        Eigen::Matrix3Xd(3, cloud.size() + copies * copied),
        Eigen::Matrix3Xd(3, cloud.size() + copies * copied)};
	all.positions.leftCols(cloud.size()) = cloud.positions;
	all.normals.leftCols(cloud.size())   = cloud.normals;
	Index next                           = cloud.size();
	for (int c = 0; c < copies; ++c)
		for (Index i = 0; i < copied; ++i, ++next) {
			all.positions.col(next) = cloud.positions.col(i) + error * random.normal3();
			all.normals.col(next)   = cloud.normals.col(i);
		}
	return all;
}

// Share of the copies that are in the group of their point, when the point is in no group of another.
double foundShare(const NearDuplicates& found, Index points, Index copied, int copies)
{
	std::map<Index, int> owners;
	for (Index i = 0; i < points; ++i)
		++owners[found.group[i]];
	int right = 0;
	for (int c = 0; c < copies; ++c)
		for (Index i = 0; i < copied; ++i) {
			const Index g = found.group[i];
			right += owners[g] == 1 && found.group[points + c * copied + i] == g;
		}
	return right / double(copies * copied);
}

TEST(NearDuplicates, AreFoundWhateverTheirErrorAndShare)
{
	constexpr Index  n      = 3000;
	const PointCloud single = shuffledCloud("torus", n, 0.002);
	const struct {
		Index  copied;
		int    copies;
		double jitter, found;
	} cases[] = {
		{n, 1, 0.0, 1.0},
		{n, 1, 1e-8, 1.0},
		{n, 1, 1e-4, 1.0},
		{n, 1, 1e-2, 0.98},
		{n, 1, 0.04, 0.85},
		{n, 2, 1e-3, 0.99},
		{n, 3, 1e-3, 0.99},
		{n / 3, 1, 1e-3, 0.99},
		{n / 12, 1, 1e-3, 0.99}};
	for (const auto& c : cases) {
		SCOPED_TRACE(
			std::to_string(c.copied) + " points, copies of each: " + std::to_string(c.copies) +
			", error: " + std::to_string(c.jitter));
		const NearDuplicates found = nearDuplicates(repeated(single, c.copied, c.copies, c.jitter));
		EXPECT_GT(found.reach, 0.0);
		EXPECT_GE(foundShare(found, n, c.copied, c.copies), c.found);
		EXPECT_NEAR(found.groups, n, 0.05 * n);
	}
}

// Leaders in the order of the index; each takes what is near it and still free.
std::vector<Index> groupsByAllPairs(const CloudIndex& index, double reach)
{
	const PointCloud&   cloud = index.cloud();
	std::vector<double> spacing(index.size());
	for (Index place = 0; place < index.size(); ++place)
		spacing[index.order().source[place]] = index.spacing()[place];
	std::vector<Index> group(index.size(), -1);
	Index              groups = 0;
	for (const Index i : index.shuffled()) {
		if (group[i] >= 0)
			continue;
		for (Index j = 0; j < index.size(); ++j)
			if (group[j] < 0 &&
			    (cloud.positions.col(j) - cloud.positions.col(i)).norm() <= reach * spacing[i] &&
			    index.gateNormals().col(i).dot(index.gateNormals().col(j)) > 0.0)
				group[j] = groups;
		++groups;
	}
	return group;
}

TEST(NearDuplicates, GroupsAreThoseOfASearchOfAllPairs)
{
	for (const char* surface : {"torus", "cube", "helicoid"})
		for (const double jitter : {1e-6, 0.02, 0.04}) {
			SCOPED_TRACE(std::string(surface) + " " + std::to_string(jitter));
			const CloudIndex index(repeated(shuffledCloud(surface, 700, 0.003), 700, 2, jitter));
			const NearDuplicates found = nearDuplicates(index);
			ASSERT_GT(found.reach, 0.0);
			EXPECT_EQ(found.group, groupsByAllPairs(index, found.reach));
			const std::set<Index> numbers(found.group.begin(), found.group.end());
			EXPECT_EQ(static_cast<Index>(numbers.size()), found.groups);
		}
}

// Random, on a grid, on scan lines five to forty times as far apart as their points.
TEST(NearDuplicates, CloudsWithoutAnyStayAsTheyAre)
{
	std::vector<PointCloud> clouds;
	for (const char* surface : {"torus", "cube", "helicoid"})
		for (const int points : {2, 30, 300, 5000})
			clouds.push_back(shuffledCloud(surface, points, 0.002));
	for (const int ratio : {1, 5, 40}) {
		PointCloud      lines{Eigen::Matrix3Xd(3, 4000), Eigen::Matrix3Xd(3, 4000)};
		samples::Random random(3, ratio);
		const Index     across = 40, along = 100;
		for (Index i = 0; i < across * along; ++i) {
			lines.positions.col(i) << 1e-3 * (i % along), 1e-3 * ratio * (i / along),
				1e-4 * random.uniform(-1.0, 1.0);
			lines.normals.col(i) = Eigen::Vector3d::UnitZ();
		}
		clouds.push_back(lines);
	}
	for (const PointCloud& cloud : clouds) {
		SCOPED_TRACE(&cloud - clouds.data());
		const NearDuplicates found = nearDuplicates(cloud);
		EXPECT_EQ(found.groups, cloud.size());
		EXPECT_EQ(found.reach, 0.0);
	}
}

// The two sides of a sheet of paper whose vertices lie above each other.
TEST(NearDuplicates, SheetsOfOpposingNormalsStayApart)
{
	PointCloud sides{Eigen::Matrix3Xd(3, 1800), Eigen::Matrix3Xd(3, 1800)};
	for (Index i = 0; i < 900; ++i)
		for (const Index side : {0, 1}) {
			sides.positions.col(2 * i + side) << 0.03 * (i % 30), 0.03 * (i / 30), 1e-4 * side;
			sides.normals.col(2 * i + side) = Eigen::Vector3d::UnitZ() * (side == 0 ? -1.0 : 1.0);
		}
	EXPECT_EQ(nearDuplicates(sides).groups, sides.size());
}

TEST(NearDuplicates, MeansAreThoseOfTheirPoints)
{
	const CloudIndex     index(repeated(shuffledCloud("torus", 500, 0.002), 500, 2, 0.01));
	const NearDuplicates found = nearDuplicates(index);
	const PointCloud     mean  = meanPoints(index, found);
	ASSERT_EQ(mean.size(), found.groups);
	for (Index g = 0; g < found.groups; ++g) {
		Eigen::Vector3d sum = Eigen::Vector3d::Zero(), normals = Eigen::Vector3d::Zero();
		int             count = 0;
		for (Index i = 0; i < index.size(); ++i)
			if (found.group[i] == g) {
				sum += index.cloud().positions.col(i);
				normals += index.cloud().normals.col(i);
				++count;
			}
		EXPECT_LT((mean.positions.col(g) - sum / count).norm(), 1e-12);
		EXPECT_LT((mean.normals.col(g) - normals.normalized()).norm(), 1e-12);
	}
}

TEST(NearDuplicates, SameGroupsForAnyOrderOfThePointsAndAnyNumberOfThreads)
{
	const PointCloud cloud   = repeated(shuffledCloud("cube", 2000, 0.003), 1500, 1, 0.02);
	const int        threads = omp_get_max_threads();
	omp_set_num_threads(1);
	const NearDuplicates found = nearDuplicates(cloud);
	omp_set_num_threads(3);
	std::vector<Index> order(cloud.size());
	for (Index i = 0; i < cloud.size(); ++i)
		order[i] = i;
	std::shuffle(order.begin(), order.end(), std::mt19937(1));
	const NearDuplicates other = nearDuplicates(columnsOf(cloud, order));
	omp_set_num_threads(threads);
	EXPECT_GT(found.reach, 0.0);
	EXPECT_EQ(other.reach, found.reach);
	EXPECT_EQ(other.groups, found.groups);
	for (Index i = 0; i < cloud.size(); ++i)
		ASSERT_EQ(other.group[i], found.group[order[i]]);
}

} // namespace
} // namespace curvature_lines::test
