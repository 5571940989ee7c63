// Local plane by alternation, then the complete quadratic (Alexa et al. 2003, section 3).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "moving_least_squares.h"

#include <optional>

#include <Eigen/Dense>

#include "control_neighborhood.h"
#include "local_polynomial.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "point_set_surface.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// As in curvature_driven_projection.cpp, so that the two surfaces can be compared (benchmarks/ray_tracing.py).
constexpr double gaussianReach = 2.0;  // bandwidths
constexpr double settled       = 1e-3; // spacings: the plane is found when a step moves less

} // namespace

MovingLeastSquaresSurface::MovingLeastSquaresSurface(
	const ControlPoints& control, const MovingLeastSquaresOptions& options) :
		PointSetSurface(
			control, gaussianReach * options.bandwidth, gaussianReach * options.bandwidth),
		m_options(options)
{
}

std::optional<LocalQuadric>
MovingLeastSquaresSurface::near(const ControlNeighborhood& around, const Vector3d& place) const
{
	const double h      = m_options.bandwidth * around.spacing();
	Vector3d     origin = place, normal = Vector3d::Zero();
	for (Index it = 0; it < m_options.planeIterations; ++it) {
		const PlaneSums sums = around.planeSums(origin, h);
		if (!(sums.weight > 0.0))
			return std::nullopt;
		const Vector3d                                 mean = sums.offset / sums.weight;
		Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
		eigen.computeDirect(sums.square / sums.weight - mean * mean.transpose());
		normal = eigen.eigenvectors().col(0);
		if (!normal.allFinite())
			return std::nullopt;
		// q stays on the normal through the place: that is what makes r project along n.
		const Vector3d moved = place + (origin + mean - place).dot(normal) * normal;
		const double   step  = (moved - origin).norm();
		origin               = moved;
		if (step < settled * around.spacing())
			break;
	}
	if (normal.dot(around.side()) < 0.0)
		normal = -normal;

	thread_local LocalSamples<1> samples;
	const TangentFrame           frame(normal);
	around.heights(origin, frame, h, samples);
	const auto fit = fitPolynomial<2, 1>(samples);
	if (!fit.valid)
		return std::nullopt;
	LocalQuadric quadric{origin, frame.u, frame.v, frame.n};
	const double scale[6] = {h, 1.0, 1.0, 1.0 / h, 1.0 / h, 1.0 / h};
	for (int m = 0; m < 6; ++m)
		quadric.c[m] = scale[m] * fit.coefficients(m, 0);
	return quadric;
}

bool MovingLeastSquaresSurface::follow(
	const ControlNeighborhood& around, const Vector3d& place, LocalQuadric& quadric) const
{
	const auto again = near(around, place);
	if (again)
		quadric = *again;
	return again.has_value();
}

} // namespace curvature_lines
