// Projection of a free point onto the surface the cloud implies, with interpolated normal and
// curvature tensor (A09 section 5.1 steps 1-3; R07 section 5; LOP: Lipman et al. 2007).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "cloud_index.h"
#include "curvature_field.h"
#include "point_cloud.h"

namespace curvature_lines {

enum class ProjectionKind {
	// Hermite mean of point average and tangent planes: their errors +-k s^2/2 cancel
	Mixed,
	// A09: LOP, 5 iterations, normal component only (LOP alone slides tangentially)
	LocallyOptimal,
	WeightedAverage, // R07
};

struct SurfaceSample {
	Eigen::Vector3d position = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
	// unit principal directions, d2 = n x d1; sign arbitrary
	Eigen::Vector3d d1 = Eigen::Vector3d::Zero();
	Eigen::Vector3d d2 = Eigen::Vector3d::Zero();
	double          k1 = 0.0, k2 = 0.0;
	// Tangent, from here to the mean of the points around, in widths of their kernel: rimOffset long at a straight rim
	// or crease, since points across a crease do not count. 0 where there is only one point.
	Eigen::Vector3d inwards = Eigen::Vector3d::Zero();
	// the cloud point whose statistical weights were used (given by the caller)
	Index closest = -1;
};

constexpr double rimOffset = 0.56; // 1 / sqrt(pi): of a half plane

// The points where the surfaces fitted around them are, as far as these are known. Heights far beyond the
// noise are left alone: they are those of stray points and of points next to a crease that took the normal of the other
// face.
PointCloud onFittedSurface(const PointCloud& cloud, const CurvatureField& field);

// The nearest point of the cloud whose normal agrees with that of a place, which may be near to another sheet; the nearest of
// all where none of several agrees.
Index closestOnSide(
	const CloudIndex& index, const Eigen::Vector3d& position, const Eigen::Vector3d& normal);

// `closest`: the cloud point nearest to `position` (its Voronoi cell). The support are the points
// with positive statistical weight there, and itself; opposing normals are left out. Where the
// support is empty the closest point's own tangent plane serves. Never returns NaN.
SurfaceSample projectToSurface(
	const PointCloud&      cloud,
	const CurvatureField&  field,
	const Eigen::Vector3d& position,
	Index                  closest,
	ProjectionKind         kind);

} // namespace curvature_lines
