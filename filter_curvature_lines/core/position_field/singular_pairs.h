// Fewer singular points of the crosses: pairs that noise, or parts that are flat or round, have made are not left to become
// irregular vertices of the mesh.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cross_field.h"
#include "point_cloud.h"
#include "scaffold.h"

namespace curvature_lines {

// By experiment on the shapes of benchmarks/real_shapes.py.
struct SingularPairOptions {
	// Where the next singular point of another index is nearer, in cells of the mesh, the directions around both are trusted
	// less by this factor, out to half their distance and some cells more, in each of so many rounds.
	double near = 3.0, fade = 0.3, margin = 1.5;
	int    rounds = 8;
	// Pairs whose indices add up to none and that are nearer are joined whatever the directions are.
	double joined = 2.0;
	// Singular points nearer to each other, in cells, move apart: their crossings will be a cell apart at least.
	double apart = 1.0;
};

// The crosses of the guide with its weights lowered around such pairs.
CrossField calmCrossField(
	const Scaffold& scaffold, DirectionGuide& guide, const SingularPairOptions& options = {});

// Joins pairs, closest first, without crossing a crease: the turns of the edges between both change, the crosses stay.
// Returns how many.
Index joinSingularPairs(
	const Scaffold& scaffold, CrossField& field, const SingularPairOptions& options = {});

// Moves singular points that are nearer to others than options.apart away from them, as far as one without crossing
// creases can. Returns how many.
Index spreadSingularPoints(
	const Scaffold& scaffold, CrossField& field, const SingularPairOptions& options = {});

} // namespace curvature_lines
