// Overlapping local quadrics and, at every point, the blend of all that cover it: the mixed projection
// of A09 section 4 with quadrics of hundreds of points, weighted by inverse prediction variance.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "neighborhoods.h"
#include "spatial_order.h"

namespace curvature_lines {

// What patches are fitted to. Columns are in `order`; the first of its shuffled order are the centres of
// patches.
struct BlendInput {
	SpatialOrder        order;
	PointCloud          cloud;
	std::vector<double> spacing; // per point, smooth: the unit of radii
	std::vector<double> noise;   // per point: standard deviation of the positions, a length
};

// Where the points are thought to be: tells frames and gates. Heights are always those of the input,
// so that repeated passes do not shrink the surface.
struct BlendGuide {
	Eigen::Matrix3Xd positions, normals;
};

struct BlendOptions {
	enum class Support {
		Free,  // frame by principal components; normals only tell sheets apart. For noisy guides
		Gated, // points whose guide normals vary linearly with the place belong: stops at edges
		Bent,  // arc lengths along the guide instead of their projection: reaches further round a bend
	};
	Support support    = Support::Free;
	double  radius     = 5.0; // in local spacings
	double  gateWidth  = 0.7; // Gated: deviation from the linear normal that quarters a weight
	double  purity     = 0.0; // how fast a patch loses weight as its residuals exceed the noise
	double  acceptance = 0.0; // residual, in noise units, that quarters a weight; 0: no limit
	bool    edges      = false; // Gated: points beside an edge also see the faces beyond it
	double  overlap    = 38.0; // patches that cover a point, on average
};

// Per point of the input, and at points that were not asked for the guide itself.
struct PatchBlend {
	Eigen::Matrix3Xd    positions, normals; // 3 x N
	std::vector<double> residual; // leave-one-out, a length; infinite where no patch reaches
	std::vector<double> purity;   // 0..1: share of the patches' weight that their residuals leave
	// Per valid patch, of its residuals; see SurfacePatch.
	std::vector<double> variance, effectiveCount;
};

// At the points of `targets` only, with the patches they need; best in ascending order.
PatchBlend blendPatches(
	const BlendInput&         input,
	const BlendGuide&         guide,
	const BlendOptions&       options,
	const std::vector<Index>& targets,
	const Progress&           progress = {});

} // namespace curvature_lines
