// Merges and turns of quads: what they keep, and that they can be taken back.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "quad_edits.h"

#include <cstddef>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygon_meshes.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

std::vector<QuadEdits::Edit> editsOf(const QuadEdits& mesh, Index face)
{
	std::vector<QuadEdits::Edit> edits = mesh.mergesOf(face), turns = mesh.turnsOf(face);
	edits.insert(edits.end(), turns.begin(), turns.end());
	return edits;
}

PolygonMesh with(const PolygonMesh& mesh, const std::vector<std::vector<Index>>& loops)
{
	PolygonMesh       changed = mesh;
	std::vector<char> none(mesh.vertexCount(), 0);
	replaceFaces(loops, none, changed);
	return changed;
}

TEST(QuadEdits, EveryEditKeepsTheSurfaceAndCanBeTakenBack)
{
	for (const bool torus : {true, false}) {
		PolygonMesh mesh =
			torus ? test::torusOfQuads(12, 8) : test::quadsOn(test::triangulatedSphere(1).mesh);
		const PolygonMesh       before = mesh;
		const std::vector<char> none(mesh.vertexCount(), 0);
		QuadEdits               edits(none, mesh);
		const auto              loops  = edits.loops();
		int                     merges = 0, turns = 0;
		for (Index f = 0; f < mesh.faceCount(); ++f)
			for (const QuadEdits::Edit& edit : editsOf(edits, f)) {
				QuadEdits::Undo undo;
				if (edits.apply(edit, undo)) {
					const MeshTopology topology = topologyOf(with(mesh, edits.loops()));
					const bool         merged   = std::holds_alternative<QuadEdits::Merge>(edit);
					++(merged ? merges : turns);
					EXPECT_EQ(topology.eulerCharacteristic, torus ? 0 : 2);
					EXPECT_EQ(topology.quads, topology.faces);
					EXPECT_EQ(
						topology.nonmanifoldEdges + topology.nonmanifoldVertices +
							topology.boundaryEdges,
						0);
					if (!merged)
						EXPECT_EQ(topology.vertices, before.vertexCount());
					else
						EXPECT_LT(topology.vertices, before.vertexCount());
				}
				edits.restore(undo);
				ASSERT_EQ(edits.loops(), loops);
				ASSERT_EQ(mesh.vertices, before.vertices);
			}
		EXPECT_GT(merges, 100);
		EXPECT_GT(turns, 100);
	}
}

// Three turns one way are half a turn of the six corners: the edge is where it was.
TEST(QuadEdits, ThreeTurnsBringTheEdgeBack)
{
	PolygonMesh             mesh = test::torusOfQuads(20, 10);
	const std::vector<char> none(mesh.vertexCount(), 0);
	int                     tried = 0;
	for (Index f = 0; f < mesh.faceCount(); f += 7) {
		QuadEdits                edits(none, mesh);
		const std::vector<Index> loop  = edits.loops()[f];
		const auto               first = edits.turnsOf(f);
		ASSERT_EQ(first.size(), 8U);
		QuadEdits::Undo undo;
		if (!edits.apply(first[0], undo))
			continue;
		// The turned edge is the one from the last corner of this face to its first.
		bool allowed = true;
		for (int k = 0; k < 2 && allowed; ++k) {
			QuadEdits::Undo more;
			allowed = edits.apply(QuadEdits::Turn{f, 3, true}, more);
		}
		if (allowed) {
			++tried;
			const std::vector<Index>& now = edits.loops()[f];
			const Index               a = loop[0], b = loop[1];
			bool                      found = false;
			for (std::size_t k = 0; k < 4; ++k)
				found = found || (now[k] == a && now[(k + 1) % 4] == b) ||
				        (now[k] == b && now[(k + 1) % 4] == a);
			EXPECT_TRUE(found);
		}
	}
	EXPECT_GT(tried, 3);
}

TEST(QuadEdits, VerticesAndEdgesOnFeaturesAndRimsStay)
{
	PolygonMesh       mesh = test::quadsOn(test::triangulatedPlane(6, 0.2).mesh);
	std::vector<char> onFeature(mesh.vertexCount(), 0);
	for (Index v = 0; v < mesh.vertexCount(); v += 2)
		onFeature[v] = 1;
	const Eigen::Matrix3Xd before = mesh.vertices;
	const auto             rim    = test::rimSides(mesh);
	QuadEdits              edits(onFeature, mesh);
	for (Index f = 0; f < mesh.faceCount(); ++f)
		for (const QuadEdits::Edit& edit : editsOf(edits, f)) {
			QuadEdits::Undo undo;
			if (edits.apply(edit, undo)) {
				PolygonMesh changed = mesh;
				changed.faces       = NeighborLists::fromRows(edits.loops());
				EXPECT_EQ(test::rimSides(changed), rim);
				for (Index v = 0; v < mesh.vertexCount(); ++v)
					if (onFeature[v]) {
						EXPECT_EQ(mesh.vertices.col(v), before.col(v));
						EXPECT_FALSE(edits.facesAround({v}).empty());
					}
			}
			edits.restore(undo);
		}
}

TEST(QuadEdits, OtherFacesThanQuadsHaveNone)
{
	PolygonMesh             mesh = test::polygonsOf(test::triangulatedSphere(1).mesh);
	const std::vector<char> none(mesh.vertexCount(), 0);
	const QuadEdits         edits(none, mesh);
	for (Index f = 0; f < mesh.faceCount(); ++f)
		EXPECT_TRUE(editsOf(edits, f).empty());
}

} // namespace
} // namespace curvature_lines
