// Strips between irregular faces: they leave only quads and keep the topology.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "quad_cleanup.h"

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "point_cloud.h"
#include "polygon_mesh.h"
#include "rim_cleanup.h"

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

// The unit grid above the line y = x + 1 - gap, `cells` along that rim: cells it cuts are triangles, whose side on
// the rim is sqrt(2) gap, and pentagons in turn.
PolygonMesh diagonalRim(Index cells, double gap)
{
	std::map<std::pair<double, double>, Index> names;
	std::vector<std::vector<Index>>            faces;
	const auto add = [&](const std::vector<std::pair<double, double>>& corners) {
		faces.emplace_back();
		for (const auto& p : corners)
			faces.back().push_back(
				names.try_emplace(p, static_cast<Index>(names.size())).first->second);
	};
	const double below = 1.0 - gap;
	for (double i = 0.0; i < cells; ++i) {
		add({{i, i + below}, {i + gap, i + 1.0}, {i, i + 1.0}});
		add(
			{{i, i + 1.0},
		     {i + gap, i + 1.0},
		     {i + 1.0, i + 1.0 + below},
		     {i + 1.0, i + 2.0},
		     {i, i + 2.0}});
		add({{i, i + 2.0}, {i + 1.0, i + 2.0}, {i + 1.0, i + 3.0}, {i, i + 3.0}});
	}
	PolygonMesh mesh;
	mesh.vertices.setZero(3, names.size());
	for (const auto& [p, v] : names)
		mesh.vertices.col(v).head<2>() << p.first, p.second;
	mesh.normals = Eigen::Vector3d::UnitZ().replicate(1, mesh.vertexCount());
	mesh.faces   = NeighborLists::fromRows(faces);
	return mesh;
}

std::vector<char> rimMarks(const PolygonMesh& mesh, double gap)
{
	std::vector<char> marks(mesh.vertexCount(), 0);
	for (Index v = 0; v < mesh.vertexCount(); ++v)
		marks[v] = std::abs(mesh.vertices(1, v) - mesh.vertices(0, v) - 1.0 + gap) < 1e-9;
	return marks;
}

TEST(QuadCleanup, RimTrianglesVanishAndPentagonsAreCutThroughTheRim)
{
	for (const double gap : {0.02, 0.1, 0.4}) {
		const PolygonMesh  before    = diagonalRim(8, gap);
		std::vector<char>  onFeature = rimMarks(before, gap);
		const PolygonMesh  after     = cleanUpQuads(before, onFeature);
		const MeshTopology a = topologyOf(before), b = topologyOf(after);
		EXPECT_EQ(a.faces - a.quads, 16) << gap;
		EXPECT_LE(b.faces - b.quads, 2) << gap; // at the ends of the row
		EXPECT_EQ(b.eulerCharacteristic, 1);
		EXPECT_EQ(b.boundaryLoops, 1);
		EXPECT_EQ(b.nonmanifoldEdges, 0);
		ASSERT_EQ(static_cast<Index>(onFeature.size()), after.vertexCount());
		EXPECT_EQ(onFeature, rimMarks(after, gap)) << "vertices left the rim";
	}
}

TEST(RimCleanup, OnlyShortRimEdgesOfTrianglesGo)
{
	for (const double gap : {0.1, 0.4}) {
		const PolygonMesh before    = diagonalRim(8, gap);
		std::vector<char> onFeature = rimMarks(before, gap);
		const PolygonMesh after     = mergeRimTriangles(before, onFeature, 0.25);
		// The first triangle is a corner of the mesh.
		EXPECT_EQ(before.faceCount() - after.faceCount(), gap < 0.2 ? 7 : 0);
		EXPECT_EQ(before.vertexCount() - after.vertexCount(), gap < 0.2 ? 7 : 0);
	}
}

} // namespace
} // namespace curvature_lines
