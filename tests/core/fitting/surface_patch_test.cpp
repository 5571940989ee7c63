// The local quadric: exact on quadrics, its leverage and scale by the textbook's matrices, the robust fit
// among points that lie elsewhere.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_patch.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "local_polynomial.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using samples::Random;

Eigen::Matrix<double, 1, 1> value(double z)
{
	return Eigen::Matrix<double, 1, 1>(z);
}

double paraboloid(double x, double y)
{
	return 0.02 + 0.1 * x - 0.2 * y + 0.3 * x * x - 0.1 * x * y + 0.05 * y * y;
}

TEST(SurfacePatch, FindsAQuadricAndItsNormals)
{
	const double    radius = 0.4;
	SurfacePatch    patch(Vector3d(1.0, 2.0, 3.0), Vector3d(1.0, 1.0, 0.5).normalized(), radius);
	LocalSamples<1> samples;
	Random          random(1, 0);
	samples.reserve(40);
	for (int k = 0; k < 40; ++k) {
		const double x = random.uniform(-0.7, 0.7), y = random.uniform(-0.7, 0.7);
		samples.add(x, y, supportWeight(x, y), value(paraboloid(x, y)));
	}
	ASSERT_TRUE(fitPatch(patch, samples));
	EXPECT_NEAR(patch.scale, 0.0, 1e-7);
	const auto at = [&](double x, double y) -> Vector3d {
		return patch.origin + radius * patch.frame.toSpace(Eigen::Vector2d(x, y)) +
		       paraboloid(x, y) * patch.frame.n;
	};
	const double        x = 0.3, y = -0.2, h = 1e-5;
	const Vector3d      p  = at(x, y);
	const Vector3d      du = (at(x + h, y) - at(x - h, y)), dv = (at(x, y + h) - at(x, y - h));
	const Vector3d      normal = du.cross(dv).normalized();
	SurfacePatch::Local local  = patch.toLocal(p);
	EXPECT_NEAR(patch.residual(local), 0.0, 1e-9);
	EXPECT_LT((patch.normal(x, y) - normal).norm(), 1e-6);
	// Off the surface along the normal, the residual is the distance to first order.
	EXPECT_NEAR(patch.residual(patch.toLocal(p + 1e-3 * normal)), 1e-3, 2e-5);

	const Vector3d before = patch.normal(0.0, 0.0);
	patch.tilt();
	EXPECT_LT((patch.frame.n - before).norm(), 1e-12);
}

TEST(SurfacePatch, LeverageScaleAndCountByDenseMatrices)
{
	SurfacePatch        patch(Vector3d::Zero(), Vector3d::UnitZ(), 1.0);
	LocalSamples<1>     samples;
	std::vector<double> residuals;
	Random              random(2, 0);
	const int           n = 50;
	MatrixXd            phi(n, 6);
	Eigen::VectorXd     w(n);
	samples.reserve(n);
	for (int k = 0; k < n; ++k) {
		const double x = random.uniform(-0.7, 0.7), y = random.uniform(-0.7, 0.7);
		phi.row(k) << 1.0, x, y, x * x, x * y, y * y;
		w[k] = supportWeight(x, y);
		samples.add(x, y, w[k], value(paraboloid(x, y) + 0.01 * random.normal()));
	}
	ASSERT_TRUE(fitPatch(patch, samples));
	patchResiduals(patch, samples, residuals);
	const MatrixXd inverse = (phi.transpose() * w.asDiagonal() * phi).inverse();
	const MatrixXd lost    = inverse * phi.transpose() * w.cwiseProduct(w).asDiagonal() * phi;
	double         squares = 0.0;
	for (int k = 0; k < n; ++k) {
		EXPECT_NEAR(
			patch.leverage(phi(k, 1), phi(k, 2)),
			phi.row(k).dot(inverse * phi.row(k).transpose()),
			1e-7);
		EXPECT_NEAR(
			residuals[k], patch.residual({samples.x[k], samples.y[k], samples.value[0][k]}), 1e-14);
		squares += w[k] * residuals[k] * residuals[k];
	}
	EXPECT_NEAR(patch.scale, std::sqrt(squares / (w.sum() - lost.trace())), 1e-8);
	EXPECT_NEAR(patch.effectiveCount, w.sum() * w.sum() / w.squaredNorm(), 1e-9);
}

