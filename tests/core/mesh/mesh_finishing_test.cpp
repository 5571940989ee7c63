// Holes up to the longest perimeter are closed, others stay; concave faces and polygons are cut.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_finishing.h"

#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {
namespace {

// n x n unit squares in the plane z = 0 without a block of hole x hole squares in the middle.
PolygonMesh gridWithHole(Index n, Index hole)
{
	PolygonMesh mesh;
	mesh.vertices.resize(3, (n + 1) * (n + 1));
	mesh.normals = Eigen::Vector3d::UnitZ().replicate(1, mesh.vertices.cols());
	for (Index y = 0; y <= n; ++y)
		for (Index x = 0; x <= n; ++x)
			mesh.vertices.col(y * (n + 1) + x) << x, y, 0.0;
	std::vector<std::vector<Index>> faces;
	const Index                     first = (n - hole) / 2, last = first + hole;
	for (Index y = 0; y < n; ++y)
		for (Index x = 0; x < n; ++x) {
			const Index corner = y * (n + 1) + x;
			if (x < first || x >= last || y < first || y >= last)
				faces.push_back({corner, corner + 1, corner + n + 2, corner + n + 1});
		}
	mesh.faces = NeighborLists::fromRows(faces);
	return mesh;
}

TEST(CloseSmallHoles, UpToTheLongestPerimeter)
{
	// Perimeters 12 and 16; the rim of the grid is longer than either.
	for (const Index hole : {3, 4}) {
		PolygonMesh mesh = gridWithHole(9, hole);
		EXPECT_EQ(topologyOf(mesh).boundaryLoops, 2);
		closeSmallHoles(mesh);
		const MeshTopology topology = topologyOf(mesh);
		EXPECT_EQ(topology.boundaryLoops, 4 * hole <= longestClosedHole ? 1 : 2);
		EXPECT_EQ(topology.nonmanifoldEdges + topology.nonmanifoldVertices, 0);
	}
	PolygonMesh none;
	none.vertices.resize(3, 0);
	none.normals.resize(3, 0);
	closeSmallHoles(none);
	EXPECT_EQ(none.faceCount(), 0);
}

// A pentagon with one corner pushed inwards.
PolygonMesh dart()
{
	PolygonMesh mesh;
	mesh.vertices.resize(3, 5);
	mesh.vertices << 0, 2, 1, 2, 0, 0, 0, 1, 2, 2, 0, 0, 0, 0, 0;
	mesh.normals = Eigen::Vector3d::UnitZ().replicate(1, 5);
	mesh.faces   = NeighborLists::fromRows({{0, 1, 2, 3, 4}});
	return mesh;
}

TEST(WithConvexFaces, CutsAtTheReflexCorner)
{
	const PolygonMesh  cut      = withConvexFaces(dart());
	const MeshTopology topology = topologyOf(cut);
	EXPECT_GE(topology.faces, 2);
	EXPECT_EQ(topology.eulerCharacteristic, 1);
	EXPECT_EQ(cut.vertices, dart().vertices);
	for (Index f = 0; f < cut.faceCount(); ++f)
		if (cut.faces[f].size() > 4)
			ADD_FAILURE() << "a face of " << cut.faces[f].size() << " corners is left";
}

TEST(Triangulated, HasOnlyTriangles)
{
	FinishedMesh         result;
	MeshFinishingOptions options;
	options.triangulate = true;
	result.mesh         = gridWithHole(4, 2);
	finish(result, {}, options);
	const MeshTopology& topology = result.topology;
	EXPECT_EQ(topology.triangles, topology.faces);
	EXPECT_EQ(topology.triangles, 24);
	EXPECT_EQ(topology.boundaryLoops, 2);
	EXPECT_EQ(result.mesh.faceCount(), 24);
	EXPECT_EQ(result.texture.corners.cols(), 0);
}

// Of polygons and of their triangles.
TEST(Finish, TextureCoordinatesOnRequest)
{
	for (const bool triangulate : {false, true}) {
		FinishedMesh         result;
		MeshFinishingOptions options;
		options.triangulate        = triangulate;
		options.textureCoordinates = true;
		result.mesh                = gridWithHole(4, 2);
		finish(result, std::vector<char>(25, 1), options);
		EXPECT_EQ(result.texture.charts, 1) << "marked, but flat";
		EXPECT_EQ(result.texture.cells, 4);
		EXPECT_EQ(
			result.texture.corners.cols(), static_cast<Index>(result.mesh.faces.indices.size()));
		EXPECT_EQ(result.texture.chart.size(), static_cast<std::size_t>(result.mesh.faceCount()));
		EXPECT_EQ(result.texture.corners.minCoeff(), 0.0);
		EXPECT_EQ(result.texture.corners.maxCoeff(), 1.0);
	}
}

} // namespace
} // namespace curvature_lines
