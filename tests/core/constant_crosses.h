// Triangulations of exact surfaces with the crosses of their principal directions, as the stages of the position field
// take them.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <numeric>
#include <utility>

#include "cross_field.h"
#include "curvature_field.h"
#include "point_cloud.h"
#include "scaffold.h"
#include "triangulated_surfaces.h"

namespace curvature_lines::test {

struct CrossedSurface {
	TriangulatedSurface surface;
	Scaffold            scaffold;
	CurvatureField      curvature; // exact
	CrossField          field;
};

inline CrossedSurface crossed(TriangulatedSurface surface)
{
	CrossedSurface result;
	const Index    n     = surface.size();
	result.scaffold.mesh = surface.mesh;
	const double spacing = std::sqrt(surface.mesh.vertexAreas().sum() / n);
	result.scaffold.spacing.setConstant(n, spacing);
	result.scaffold.size.setConstant(n, 2.0 * spacing);
	result.scaffold.source.resize(n);
	std::iota(result.scaffold.source.begin(), result.scaffold.source.end(), 0);
	result.scaffold.creaseEdge.assign(surface.mesh.edgeCount(), 0);
	result.curvature.k1 = surface.truth.k1;
	result.curvature.k2 = surface.truth.k2;
	result.curvature.d1 = surface.truth.d1;
	result.curvature.d2 = surface.truth.d2;
	result.curvature.error.setZero(n);
	result.curvature.status.assign(n, PointStatus::Ok);
	DirectionGuide guide;
	guide.normals    = surface.truth.normals;
	guide.directions = surface.truth.d1;
	guide.weights.setConstant(n, 1.0);
	guide.onCrease.assign(n, 0);
	result.field   = smoothCrossField(surface.mesh, guide);
	result.surface = std::move(surface);
	return result;
}

} // namespace curvature_lines::test