TEST(SurfacePatch, TooFewOrCollinearSamplesAreInvalidOrFinite)
{
	SurfacePatch    patch(Vector3d::Zero(), Vector3d::UnitZ(), 1.0);
	LocalSamples<1> samples;
	samples.reserve(20);
	for (int k = 0; k < 5; ++k)
		samples.add(0.1 * k, 0.01 * k * k, 1.0, value(0.0));
	EXPECT_FALSE(fitPatch(patch, samples));
	samples.reserve(20);
	for (int k = 0; k < 20; ++k)
		samples.add(0.05 * k, 0.0, 1.0, value(0.1));
	if (fitPatch(patch, samples)) {
		EXPECT_TRUE(patch.coefficients.allFinite());
		EXPECT_TRUE(std::isfinite(patch.scale));
		EXPECT_NEAR(patch.residual({0.3, 0.0, 0.1}), 0.0, 1e-6);
	}
}

// `share` of the points on a noisy paraboloid within the unit disk, the others where `elsewhere` says.
template<class Elsewhere>
Matrix3Xd mixture(int n, double share, double noise, const Elsewhere& elsewhere)
{
	Random                random(3, 0);
	std::vector<Vector3d> points;
	while (static_cast<int>(points.size()) < n) {
		const double x = random.uniform(-1.0, 1.0), y = random.uniform(-1.0, 1.0);
		if (x * x + y * y > 1.0)
			continue;
		const Vector3d on(x, y, 0.2 * x * x + noise * random.normal());
		points.push_back(random.uniform() < share ? on : elsewhere(on, random));
	}
	std::sort(points.begin(), points.end(), [](const Vector3d& a, const Vector3d& b) {
		return a.squaredNorm() < b.squaredNorm();
	});
	Matrix3Xd result(3, n);
	for (int k = 0; k < n; ++k)
		result.col(k) = points[k];
	return result;
}

double largestError(const SurfacePatch& patch)
{
	double largest = 0.0;
	for (double x = -0.5; x <= 0.5; x += 0.25)
		for (double y = -0.5; y <= 0.5; y += 0.25)
			largest = std::max(
				largest, std::abs(patch.residual(patch.toLocal(Vector3d(x, y, 0.2 * x * x)))));
	return largest;
}

TEST(RobustPatch, NoiseAndScale)
{
	SurfacePatch       patch;
	RobustPatchScratch scratch;
	const Matrix3Xd points = mixture(150, 1.0, 0.01, [](const Vector3d& p, Random&) { return p; });
	ASSERT_TRUE(fitPatchRobustly(patch, points, 1.0, 1e-6, 1, scratch));
	EXPECT_NEAR(patch.scale, 0.0095, 0.002);
	EXPECT_LT(largestError(patch), 0.01);
}

TEST(RobustPatch, AThirdOfThePointsAnywhere)
{
	SurfacePatch       patch;
	RobustPatchScratch scratch;
	const Matrix3Xd    points =
		mixture(150, 0.65, 0.005, [](const Vector3d& p, Random& random) -> Vector3d {
			return {p.x(), p.y(), random.uniform(-0.7, 0.7)};
		});
	ASSERT_TRUE(fitPatchRobustly(patch, points, 1.0, 1e-6, 1, scratch));
	EXPECT_LT(largestError(patch), 0.01);
	EXPECT_LT(patch.scale, 0.02);
}

TEST(RobustPatch, OneOfTwoSheetsNotTheMiddle)
{
	SurfacePatch       patch;
	RobustPatchScratch scratch;
	const Matrix3Xd    points = mixture(150, 0.6, 0.003, [](const Vector3d& p, Random&) {
        return Vector3d(p - Vector3d(0, 0, 0.3));
    });
	ASSERT_TRUE(fitPatchRobustly(patch, points, 1.0, 1e-6, 1, scratch));
	EXPECT_LT(largestError(patch), 0.005);
	EXPECT_LT(patch.scale, 0.005);
}

TEST(RobustPatch, DegeneratePointsAreRefusedOrFinite)
{
	SurfacePatch       patch;
	RobustPatchScratch scratch;
	EXPECT_FALSE(fitPatchRobustly(patch, Matrix3Xd(3, 0), 0.0, 0.0, 1, scratch));
	Matrix3Xd line = Matrix3Xd::Zero(3, 30);
	line.row(0).setLinSpaced(0.0, 1.0);
	EXPECT_FALSE(fitPatchRobustly(patch, line, 1.0, 1e-3, 1, scratch));
	const Matrix3Xd flat = mixture(
		40, 0.0, 0.0, [](const Vector3d& p, Random&) { return Vector3d(p.x(), p.y(), 0.0); });
	ASSERT_TRUE(fitPatchRobustly(patch, flat, 1.0, 1e-4, 1, scratch));
	EXPECT_TRUE(patch.coefficients.allFinite());
	EXPECT_EQ(patch.scale, 1e-4);
}

} // namespace
} // namespace curvature_lines::test
