// Whole numbers of a position field that close: lines that end are joined in pairs, and singular points moved onto
// crossings of lines, by the least change of the lines (a minimum-cost flow; compare QuadriFlow, Huang et al. 2018, and
// Bi-MDF, Heistermann et al. 2023).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "cross_field.h"
#include "line_density.h"
#include "triangle_mesh.h"

namespace curvature_lines {

// Of every edge and family, in the frame at its start: the increase along it is held.
using HeldIncreases = std::vector<std::array<char, 2>>;

struct IntegerFlowOptions {
	// Cost of moving the end of a line by a cell along the line, over that by a cell across it: the first adds a piece of
	// line, the second bends lines. By experiment, see pure-quad tables in docs/method.md.
	double along = 1.0 / 3.0;
	// Cost of turning at a singular point, where a line of one family goes on as the other, in cells.
	double atSingular = 0.5;
	// Of a path, in cells; what needs a longer one stays as it is.
	double longest = std::numeric_limits<double>::infinity();
	// Of vertices on thin limbs: a path along one takes away one of its few lines; too many, and the limb is gone (a
	// chameleon's tongue). Empty: there are none; and how much longer paths there count.
	std::vector<char> onLimb;
	double            limbCost = 20.0;
};

struct IntegerFlow {
	Eigen::VectorXcd translations; // of every edge
	int              paths  = 0;
	double           length = 0.0; // of all paths, in cells across lines
	int              left   = 0;   // triangles that still do not close
};

// `translations`: of every edge, whole numbers. Lines that meet a rim may end there, unless its increase is held. Pairs are
// joined closest first.
IntegerFlow closeTranslations(
	const TriangleMesh&       mesh,
	const CrossField&         field,
	const LineDensity&        density,
	const HeldIncreases&      held,
	Eigen::VectorXcd          translations,
	const IntegerFlowOptions& options = {});

} // namespace curvature_lines
