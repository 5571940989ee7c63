// The moving-least-squares surface with complete quadratics (Alexa et al. 2003), which T06 compares itself
// with: on the same control points and neighbour search.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include <Eigen/Core>

#include "control_neighborhood.h"
#include "point_cloud.h"
#include "point_set_surface.h"

namespace curvature_lines {

struct MovingLeastSquaresOptions {
	double bandwidth       = 2.0; // of the Gaussian, in local spacings
	Index  planeIterations = 10;  // of the local plane, at most
};

class MovingLeastSquaresSurface : public PointSetSurface {
public:
	MovingLeastSquaresSurface(
		const ControlPoints& control, const MovingLeastSquaresOptions& options = {});

	// The quadratic of weighted least squares over the plane through q = r + t n that minimises
	// sum <n, p_i - q>^2 exp(-|p_i - q|^2 / h^2); found by turns for n (covariance) and t.
	std::optional<LocalQuadric>
	near(const ControlNeighborhood& around, const Eigen::Vector3d& place) const override;
	// From the same start: plane and quadratic both depend on the place.
	bool follow(
		const ControlNeighborhood& around,
		const Eigen::Vector3d&     place,
		LocalQuadric&              quadric) const override;

private:
	MovingLeastSquaresOptions m_options;
};

} // namespace curvature_lines
