// Candidate scales at the probes of spheres and planes, whose shape operators are known.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "scale_trials.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "point_cloud.h"
#include "point_subsets.h"
#include "shuffled_cloud.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3d;

TEST(ScaleTrials, ProductsOfShapeVectorsAreThoseOfTensors)
{
	samples::Random random(1, 0);
	for (int k = 0; k < 20; ++k) {
		Matrix3d a, b;
		a << random.normal3(), random.normal3(), random.normal3();
		b << random.normal3(), random.normal3(), random.normal3();
		a += a.transpose().eval();
		b += b.transpose().eval();
		EXPECT_NEAR(shapeVector(a).dot(shapeVector(b)), (a * b).trace(), 1e-12);
	}
}

TEST(ScaleTrials, AllFamiliesKnowASphere)
{
	const Index       probes = 200;
	const PointSample sample(shuffledCloud("sphere", 6000, 0.0005));
	const double      radius = sample.cloud.positions.colwise().norm().mean();
	ScaleTrials       trials(sample, probes, 0.0005);
	trials.run(0.08, 3);
	trials.run(0.1, 4);
	ASSERT_EQ(trials.all().size(), 6u);
	ASSERT_EQ(trials.positions(), sample.cloud.positions.leftCols(probes));
	// Of a half, in shares of the shape operator: from much variance to little.
	const double mostError[] = {0.3, 0.05, 0.015, 0.15, 0.025, 0.01};
	for (std::size_t c = 0; c < 6; ++c) {
		const ScaleTrial& trial = trials.all()[c];
		EXPECT_EQ(trial.scale.height.radius, c < 3 ? 0.08 : 0.1);
		EXPECT_EQ(trial.scale.level, c < 3 ? 3 : 4);
		EXPECT_EQ(trial.scale.family, static_cast<int>(c % 3));
		double square = 0.0, variance = 0.0, offset = 0.0;
		for (Index p = 0; p < probes; ++p) {
			ASSERT_TRUE(trial.valid(p));
			EXPECT_FALSE(trial.atEdge(p));
			const Eigen::Vector3d n = trials.positions().col(p).normalized();
			const ShapeVector     exact =
				shapeVector((Matrix3d::Identity() - n * n.transpose()) / radius);
			for (const auto& half : trial.halves) {
				square += 0.5 * (half[p].shape - exact).squaredNorm();
				EXPECT_LT(half[p].residual * trial.scale.height.radius, 0.0015);
				offset += 0.5 * half[p].offset;
			}
			variance += trial.variance(p);
		}
		EXPECT_LT(std::sqrt(square / probes), mostError[c] * std::sqrt(2.0) / radius) << c;
		EXPECT_LT(offset / probes, 0.08) << c; // no rim
		// The halves share no points, and a sphere is fitted without bias worth the name: the mean of both errs half as
		// much, squared, as one.
		EXPECT_NEAR(variance / (0.5 * square), 1.0, 0.3) << c;
	}
}

TEST(ScaleTrials, NormalsAreNotFittedOverMostOfTheCloud)
{
	const PointSample sample(shuffledCloud("sphere", 1500, 0.0));
	ScaleTrials       trials(sample, 50, 0.0);
	trials.run(0.2, 0); // 1.7 times this is within .36, 2.4 times is not
	trials.run(0.22, 1);
	ASSERT_EQ(trials.all().size(), 3u);
	EXPECT_EQ(trials.all()[1].scale.family, 1);
	EXPECT_EQ(trials.all()[2].scale.family, 0);
}

TEST(ScaleTrials, OffsetsTellTheRimOfAPlane)
{
	const PointSample sample(shuffledCloud("plane", 4000, 0.0));
	ScaleTrials       trials(sample, 400, 0.0);
	const double      radius = 0.06;
	trials.run(radius, 0);
	const auto low  = sample.cloud.positions.rowwise().minCoeff().eval();
	const auto high = sample.cloud.positions.rowwise().maxCoeff().eval();
	int        rim = 0, inside = 0;
	double     atRim = 0.0, within = 0.0;
	for (Index p = 0; p < 400; ++p) {
		const Eigen::Vector2d at = trials.positions().col(p).head<2>();
		const double          distance =
			std::min((at - low.head<2>()).minCoeff(), (high.head<2>() - at).minCoeff());
		const ScaleTrial& trial  = trials.all()[0];
		const double      offset = 0.5 * (trial.halves[0][p].offset + trial.halves[1][p].offset);
		if (distance < 0.2 * radius) {
			++rim;
			atRim += offset;
		}
		else if (distance > 1.5 * radius) {
			++inside;
			within += offset;
		}
	}
	ASSERT_GT(rim, 5);
	ASSERT_GT(inside, 100);
	EXPECT_GT(atRim / rim, 0.2);
	EXPECT_LT(within / inside, 0.1); // by chance: the mean of some fifty points
}

} // namespace
} // namespace curvature_lines::test
