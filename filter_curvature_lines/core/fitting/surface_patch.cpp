// Weighted and robust fits of one local quadric.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_patch.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Dense>

#include "bracketed_selection.h"
#include "local_polynomial.h"
#include "monomials.h"
#include "neighborhoods.h"
#include "robust_kernel.h"
#include "sample_kernels.h"

namespace curvature_lines {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// docs/method.md, "Local polynomials", robust patches; values without another reason by experiment (cleaning.py).
constexpr int minRobustPoints = 12; // twice the unknowns: a majority must determine a quadric
// Planes that are tried, each through three random points. With half of the points on the surface none of 24 goes
// through three of these in one case of 25 ((1 - 1/8)^24); with two thirds in one of 4600.
constexpr int triples     = 24;
constexpr int planeSample = 48; // points that judge a plane
// Robust deviations of the points near the plane within which a point belongs to it.
constexpr double planeCutoff = 2.5;
// Share of the points that may be all that lie on one surface, and the deviation of a normal distribution over this
// quantile of |r|: 1 / Phi^-1((1 + 0.35) / 2).
constexpr double minority           = 0.35;
constexpr double minorityDeviations = 2.2036;
// Deviations in which the Geman-McClure weight takes a residual, and beyond which it is 0.
constexpr double downweighting = 1.5;
constexpr double cutoff        = 4.5;
// Steps in the frame of the plane, and in that of the quadric: weights change by little after as many.
constexpr int firstIterations  = 5;
constexpr int tiltedIterations = 6;

// phi^T A^-1 phi collected by powers: a sixth of the products of the quadratic form.
template<class Matrix>
auto leveragePolynomial(const Matrix& inverse)
{
	constexpr int exponent[6][2]                 = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}};
	Eigen::Matrix<double, monomialCount(4), 1> c = decltype(c)::Zero();
	for (int r = 0; r < 6; ++r)
		for (int s = 0; s < 6; ++s)
			c[monomialIndex(exponent[r][0] + exponent[s][0], exponent[r][1] + exponent[s][1])] +=
				inverse(r, s);
	return c;
}

double quantile(std::vector<double>& values, int n, double share)
{
	const auto middle = values.begin() + static_cast<int>(share * n);
	std::nth_element(values.begin(), middle, values.begin() + n);
	return *middle;
}

std::uint32_t nextRandom(std::uint32_t& state)
{
	state += 0x9e3779b9u;
	std::uint32_t h = state;
	h               = (h ^ (h >> 16)) * 0x7feb352du;
	h               = (h ^ (h >> 15)) * 0x846ca68bu;
	return h ^ (h >> 16);
}

struct Plane {
	Vector3d normal    = Vector3d::Zero();
	double   offset    = 0.0;
	double   deviation = -1.0; // of the points near it; negative when no three points span a plane
};

// Least quantile of squares over random triples: most of the points may lie anywhere.
Plane majorityPlane(
	const Eigen::Matrix3Xd& points,
	double                  radius,
	std::uint32_t           seed,
	std::vector<double>&    distance)
{
	const auto n            = static_cast<std::uint32_t>(points.cols());
	const int  judges       = std::min<int>(n, planeSample);
	double     bestDistance = std::numeric_limits<double>::infinity();
	Plane      best;
	distance.resize(std::max<std::size_t>(distance.size(), judges));
	for (int trial = 0; trial < triples; ++trial) {
		std::uint32_t corner[3];
		for (std::uint32_t& c : corner)
			c = nextRandom(seed) % n;
		const Vector3d a      = points.col(corner[0]);
		const Vector3d normal = (points.col(corner[1]) - a).cross(points.col(corner[2]) - a);
		const double   length = normal.norm();
		if (!(length > 1e-3 * radius * radius))
			continue;
		Plane plane;
		plane.normal = normal / length;
		plane.offset = plane.normal.dot(a);
		int nearer   = 0; // than the quantile of the best so far
		for (int k = 0; k < judges; ++k) {
			distance[k] = std::abs(plane.normal.dot(points.col(k * n / judges)) - plane.offset);
			nearer += distance[k] < bestDistance;
		}
		if (nearer <= static_cast<int>(minority * judges))
			continue;
		bestDistance    = quantile(distance, judges, minority);
		plane.deviation = minorityDeviations * bestDistance;
		best            = plane;
	}
	return best;
}

