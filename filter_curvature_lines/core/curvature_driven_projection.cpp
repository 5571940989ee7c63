// The eight steps of T06 section 5.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature_driven_projection.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

constexpr double reach      = 2.6;  // bandwidths: beyond, a Gaussian is below a thousandth
constexpr double isolated   = 3.0;  // spacings: farther from the cloud there is no surface
constexpr double settled    = 1e-5; // spacings: what diffusion moves at last

} // namespace

struct CurvatureDrivenSurface::Neighborhood {
	std::vector<Index> points;
	double             spacing = 0.0, bandwidth = 0.0;
};

CurvatureDrivenSurface::CurvatureDrivenSurface(
	const PointCloud&             control,
	const NeighborSearch&         search,
	const std::vector<double>&    spacing,
	const CurvatureDrivenOptions& options) :
		m_control(control), m_search(search), m_spacing(spacing), m_options(options)
{
}

// All that any step may use, on the sheet of the closest point.
bool CurvatureDrivenSurface::gather(const Vector3d& position, Neighborhood& around) const
{
	around.points = m_search.nearest(position, m_options.neighbors);
	if (around.points.empty())
		return false;
	const Index  closest  = around.points.front();
	const double farthest = (m_control.positions.col(around.points.back()) - position).squaredNorm();
	// A mean that changes gradually from place to place, and the surface with it.
	double total = 0.0;
	around.spacing = 0.0;
	for (const Index j : around.points) {
		const double w = 1.0 + 1e-9 - (m_control.positions.col(j) - position).squaredNorm() / farthest;
		around.spacing += w * m_spacing[j];
		total += w;
	}
	around.spacing /= total;
	if (!(around.spacing > 0.0) ||
		(m_control.positions.col(closest) - position).norm() > isolated * around.spacing)
		return false;
	around.bandwidth = m_options.bandwidth * around.spacing;
	// The Gaussian means around the point, and the curvature around its foot on the surface.
	const double     curvatureReach = m_options.curvature.bandwidth * around.spacing *
		(1.6 + std::sqrt(double(m_options.curvature.exponent)));
	const double radius  = std::max(reach * around.bandwidth, curvatureReach) + isolated * around.spacing;
	const Vector3d side  = m_control.normals.col(closest);
	around.points.erase(
		std::remove_if(
			around.points.begin(),
			around.points.end(),
			[&](Index j) {
				return m_control.normals.col(j).dot(side) <= 0.0 ||
					(m_control.positions.col(j) - position).norm() > radius;
			}),
		around.points.end());
	return true;
}

