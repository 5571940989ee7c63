// Arrangements on scaffolds of exact surfaces: certificates, repair, and the mesh that comes out.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_arrangement.h"

#include <algorithm>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "level_sets.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "scaffold.h"
#include "surface_graph.h"
#include "triangle_mesh.h"

namespace curvature_lines::test {
namespace {

TriangleMesh scaffoldOf(const std::string& surface, int points = 1500)
{
	samples::SampleRequest request;
	request.surface                   = surface;
	request.points                    = points;
	request.seed                      = 5;
	const samples::SampleCloud sample = samples::generate(request);
	return buildScaffold(PointCloud{sample.positions, sample.normals}).mesh;
}

SurfaceFeatures noFeatures(const TriangleMesh& mesh)
{
	return {std::vector<char>(mesh.edgeCount(), 0), std::vector<char>(mesh.vertexCount(), 0)};
}

TEST(SurfaceArrangement, ParallelsAndMeridiansOfATorusAreAQuadMesh)
{
	const TriangleMesh       mesh   = scaffoldOf("torus");
	const auto               aslant = [](const Eigen::Vector3d& p) { return 7.3 * p.z() + 0.1; };
	const auto               across = [](const Eigen::Vector3d& p) { return 3.3 * p.x() + 0.3; };
	const SurfaceArrangement result = arrangeOnSurface(
		mesh, mesh.vertexNormals(), noFeatures(mesh), levelSets(mesh, {aslant, across}));
	const MeshTopology topology = topologyOf(result.mesh);
	EXPECT_EQ(topology.eulerCharacteristic, 0);
	EXPECT_EQ(topology.boundaryEdges, 0);
	EXPECT_EQ(topology.nonmanifoldEdges, 0);
	EXPECT_EQ(topology.nonmanifoldVertices, 0);
	EXPECT_EQ(topology.components, 1);
	EXPECT_GT(result.crossings, 20);
	EXPECT_EQ(result.lostComponents, 0);
}

// Curves that do not cut the surface into disks are seen and completed.
TEST(SurfaceArrangement, RepairsWhatIsNoDisk)
{
	for (const char* surface : {"sphere", "torus", "cylinder", "helicoid"}) {
		const TriangleMesh mesh = scaffoldOf(surface);
		for (int curves = 0; curves < 2; ++curves) {
			const auto slice = [&](const Eigen::Vector3d& p) {
				return curves * (2.1 * p.z() + 0.05) + 0.01;
			};
			const SurfaceArrangement result = arrangeOnSurface(
				mesh, mesh.vertexNormals(), noFeatures(mesh), levelSets(mesh, {slice}));
			const MeshTopology topology = topologyOf(result.mesh);
			const bool isDisk = surface == std::string("helicoid"); // its rim alone bounds it
			EXPECT_EQ(result.repairedComponents + result.lostComponents, isDisk ? 0 : 1) << surface;
			if (result.lostComponents == 0) {
				EXPECT_EQ(topology.eulerCharacteristic, mesh.eulerCharacteristic()) << surface;
				EXPECT_EQ(topology.components, 1) << surface;
				EXPECT_EQ(topology.boundaryLoops, static_cast<Index>(mesh.rims().size()))
					<< surface;
			}
			else { // only a sphere may carry no edge at all
				EXPECT_EQ(std::string(surface), "sphere");
				EXPECT_EQ(topology.faces, 0);
			}
			EXPECT_EQ(topology.nonmanifoldEdges, 0) << surface;
			EXPECT_EQ(topology.nonmanifoldVertices, 0) << surface;
		}
	}
}

TEST(SurfaceArrangement, CornersOfRimsStay)
{
	const TriangleMesh mesh         = scaffoldOf("plane", 600);
	SurfaceFeatures    features     = noFeatures(mesh);
	const Index        corner       = mesh.rims()[0][3];
	features.corner[corner]         = 1;
	const auto               across = [](const Eigen::Vector3d& p) { return 4.1 * p.x() + 0.13; };
	const auto               along  = [](const Eigen::Vector3d& p) { return 4.1 * p.y() + 0.13; };
	const SurfaceArrangement result =
		arrangeOnSurface(mesh, mesh.vertexNormals(), features, levelSets(mesh, {across, along}));
	EXPECT_LT(
		(result.mesh.vertices.colwise() - mesh.vertices.col(corner)).colwise().norm().minCoeff(),
		1e-12);
	EXPECT_EQ(topologyOf(result.mesh).eulerCharacteristic, 1);
	EXPECT_EQ(
		std::count(result.onFeature.begin(), result.onFeature.end(), char(1)),
		topologyOf(result.mesh).boundaryEdges);
}

} // namespace
} // namespace curvature_lines::test
