// The position field: two phases on the scaffold whose gradients are the arms of the crosses times the line
// density. Lines of the mesh run where a phase is an integer. A periodic start by the smallest eigenvector
// finds where lines end (Ray et al. 2006, Knoeppel et al. 2015), a real least-squares fit then places them.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "cross_field.h"
#include "line_density.h"
#include "phase_pins.h"
#include "point_cloud.h"
#include "triangle_mesh.h"

namespace curvature_lines {

struct PositionFieldOptions {
	// Cost of drifting sideways along a line over that of uneven spacing, in the start and in the fit; and
	// rounds of the fit, integers found anew in each. In a prototype on a noisy ellipsoid: 1, 10, 100 in
	// the start change nothing; 1, 30, 300 in the fit give 1.43, 1.21, 1.17 degrees; 0, 1, 2 rounds 1.06,
	// .80, .80.
	double startDrift = 10.0;
	double fitDrift   = 100.0;
	int    rounds     = 1;
};

struct PositionField {
	Eigen::VectorXcd phase; // per vertex, in its frame
	// Per edge: what the phase becomes at `to`, in the frame of `from`: phaseAtEnd + whole numbers.
	Eigen::VectorXcd end;
	Eigen::VectorXcd translations; // per edge: those whole numbers
	Index            lineEnds = 0; // triangles in which a line of either family ends
	// Singular triangles in whose inside no lines cross, so that a face around them is no quad
	Index offCrossings = 0;
};

PositionField positionField(
	const TriangleMesh&         mesh,
	const CrossField&           field,
	const LineDensity&          density,
	const PhasePins&            pins,
	const PositionFieldOptions& options = {});

// The phase at the end of an edge, in the frame at its start: i^-turns phase(to).
Complex phaseAtEnd(
	const TriangleMesh& mesh, const CrossField& field, const Eigen::VectorXcd& phase, Index edge);

// Ends and counts from phases and translations.
void finishPositions(const TriangleMesh& mesh, const CrossField& field, PositionField& positions);

} // namespace curvature_lines
