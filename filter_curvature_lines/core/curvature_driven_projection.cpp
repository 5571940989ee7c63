// The eight steps of T06 section 5.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature_driven_projection.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

constexpr double reach   = 2.6;  // bandwidths: beyond, a Gaussian is below a thousandth
constexpr double settled = 1e-5; // spacings: what diffusion moves at last

} // namespace

std::optional<LocalQuadric> CurvatureDrivenSurface::near(const Vector3d& position) const
{
	thread_local ControlNeighborhood around;
	if (!around.gather(m_control, position, m_options.neighbors))
		return std::nullopt;
	const Eigen::Matrix3Xd& positions = m_control.cloud.positions;
	const Eigen::Matrix3Xd& normals   = m_control.cloud.normals;
	const double            bandwidth = m_options.bandwidth * around.spacing;
	const auto              gaussian = [&](const Vector3d& from, Index j) {
		const double w = (positions.col(j) - from).squaredNorm() / (bandwidth * bandwidth);
		return w < reach * reach ? std::exp(-w) : 0.0;
	};
	const auto normalAt = [&](const Vector3d& at) {
		Vector3d sum = Vector3d::Zero();
		for (const Index j : around.points)
			sum += gaussian(at, j) * normals.col(j);
		return sum;
	};

	// 1, 2: the quasi-tangent plane (o, l) and the foot q of the position on it.
	Vector3d mean = Vector3d::Zero(), normal = Vector3d::Zero();
	double   total = 0.0;
	for (const Index j : around.points) {
		const double w = gaussian(position, j);
		mean += w * positions.col(j);
		normal += w * normals.col(j);
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
			const Vector3d q      = positions.col(j) - point;
			const double   height = q.dot(normal), square = q.squaredNorm();
			const double   w = gaussian(point, j);
			double         pull = height, share = 1.0;
			if (m_options.diffusion == CurvatureDrivenOptions::Diffusion::Hermite) {
				pull = 0.5 * (height + q.dot(normals.col(j)));
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
		const Vector3d offset = positions.col(j) - point;
		squares.add(
			offset,
			squaredWeight(
				offset.norm(), m_options.curvature.bandwidth * around.spacing, m_options.curvature));
	}
	const EulerLeastSquares::Fit fit = squares.solve();
	if (!fit.valid)
		return std::nullopt;
	LocalQuadric quadric{point, fit.d1, fit.d2, normal.normalized()};
	// T06's curvatures are positive where the surface bends towards the normal, ours where it is convex.
	quadric.c[3]    = -0.5 * fit.k1;
	quadric.c[5]    = -0.5 * fit.k2;
	quadric.spacing = around.spacing;
	return quadric;
}

} // namespace curvature_lines
