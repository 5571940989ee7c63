// One of the overlapping local quadrics of the denoising: the points it is fitted to, from where, and how
// far they look like one noisy surface.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "neighborhoods.h"
#include "point_cloud.h"
#include "scan_lines.h"
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
	ScanLines           lines = {}; // at the places of the points; may be left out: none
};

// Estimated places and normals of the points, from an earlier pass: they give the frames of patches and the weights by
// normals. Heights are always those of the input, so that repeated passes do not shrink the surface.
struct BlendGuide {
	BlendGuide(Eigen::Matrix3Xd guidePositions, Eigen::Matrix3Xd guideNormals) :
			positions(std::move(guidePositions)), normals(std::move(guideNormals)),
			search(positions)
	{
	}
	// `found`: over the same positions.
	BlendGuide(
		Eigen::Matrix3Xd guidePositions, Eigen::Matrix3Xd guideNormals, NeighborSearch found) :
			positions(std::move(guidePositions)), normals(std::move(guideNormals)),
			search(std::move(found))
	{
	}
	BlendGuide(const BlendGuide&)            = delete; // the search refers to the positions
	BlendGuide& operator=(const BlendGuide&) = delete;

	const Eigen::Matrix3Xd positions, normals;
	const NeighborSearch   search; // of the positions
};

struct BlendOptions {
	enum class Support {
		// Frame by principal components, all points of the sheet (by their normals). For noisy guides.
		Free,
		// Points whose guide normals are near those of the quadric, so that a patch ends at edges.
		OneFace,
		// x and y are arc lengths along the guide, not projections: reaches farther round a bend.
		ArcLength,
		// Likewise, but fits `heights`, and moves the guide by what it finds of them: twicing (Tukey 1977), which
		// squares the share of the shape that a blend flattens.
		Correction,
	};
	Support             support = Support::Free;
	std::vector<double> radius; // per point, of a patch there, smooth: a length
	// Correction: BlendedSurface::height of the blend whose positions and normals the guide has, of the same radius.
	std::vector<double> heights;
	// OneFace: length of the difference between normals that quarters a weight. By experiment (benchmarks/cleaning.py):
	// with 0.5 twice as much noise is left on a torus at 2 %, with 0.3 more at the edges of a cube.
	double normalWidth = 0.7;
	double purity      = 0.0; // how fast a patch loses weight as its residuals exceed the noise
	// Residual, in pointDeviations, that quarters a weight; 0: any is taken.
	double acceptance = 0.0;
	bool   edges      = false; // OneFace: points beside an edge also see the faces beyond it
	double overlap    = 38.0;  // patches that cover a point, on average
	// Longer semi-axis of a patch across scan lines, at least, in their gaps. Three lines determine a quadric, and the
	// next two, with little weight, one whose centre is off its line. By experiment: with 1.7 twice as much noise is left
	// on lines of 12:1, with 2.6 the error made where there is no noise is fourfold.
	double gapsAcross = 2.3;
};

// The patch and how far its residuals fit the noise, 0..1.
struct CoveringPatch {
	SurfacePatch surface;
	double       purity = 1.0;
};

CoveringPatch coveringPatchAt(
	const BlendInput& input, const BlendGuide& guide, const BlendOptions& options, Index i);

// Coordinates of a point in a patch by arc length: x and y from the guide, in radii; z from the input, a length.
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
