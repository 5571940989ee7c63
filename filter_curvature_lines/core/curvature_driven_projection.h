// Curvature-driven projection (T06 section 5, fig. 5): a point moves onto the quadric that principal
// curvatures and directions define at a nearby point of the surface. The surface is what stays.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "m_weighted_curvature.h"

namespace curvature_lines {

struct CurvatureDrivenOptions {
	// What a neighbour says about where the surface is, along the normal there.
	enum class Diffusion {
		Hermite, // half its own height, half that of its tangent plane: their errors cancel. Beyond T06
		Cutoff,  // its height; none from neighbours towards which the surface bends too much (T06 eq. 17)
		Rational // its height, the less the more the surface bends towards it (T06 eq. 18)
	};
	double    bandwidth      = 2.0; // of the Gaussian, in local spacings
	Diffusion diffusion      = Diffusion::Hermite;
	Index     diffusionSteps = 10;
	double    bend           = 0.5; // lambda of T06 eqs. 17 and 18, in 1 / local spacing (unpublished)
	Index     neighbors      = 60;  // looked at, at most
	MWeightedCurvatureOptions curvature; // `neighbors` is the one above
};

// The surface a cloud of control points defines. Cheap to make; the cloud and the search must outlive it.
class CurvatureDrivenSurface {
public:
	CurvatureDrivenSurface(
		const PointCloud&             control,
		const NeighborSearch&         search,
		const std::vector<double>&    spacing, // per control point, length
		const CurvatureDrivenOptions& options = {});

	// z = (k1 x^2 + k2 y^2) / 2 in the frame (d1, d2, normal) at origin; k1 and k2 are T06's, positive where
	// the surface bends towards the normal.
	struct Quadric {
		Eigen::Vector3d origin, d1, d2, normal;
		double          k1 = 0.0, k2 = 0.0;
		double          spacing = 0.0; // of the control points around, length

		// The quadric's point below or above `position`, along the normal (T06 fig. 5, step 7).
		Eigen::Vector3d foot(const Eigen::Vector3d& position) const;
		Eigen::Vector3d normalAt(const Eigen::Vector3d& position) const; // unit
	};
	// Steps 1 to 6. Nothing where no control point is near, or too few for a tensor.
	std::optional<Quadric> quadricNear(const Eigen::Vector3d& position) const;

private:
	struct Neighborhood;
	bool gather(const Eigen::Vector3d& position, Neighborhood& around) const;

	const PointCloud&          m_control;
	const NeighborSearch&      m_search;
	const std::vector<double>& m_spacing;
	CurvatureDrivenOptions     m_options;
};

struct ProjectionOptions {
	double tolerance  = 1e-4; // in local spacings: a point that moves less is on the surface
	Index  iterations = 10;   // projections of one point at most (T06: 2 or 3 suffice)
};

struct ProjectedPoints {
	Eigen::Matrix3Xd positions, normals; // 3 x N; where nothing is near, the position given and no normal
	Eigen::VectorXd  k1, k2;             // N, convex positive, k1 >= k2
	Eigen::Matrix3Xd d1, d2;             // 3 x N unit
	std::vector<char> projected;         // N
	Index            iterations = 0;     // largest number any point needed
};

// Every point of `positions` (3 x N) projected until it stays.
ProjectedPoints projectPoints(
	const CurvatureDrivenSurface& surface,
	const Eigen::Matrix3Xd&       positions,
	const ProjectionOptions&      options  = {},
	const Progress&               progress = {});

} // namespace curvature_lines
