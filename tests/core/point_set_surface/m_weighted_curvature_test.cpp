// M-weighted curvature: the weight's formula, the least squares against an independent solver, exact surfaces,
// the noise figure of T06, the invariances that follow from the geometry, and degenerate clouds.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "cloud_index.h"
#include "estimated_field.h"
#include "local_polynomial.h"
#include "m_weighted_curvature.h"
#include "point_cloud.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Weighting = MWeightedCurvatureOptions::Weighting;

samples::SampleCloud sampled(const std::string& surface, int points, double noise = 0.0)
{
	samples::SampleRequest request;
	request.surface = surface;
	request.points  = points;
	request.noise   = noise;
	request.seed    = 1;
	return samples::generate(request);
}

EstimatedField estimate(
	const Matrix3Xd&                 positions,
	const Matrix3Xd&                 normals,
	const MWeightedCurvatureOptions& options = {})
{
	EstimatedField result;
	result.prepared = prepareCloud(positions, normals);
	const CloudIndex index(result.prepared.cloud);
	result.minimum = index.minimum();
	result.field   = mWeightedCurvature(index, options);
	return result;
}

TEST(MWeight, PeaksAtBandwidthTimesRootOfExponent)
{
	for (const double h : {0.3, 1.0, 2.0})
		for (const Index xi : {1, 2, 5}) {
			const double peak = h * std::sqrt(double(xi));
			// Where the derivative changes its sign.
			double low = 0.5 * peak, high = 1.5 * peak;
			for (int it = 0; it < 200; ++it) {
				const double x             = 0.5 * (low + high);
				const double slope         = 2.0 * double(xi) / x - 2.0 * x / (h * h); // of log w
				(slope > 0.0 ? low : high) = x;
			}
			EXPECT_NEAR(low, peak, 1e-9);
			EXPECT_NEAR(
				mWeight(peak, h, xi),
				std::pow(peak, 2.0 * double(xi)) * std::exp(-double(xi)),
				1e-9);
			for (const double step : {1e-4, 0.1, 0.4})
				for (const double side : {-1.0, 1.0})
					EXPECT_LT(mWeight(peak * (1.0 + side * step), h, xi), mWeight(peak, h, xi));
			EXPECT_EQ(mWeight(0.0, h, xi), 0.0);
		}
	EXPECT_DOUBLE_EQ(gaussianWeight(0.0, 2.0), 1.0);
	EXPECT_DOUBLE_EQ(gaussianWeight(2.0, 2.0), std::exp(-1.0));
}

void add(LocalSamples<1>& samples, const Vector3d& q, double weight)
{
	samples.add(q.x(), q.y(), weight, Eigen::Matrix<double, 1, 1>(q.z()));
}

TEST(EulerFit, IsTheWeightedLeastSquaresSolution)
{
	samples::Random random(5, 0);
	for (int repeat = 0; repeat < 20; ++repeat) {
		constexpr int   count = 15;
		LocalSamples<1> neighbors;
		neighbors.reserve(count + 2);
		Eigen::MatrixXd a(count, 3);
		Eigen::VectorXd b(count);
		for (int s = 0; s < count; ++s) {
			const Vector3d q = random.normal3();
			const double   w = random.uniform(0.1, 2.0), phi = std::atan2(q.y(), q.x());
			add(neighbors, q, w);
			a.row(s) << 1.0, std::cos(2 * phi), std::sin(2 * phi);
			a.row(s) *= std::sqrt(w);
			b[s] = -std::sqrt(w) * 2.0 * q.z() / q.squaredNorm();
		}
		add(neighbors, Vector3d::Zero(), 1.0); // neither of them has a direction
		add(neighbors, Vector3d::UnitZ(), 1.0);
		const Vector3d v   = a.colPivHouseholderQr().solve(b);
		const EulerFit fit = fitEuler(neighbors);
		ASSERT_TRUE(fit.valid);
		EXPECT_NEAR(fit.k1, v[0] + std::hypot(v[1], v[2]), 1e-9);
		EXPECT_NEAR(fit.k2, v[0] - std::hypot(v[1], v[2]), 1e-9);
		const double phi = std::atan2(fit.d1.y(), fit.d1.x());
		EXPECT_NEAR(v[0] + v[1] * std::cos(2 * phi) + v[2] * std::sin(2 * phi), fit.k1, 1e-9);
		EXPECT_NEAR(fit.d1.norm(), 1.0, 1e-12);
	}
}

