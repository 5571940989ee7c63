// Local plane by alternation, then the complete quadratic (Alexa et al. 2003, section 3).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "moving_least_squares.h"

#include <cmath>

#include <Eigen/Dense>

#include "local_polynomial.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

constexpr double settled = 1e-4; // spacings: what the plane moves at last

} // namespace

std::optional<LocalQuadric> MovingLeastSquaresSurface::near(const Vector3d& position) const
{
	thread_local ControlNeighborhood around;
	thread_local LocalSamples<1>     samples;
	if (!around.gather(m_control, position, m_options.neighbors))
		return std::nullopt;
	const Eigen::Matrix3Xd& positions = m_control.cloud.positions;
	const double            bandwidth = m_options.bandwidth * around.spacing;
	const double            sharpness = 1.0 / (bandwidth * bandwidth);

	Vector3d origin = position, normal = Vector3d::Zero();
	for (Index it = 0; it < m_options.planeIterations; ++it) {
		Vector3d        mean       = Vector3d::Zero();
		Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
		double          total      = 0.0;
		for (const Index j : around.points) {
			const Vector3d d = positions.col(j) - origin;
			const double   w = std::exp(-d.squaredNorm() * sharpness);
			mean += w * d;
			covariance.noalias() += w * d * d.transpose();
			total += w;
		}
		if (!(total > 0.0))
			return std::nullopt;
		mean /= total;
		covariance = covariance / total - mean * mean.transpose();
		Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
		eigen.computeDirect(covariance);
		normal = eigen.eigenvectors().col(0);
		if (!normal.allFinite())
			return std::nullopt;
		// q stays on the normal through the position: that is what makes r project along n.
		const Vector3d moved = position + (origin + mean - position).dot(normal) * normal;
		const double   step  = (moved - origin).norm();
		origin               = moved;
		if (step < settled * around.spacing)
			break;
	}
	if (normal.dot(m_control.cloud.normals.col(around.points.front())) < 0.0)
		normal = -normal;

	const TangentFrame frame(normal);
	samples.reserve(around.points.size());
	for (const Index j : around.points) {
		const Vector3d d = (positions.col(j) - origin) / bandwidth;
		const double   w = std::exp(-d.squaredNorm());
		samples.add(d.dot(frame.u), d.dot(frame.v), w, Eigen::Matrix<double, 1, 1>(d.dot(frame.n)));
	}
	const auto fit = fitPolynomial<2, 1>(samples);
	if (!fit.valid)
		return std::nullopt;
	LocalQuadric quadric{origin, frame.u, frame.v, frame.n};
	const double scale[6] = {bandwidth, 1.0, 1.0, 1.0 / bandwidth, 1.0 / bandwidth, 1.0 / bandwidth};
	for (int m = 0; m < 6; ++m)
		quadric.c[m] = scale[m] * fit.coefficients(m, 0);
	quadric.spacing = around.spacing;
	return quadric;
}

} // namespace curvature_lines
