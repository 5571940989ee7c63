// The topology count on meshes whose counts are known.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "polygon_mesh.h"

#include <vector>

#include <gtest/gtest.h>

#include "point_cloud.h"

namespace curvature_lines {
namespace {

PolygonMesh mesh(Index vertices, const std::vector<std::vector<Index>>& faces)
{
	PolygonMesh result;
	result.vertices = Eigen::Matrix3Xd::Random(3, vertices);
	result.normals  = Eigen::Matrix3Xd::Zero(3, vertices);
	result.faces    = NeighborLists::fromRows(faces);
	return result;
}

const std::vector<std::vector<Index>> cubeFaces = {
	{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

TEST(MeshTopology, ClosedAndOpenCube)
{
	const MeshTopology closed = topologyOf(mesh(8, cubeFaces));
	EXPECT_EQ(closed.vertices, 8);
	EXPECT_EQ(closed.edges, 12);
	EXPECT_EQ(closed.quads, 6);
	EXPECT_EQ(closed.largestFace, 4);
	EXPECT_EQ(closed.eulerCharacteristic, 2);
	EXPECT_EQ(closed.components, 1);
	EXPECT_EQ(closed.boundaryEdges + closed.boundaryLoops, 0);
	EXPECT_EQ(closed.nonmanifoldEdges + closed.nonmanifoldVertices, 0);

	auto faces = cubeFaces;
	faces.erase(faces.begin() + 1);
	const MeshTopology box = topologyOf(mesh(9, faces)); // one vertex unused
	EXPECT_EQ(box.vertices, 8);
	EXPECT_EQ(box.eulerCharacteristic, 1);
	EXPECT_EQ(box.boundaryEdges, 4);
	EXPECT_EQ(box.boundaryLoops, 1);
	faces.erase(faces.begin());
	const MeshTopology tube = topologyOf(mesh(8, faces));
	EXPECT_EQ(tube.eulerCharacteristic, 0);
	EXPECT_EQ(tube.boundaryLoops, 2);
	EXPECT_EQ(tube.nonmanifoldVertices, 0);
}

TEST(MeshTopology, NonManifoldConfigurations)
{
	const MeshTopology bowTie = topologyOf(mesh(5, {{0, 1, 2}, {0, 3, 4}}));
	EXPECT_EQ(bowTie.nonmanifoldVertices, 1);
	EXPECT_EQ(bowTie.nonmanifoldEdges, 0);
	EXPECT_EQ(bowTie.components, 1);
	EXPECT_EQ(bowTie.boundaryLoops, 2);

	const MeshTopology book = topologyOf(mesh(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}));
	EXPECT_EQ(book.nonmanifoldEdges, 1);
	EXPECT_EQ(book.nonmanifoldVertices, 2);

	const MeshTopology twisted = topologyOf(mesh(4, {{0, 1, 2}, {0, 1, 3}}));
	EXPECT_EQ(twisted.nonmanifoldEdges, 1);
	EXPECT_EQ(topologyOf(mesh(4, {{0, 1, 2}, {1, 0, 3}})).nonmanifoldEdges, 0);

	const MeshTopology apart = topologyOf(mesh(6, {{0, 1, 2}, {3, 4, 5}}));
	EXPECT_EQ(apart.components, 2);
	EXPECT_EQ(apart.boundaryLoops, 2);
	EXPECT_EQ(apart.eulerCharacteristic, 2);

	EXPECT_EQ(topologyOf(mesh(3, {})).vertices, 0);
}

} // namespace
} // namespace curvature_lines
