// Which options ask for the same estimate, the choice between the two estimates, and directions turned into other tangent planes.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "curvature_estimate.h"
#include "curvature_field.h"
#include "exact_field.h"
#include "point_cloud.h"
#include "robust_curvature.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

test::ExactCloud exact(const char* surface, int points)
{
	samples::SampleRequest request;
	request.surface = surface;
	request.points  = points;
	request.seed    = 8;
	return test::exactCloud(request);
}

double relativeError(const Eigen::VectorXd& found, const Eigen::VectorXd& truth)
{
	std::vector<double> errors;
	for (Index i = 0; i < static_cast<Index>(found.size()); ++i)
		errors.push_back(std::abs(found[i] - truth[i]));
	std::nth_element(errors.begin(), errors.begin() + errors.size() / 2, errors.end());
	return errors[errors.size() / 2] / truth.cwiseAbs().mean();
}

TEST(CurvatureEstimate, BothScalesFindTheCurvatureOfATorus)
{
	const test::ExactCloud torus = exact("torus", 3000);
	CurvatureOptions       options;
	std::vector<double>    radii;
	for (const ScaleMode mode : {ScaleMode::Adaptive, ScaleMode::Paper}) {
		options.scaleMode          = mode;
		const CurvatureField field = estimateCurvature(torus.cloud, options);
		EXPECT_LT(relativeError(field.k1, torus.field.k1), 0.02);
		EXPECT_LT(relativeError(field.k2, torus.field.k2), 0.06);
		radii.push_back(field.radius.mean());
	}
	EXPECT_NE(radii[0], radii[1]);
}

TEST(CurvatureEstimate, SurfaceNormalsAreAcrossTheDirections)
{
	const test::ExactCloud torus = exact("torus", 500);
	EXPECT_LT((surfaceNormals(torus.field) - torus.cloud.normals).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(CurvatureEstimate, DirectionsTurnAsLittleAsPossible)
{
	test::ExactCloud torus = exact("torus", 500);
	samples::Random  random(1, 0);
	Eigen::Matrix3Xd tilted = torus.cloud.normals;
	for (Index i = 0; i < torus.cloud.size(); ++i)
		tilted.col(i) = (tilted.col(i) + 0.2 * random.normal3()).normalized();
	CurvatureField field = torus.field;
	makeTangent(tilted, field);
	for (Index i = 0; i < torus.cloud.size(); ++i) {
		const Vector3d n = tilted.col(i), d1 = field.d1.col(i), d2 = field.d2.col(i);
		EXPECT_NEAR(d1.norm(), 1.0, 1e-12);
		EXPECT_NEAR(d1.dot(n), 0.0, 1e-12);
		EXPECT_LT((n.cross(d1) - d2).norm(), 1e-12);
		// no tangent direction is closer to the old one
		const Vector3d old = torus.field.d1.col(i);
		EXPECT_NEAR(d1.dot(old), (old - n.dot(old) * n).norm(), 1e-9);
	}
	makeTangent(tilted, field); // again changes nothing
	EXPECT_LT((surfaceNormals(field) - tilted).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(CurvatureEstimate, ADirectionAlongTheNormalIsReplaced)
{
	test::ExactCloud torus = exact("torus", 200);
	CurvatureField   field = torus.field;
	makeTangent(field.d1, field);
	EXPECT_TRUE(field.d1.allFinite());
	for (Index i = 0; i < field.size(); ++i) {
		EXPECT_NEAR(field.d1.col(i).norm(), 1.0, 1e-12);
		EXPECT_NEAR(field.d1.col(i).dot(torus.field.d1.col(i)), 0.0, 1e-9);
	}
}

CurvatureOptions paper()
{
	CurvatureOptions options;
	options.scaleMode = ScaleMode::Paper;
	return options;
}

// Every option of the published estimate.
const std::vector<std::function<void(RobustCurvatureOptions&)>> changes = {
	[](auto& o) { o.regionScale += 1.0; },
	[](auto& o) { o.maxIterations += 1; },
	[](auto& o) { o.tolerance *= 2.0; },
	[](auto& o) { o.sigmaFactor += 0.1; },
	[](auto& o) { o.cut += 0.1; },
	[](auto& o) { o.featureGate = !o.featureGate; },
	[](auto& o) { o.robust = !o.robust; },
	[](auto& o) { o.maxPoints += 1; },
	[](auto& o) { o.maxPairs += 1; },
};

TEST(CurvatureOptions, DifferInTheirMode)
{
	EXPECT_TRUE(paper() == paper());
	EXPECT_TRUE(CurvatureOptions() == CurvatureOptions());
	EXPECT_FALSE(paper() == CurvatureOptions());
}

TEST(CurvatureOptions, DifferInEveryOptionOfTheirMode)
{
	for (std::size_t k = 0; k < changes.size(); ++k) {
		CurvatureOptions changed = paper();
		changes[k](changed.paper);
		EXPECT_FALSE(changed == paper()) << k;
	}
	CurvatureOptions changed;
	changed.adaptive.minProbes += 1;
	EXPECT_FALSE(changed == CurvatureOptions());
	changed = {};
	changed.adaptive.maxProbes += 1;
	EXPECT_FALSE(changed == CurvatureOptions());
}

TEST(CurvatureOptions, OptionsOfTheOtherModeDoNotCount)
{
	for (const auto& change : changes) {
		CurvatureOptions changed;
		change(changed.paper);
		EXPECT_TRUE(changed == CurvatureOptions());
	}
	CurvatureOptions changed = paper();
	changed.adaptive.minProbes += 1;
	EXPECT_TRUE(changed == paper());
}

TEST(CurvatureEstimate, GivenDirectionsAreTakenWhereTheyAreUsable)
{
	const double     nan = std::numeric_limits<double>::quiet_NaN();
	Eigen::Matrix3Xd normals(3, 3), given(3, 3);
	normals.colwise() = Vector3d(0, 0, 1);
	given.col(0)      = Vector3d(0, 5, 2); // to be made tangent and unit
	given.col(1)      = Vector3d(0, nan, 0);
	given.col(2)      = Vector3d(0, 1e-9, 0);
	CurvatureField field;
	field.k1.setZero(3);
	field.d1.resize(3, 3);
	field.d2.resize(3, 3);
	field.d1.colwise() = Vector3d(1, 0, 0);
	field.d2.colwise() = Vector3d(0, 1, 0);
	adoptDirections(given, normals, field);
	EXPECT_EQ(Vector3d(field.d1.col(0)), Vector3d(0, 1, 0));
	EXPECT_EQ(Vector3d(field.d2.col(0)), Vector3d(-1, 0, 0));
	for (int i = 1; i < 3; ++i) {
		EXPECT_EQ(Vector3d(field.d1.col(i)), Vector3d(1, 0, 0));
		EXPECT_EQ(Vector3d(field.d2.col(i)), Vector3d(0, 1, 0));
	}
}

} // namespace
} // namespace curvature_lines
