// Local polynomial fits along the tangent, and steps from one to the next.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "crease_tracing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "crease_points.h"
#include "local_surface.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "quantile.h"
#include "robust_kernel.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// By experiment, as those of crease_points.cpp (benchmarks/creases.py).
// Local spacings along the curve to each side, in which the curve is a parabola.
constexpr double window = 3.0;
// Distance from the curve, in spacings or faceDeviations, beyond which points are of another crease.
constexpr double widthSpacings   = 1.5;
constexpr double widthDeviations = 2.5;
// Cosines between tangents (46 degrees) and between the normals of a face (41 degrees) along one crease.
constexpr double sameTangent = 0.7;
constexpr double sameNormal  = 0.75;
constexpr int    minSupport  = 3;   // points within one spacing along the curve, from both faces
constexpr double tracedShare = 0.6; // of the points at a place: the crease there was traced before
constexpr double robustScale = 2.5; // median distances in the scale of the Geman-McClure weights

struct PolynomialAtZero {
	Eigen::Vector2d value = Eigen::Vector2d::Zero(), slope = Eigen::Vector2d::Zero();
};

// Weighted least squares of two values over s: a parabola with samples on both sides, else a line.
PolynomialAtZero fitAlong(
	const std::vector<double>&          s,
	const std::vector<Eigen::Vector2d>& values,
	const std::vector<double>&          weights,
	double                              radius)
{
	double                      low = 0.0, high = 0.0;
	Eigen::Matrix3d             gram = Eigen::Matrix3d::Zero();
	Eigen::Matrix<double, 3, 2> rhs  = Eigen::Matrix<double, 3, 2>::Zero();
	for (std::size_t k = 0; k < s.size(); ++k) {
		const double   t = s[k] / radius;
		const Vector3d phi(1.0, t, t * t);
		gram += weights[k] * phi * phi.transpose();
		rhs += weights[k] * phi * values[k].transpose();
		low  = std::min(low, t);
		high = std::max(high, t);
	}
	PolynomialAtZero result;
	gram.diagonal().array() += 1e-9 * gram(0, 0);
	Eigen::Matrix<double, 3, 2> c = Eigen::Matrix<double, 3, 2>::Zero();
	if (low < -0.5 && high > 0.5)
		c = gram.ldlt().solve(rhs);
	else
		c.topRows<2>() = gram.topLeftCorner<2, 2>().ldlt().solve(rhs.topRows<2>());
	result.value = c.row(0);
	result.slope = c.row(1) / radius;
	return result;
}

} // namespace

CreaseTracing::CreaseTracing(const CreasePoints& points) :
		m_points(points), m_positions(positionsOf(points.points)), m_search(m_positions),
		m_traced(points.points.size(), 0)
{
}

Eigen::Matrix3Xd CreaseTracing::positionsOf(const std::vector<CreasePoint>& points)
{
	Eigen::Matrix3Xd positions(3, points.size());
	for (std::size_t k = 0; k < points.size(); ++k)
		positions.col(k) = points[k].position;
	return positions;
}

double CreaseTracing::width(const CreasePoint& at) const
{
	return std::max(widthSpacings * at.spacing, widthDeviations * m_points.faceDeviation);
}

std::vector<Index>
CreaseTracing::sameCrease(const CreasePoint& at, double radius, double width) const
{
	std::vector<Index> near    = m_search.within(at.position, radius);
	const auto         differs = [&](Index k) {
        const CreasePoint& p      = m_points.points[k];
        const double       cosine = p.tangent.dot(at.tangent);
        const Vector3d     d      = p.position - at.position;
        if (std::abs(cosine) < sameTangent || p.angle * at.angle < 0.0 ||
            (d - d.dot(at.tangent) * at.tangent).norm() > width)
            return true;
        const Vector3d& left  = cosine > 0.0 ? p.left : p.right;
        const Vector3d& right = cosine > 0.0 ? p.right : p.left;
        return left.dot(at.left) < sameNormal || right.dot(at.right) < sameNormal;
	};
	near.erase(std::remove_if(near.begin(), near.end(), differs), near.end());
	return near;
}