TEST(EulerFit, NeedsDirectionsThatDetermineATensor)
{
	LocalSamples<1> none, line, cross;
	for (auto* neighbors : {&none, &line, &cross})
		neighbors->reserve(9);
	for (int s = 1; s < 9; ++s) {
		add(line, Vector3d(s % 2 ? s : -s, 0, 0.1 * s), 1.0);
		add(cross, s % 2 ? Vector3d(s, 0, 0.1 * s) : Vector3d(0, s, 0.2 * s), 1.0);
	}
	EXPECT_FALSE(fitEuler(none).valid);
	EXPECT_FALSE(fitEuler(line).valid);
	EXPECT_FALSE(fitEuler(cross).valid); // the twist between two lines is not seen
}

TEST(MWeightedCurvature, ExactSurfaces)
{
	// Of a sphere every chord has the exact curvature.
	const auto sphere = sampled("sphere", 1000);
	const auto errors = curvatureErrors(estimate(sphere.positions, sphere.normals), sphere);
	EXPECT_LT(errors.k1, 1e-9);
	EXPECT_LT(errors.k2, 1e-9);

	const auto torus  = sampled("torus", 20000);
	const auto coarse = sampled("torus", 5000);
	const auto fine   = curvatureErrors(estimate(torus.positions, torus.normals), torus);
	EXPECT_LT(fine.k1, 0.02); // of 2.5
	EXPECT_LT(fine.k2, 0.02);
	EXPECT_LT(fine.direction, 0.01);
	// Smaller with the square of the spacing on an even density, in between on a random one.
	EXPECT_LT(
		fine.k1, 0.55 * curvatureErrors(estimate(coarse.positions, coarse.normals), coarse).k1);
}

TEST(MWeightedCurvature, WithstandsNoiseBetterThanOtherWeights) // T06 fig. 6
{
	const auto sample = sampled("torus", 2000, 0.0025);
	const auto k1     = [&](Weighting weighting) {
        MWeightedCurvatureOptions options;
        options.weighting = weighting;
        return curvatureErrors(estimate(sample.positions, sample.normals, options), sample).k1;
	};
	const double m = k1(Weighting::M);
	EXPECT_LT(m, 0.3);
	EXPECT_LT(m, 0.5 * k1(Weighting::Unweighted));
	EXPECT_LT(m, 0.2 * k1(Weighting::Gaussian));
}

TEST(MWeightedCurvature, ErrorIsThatOfTheDifference)
{
	const auto   sample    = sampled("torus", 3000, 0.0025);
	const auto   estimated = estimate(sample.positions, sample.normals);
	double       pull      = 0.0;
	const double n         = estimated.field.size();
	for (Index i = 0; i < estimated.field.size(); ++i) {
		const Index  s     = estimated.prepared.source[i];
		const double error = estimated.field.error[i] / estimated.prepared.diagonal;
		pull +=
			std::pow((estimated.k1(i) - estimated.k2(i) - sample.k1[s] + sample.k2[s]) / error, 2) /
			n;
	}
	// The place's own displacement is in all its directional curvatures alike and not seen in their scatter.
	EXPECT_GT(std::sqrt(pull), 0.5);
	EXPECT_LT(std::sqrt(pull), 2.0);
}

TEST(MWeightedCurvature, WeightsOfARowSumUpToOne)
{
	const auto  sample    = sampled("torus", 500);
	const auto  estimated = estimate(sample.positions, sample.normals);
	const auto& weights   = estimated.field.weights;
	for (Index i = 0; i < estimated.field.size(); ++i) {
		double sum = 0.0;
		for (const Index j : weights.neighbors[i]) {
			EXPECT_NE(j, i);
			sum += weights(i, j);
		}
		EXPECT_NEAR(sum, 1.0, 1e-12);
	}
	EXPECT_NEAR(estimated.field.confidence.sum(), estimated.field.size(), 1e-9);
}

