// Creases of a scaffold that its quad mesh can have as lines: some are too short, or too near to others, for its cells.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "point_cloud.h"
#include "scaffold.h"

namespace curvature_lines {

// Pieces of creases that are shorter than a cell of the mesh and end freely, or are closed and enclose less than one, are no
// creases any more. Returns how many edges.
Index dropShortCreases(Scaffold& scaffold);

// Neither are those within a cell of these triangles, at which lines could not be laid along the creases, but where the
// faces meet sharply. Returns how many edges.
Index dropCreasesAt(const std::vector<Index>& triangles, Scaffold& scaffold);

} // namespace curvature_lines
