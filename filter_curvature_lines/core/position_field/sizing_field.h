// How long the edges of the quad mesh are to be at every point: as the number of vertices allows, and shorter where the
// shape asks for it: limbs get quads around, tight bends are not cut by chords, every part of the cloud gets faces of
// its own. Beyond the papers, whose line spacing knows curvature alone (A09 section 5.1).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "cloud_index.h"
#include "curvature_field.h"
#include "progress.h"

namespace curvature_lines {

struct SizingOptions {
	double targetVertices = 1600.0;
	// The target is nobody's wish: features come on top of it. Else the rest of the surface gives way to them first.
	bool automatic = false;
	// Edges around a limb; and so many where the target is too low for that.
	double aroundLimb = 7.0, fewestAroundLimb = 4.0;
	// Edge over the radius of a bend of the surface, at most.
	double longestAcrossBend = 0.7;
	// Growth of the size per length on the surface.
	double gradation = 0.4;
	// Faces of the smallest component, if it has points enough.
	double componentFaces = 24.0;
	// How much longer the edges of the rest may get for the sake of features.
	double mostBody = 1.3;
};

struct SizingField {
	Eigen::VectorXd feature;    // N, lengths: the longest edge the shape allows; INFINITY: any
	Eigen::VectorXd spacing;    // N, lengths: of the points around
	Eigen::VectorXd limb;       // N, lengths: radius of the limb a point is on; INFINITY: of none
	double          body = 0.0; // longest edge that the target allows; size = min(feature, body)
	double          expected = 0.0; // vertices

	Eigen::VectorXd size() const { return feature.cwiseMin(body); }
};

// `index`: the points as the mesh is to have them; the field has an estimate for each.
SizingField sizingField(
	const CloudIndex&     index,
	const CurvatureField& curvature,
	const SizingOptions&  options,
	const Progress&       progress = {});

// The body that gives patches of these areas (N) and features (N) so many vertices, one per square of the size; at
// most `longest`. Features alone may give more.
double bodyFor(
	const Eigen::VectorXd& areas, const Eigen::VectorXd& feature, double vertices, double longest);

} // namespace curvature_lines
