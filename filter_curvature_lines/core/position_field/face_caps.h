// Faces the surface bulges out of, as at the tips of limbs that no line crosses: they get rings of quads that go on to the
// farthest point.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cloud_index.h"
#include "curvature_field.h"
#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {

// A face bulges when a point of the surface is above it by more than `bulge`, in its mean edges.
// `index`: the points on the surface. Vertices of the mesh stay; new ones lie on the surface and are marked as not
// `onFeature`. Keeps V - E + F. Returns how many faces got a cap.
Index capBulgingFaces(
	const CloudIndex&     index,
	const CurvatureField& curvature,
	double                bulge,
	PolygonMesh&          mesh,
	std::vector<char>&    onFeature);

} // namespace curvature_lines