// Origin and axis from the points near the plane. Returns how many there are; the weights are 0 and 1.
int frameFromPlane(
	SurfacePatch&           patch,
	const Eigen::Matrix3Xd& points,
	const Plane&            plane,
	double                  minScale,
	std::vector<double>&    inPlane)
{
	const double reach = planeCutoff * std::max(plane.deviation, minScale);
	Vector3d     sum   = Vector3d::Zero();
	int          count = 0;
	inPlane.resize(std::max<std::size_t>(inPlane.size(), points.cols()));
	for (Eigen::Index k = 0; k < points.cols(); ++k) {
		inPlane[k] = std::abs(plane.normal.dot(points.col(k)) - plane.offset) < reach;
		if (inPlane[k] > 0.0) {
			sum += points.col(k);
			++count;
		}
	}
	if (count < SurfacePatch::Fit::count)
		return count;
	const Vector3d  centroid   = sum / count;
	Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
	for (Eigen::Index k = 0; k < points.cols(); ++k)
		if (inPlane[k] > 0.0) {
			const Vector3d d = points.col(k) - centroid;
			covariance += d * d.transpose();
		}
	const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
	patch = SurfacePatch(centroid, axes.eigenvectors().col(0), patch.radius);
	return count;
}

void project(const SurfacePatch& patch, const Eigen::Matrix3Xd& points, LocalSamples<1>& samples)
{
	for (Eigen::Index k = 0; k < points.cols(); ++k) {
		const SurfacePatch::Local p = patch.toLocal(points.col(k));
		samples.x[k]                = p.x;
		samples.y[k]                = p.y;
		samples.value[0][k]         = p.z;
	}
}

// Of residuals that belong to the surface by the scale of the step before: of another sheet, a few spacings
// away, the median over all of them would be a mixture. 0 in the first step, which takes the minority.
double robustScale(RobustPatchScratch& scratch, int n, double before)
{
	const bool   first    = before <= 0.0;
	const double limit    = first ? std::numeric_limits<double>::infinity() : cutoff * before;
	const double factor   = first ? minorityDeviations : deviationOverMedian;
	const auto   absolute = [&](int k) {
        const double r = std::abs(scratch.residuals[k]);
        return r < limit ? r : -1.0;
	};
	const double value =
		quantileNear(before / factor, n, absolute, first ? minority : 0.5, scratch.absolute);
	return value < 0.0 ? before : factor * value;
}

// One step of iteratively reweighted least squares; the weights are of the step before.
bool reweightedStep(SurfacePatch& patch, double minScale, RobustPatchScratch& scratch)
{
	LocalSamples<1>&        samples = scratch.samples;
	const SurfacePatch::Fit fit     = fitPolynomial<2, 1>(samples);
	if (!fit.valid)
		return false;
	const int n        = samples.size();
	patch.coefficients = fit.coefficients;
	patchResiduals(patch, samples, scratch.residuals);
	patch.scale        = std::max(robustScale(scratch, n, patch.scale), minScale);
	const double unit  = 1.0 / (downweighting * patch.scale);
	const double limit = (cutoff / downweighting) * (cutoff / downweighting);
	for (int k = 0; k < n; ++k) {
		const double e    = scratch.residuals[k] * unit;
		const double e2   = e * e;
		samples.weight[k] = e2 < limit ? relativeGemanMcClureWeight(e2) : 0.0;
	}
	return true;
}

} // namespace

SurfacePatch::Local SurfacePatch::toLocal(const Vector3d& p) const
{
	const Vector3d d = p - origin;
	const Vector2d q = toPlane(d);
	return {q.x(), q.y(), d.dot(frame.n)};
}

void SurfacePatch::setFrame(const Vector3d& normal)
{
	frame = TangentFrame(normal);
	if (elongation > 1.0) {
		frame.u = tangentNear(lines, normal);
		frame.v = normal.cross(frame.u);
	}
}

Vector2d SurfacePatch::toPlane(const Vector3d& d) const
{
	return {d.dot(frame.u) / radius * elongation, d.dot(frame.v) / radius / elongation};
}

double SurfacePatch::height(double x, double y) const
{
	const auto& a = coefficients;
	return a[0] + x * (a[1] + a[3] * x + a[4] * y) + y * (a[2] + a[5] * y);
}

Vector2d SurfacePatch::gradient(double x, double y) const
{
	const auto&    a = coefficients;
	const Vector2d slope(a[1] + 2.0 * a[3] * x + a[4] * y, a[2] + a[4] * x + 2.0 * a[5] * y);
	return Vector2d(slope.x() * elongation, slope.y() / elongation) / radius;
}

Vector3d SurfacePatch::normal(double x, double y) const
{
	const Vector2d g = gradient(x, y);
	return (frame.n - frame.toSpace(g)).normalized();
}

