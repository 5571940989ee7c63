// The arrangement of curves on a triangulated surface: their graph, its reduction, and faces with a
// certificate that each of them is a disk (Euler's formula). A09 section 6 takes every loop of half-edges
// for a face.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"
#include "polygon_mesh.h"
#include "surface_curves.h"
#include "surface_graph.h"
#include "triangle_mesh.h"

namespace curvature_lines {

struct SurfaceArrangement {
	PolygonMesh       mesh;
	std::vector<char> onFeature; // of every vertex: lies on a rim or crease
	Index             crossings          = 0;
	Index             repairedComponents = 0; // the curves alone left a face that was no disk
	Index             lostComponents     = 0; // that carry no face
};

// For a graph on a surface V - E + (loops of faces) is the Euler characteristic chi of the surface plus
// sum (2 g + 2 b - 2) over the faces, g their genus and b the number of their borders: it equals chi exactly
// when all are disks. Components in which it does not get further edges, pieces of the triangles' edges.
SurfaceArrangement arrangeOnSurface(
	const TriangleMesh&     mesh,
	const Eigen::Matrix3Xd& normals, // of the vertices
	const SurfaceFeatures&  features,
	const SurfaceCurves&    curves);

} // namespace curvature_lines
