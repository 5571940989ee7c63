// Quadrics of heights over several planes, and implicit quadrics.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "small_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include "implicit_quadric.h"
#include "neighborhoods.h"
#include "outlier_voter.h"
#include "point_cloud.h"
#include "quantile.h"

namespace curvature_lines {

namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Quadric = Eigen::Matrix<double, 6, 1>; // z over 1, x, y, x^2, x y, y^2
using Moments = Eigen::Matrix<double, 6, 6>;

// By experiment on exact and scanned shapes with tips, rods, rims, fillets and close sheets, clean and with far outliers,
// blobs of 12 and flat patches of 25 points beside them; benchmarks/cleaning.py, "True shapes", judges them now.

// Neighbours of a fit. With 20 alone four times as many true points stay rejected, with 10 alone twice as many.
constexpr std::array<Index, 3> fitSizes          = {20, 14, 10};
constexpr Index                deviationSize     = 16;
constexpr int                  quadricUnknowns   = 6;
constexpr int                  implicitUnknowns  = 9; // ten coefficients up to a common factor
constexpr Index                fewestForImplicit = 14;
// Least standard deviation in spacings: what a small quadric misses on an exact surface. With .08 five true points more
// are lost on the bunny, with .12 outliers half a spacing off an exact surface are taken back.
constexpr double leastNoise = 0.1;
// Allowed deviation of a fit over that of the noise, and in spacings whatever the noise.
constexpr double deviationRatio         = 2.0;
constexpr double leastDeviation         = 0.12;
constexpr double leastImplicitDeviation = 0.08;
// Variance of the prediction at the point over that of one sample; more is extrapolation.
constexpr double mostLeverage = 2.0;
constexpr double fewestOn     = 0.8; // of the neighbours are on the surface
// Distance between the surface and the middle of the way from the point to a member, over the length of the way. On a
// cylinder .26 when the way is twice its radius; between two parallel sheets .5.
constexpr double joinedDistance = 0.35;
// PassingSurface::reach in spacings of the neighbours; in the point's own where these are larger, up to so many of theirs.
constexpr double heightReach = 1.6, implicitReach = 1.4;
constexpr double mostOwnSpacing = 3.0, mostImplicitOwnSpacing = 2.0;
// Where two sheets are close, their points together are denser than those of either: the reach on one sheet is longer
// by the root of the ratio, at most this. More takes back patches beside thin parts.
constexpr double mostSheetFactor = 1.1;
constexpr double ridge           = 1e-9; // for points on a curve, that determine no quadric

Quadric monomials(double x, double y)
{
	Quadric m;
	m << 1.0, x, y, x * x, x * y, y * y;
	return m;
}

struct HeightQuadric {
	TangentFrame frame;
	Quadric      coefficients = Quadric::Zero();
	double       leverage     = 0.0; // of the prediction at the origin

