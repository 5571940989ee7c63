// One table of filters: what each is called, where MeshLab lists it, what it takes and does.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <common/plugins/interfaces/filter_plugin.h>

#include "curvature_cache.h"
#include "filter_results.h"
#include "parameters.h"

namespace curvature_lines {

struct FilterContext {
	Parameters      parameters;
	MeshDocument&   document;
	CurvatureCache& cache;
	Progress        progress;
};

struct FilterSpec {
	QString                   name; // menu text and key in .mlx files: never change it
	QString                   pythonName;
	QString                   help;        // HTML
	int                       filterClass; // FilterPlugin::FilterClass, or-ed
	FilterPlugin::FilterArity arity;
	int                       preConditions, postCondition; // MeshModel::MeshElement, or-ed
	// Must be cheap and never throw: hosts call it for documents without a usable layer.
	RichParameterList (*parameters)(const MeshDocument&);
	// Read layer, call core, write layer. Leaves the document untouched when it throws.
	FilterResults (*apply)(const FilterContext&);
};

// A filter's id is its position.
const std::vector<FilterSpec>& filterTable();

FilterSpec robustCurvatureFilter();
FilterSpec selectOutliersFilter();
FilterSpec denoiseFilter();
FilterSpec smoothDirectionsFilter();
FilterSpec traceLinesFilter();
FilterSpec sharpFeaturesFilter();
FilterSpec quadMeshFilter();
FilterSpec reconstructionFilter();
FilterSpec mWeightedCurvatureFilter();
FilterSpec projectionFilter();
FilterSpec rayTraceFilter();

} // namespace curvature_lines
