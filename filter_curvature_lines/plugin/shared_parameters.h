// Parameters that several filters have, each row written once.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "curvature_cache.h"
#include "curvature_estimate.h"
#include "mesh_finishing.h"
#include "parameter_table.h"
#include "umbilics.h"

namespace curvature_lines {

// Adaptive or published.
void scaleModeParameter(ParameterTable& table, ScaleMode& mode, bool advanced);
// Of the curvature estimate, scale mode included.
void estimateParameters(ParameterTable& table, EstimateOptions& options);
void umbilicParameter(ParameterTable& table, UmbilicOptions& options);
// Of the filters that end in a mesh.
void meshParameters(ParameterTable& table, MeshFinishingOptions& options);

} // namespace curvature_lines
