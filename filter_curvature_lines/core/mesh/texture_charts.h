// Texture coordinates of quad meshes: every quad is a unit square of a grid whose lines are the two families of edges, and
// the mesh is cut into charts, pieces of the grid that do not overlap. Our own addition; nothing in A09 or R07.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "linked_faces.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygon_triangulation.h"

namespace curvature_lines {

struct TextureCoordinates {
	// 2 x corners of all faces, as in PolygonMesh::faces.indices; within [0, 1]. Times `cells`, the corners of quads are whole
	// numbers, and every quad is a unit square, counter-clockwise as its face is. Neighbours agree along their common edge
	// unless there is a seam.
	Eigen::Matrix2Xd   corners;
	std::vector<Index> chart; // of every face
	Index              charts = 0;
	Index              cells  = 0; // along a side of the texture
};

// Every face is in one chart; no two faces overlap, and between the boxes of two charts one row or column of cells stays
// empty. A chart ends at `creases`, rims and faces that are no quads, and where its next cell is taken: seams run from
// irregular vertices outwards, and where a chart would meet itself. None is longer than one and a half times the side of a
// square that all faces would fill. Faces that are no quads fill a cell, with the ends of one side at those of a quad's where
// there is room for it. Of regular quads around a torus there is one chart, of a cube with its creases there are six.
TextureCoordinates
textureCoordinates(const PolygonMesh& mesh, const std::vector<VertexPair>& creases = {});

// Edges between two marked vertices at which the surface bends: creases, where only their vertices are known. Without the
// second condition, edges from one crease or rim to another would be among them.
std::vector<VertexPair> bentEdgesBetween(const PolygonMesh& mesh, const std::vector<char>& marked);

// 2 x three per triangle: what the corners of polygons become when these are cut. A vertex that was put into a face gets the
// mean of its corners.
Eigen::Matrix2Xd cornersOfTriangles(
	const PolygonMesh& polygons, const Eigen::Matrix2Xd& corners, const PolygonTriangulation& cut);

} // namespace curvature_lines