TEST(MWeightedCurvature, InvariancesOfTheGeometry)
{
	const auto      sample  = sampled("ellipsoid", 700, 0.002);
	const Matrix3Xd normals = planeFitNormals(sample, 16);
	const auto      base    = estimate(sample.positions, normals);
	const Index     n       = base.field.size();

	const auto flipped = estimate(sample.positions, -normals);
	EXPECT_LT(
		(base.field.k1 + flipped.field.k2).cwiseAbs().maxCoeff(),
		1e-9 * base.field.k1.cwiseAbs().maxCoeff());

	const auto scaled = estimate(1e6 * sample.positions, normals);
	for (Index i = 0; i < n; ++i)
		EXPECT_NEAR(1e6 * scaled.k1(i), base.k1(i), 1e-6 * (1.0 + std::abs(base.k1(i))));

	const Eigen::Matrix3d turn =
		Eigen::AngleAxisd(1.1, Vector3d(0.4, -0.8, 0.3).normalized()).toRotationMatrix();
	const auto moved =
		estimate((turn * sample.positions).colwise() + Vector3d(3, -5, 8), turn * normals);
	// Spacings may take other slices in another frame: hardly any point feels it.
	Index off = 0;
	for (Index i = 0; i < n; ++i)
		off += std::abs(moved.k1(i) - base.k1(i)) > 1e-3 * (1.0 + std::abs(base.k1(i)));
	EXPECT_LE(off, n / 50);

	std::vector<Index> order(n);
	Matrix3Xd          positions(3, n), turned(3, n);
	for (Index i = 0; i < n; ++i) {
		order[i]         = (i * 367 + 11) % n;
		positions.col(i) = sample.positions.col(order[i]);
		turned.col(i)    = normals.col(order[i]);
	}
	const auto permuted = estimate(positions, turned);
	for (Index i = 0; i < n; ++i)
		EXPECT_NEAR(permuted.field.k1[i], base.field.k1[order[i]], 1e-9);

	const int threads = omp_get_max_threads();
	omp_set_num_threads(3);
	const auto three = estimate(sample.positions, normals);
	omp_set_num_threads(threads);
	EXPECT_EQ(base.field.k1, three.field.k1);
	EXPECT_EQ(base.field.confidence, three.field.confidence);
}

TEST(MWeightedCurvature, DegenerateCloudsGiveFiniteFrames)
{
	PointCloud cloud;
	for (const Index n : {0, 1, 2, 30}) {
		cloud.positions.setZero(3, n);
		if (n > 0)
			cloud.positions.row(0).setLinSpaced(0.0, n > 1 ? 1.0 : 0.0);
		cloud.normals.setZero(3, n);
		cloud.normals.row(2).setConstant(-1.0);
		for (const Weighting weighting :
		     {Weighting::M, Weighting::Gaussian, Weighting::Unweighted}) {
			MWeightedCurvatureOptions options;
			options.weighting      = weighting;
			const CurvatureField f = mWeightedCurvature(cloud, options);
			EXPECT_TRUE(f.k1.isZero() && f.k2.isZero() && f.error.isZero());
			for (Index i = 0; i < f.size(); ++i) {
				EXPECT_NEAR(f.d1.col(i).norm(), 1.0, 1e-9);
				EXPECT_NEAR(f.d1.col(i).dot(f.d2.col(i)), 0.0, 1e-9);
				EXPECT_NE(f.status[i], PointStatus::Ok);
			}
		}
	}
	const auto sheet = sampled("plane", 400); // flat: no curvature at all, and no noise in it
	const auto flat  = estimate(sheet.positions, sheet.normals);
	EXPECT_LT(flat.field.k1.cwiseAbs().maxCoeff(), 1e-9);
	EXPECT_TRUE(flat.field.d1.allFinite());
}

TEST(MWeightedCurvature, SheetsThatTouchDoNotMix)
{
	const auto sheet = sampled("plane", 600);
	Matrix3Xd  positions(3, 1200), normals(3, 1200);
	positions << sheet.positions, sheet.positions.colwise() + Vector3d(0, 0, -1e-3);
	normals << sheet.normals, -sheet.normals;
	const auto estimated = estimate(positions, normals);
	EXPECT_LT(estimated.field.k1.cwiseAbs().maxCoeff(), 1e-9);
	EXPECT_LT(estimated.field.k2.cwiseAbs().maxCoeff(), 1e-9);
}

} // namespace
} // namespace curvature_lines::test
