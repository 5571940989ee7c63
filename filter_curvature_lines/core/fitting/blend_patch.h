// One of the overlapping local quadrics of the denoising: the points it is fitted to, from where, and how
// far they look like one noisy surface.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>

#include "neighborhoods.h"
#include "spatial_order.h"
#include "surface_patch.h"

namespace curvature_lines {

// What patches are fitted to. Columns are in `order`; the first of its shuffled order are the centres of
// patches.
struct BlendInput {
	SpatialOrder order;
	PointCloud   cloud;
	// per point, smooth: side of the square that holds one point, a length
	std::vector<double> spacing;
	// per point: standard deviation of the positions across the surface (point_deviation.h, or the
	// caller's), a length
	std::vector<double> pointDeviation;
};

// Where the points are thought to be: tells frames and gates. Heights are always those of the input,
// so that repeated passes do not shrink the surface.
struct BlendGuide {
	BlendGuide(Eigen::Matrix3Xd guidePositions, Eigen::Matrix3Xd guideNormals) :
			positions(std::move(guidePositions)), normals(std::move(guideNormals)),
			search(positions)
	{
	}
	BlendGuide(const BlendGuide&)            = delete; // the search refers to the positions
	BlendGuide& operator=(const BlendGuide&) = delete;

	const Eigen::Matrix3Xd positions, normals;
	const NeighborSearch   search; // of the positions
};

struct BlendOptions {
	enum class Support {
		Free,    // frame by principal components; normals only tell sheets apart. For noisy guides
		OneFace, // points whose guide normals vary linearly with the place belong: stops at edges
		// arc lengths along the guide instead of their projection: reaches further round a bend
		ArcLength,
	};
	Support             support = Support::Free;
	std::vector<double> radius; // per point, of a patch there, smooth: a length
	double normalWidth = 0.7;   // OneFace: deviation from the linear normal that quarters a weight
	double purity      = 0.0;   // how fast a patch loses weight as its residuals exceed the noise
	double acceptance  = 0.0;   // residual, in noise units, that quarters a weight; 0: any is taken
	bool   edges       = false; // OneFace: points beside an edge also see the faces beyond it
	double overlap     = 38.0;  // patches that cover a point, on average
};

// The patch and how far its residuals fit the noise, 0..1.
struct BlendPatch {
	SurfacePatch surface;
	double       purity = 1.0;
};

BlendPatch
patchAt(const BlendInput& input, const BlendGuide& guide, const BlendOptions& options, Index i);

// Where a bent patch sees a point: x and y from the guide, z from the input.
struct ArcCoordinates {
	double x = 0.0, y = 0.0, z = 0.0;
	bool   valid = false;
};

// `height` and `place`: of the input and of the guide, from the patch's origin; `normal`: of the guide.
ArcCoordinates arcCoordinates(
	const SurfacePatch&    patch,
	const Eigen::Vector3d& height,
	const Eigen::Vector3d& place,
	const Eigen::Vector3d& normal);

// Noise carries no point farther from its surface.
double farthestMove(const BlendInput& input, Index i);

// Geman-McClure weight of a squared residual in units of its width; 0 beyond two widths.
double normalWeight(double e2);

// Normals that oppose each other further are of another sheet (cosine).
constexpr double minOpposing = -0.2;

// Of the ball that holds all points a patch at a point may see.
double ballRadius(const BlendInput& input, const BlendOptions& options, double radius, Index i);

} // namespace curvature_lines
