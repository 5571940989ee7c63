// Curvature-driven projection (T06 section 5, fig. 5): a point moves onto the quadric that principal
// curvatures and directions define at a nearby point of the surface. The surface is what stays.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include <Eigen/Core>

#include "control_neighborhood.h"
#include "point_cloud.h"
#include "point_set_surface.h"

namespace curvature_lines {

struct CurvatureDrivenOptions {
	// What a neighbour says about where the surface is, along the normal there.
	enum class Diffusion {
		// half its own height, half that of its tangent plane: their errors cancel. Beyond T06
		Hermite,
		// its height; none from neighbours towards which the surface bends too much (T06 eq. 17)
		Cutoff,
		Rational // its height, the less the more the surface bends towards it (T06 eq. 18)
	};
	// Of the Gaussian, in local spacings: as little noise is left as moving least squares leave with 2.
	double    bandwidth      = 1.6;
	Diffusion diffusion      = Diffusion::Hermite;
	Index     diffusionSteps = 10;
	// lambda of T06 eqs. 17 and 18, in 1 / local spacing (unpublished)
	double bend               = 0.5;
	double curvatureBandwidth = 2.5; // of the M weights, in local spacings
	Index  curvatureExponent  = 2;   // of the M weights: xi
};

// The surface that control points define.
class CurvatureDrivenSurface : public PointSetSurface {
public:
	CurvatureDrivenSurface(
		const ControlPoints& control, const CurvatureDrivenOptions& options = {});

	// Steps 1 to 6: z = (k1 x^2 + k2 y^2) / 2 over the tangent plane at a point of the surface, in principal
	// directions; k1 and k2 are T06's here, positive where the surface bends towards the normal.
	std::optional<LocalQuadric>
	near(const ControlNeighborhood& around, const Eigen::Vector3d& place) const override;
	// Steps 5 and 6 alone, as if the control point were on the surface.
	std::optional<LocalQuadric>
	roughlyAt(const ControlNeighborhood& around, const Eigen::Vector3d& place) const override;
	// One step of 3 and 4 alone: curvature moves points towards the surface, it does not say where it is.
	bool follow(
		const ControlNeighborhood& around,
		const Eigen::Vector3d&     place,
		LocalQuadric&              quadric) const override;

private:
	struct Base { // a point on the surface, and the unit normal there
		Eigen::Vector3d point, normal;
	};
	std::optional<Base>
	diffuse(const ControlNeighborhood& around, const Eigen::Vector3d& from) const;
	// How far above a point the neighbours say the surface is; `sums` are those there.
	double heightAlong(
		const Eigen::Vector3d&     normal,
		const ControlNeighborhood& around,
		const Eigen::Vector3d&     point,
		const NormalSums&          sums) const;
	std::optional<LocalQuadric>
	quadricAt(const ControlNeighborhood& around, const Base& base) const;

	CurvatureDrivenOptions m_options;
};

} // namespace curvature_lines