double SurfacePatch::residual(const Local& p) const
{
	return (p.z - height(p.x, p.y)) / std::sqrt(1.0 + gradient(p.x, p.y).squaredNorm());
}

double SurfacePatch::leverage(double x, double y) const
{
	double sum = 0.0;
	for (int a = 4; a >= 0; --a) {
		double inner = 0.0;
		for (int b = 4 - a; b >= 0; --b)
			inner = inner * y + leverageCoefficients[monomialIndex(a, b)];
		sum = sum * x + inner;
	}
	return sum;
}

double SurfacePatch::meanCurvature() const
{
	const double stretch = elongation * elongation;
	return -(coefficients[3] * stretch + coefficients[5] / stretch) / (radius * radius);
}

void SurfacePatch::tilt()
{
	setFrame(normal(0.0, 0.0));
}

void patchResiduals(
	const SurfacePatch& patch, LocalSamples<1>& samples, std::vector<double>& residuals)
{
	using Array     = Eigen::Map<const Eigen::ArrayXd>;
	const int    n  = samples.pad();
	const auto&  a  = patch.coefficients;
	const double ir = 1.0 / patch.radius;
	residuals.resize(std::max<std::size_t>(residuals.size(), n));
	const Array x(samples.x.data(), n), y(samples.y.data(), n), z(samples.value[0].data(), n);
	Eigen::Map<Eigen::ArrayXd>(residuals.data(), n) =
		(z - a[0] - x * (a[1] + a[3] * x + a[4] * y) - y * (a[2] + a[5] * y)) /
		(1.0 + ((a[1] + 2.0 * a[3] * x + a[4] * y) * ir).square() +
	     ((a[2] + a[4] * x + 2.0 * a[5] * y) * ir).square())
			.sqrt();
}

bool fitQuadric(SurfacePatch& patch, LocalSamples<1>& samples)
{
	const SurfacePatch::Fit fit = fitPolynomial<2, 1>(samples);
	if (fit.valid)
		patch.coefficients = fit.coefficients;
	return fit.valid;
}

bool fitPatch(SurfacePatch& patch, LocalSamples<1>& samples)
{
	const SurfacePatch::Fit fit = fitPolynomial<2, 1>(samples);
	patch.valid                 = fit.valid;
	if (!fit.valid)
		return false;
	patch.coefficients = fit.coefficients;
	auto regular       = fit.gram;
	regular.diagonal() *= 1.0 + 1e-10; // as in the fit
	patch.leverageCoefficients =
		leveragePolynomial(regular.ldlt().solve(decltype(regular)::Identity()).eval());
	const PatchSums sums = patchSumsOf(
		patch.coefficients.data(),
		patch.leverageCoefficients.data(),
		patch.radius / patch.elongation,
		patch.radius * patch.elongation,
		samples.columns());
	const double degrees = fit.sumOfWeights - sums.lost;
	// Samples that a quadric goes through exactly tell nothing about the noise.
	patch.scale = degrees > 1e-6 * fit.sumOfWeights ? std::sqrt(sums.squares / degrees) : 0.0;
	patch.effectiveCount = fit.sumOfWeights * fit.sumOfWeights / sums.squaredWeights;
	return true;
}

bool fitPatchRobustly(
	SurfacePatch&           patch,
	const Eigen::Matrix3Xd& points,
	double                  radius,
	double                  minScale,
	std::uint32_t           seed,
	RobustPatchScratch&     scratch)
{
	const int n  = static_cast<int>(points.cols());
	patch        = SurfacePatch();
	patch.radius = radius;
	if (n < minRobustPoints || !(radius > 0.0))
		return false;
	const Plane plane = majorityPlane(points, radius, seed, scratch.absolute);
	if (plane.deviation < 0.0)
		return false;
	LocalSamples<1>& samples = scratch.samples;
	samples.reserve(n);
	for (int k = 0; k < n; ++k)
		samples.add(0.0, 0.0, 0.0, Eigen::Matrix<double, 1, 1>(0.0));
	if (frameFromPlane(patch, points, plane, minScale, samples.weight) < SurfacePatch::Fit::count)
		return false;
	for (const int iterations : {firstIterations, tiltedIterations}) {
		project(patch, points, samples);
		for (int iteration = 0; iteration < iterations; ++iteration)
			if (!reweightedStep(patch, minScale, scratch))
				return false;
		if (iterations == firstIterations)
			patch.tilt();
	}
	patch.valid = true;
	return true;
}

} // namespace curvature_lines
