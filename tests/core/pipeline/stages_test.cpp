// Each stage by itself: what it takes over from the value before, and what it refuses.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "cloud_index.h"
#include "curvature_estimate.h"
#include "point_cloud.h"
#include "stages.h"

namespace curvature_lines::test {
namespace {

CloudIndex torus(int points, double noise)
{
	samples::SampleRequest request;
	request.points    = points;
	request.noise     = noise;
	request.seed      = 5;
	const auto sample = samples::generate(request);
	return prepareCloud(sample.positions, sample.normals).cloud;
}

TEST(Stages, AllPointsAreKeptAsTheyAre)
{
	const CloudIndex  given  = torus(500, 0.005);
	const NoisyPoints points = allPoints(given);
	EXPECT_EQ(&points.index.cloud(), &given.cloud());
	std::vector<Index> all(500);
	std::iota(all.begin(), all.end(), 0);
	EXPECT_EQ(points.kept, all);
	EXPECT_EQ(points.outlier, std::vector<char>(500, 0));
	EXPECT_EQ(points.heightDeviation, 0.0);
}

TEST(Stages, WhatIsLeftOfOutliersAreThePointsNamed)
{
	const CloudIndex clean = torus(1500, 0.003);
	PointCloud       cloud = clean.cloud();
	cloud.positions.col(7) += 0.2 * cloud.normals.col(7);
	const NoisyPoints points = withoutOutliers(cloud, {}, {});
	EXPECT_TRUE(points.outlier[7]);
	ASSERT_EQ(static_cast<Index>(points.kept.size()), points.index.size());
	for (Index k = 0; k < points.index.size(); ++k) {
		EXPECT_FALSE(points.outlier[points.kept[k]]);
		EXPECT_EQ(points.index.cloud().positions.col(k), cloud.positions.col(points.kept[k]));
	}
	EXPECT_GT(points.heightDeviation, 0.0);
}

TEST(Stages, ThinningKeepsTheNamesOfTheGivenPoints)
{
	const CloudIndex  given = torus(4000, 0.003);
	const NoisyPoints whole = thinned(allPoints(given), 5000.0, {});
	EXPECT_EQ(whole.index.size(), 4000);
	const NoisyPoints some = thinned(allPoints(given), 1000.0, {});
	EXPECT_NEAR(some.index.size(), 1000, 100);
	for (Index k = 0; k < some.index.size(); ++k)
		EXPECT_EQ(some.index.cloud().positions.col(k), given.cloud().positions.col(some.kept[k]));
}

TEST(Stages, DirectionsAreTangentToTheNormalsOfTheSurface)
{
	const NoisyPoints noisy = allPoints(torus(1500, 0.005));
	StageClock        clock;
	for (const bool denoise : {false, true})
		for (const auto stage : {estimateThenDenoise, denoiseThenEstimate}) {
			CleaningOptions options;
			options.denoise            = denoise;
			const CleanSurface surface = stage(noisy, options, clock, {});
			EXPECT_EQ(surface.rmsMove > 0.0, denoise);
			const Eigen::Matrix3Xd& normals = surface.index.cloud().normals;
			for (Index i = 0; i < surface.index.size(); ++i) {
				EXPECT_NEAR(surface.field.d1.col(i).dot(normals.col(i)), 0.0, 1e-9);
				EXPECT_NEAR(surface.field.d1.col(i).norm(), 1.0, 1e-9);
			}
		}
	for (const char* stage : {"neighborhoods", "curvature", "denoising"})
		EXPECT_EQ(clock.seconds().count(stage), 1u) << stage;
}

// The curvature of the first order is that of the points as they were.
TEST(Stages, TheTwoOrdersEstimateDifferentPoints)
{
	const NoisyPoints    noisy = allPoints(torus(1500, 0.005));
	StageClock           clock;
	const CurvatureField direct = estimateCurvature(noisy.index);
	EXPECT_EQ(estimateThenDenoise(noisy, {}, clock, {}).field.k1, direct.k1);
	EXPECT_NE(denoiseThenEstimate(noisy, {}, clock, {}).field.k1, direct.k1);
}

TEST(Stages, AutomaticTargets)
{
	EXPECT_EQ(automaticTargetVertices(100), 25);
	EXPECT_EQ(automaticTargetVertices(4000), 500);
	EXPECT_EQ(automaticTargetVertices(160000), 10000);
	EXPECT_EQ(mostTargetVertices(249), 996);
}

} // namespace
} // namespace curvature_lines::test
