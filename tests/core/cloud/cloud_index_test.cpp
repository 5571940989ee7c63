// One index for all that is known of a set of positions: its names, what it shares, what it leaves undone.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numeric>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "cloud_index.h"
#include "gate_normals.h"
#include "local_spacing.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "shuffled_order.h"
#include "spatial_order.h"

namespace curvature_lines::test {
namespace {

PointCloud torus(int points = 600)
{
	samples::SampleRequest request;
	request.points    = points;
	request.noise     = 0.005;
	request.seed      = 11;
	const auto sample = samples::generate(request);
	return prepareCloud(sample.positions, sample.normals).cloud;
}

std::vector<Index> nearestByHand(const Eigen::Matrix3Xd& positions, Index i, Index k)
{
	std::vector<Index> order(positions.cols());
	std::iota(order.begin(), order.end(), 0);
	const Eigen::VectorXd far = (positions.colwise() - positions.col(i)).colwise().squaredNorm();
	std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return far[a] < far[b]; });
	order.resize(k);
	return order;
}

TEST(CloudIndex, OneTreeAnswersInThreeNames)
{
	const PointCloud       cloud = torus();
	const CloudIndex       index(cloud);
	const Eigen::Matrix3Xd shuffled = columnsOf(cloud.positions, index.shuffled());
	for (Index i = 0; i < index.size(); i += 37) {
		EXPECT_EQ(
			index.search().nearest(cloud.positions.col(i), 9),
			nearestByHand(cloud.positions, i, 9));
		EXPECT_EQ(
			index.arrangedSearch().nearest(index.arrangedPositions().col(i), 9),
			nearestByHand(index.arrangedPositions(), i, 9));
		EXPECT_EQ(
			index.shuffledSearch().nearest(shuffled.col(i), 9), nearestByHand(shuffled, i, 9));
		std::vector<Index> ball;
		index.shuffledSearch().within(shuffled.col(i), 0.05, ball);
		std::sort(ball.begin(), ball.end());
		std::vector<Index> sorted = index.shuffledSearch().within(shuffled.col(i), 0.05);
		std::sort(sorted.begin(), sorted.end());
		EXPECT_EQ(ball, sorted);
		EXPECT_TRUE(std::find(ball.begin(), ball.end(), i) != ball.end());
	}
}

TEST(CloudIndex, TiesGoByTheNameThatIsAskedFor)
{
	// Four neighbours at the same distance: which two come first depends on their names alone.
	PointCloud cloud{Eigen::Matrix3Xd(3, 5), Eigen::Vector3d::UnitZ().replicate(1, 5)};
	cloud.positions << 0, 1, -1, 0, 0, 0, 0, 0, 1, -1, 0, 0, 0, 0, 0;
	const CloudIndex index(cloud);
	EXPECT_EQ(index.search().nearest(Eigen::Vector3d::Zero(), 3), (std::vector<Index>{0, 1, 2}));
	const std::vector<Index> near = index.shuffledSearch().nearest(Eigen::Vector3d::Zero(), 3);
	EXPECT_EQ(index.shuffled()[near[0]], 0);
	EXPECT_LT(near[1], near[2]);
}

TEST(CloudIndex, GivesWhatTheFunctionsOfTheRoomGive)
{
	const PointCloud     cloud = torus();
	const CloudIndex     index(cloud);
	const NeighborSearch search(cloud.positions);
	EXPECT_EQ(index.shuffled(), shuffledOrder(cloud.positions));
	EXPECT_EQ(index.gateNormals(), gateNormals(cloud, search));
	const MinimumNeighborhoods minimum = minimumNeighborhoods(cloud, search);
	EXPECT_EQ(index.minimum().neighbors.indices, minimum.neighbors.indices);
	EXPECT_EQ(index.minimum().spacing, minimum.spacing);
	const SpatialOrder     order(cloud.positions);
	const Eigen::Matrix3Xd arranged = order.arrange(cloud.positions);
	EXPECT_EQ(index.spacing(), localSpacing(arranged, NeighborSearch(arranged), order));
}

TEST(CloudIndex, CopiesShareWhatIsComputed)
{
	const CloudIndex index(torus());
	const CloudIndex copy = index;
	EXPECT_EQ(&copy.minimum(), &index.minimum());
	EXPECT_EQ(&copy.search(), &index.search());
	const Eigen::Matrix3Xd up    = Eigen::Vector3d::UnitZ().replicate(1, index.size());
	const CloudIndex       other = index.withNormals(up);
	EXPECT_EQ(other.cloud().normals, up);
	EXPECT_EQ(other.cloud().positions, index.cloud().positions);
	EXPECT_EQ(&other.search(), &index.search());
	EXPECT_EQ(&other.minimum(), &index.minimum());
}

TEST(CloudIndex, IsComputedOnceWhateverThreadAsksFirst)
{
	const CloudIndex                         index(torus(2000));
	std::vector<const MinimumNeighborhoods*> seen(4);
	std::vector<std::thread>                 threads;
	for (auto& one : seen)
		threads.emplace_back([&] { one = &index.minimum(); });
	for (std::thread& thread : threads)
		thread.join();
	for (const auto* one : seen)
		EXPECT_EQ(one, seen[0]);
}

TEST(CloudIndex, ACancellationLeavesItUndone)
{
	const CloudIndex index(torus(2000));
	EXPECT_THROW(index.minimum(Progress([](double, const char*) { return false; })), Cancelled);
	EXPECT_EQ(index.minimum().spacing.size(), 2000u);
}

TEST(CloudIndex, PartsAndMovedCloudsAreCloudsOfTheirOwn)
{
	MinimumNeighborhoodOptions options;
	options.boundaryThreshold      = 1.0;
	const PointCloud         cloud = torus();
	const CloudIndex         index(cloud, options);
	const std::vector<Index> which = {5, 3, 100};
	const CloudIndex         part  = index.part(which);
	EXPECT_EQ(part.size(), 3);
	EXPECT_EQ(part.cloud().positions.col(0), cloud.positions.col(5));
	EXPECT_EQ(part.cloud().normals.col(2), cloud.normals.col(100));
	const CloudIndex moved = index.moved(2.0 * cloud.positions, cloud.normals);
	EXPECT_EQ(moved.cloud().positions, 2.0 * cloud.positions);
	EXPECT_EQ(moved.minimum().status, index.minimum().status); // by the same options
	EXPECT_EQ(CloudIndex().size(), 0);
	EXPECT_TRUE(CloudIndex().search().nearest(Eigen::Vector3d::Zero(), 1).empty());
}

} // namespace
} // namespace curvature_lines::test