std::optional<CreasePoint> CreaseTracing::curveAt(const CreasePoint& guess) const
{
	const double                 radius = std::max(window * guess.spacing, width(guess));
	const std::vector<Index>     near   = sameCrease(guess, radius, width(guess));
	const TangentFrame           frame(guess.tangent);
	std::vector<double>          along, weights, distances;
	std::vector<Eigen::Vector2d> across;
	int                          left = 0, right = 0; // points of the two faces
	double                       total = 0.0, angle = 0.0;
	CreasePoint                  result = guess;
	result.left = result.right = Vector3d::Zero();
	result.spacing             = 0.0;
	for (const Index k : near) {
		const CreasePoint& p    = m_points.points[k];
		const bool         same = p.tangent.dot(guess.tangent) > 0.0;
		const Vector3d     d    = p.position - guess.position;
		const double weight     = p.weight * ballKernel(d.squaredNorm() / (radius * radius)) + 1e-9;
		along.push_back(d.dot(guess.tangent));
		across.push_back(frame.toPlane(d));
		weights.push_back(weight);
		if (std::abs(along.back()) < guess.spacing)
			++(p.fromLeft == same ? left : right);
		result.left += weight * (same ? p.left : p.right);
		result.right += weight * (same ? p.right : p.left);
		result.spacing += weight * p.spacing;
		angle += weight * p.angle;
		total += weight;
	}
	if (left + right < minSupport || left == 0 || right == 0)
		return std::nullopt;
	PolynomialAtZero fit = fitAlong(along, across, weights, radius);
	for (std::size_t k = 0; k < along.size(); ++k)
		distances.push_back((across[k] - fit.value - along[k] * fit.slope).norm());
	std::vector<double> sorted = distances;
	const double        scale  = robustScale * medianInPlace(sorted) + 1e-12;
	for (std::size_t k = 0; k < along.size(); ++k) {
		const double t = distances[k] / scale;
		weights[k] /= gemanMcClureDivisor(t * t);
	}
	fit             = fitAlong(along, across, weights, radius);
	result.position = guess.position + frame.toSpace(fit.value);
	result.tangent  = (guess.tangent + frame.toSpace(fit.slope)).normalized();
	result.left.normalize();
	result.right.normalize();
	result.spacing /= total;
	result.angle  = angle / total;
	result.weight = left + right;
	if ((result.position - guess.position).norm() > width(guess) ||
	    result.tangent.dot(guess.tangent) < sameTangent || !result.position.allFinite())
		return std::nullopt;
	return result;
}

bool CreaseTracing::isTraced(const CreasePoint& at) const
{
	const std::vector<Index> near = sameCrease(at, at.spacing, width(at));
	const auto               traced =
		std::count_if(near.begin(), near.end(), [&](Index k) { return m_traced[k]; });
	return traced > tracedShare * near.size();
}

void CreaseTracing::markTraced(const CreaseTrace& trace, double step)
{
	for (const CreasePoint& v : trace.vertices)
		for (const Index k : sameCrease(v, std::max(step, 1.5 * width(v)), 1.5 * width(v)))
			m_traced[k] = 1;
}

// On from the last vertex as far as there are points, or to the first vertex again.
void CreaseTracing::follow(double step, CreaseTrace& trace) const
{
	std::vector<CreasePoint>& path = trace.vertices;
	const std::size_t         most = 4 * m_points.points.size() + 16;
	while (path.size() < most) {
		CreasePoint guess = path.back();
		guess.position += step * guess.tangent;
		const auto next = curveAt(guess);
		if (!next || isTraced(*next) || (next->position - path.back().position).norm() < 0.3 * step)
			return;
		for (std::size_t v = 0; v + 4 < path.size(); ++v)
			if ((path[v].position - next->position).norm() < 0.8 * step &&
			    path[v].tangent.dot(next->tangent) > sameTangent) {
				trace.closed = v < 2;
				if (v == 1)
					path.erase(path.begin());
				return;
			}
		path.push_back(*next);
	}
}

std::vector<CreaseTrace> CreaseTracing::traceAll(double step, double minAngle)
{
	std::vector<Index> seeds;
	for (Index k = 0; k < static_cast<Index>(m_points.points.size()); ++k)
		if (std::abs(m_points.points[k].angle) >= minAngle)
			seeds.push_back(k);
	std::stable_sort(seeds.begin(), seeds.end(), [&](Index a, Index b) {
		return m_points.points[a].weight > m_points.points[b].weight;
	});
	std::vector<CreaseTrace> traces;
	for (const Index seed : seeds) {
		if (m_traced[seed])
			continue;
		m_traced[seed]   = 1;
		const auto start = curveAt(m_points.points[seed]);
		if (!start || std::abs(start->angle) < minAngle || isTraced(*start))
			continue;
		CreaseTrace trace;
		trace.vertices = {*start};
		follow(step, trace);
		if (!trace.closed) {
			std::reverse(trace.vertices.begin(), trace.vertices.end());
			for (CreasePoint& v : trace.vertices)
				v = v.reversed();
			follow(step, trace);
		}
		markTraced(trace, step);
		if (trace.vertices.size() > 1)
			traces.push_back(std::move(trace));
	}
	return traces;
}

} // namespace curvature_lines
