// Voters on exact and noisy surfaces among outliers: the surface of the majority, and the part of it they know.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "neighborhoods.h"
#include "outlier_voter.h"
#include "point_cloud.h"
#include "shuffled_order.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

struct Cloud {
	Eigen::Matrix3Xd    positions;
	NeighborSearch      search;
	std::vector<double> crowding;
	std::vector<Index>  rank, active;

	explicit Cloud(const Eigen::Matrix3Xd& points) : positions(points), search(positions)
	{
		const Index n = static_cast<Index>(positions.cols());
		for (Index i = 0; i < n; ++i)
			crowding.push_back(
				(positions.col(search.nearest(positions.col(i), crowdSize + 1).back()) -
			     positions.col(i))
					.norm());
		const std::vector<Index> order = shuffledOrder(positions);
		rank.resize(n);
		for (Index k = 0; k < n; ++k)
			rank[order[k]] = k;
		active.resize(n);
		std::iota(active.begin(), active.end(), 0);
	}
	OutlierVoter voter(Index centre, Index neighbors) const
	{
		OutlierVoter voter;
		voter.centre    = centre;
		voter.neighbors = neighbors;
		fitVoter(voter, {positions, crowding, rank, search, active, search});
		return voter;
	}
};

Eigen::Matrix3Xd pointsOf(const char* surface, int points, double noise, double outliers = 0.0)
{
	samples::SampleRequest request;
	request.surface     = surface;
	request.points      = points;
	request.noise       = noise;
	request.farOutliers = outliers;
	request.seed        = 9;
	return samples::generate(request).positions;
}

TEST(OutlierVoter, FindsThePlaneItsDeviationAndTheSpacing)
{
	for (const double outliers : {0.0, 0.2}) {
		const double noise = 0.003 * std::sqrt(2.0); // of the diagonal of the unit square
		const Cloud  cloud(pointsOf("plane", 4000, 0.003, outliers));
		int          tried     = 0;
		double       deviation = 0.0;
		for (Index i = 0; i < 4000 && tried < 40; i += 61) {
			if (cloud.positions.col(i).head<2>().cwiseAbs().maxCoeff() > 0.3 ||
			    std::abs(cloud.positions(2, i)) > 0.01)
				continue;
			const OutlierVoter voter = cloud.voter(i, 60);
			ASSERT_TRUE(voter.surface.valid);
			++tried;
			const Vector3d normal = voter.surface.normal(0.0, 0.0);
			EXPECT_GT(std::abs(normal.z()), 0.98);
			EXPECT_NEAR(voter.spacing, 1.0 / std::sqrt(4000.0), 0.35 / std::sqrt(4000.0));
			deviation += voter.deviation();
			EXPECT_EQ(voter.support({0.0, 0.0, 0.0}), OutlierVoter::Support::Inside);
			EXPECT_EQ(voter.support({4.0, 0.0, 0.0}), OutlierVoter::Support::Outside);
			EXPECT_FALSE(voter.ball.empty());
			for (const Index j : voter.ball)
				EXPECT_LE(
					(cloud.positions.col(j) - cloud.positions.col(i)).norm(),
					voter.surface.radius * (1.0 + 1e-9));
		}
		ASSERT_GT(tried, 10);
		EXPECT_NEAR(deviation / tried, noise, 0.25 * noise);
	}
}

TEST(OutlierVoter, SeesTheHeightOfAPointAboveASphere)
{
	const Cloud        cloud(pointsOf("sphere", 4000, 0.0));
	const OutlierVoter voter = cloud.voter(10, 50);
	ASSERT_TRUE(voter.surface.valid);
	const Vector3d out = cloud.positions.col(10).normalized();
	for (const double height : {-0.05, 0.0, 0.05}) {
		const double residual = voter.surface.residual(voter.surface.toLocal((1.0 + height) * out));
		EXPECT_NEAR(std::abs(residual), std::abs(height), 2e-3);
	}
}

TEST(OutlierVoter, WithoutAMajorityOnASurfaceThereIsNoVote)
{
	samples::Random  random(4, 0);
	Eigen::Matrix3Xd blob(3, 500);
	for (int k = 0; k < 500; ++k)
		blob.col(k) = random.normal3();
	const Cloud cloud(blob);
	int         rough = 0;
	for (Index i = 0; i < 500; i += 10) {
		const OutlierVoter voter = cloud.voter(i, 60);
		rough += !voter.surface.valid || voter.deviation() > 0.1 * voter.surface.radius;
	}
	EXPECT_EQ(rough, 50);
}

// At the rim of a square a voter knows nothing beyond it.
TEST(OutlierVoter, KnowsWhereItsPointsEnd)
{
	const Cloud cloud(pointsOf("plane", 4000, 0.0));
	Index       atRim = 0;
	for (Index i = 0; i < 4000; ++i)
		if (std::abs(cloud.positions(1, i)) < 0.2 &&
		    cloud.positions(0, i) > cloud.positions(0, atRim))
			atRim = i;
	const OutlierVoter voter = cloud.voter(atRim, 60);
	ASSERT_TRUE(voter.surface.valid);
	const double   r  = voter.surface.radius;
	const Vector3d p  = cloud.positions.col(atRim);
	const auto     at = [&](double step) {
        return voter.support(voter.surface.toLocal(p + Vector3d(step * r, 0, 0)));
	};
	EXPECT_EQ(at(-0.5), OutlierVoter::Support::Inside);
	EXPECT_EQ(at(0.9), OutlierVoter::Support::Outside);
}

} // namespace
} // namespace curvature_lines