std::optional<CurvatureDrivenSurface::Quadric>
CurvatureDrivenSurface::quadricNear(const Vector3d& position) const
{
	thread_local Neighborhood around;
	if (!gather(position, around))
		return std::nullopt;
	const auto gaussian = [&](const Vector3d& from, Index j) {
		const double w = (m_control.positions.col(j) - from).squaredNorm() / (around.bandwidth * around.bandwidth);
		return w < reach * reach ? std::exp(-w) : 0.0;
	};
	const auto normalAt = [&](const Vector3d& at) {
		Vector3d sum = Vector3d::Zero();
		for (const Index j : around.points)
			sum += gaussian(at, j) * m_control.normals.col(j);
		return sum;
	};

	// 1, 2: the quasi-tangent plane (o, l) and the foot q of the position on it.
	Vector3d mean = Vector3d::Zero(), normal = Vector3d::Zero();
	double   total = 0.0;
	for (const Index j : around.points) {
		const double w = gaussian(position, j);
		mean += w * m_control.positions.col(j);
		normal += w * m_control.normals.col(j);
		total += w;
	}
	if (!(total > 0.0) || !(normal.norm() > 0.0))
		return std::nullopt;
	mean /= total;
	normal.normalize();
	Vector3d point = position - (position - mean).dot(normal) * normal;

	// 3, 4: onto the surface along the normal at q.
	normal = normalAt(point);
	if (!(normal.norm() > 0.0))
		return std::nullopt;
	normal.normalize();
	const double lambda = m_options.bend / around.spacing;
	for (Index step = 0; step < m_options.diffusionSteps; ++step) {
		double sum = 0.0, weight = 0.0;
		for (const Index j : around.points) {
			const Vector3d q      = m_control.positions.col(j) - point;
			const double   height = q.dot(normal), square = q.squaredNorm();
			const double   w = gaussian(point, j);
			double         pull = height, share = 1.0;
			if (m_options.diffusion == CurvatureDrivenOptions::Diffusion::Hermite) {
				pull = 0.5 * (height + q.dot(m_control.normals.col(j)));
			}
			else if (square > 0.0) {
				const double bend = 2.0 * std::abs(height) / square; // T06 eq. 6
				if (m_options.diffusion == CurvatureDrivenOptions::Diffusion::Cutoff)
					share = bend < lambda ? 1.0 : 0.0;
				else if (bend >= lambda)
					share = lambda * lambda / (lambda * lambda + 10.0 * (bend - lambda) * (bend - lambda));
			}
			sum += w * share * pull;
			weight += w;
		}
		if (!(weight > 0.0))
			return std::nullopt;
		point += sum / weight * normal;
		if (std::abs(sum / weight) < settled * around.spacing)
			break;
	}

	// 5, 6: normal, principal curvatures and directions there. M weights only here.
	normal = normalAt(point);
	if (!(normal.norm() > 0.0))
		return std::nullopt;
	EulerLeastSquares squares(TangentFrame(normal.normalized()));
	for (const Index j : around.points) {
		const Vector3d offset = m_control.positions.col(j) - point;
		squares.add(
			offset,
			squaredWeight(
				offset.norm(), m_options.curvature.bandwidth * around.spacing, m_options.curvature));
	}
	const EulerLeastSquares::Fit fit = squares.solve();
	if (!fit.valid)
		return std::nullopt;
	// T06's curvatures are positive where the surface bends towards the normal, ours where it is convex.
	return Quadric{point, fit.d1, fit.d2, normal.normalized(), -fit.k1, -fit.k2, around.spacing};
}

Vector3d CurvatureDrivenSurface::Quadric::foot(const Vector3d& position) const
{
	const Vector3d d = position - origin;
	const double   x = d.dot(d1), y = d.dot(d2);
	return origin + x * d1 + y * d2 + 0.5 * (k1 * x * x + k2 * y * y) * normal;
}

Vector3d CurvatureDrivenSurface::Quadric::normalAt(const Vector3d& position) const
{
	const Vector3d d = position - origin;
	return (normal - k1 * d.dot(d1) * d1 - k2 * d.dot(d2) * d2).normalized();
}

ProjectedPoints projectPoints(
	const CurvatureDrivenSurface& surface,
	const Eigen::Matrix3Xd&       positions,
	const ProjectionOptions&      options,
	const Progress&               progress)
{
	const auto      n = static_cast<Index>(positions.cols());
	ProjectedPoints result;
	result.positions = positions;
	for (auto* vectors : {&result.normals, &result.d1, &result.d2})
		vectors->setZero(3, n);
	result.k1.setZero(n);
	result.k2.setZero(n);
	result.projected.assign(n, 0);
	std::vector<Index> iterations(n, 0);
	parallelFor(n, progress, [&](Index i) {
		Vector3d point = positions.col(i);
		for (Index it = 1; it <= options.iterations; ++it) {
			const auto quadric = surface.quadricNear(point);
			if (!quadric)
				return;
			const Vector3d moved   = quadric->foot(point);
			const bool     settled = (moved - point).norm() < options.tolerance * quadric->spacing;
			point                  = moved;
			iterations[i]          = it;
			if (!settled && it < options.iterations)
				continue;
			result.positions.col(i) = point;
			result.normals.col(i)   = quadric->normalAt(point);
			result.k1[i]            = -quadric->k1;
			result.k2[i]            = -quadric->k2;
			result.d1.col(i)        = quadric->d1;
			result.d2.col(i)        = quadric->d2;
			result.projected[i]     = 1;
			return;
		}
	});
	if (n > 0)
		result.iterations = *std::max_element(iterations.begin(), iterations.end());
	return result;
}

} // namespace curvature_lines