	double distance(const Vector3d& p) const // to first order
	{
		const Quadric& c = coefficients;
		const double   x = p.dot(frame.u), y = p.dot(frame.v);
		const double   gx = c[1] + 2.0 * c[3] * x + c[4] * y, gy = c[2] + c[4] * x + 2.0 * c[5] * y;
		const double   height = p.dot(frame.n) - c.dot(monomials(x, y));
		return std::abs(height) / std::sqrt(1.0 + gx * gx + gy * gy);
	}
};

HeightQuadric fitHeights(const Matrix3Xd& points, const Vector3d& normal)
{
	HeightQuadric fit{TangentFrame(normal)};
	Moments       moments = Moments::Zero();
	Quadric       sum     = Quadric::Zero();
	for (const auto& p : points.colwise()) {
		const Quadric m = monomials(p.dot(fit.frame.u), p.dot(fit.frame.v));
		moments += m * m.transpose();
		sum += p.dot(fit.frame.n) * m;
	}
	moments.diagonal().array() += ridge * static_cast<double>(points.cols());
	const Eigen::LDLT<Moments> solver(moments);
	fit.coefficients = solver.solve(sum);
	fit.leverage     = solver.solve(monomials(0.0, 0.0))[0];
	return fit;
}

HeightQuadric fitTiltedHeights(const Matrix3Xd& points, const Vector3d& normal)
{
	const HeightQuadric first = fitHeights(points, normal);
	const TangentFrame& frame = first.frame;
	const Vector3d      tilted =
		frame.n - first.coefficients[1] * frame.u - first.coefficients[2] * frame.v;
	return fitHeights(points, tilted.normalized());
}

Matrix3d principalAxes(const Matrix3Xd& points)
{
	const Vector3d                          mean    = points.rowwise().mean();
	const Matrix3Xd                         offsets = points.colwise() - mean;
	Eigen::SelfAdjointEigenSolver<Matrix3d> solver;
	solver.computeDirect(offsets * offsets.transpose());
	return solver.eigenvectors();
}

// Neighbours of a point as offsets from it, in units of their largest distance, and what is allowed in these units.
struct Neighborhood {
	std::vector<Index> indices; // the nearest first
	Matrix3Xd          points;
	double             radius          = 0.0; // the unit, a length
	double             spacing         = 0.0; // a length
	double             reach           = 0.0; // largest distance of a point from its surface
	double             heightDeviation = 0.0, implicitDeviation = 0.0;

	Neighborhood(
		const VoterCloud&          cloud,
		Index                      i,
		const std::vector<Index>&  nearest,
		const SmallSurfaceOptions& options);
	Index size() const { return static_cast<Index>(indices.size()); }
};

Neighborhood::Neighborhood(
	const VoterCloud&          cloud,
	Index                      i,
	const std::vector<Index>&  nearest,
	const SmallSurfaceOptions& options) : indices(nearest), points(3, nearest.size())
{
	const Vector3d p = cloud.positions.col(i);
	radius           = (cloud.positions.col(nearest.back()) - p).norm();
	std::vector<double> spacings;
	spacings.reserve(nearest.size());
	for (Index k = 0; k < size(); ++k) {
		points.col(k) = (cloud.positions.col(nearest[k]) - p) / radius;
		spacings.push_back(spacingOfCrowd * cloud.crowding[nearest[k]]);
	}
	spacing           = medianInPlace(spacings);
	const double unit = spacing / radius;
	reach             = options.sensitivity * std::max(options.noise, leastNoise) * unit;
	heightDeviation   = std::max(deviationRatio * options.noise, leastDeviation) * unit;
	implicitDeviation = std::max(deviationRatio * options.noise, leastImplicitDeviation) * unit;
}

template<class Surface>
PassingSurface passing(
	const Neighborhood& near, const Surface& surface, const std::vector<Index>& on, double reach)
{
	PassingSurface found;
	found.neighbors = near.size();
	found.spacing   = near.spacing;
	found.reach     = reach;
	for (const Index k : on) {
		const Vector3d p = near.points.col(k);
		found.members.push_back(near.indices[k]);
		if (surface.distance(0.5 * p) <= joinedDistance * p.norm())
			found.joined.push_back(near.indices[k]);
	}
	return found;
}

void addHeights(
	const Neighborhood&          near,
	const Vector3d&              normal,
	double                       reach,
	std::vector<PassingSurface>& found)
{
	const HeightQuadric fit = fitTiltedHeights(near.points, normal);
	if (!(fit.leverage < mostLeverage && fit.distance(Vector3d::Zero()) <= near.reach))
		return;
	double             squares = 0.0;
	std::vector<Index> on;
	for (Index k = 0; k < near.size(); ++k) {
		const double distance = fit.distance(near.points.col(k));
		squares += distance * distance;
		if (distance < near.reach)
			on.push_back(k);
	}
	const double deviation = std::sqrt(squares / double(near.size() - quadricUnknowns));
	if (deviation <= near.heightDeviation && double(on.size()) >= fewestOn * double(near.size()))
		found.push_back(passing(near, fit, on, reach));
}

// Every implicit quadric that fits the neighbours has to pass through the point: the points of a plane lie on that plane
// and any other, too, and of these pairs one passes anywhere.
bool allPass(const Neighborhood& near, const ImplicitQuadricFit& fit)
{
	const double lost = std::sqrt(double(near.size()) / double(near.size() - implicitUnknowns));
	for (int q = 0; q < ImplicitQuadric::count; ++q) {
		if (fit.deviations[q] * lost > near.implicitDeviation)
			return q > 0;
		if (fit.quadrics[q].distance(Vector3d::Zero()) > near.reach)
			return false;
	}
	return true;
}

void addImplicit(const Neighborhood& near, double reach, std::vector<PassingSurface>& found)
{
	const ImplicitQuadricFit fit = fitImplicitQuadrics(near.points);
	if (!fit.valid || !allPass(near, fit))
		return;
	std::vector<Index> on(near.size());
	for (Index k = 0; k < near.size(); ++k) {
		on[k] = k;
		if (fit.quadrics[0].distance(near.points.col(k)) > near.reach)
			return;
	}
	PassingSurface surface = passing(near, fit.quadrics[0], on, reach);
	if (!surface.joined.empty())
		surface.reach *= std::min(
			mostSheetFactor,
			std::sqrt(double(surface.members.size()) / double(surface.joined.size())));
	found.push_back(std::move(surface));
}

} // namespace

