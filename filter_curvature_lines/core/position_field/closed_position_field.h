// A position field in which no line ends, every singular point of the crosses is a crossing of lines, and no triangle is
// turned over: what its lines bound are quads.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cross_field.h"
#include "integer_flow.h"
#include "line_density.h"
#include "phase_pins.h"
#include "point_cloud.h"
#include "position_field.h"
#include "progress.h"
#include "triangle_mesh.h"

namespace curvature_lines {

struct ClosingOptions {
	IntegerFlowOptions flow;
	// PositionFieldOptions::fitDrift, with closed whole numbers. With 3, ten real shapes lie 15 % nearer to the points
	// than with 30, and fewer triangles turn over: lines that must reach a place may swerve to it.
	double drift = 3.0;
	// Times singular points may move on to the triangle that their crossing is in.
	int moves = 2;
};

struct ClosedPositionField {
	PositionField positions;
	CrossField    field; // its singular points have moved
	// Triangles turned over in the plane of the phases, where faces may overlap or be no quads
	std::vector<Index> turnedOver;
};

// `guide`: the one `field` comes from.
ClosedPositionField closePositionField(
	const TriangleMesh&   mesh,
	const DirectionGuide& guide,
	CrossField            field,
	const LineDensity&    density,
	const PhasePins&      pins,
	PositionField         positions,
	const ClosingOptions& options  = {},
	const Progress&       progress = {});

// Phases anew where other vertices are pinned: some creases have been given up. Whole numbers stay.
void layPhases(
	const TriangleMesh&   mesh,
	const LineDensity&    density,
	const PhasePins&      pins,
	const ClosingOptions& options,
	ClosedPositionField&  closed,
	const Progress&       progress = {});

} // namespace curvature_lines
