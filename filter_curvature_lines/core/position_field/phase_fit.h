// The phases whose gradients are as nearly as possible what they should be, with all whole numbers held.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "cross_field.h"
#include "line_density.h"
#include "phase_elements.h"
#include "phase_pins.h"
#include "triangle_mesh.h"

namespace curvature_lines {

// The pieces of the scaffold, and how many lines of either family end in each: there the phases have no gradient like the
// one they should have.
struct PhasePieces {
	std::vector<PhaseElement> elements;
	std::vector<Complex>      lost;
};

// In a singular triangle all lines end, unless it is parted around its fixed point.
PhasePieces phasePieces(
	const TriangleMesh&     mesh,
	const CrossField&       field,
	const LineDensity&      density,
	const Eigen::VectorXcd& translations,
	bool                    parted);

// One linear least-squares fit. `drift`: cost of a line that drifts sideways over that of uneven spacing. Pinned phases go to
// the nearest integer. `phase` stays as it is where there is no solution.
void fitPhases(
	const PhasePieces& pieces, const PhasePins& pins, double drift, Eigen::VectorXcd& phase);

} // namespace curvature_lines
