// Phases moved until no triangle is turned over in their plane: there lines would turn back and faces overlap. The
// regularised energy of Garanzha et al. 2021 (foldover-free maps in 50 lines of code).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "phase_elements.h"
#include "phase_pins.h"
#include "point_cloud.h"
#include "progress.h"
#include "triangle_mesh.h"

namespace curvature_lines {

// Signed area of an element in the plane of the phases, over the one it should have.
double imageArea(const PhaseElement& element, const Eigen::VectorXcd& phase);

// Moves the phases of the vertices around elements that are turned over or thin; pinned ones stay. Returns the elements
// that are still turned over.
std::vector<Index> unfoldPhases(
	const TriangleMesh&              mesh,
	const std::vector<PhaseElement>& elements,
	const PhasePins&                 pins,
	Eigen::VectorXcd&                phase,
	const Progress&                  progress = {});

} // namespace curvature_lines
