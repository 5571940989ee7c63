// The scale found from the cloud: mixtures are shares, more noise asks for more points, and what a cloud's place and
// pose may not change.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "adaptive_scale.h"

#include <cstddef>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <omp.h>

#include "point_cloud.h"
#include "point_subsets.h"
#include "scale_mixture.h"
#include "shuffled_cloud.h"
#include "surface_anchors.h"

namespace curvature_lines::test {
namespace {

AdaptiveScaleOptions fewProbes()
{
	AdaptiveScaleOptions options;
	options.minProbes = 128;
	options.maxProbes = 256;
	return options;
}

// Mean over the probes of the radius that each relies on.
double meanRadius(const ScaleSelection& selection)
{
	double sum = 0.0;
	for (const ScaleMixture& mixture : selection.mixtures)
		for (const auto& [scale, share] : mixture.weights)
			sum += share * selection.scales[scale].radius();
	return sum / double(selection.mixtures.size());
}

TEST(AdaptiveScale, MixturesAreSharesOfTheCandidates)
{
	const PointSample    sample(shuffledCloud("torus", 3000, 0.003));
	const ScaleSelection found = selectScales(sample, fewProbes());
	ASSERT_GT(found.scales.size(), 3u);
	ASSERT_EQ(found.positions.cols(), static_cast<Eigen::Index>(found.mixtures.size()));
	ASSERT_GE(found.mixtures.size(), 32u); // at every fourth of the probes
	for (const ScaleMixture& mixture : found.mixtures) {
		ASSERT_FALSE(mixture.weights.empty());
		double sum = 0.0, before = 1.0;
		for (const auto& [scale, share] : mixture.weights) {
			EXPECT_TRUE(scale >= 0 && scale < static_cast<int>(found.scales.size()));
			EXPECT_GT(share, 0.0);
			EXPECT_LE(share, before);
			before = share;
			sum += share;
		}
		EXPECT_NEAR(sum, 1.0, 1e-12);
		EXPECT_GE(mixture.variance, 0.0);
	}
	for (const CurvatureScale& scale : found.scales) {
		EXPECT_GT(scale.height.radius, 0.0);
		EXPECT_TRUE(scale.height.degree == 2 || scale.height.degree == 4);
		EXPECT_TRUE(scale.normalRadius == 0.0 || scale.normalRadius > scale.height.radius);
	}
	EXPECT_GT(found.usualRadius, 0.0);
}

TEST(AdaptiveScale, GrowsWithTheNoiseAndMeasuresIt)
{
	double radius = 0.0;
	for (const double noise : {0.0005, 0.002, 0.008}) {
		const PointSample    sample(shuffledCloud("torus", 4000, noise));
		const ScaleSelection found = selectScales(sample, fewProbes());
		EXPECT_GT(meanRadius(found), radius) << noise;
		radius = meanRadius(found);
		if (noise >= 0.002) { // below, the smallest balls are bent by more than the noise
			EXPECT_GT(found.quadricResidual, 0.7 * noise);
			EXPECT_LT(found.quadricResidual, 1.3 * noise);
		}
	}
}

TEST(AdaptiveScale, FollowsARigidMotionAndIsTheSameForAnyThreads)
{
	const PointCloud      cloud = shuffledCloud("ellipsoid", 2500, 0.002);
	const Eigen::Matrix3d turn =
		Eigen::AngleAxisd(0.9, Eigen::Vector3d(2.0, -1.0, 2.0).normalized()).toRotationMatrix();
	const PointSample    still(cloud), turned({turn * cloud.positions, turn * cloud.normals});
	const ScaleSelection a       = selectScales(still, fewProbes());
	const ScaleSelection b       = selectScales(turned, fewProbes());
	const int            threads = omp_get_max_threads();
	omp_set_num_threads(1);
	const ScaleSelection c = selectScales(still, fewProbes());
	omp_set_num_threads(threads);
	EXPECT_NEAR(meanRadius(a), meanRadius(b), 1e-6 * meanRadius(a));
	EXPECT_NEAR(a.usualRadius, b.usualRadius, 1e-9 * a.usualRadius);
	EXPECT_NEAR(a.quadricResidual, b.quadricResidual, 1e-6 * a.quadricResidual);
	ASSERT_EQ(a.mixtures.size(), c.mixtures.size());
	EXPECT_EQ(a.positions, c.positions);
	EXPECT_EQ(meanRadius(a), meanRadius(c));
	for (std::size_t k = 0; k < a.mixtures.size(); ++k)
		EXPECT_EQ(a.mixtures[k].weights, c.mixtures[k].weights);
}

} // namespace
} // namespace curvature_lines::test