std::vector<PassingSurface>
surfacesThrough(const VoterCloud& cloud, Index i, const SmallSurfaceOptions& options)
{
	const Vector3d     p       = cloud.positions.col(i);
	std::vector<Index> nearest = cloud.all.nearest(p, fitSizes[0] + 1);
	nearest.erase(std::remove(nearest.begin(), nearest.end(), i), nearest.end());
	std::vector<PassingSurface> found;
	for (const Index size : fitSizes) {
		if (static_cast<Index>(nearest.size()) < size)
			continue;
		nearest.resize(size);
		if (cloud.positions.col(nearest.back()) == p)
			break;
		const Neighborhood near(cloud, i, nearest, options);
		const double       own   = spacingOfCrowd * cloud.crowding[i];
		const auto         reach = [&](double most) {
            return std::max(near.spacing, std::min(own, most * near.spacing));
		};
		const Matrix3d axes = principalAxes(near.points);
		const Vector3d away = -near.points.rowwise().mean().normalized();
		for (const Vector3d& normal :
		     {Vector3d(axes.col(0)), Vector3d(axes.col(1)), Vector3d(axes.col(2)), away})
			addHeights(near, normal, heightReach * reach(mostOwnSpacing), found);
		if (options.implicit && size >= fewestForImplicit)
			addImplicit(near, implicitReach * reach(mostImplicitOwnSpacing), found);
	}
	return found;
}

double smallDeviation(const VoterCloud& cloud, Index i)
{
	const std::vector<Index> nearest = cloud.all.nearest(cloud.positions.col(i), deviationSize);
	const auto               size    = static_cast<Index>(nearest.size());
	if (size <= quadricUnknowns || cloud.positions.col(nearest.back()) == cloud.positions.col(i))
		return 0.0;
	const Neighborhood  near(cloud, i, nearest, {});
	const HeightQuadric fit     = fitHeights(near.points, principalAxes(near.points).col(0));
	double              squares = 0.0;
	for (const auto& p : near.points.colwise()) {
		const double height =
			p.dot(fit.frame.n) -
			fit.coefficients.dot(monomials(p.dot(fit.frame.u), p.dot(fit.frame.v)));
		squares += height * height;
	}
	return near.radius * std::sqrt(squares / double(size - quadricUnknowns));
}

} // namespace curvature_lines
