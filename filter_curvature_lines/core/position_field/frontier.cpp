// The likelihood of an intensity that falls like the normal distribution function, and Newton's method for it.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "frontier.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "point_cloud.h"

namespace curvature_lines {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Lengths are in spacings here: 1 / sqrt(density). Chosen on helicoids, seeds 1 to 20 (benchmarks/quad_mesh.py
// open), unless said otherwise.

// Blur of the likelihood, added to that of the sample, in turn: from a wide one it climbs from inside to
// where the points end, and strays beyond a gap do not pull it on; the last one decides the result.
constexpr double blurs[] = {0.7, 0.35, 0.2};
// Windows along the curve: the first one, its growth, and the longest one.
constexpr double narrowestWindow = 20.0;
constexpr double windowGrowth    = 1.5;
constexpr double widestWindow    = 155.0;
// Windows agree whose values differ by no more than so many standard errors (the constant of Lepski's
// rule); and a standard error of the value at which no wider window is tried.
constexpr double agreement  = 6.0;
constexpr double sufficient = 0.1;
// How often a point lies anywhere: a stray costs log(1e-6), and no more the farther it lies.
constexpr double strays = 1e-6;
// Of a window: below, three coefficients are told by chance.
constexpr Index fewestPoints = 8;
// Newton's method: safeguards, and the longest step in blurs.
constexpr int    mostSteps    = 60;
constexpr int    mostHalvings = 12;
constexpr double longestStep  = 1.0;
// A blur that the sample does not have puts the end of an even sample where the normal distribution
// function is 1 / e, so many blurs inside the end: Phi(-0.337) = 1 / e.
constexpr double blurBias = 0.337;
// Points so many blurs inside have a term of less than 1e-9: it is left out.
constexpr double certain = 6.0;

// log(Phi(z) + strays) and its derivatives, those of the logarithm as if the point's being a stray were
// known, by how probable it is that it is none.
struct PointTerm {
	double value = 0.0, first = 0.0, second = 0.0, third = 0.0;
	explicit PointTerm(double z)
	{
		if (z > certain)
			return;
		const double normal = 0.5 * std::erfc(-z / std::sqrt(2.0));
		value               = std::log((normal + strays) / (1.0 + strays));
		if (normal < 1e-3 * strays)
			return;
		const double member = normal / (normal + strays);
		const double r      = std::exp(-0.5 * z * z) / std::sqrt(2.0 * double(EIGEN_PI)) / normal;
		first               = member * r;
		second              = -member * r * (z + r);
		third               = member * r * ((z + r) * (z + r) - 1.0 + r * (z + r));
	}
};

// A quadratic in u = s / scale by maximum likelihood; the problem is concave.
struct Likelihood {
	Eigen::Matrix3Xd basis; // 3 x N
	Eigen::VectorXd  x;
	Vector3d         area; // points expected per coefficient
	double           blur;

	double operator()(const Vector3d& c) const
	{
		double sum = -area.dot(c);
		for (Index i = 0; i < x.size(); ++i)
			sum += PointTerm((basis.col(i).dot(c) - x[i]) / blur).value;
		return sum;
	}

	Vector3d maximum(Vector3d c) const
	{
		double value = (*this)(c);
		for (int step = 0; step < mostSteps; ++step) {
			Vector3d       gradient = -area;
			const Matrix3d told     = information(c, &gradient);
			const Vector3d ascent   = told.ldlt().solve(gradient);
			// Bounded, because far inside, where all points are strays to it, the likelihood grows again.
			double share = std::min(1.0, longestStep * blur / ascent.cwiseAbs().maxCoeff());
			double next  = (*this)(c + share * ascent);
			for (int halving = 0; halving < mostHalvings && !(next > value); ++halving)
				next = (*this)(c + (share *= 0.5) * ascent);
			if (!(next > value))
				break;
			c += share * ascent;
			value = next;
			if (share * ascent.cwiseAbs().maxCoeff() < 1e-4 * blur)
				break;
		}
		return c;
	}

	// Fisher information of the points about the coefficients, and a little for those they do not
	// determine. Adds to the gradient what is theirs of it.
	Matrix3d information(const Vector3d& c, Vector3d* gradient = nullptr) const
	{
		Matrix3d sum = Matrix3d::Zero();
		for (Index i = 0; i < x.size(); ++i) {
			const double z = (basis.col(i).dot(c) - x[i]) / blur;
			if (z > certain)
				continue;
			const PointTerm term(z);
			sum -= term.second / (blur * blur) * basis.col(i) * basis.col(i).transpose();
			if (gradient)
				*gradient += term.first / blur * basis.col(i);
		}
		return sum + Matrix3d::Identity() * std::max(1e-6 * sum.trace(), 1e-12);
	}

	// Of the posterior distribution, to the first order of its skewness.
	Vector3d meanLessMode(const Vector3d& c, const Matrix3d& covariance) const
	{
		Vector3d sum = Vector3d::Zero();
		for (Index i = 0; i < x.size(); ++i)
			sum += PointTerm((basis.col(i).dot(c) - x[i]) / blur).third / (blur * blur * blur) *
			       basis.col(i).dot(covariance * basis.col(i)) * basis.col(i);
		return 0.5 * covariance * sum;
	}
};

// The parabola of one window.
std::optional<Frontier>
fitWindow(const Eigen::Matrix2Xd& points, double begin, double end, double noise)
{
	const double       scale = std::max(end, -begin);
	std::vector<Index> inside;
	for (Index i = 0; i < points.cols(); ++i)
		if (points(0, i) >= begin && points(0, i) <= end)
			inside.push_back(i);
	if (static_cast<Index>(inside.size()) < fewestPoints || !(scale > 0.0))
		return {};

	Vector3d   c = Vector3d::Zero();
	Likelihood likelihood;
	likelihood.basis.resize(3, inside.size());
	likelihood.x.resize(inside.size());
	for (std::size_t i = 0; i < inside.size(); ++i) {
		const double u = points(0, inside[i]) / scale;
		likelihood.basis.col(i) << 1.0, u, u * u;
		likelihood.x[i] = points(1, inside[i]);
	}
	const double a = begin / scale, b = end / scale;
	likelihood.area = scale * Vector3d(b - a, (b * b - a * a) / 2.0, (b * b * b - a * a * a) / 3.0);
	c[0]            = likelihood.x.mean();
	for (const double blur : blurs) {
		likelihood.blur = std::hypot(noise, blur);
		c               = likelihood.maximum(c);
	}
	const double   addedBlur  = *std::prev(std::end(blurs));
	const Matrix3d covariance = likelihood.information(c).inverse();
	c += likelihood.meanLessMode(c, covariance);
	c[0] += blurBias * addedBlur * addedBlur / likelihood.blur;
	if (!c.allFinite())
		return {};
	return Frontier{c[0], c[1] / scale, std::sqrt(covariance(0, 0))};
}

} // namespace

std::optional<Frontier>
fitFrontier(const Eigen::Matrix2Xd& points, double begin, double end, double density, double noise)
{
	const double            perLength = std::sqrt(density);
	const Eigen::Matrix2Xd  scaled    = points * perLength;
	const double            from = begin * perLength, to = end * perLength;
	std::optional<Frontier> best;
	double                  low = -INFINITY, high = INFINITY; // what all windows up to now allow
	for (double length = narrowestWindow; length <= widestWindow; length *= windowGrowth) {
		const double b = std::min(to, std::max(from, -0.5 * length) + length),
					 a = std::max(from, b - length);
		const auto fit = fitWindow(scaled, a, b, noise * perLength);
		if (fit) {
			if (fit->value < low || fit->value > high)
				break;
			best = fit;
			low  = std::max(low, fit->value - agreement * fit->deviation);
			high = std::min(high, fit->value + agreement * fit->deviation);
		}
		if ((a == from && b == to) || (best && best->deviation < sufficient))
			break;
	}
	if (best) {
		best->value /= perLength;
		best->deviation /= perLength;
	}
	return best;
}

} // namespace curvature_lines
