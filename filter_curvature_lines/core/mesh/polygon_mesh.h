// Polygon meshes over shared vertices, and a count of what one is that assumes nothing about how it was made.
// A09 section 6 asks for such meshes; the counts are ours.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"

namespace curvature_lines {

// Polygons over shared vertices, counter-clockwise seen from outside.
struct PolygonMesh {
	Eigen::Matrix3Xd vertices, normals; // 3 x V
	NeighborLists    faces;             // vertex loop of each face

	Index vertexCount() const { return static_cast<Index>(vertices.cols()); }
	Index faceCount() const { return faces.size(); }
};

Eigen::Matrix3Xd asColumns(const std::vector<Eigen::Vector3d>& vectors);

PolygonMesh polygonMesh(
	const std::vector<Eigen::Vector3d>&    vertices,
	const std::vector<Eigen::Vector3d>&    normals,
	const std::vector<std::vector<Index>>& faces);

// The vertex loop of every face, to be changed.
std::vector<std::vector<Index>> faceLoopsOf(const PolygonMesh& mesh);

// What a mesh is, counted; nothing is assumed.
struct MeshTopology {
	Index vertices = 0, edges = 0, faces = 0, triangles = 0, quads = 0, largestFace = 0;
	Index boundaryEdges = 0, boundaryLoops = 0;
	Index nonmanifoldEdges    = 0; // more than two faces, or two that disagree about its direction
	Index nonmanifoldVertices = 0; // faces around it do not form one fan
	Index components          = 0;
	Index eulerCharacteristic = 0; // V - E + F over used vertices
};
MeshTopology topologyOf(const PolygonMesh& mesh);

} // namespace curvature_lines
