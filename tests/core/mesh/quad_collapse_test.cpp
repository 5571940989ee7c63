// Quads with folds: what goes, what stays, and that the surface is the same kind of surface afterwards.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "quad_collapse.h"

#include <cstddef>
#include <cstdint>
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

using Eigen::Vector3d;
using test::fold;
using test::quadsOn;
using test::unsoundOf;

TEST(QuadCollapse, FoldsBecomeFewerAndTheSurfaceStays)
{
	samples::Random random(3, 0);
	for (const bool torus : {true, false}) {
		PolygonMesh mesh = quadsOn(
			torus ? test::triangulatedTorus(48, 16).mesh : test::triangulatedSphere(3).mesh);
		fold(0.05, 1.3, random, mesh);
		const Index       before = unsoundOf(mesh), faces = mesh.faceCount();
		std::vector<char> onFeature(mesh.vertexCount(), 0);
		const Index       gone     = collapseUnsoundQuads(onFeature, mesh);
		const auto        topology = topologyOf(mesh);
		SCOPED_TRACE(torus);
		ASSERT_GT(before, 30);
		EXPECT_GT(gone, 10);
		EXPECT_EQ(mesh.faceCount(), faces - gone);
		EXPECT_EQ(Index(onFeature.size()), mesh.vertexCount());
		EXPECT_LT(unsoundOf(mesh), before / 2);
		EXPECT_EQ(topology.eulerCharacteristic, torus ? 0 : 2);
		EXPECT_EQ(topology.quads, topology.faces);
		EXPECT_EQ(topology.vertices, mesh.vertexCount());
		EXPECT_EQ(
			topology.nonmanifoldEdges + topology.nonmanifoldVertices + topology.boundaryEdges, 0);
	}
}

// As in a mesh that has other faces than quads: those may become one with a quad, and are no quads then.
TEST(QuadCollapse, OtherFacesAroundAreNoHarm)
{
	samples::Random random(8, 0);
	Index           all = 0;
	for (std::uint64_t seed = 0; seed < 10; ++seed) {
		PolygonMesh mesh = test::randomPolygons(test::triangulatedSphere(3).mesh, 5, 0.6, seed);
		fold(0.1, 0.8, random, mesh);
		const Index       before = unsoundOf(mesh);
		std::vector<char> onFeature(mesh.vertexCount(), 0);
		all += collapseUnsoundQuads(onFeature, mesh);
		const MeshTopology topology = topologyOf(mesh);
		EXPECT_LE(unsoundOf(mesh), before);
		EXPECT_EQ(topology.eulerCharacteristic, 2);
		EXPECT_EQ(
			topology.nonmanifoldEdges + topology.nonmanifoldVertices + topology.boundaryEdges, 0);
	}
	EXPECT_GT(all, 10);
}

TEST(QuadCollapse, SoundFacesStay)
{
	PolygonMesh       mesh   = quadsOn(test::triangulatedSphere(2).mesh);
	const PolygonMesh before = mesh;
	std::vector<char> onFeature(mesh.vertexCount(), 0);
	onFeature[3] = 1;
	EXPECT_EQ(collapseUnsoundQuads(onFeature, mesh), 0);
	EXPECT_EQ(mesh.vertices, before.vertices);
	EXPECT_EQ(mesh.faces.indices, before.faces.indices);
	EXPECT_EQ(onFeature[3], 1);
}

// Vertices on features and rims are where they were, and there are as many.
TEST(QuadCollapse, FeaturesAndRimsStay)
{
	samples::Random random(4, 0);
	PolygonMesh     mesh = quadsOn(test::triangulatedPlane(16, 0.2).mesh);
	fold(0.08, 1.2, random, mesh);
	std::vector<char>     onFeature(mesh.vertexCount(), 0);
	std::vector<Vector3d> held;
	for (Index v = 0; v < mesh.vertexCount(); v += 5) {
		onFeature[v] = 1;
		held.emplace_back(mesh.vertices.col(v));
	}
	const MeshTopology before = topologyOf(mesh);
	const Index        folds  = unsoundOf(mesh);
	EXPECT_GT(collapseUnsoundQuads(onFeature, mesh), 0);
	const MeshTopology after = topologyOf(mesh);
	EXPECT_LT(unsoundOf(mesh), folds);
	EXPECT_EQ(after.boundaryEdges, before.boundaryEdges);
	EXPECT_EQ(after.eulerCharacteristic, 1);
	EXPECT_EQ(after.nonmanifoldEdges + after.nonmanifoldVertices, 0);
	std::size_t found = 0;
	for (Index v = 0; v < mesh.vertexCount(); ++v)
		if (onFeature[v]) {
			ASSERT_LT(found, held.size());
			EXPECT_EQ(mesh.vertices.col(v), held[found++]);
		}
	EXPECT_EQ(found, held.size());
}

} // namespace
} // namespace curvature_lines
