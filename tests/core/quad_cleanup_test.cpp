// Strips between irregular faces: they leave only quads and keep the topology.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/quad_cleanup.h"

#include <gtest/gtest.h>

namespace curvature_lines {
namespace {

// A row of `quads` squares with a pentagon at each end: the pentagon's fifth corner lies on its outer side.
PolygonMesh row(Index quads)
{
	const Index columns = quads + 3;
	PolygonMesh mesh;
	mesh.vertices.setZero(3, 2 * columns + 2);
	mesh.normals = Eigen::Vector3d::UnitZ().replicate(1, 2 * columns + 2);
	for (Index k = 0; k < columns; ++k) {
		mesh.vertices.col(2 * k) << k, 0.0, 0.0;
		mesh.vertices.col(2 * k + 1) << k, 1.0, 0.0;
	}
	const Index left = 2 * columns, right = left + 1;
	mesh.vertices.col(left) << 0.0, 0.5, 0.0;
	mesh.vertices.col(right) << columns - 1, 0.5, 0.0;
	std::vector<std::vector<Index>> faces;
	for (Index k = 0; k + 1 < columns; ++k)
		faces.push_back({2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1});
	faces.front().push_back(left);
	faces.back().insert(faces.back().begin() + 2, right);
	mesh.faces = NeighborLists::fromRows(faces);
	return mesh;
}

TEST(QuadCleanup, StripsTurnPairsOfPentagonsIntoQuads)
{
	for (Index quads = 0; quads < 3; ++quads) {
		const PolygonMesh  before = row(quads);
		std::vector<char>  onFeature(before.vertexCount(), 0);
		const PolygonMesh  after = insertStrips(before, onFeature, 3);
		const MeshTopology a = topologyOf(before), b = topologyOf(after);
		EXPECT_EQ(a.quads, quads);
		EXPECT_EQ(b.quads, b.faces);
		EXPECT_EQ(b.quads, 2 * (quads + 2));
		EXPECT_EQ(b.eulerCharacteristic, a.eulerCharacteristic);
		EXPECT_EQ(b.boundaryLoops, 1);
		EXPECT_EQ(b.nonmanifoldEdges, 0);
		EXPECT_EQ(static_cast<Index>(onFeature.size()), after.vertexCount());
	}
}

TEST(QuadCleanup, LongStripsStay)
{
	const PolygonMesh before = row(5);
	std::vector<char> onFeature(before.vertexCount(), 0);
	EXPECT_EQ(topologyOf(insertStrips(before, onFeature, 3)).quads, 5);
}

TEST(QuadCleanup, NewVerticesBetweenFeatureVerticesAreOnTheFeature)
{
	const PolygonMesh before = row(0);
	std::vector<char> onFeature(before.vertexCount(), 1);
	const PolygonMesh after = cleanUpQuads(before, onFeature);
	EXPECT_EQ(onFeature, std::vector<char>(after.vertexCount(), 1));
}

} // namespace
} // namespace curvature_lines
