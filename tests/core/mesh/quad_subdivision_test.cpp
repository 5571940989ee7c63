// Faces cut around their centres: as many quads as there were corners.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "quad_subdivision.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "linked_faces.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygon_meshes.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines::test {
namespace {

QuadSubdivision checked(const PolygonMesh& mesh)
{
	std::vector<char>       onFeature(mesh.vertexCount(), 0);
	const std::vector<char> before = onFeature;
	QuadSubdivision         result = subdivided(mesh, onFeature);
	expectQuadsOf(mesh, before, result.mesh, onFeature);
	EXPECT_EQ(result.mesh.faceCount(), static_cast<Index>(mesh.faces.indices.size()));
	const MeshTopology topology = topologyOf(mesh);
	EXPECT_EQ(result.mesh.vertexCount(), topology.vertices + topology.edges + topology.faces);
	return result;
}

TEST(QuadSubdivision, NothingOfNothing)
{
	EXPECT_EQ(checked(polygonMesh({}, {}, {})).mesh.vertexCount(), 0);
}

TEST(QuadSubdivision, AnyPolygons)
{
	for (const TriangleMesh& mesh :
	     {triangulatedSphere(2).mesh,
	      triangulatedTorus(20, 12).mesh,
	      triangulatedPlane(9, 0.3).mesh,
	      triangulatedCylinder(13, 9).mesh})
		for (const std::size_t largest : {3, 4, 9}) {
			const PolygonMesh before = randomPolygons(mesh, largest, 0.7, 2);
			const double      volume = volumeUnder(before);
			EXPECT_NEAR(volumeUnder(checked(before).mesh), volume, 0.02 * std::abs(volume) + 1e-12);
		}
	checked(dualOf(triangulatedSphere(1).mesh));
}

TEST(QuadSubdivision, MarksGrowAlongFeaturesAndRimsOnly)
{
	const PolygonMesh mesh = polygonMesh(
		{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}, {3, 1, 0}},
		std::vector<Eigen::Vector3d>(8, Eigen::Vector3d::UnitZ()),
		{{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}});
	std::vector<char>     onFeature(8, 1);
	const QuadSubdivision result = subdivided(mesh, onFeature, {{1, 5}});
	// eight vertices, eight edges of the rim, one crease of two inner edges, no centre
	EXPECT_EQ(std::count(onFeature.begin(), onFeature.end(), 1), 8 + 8 + 1);
	EXPECT_EQ(result.featureEdges.size(), 2U);
	for (const auto& [a, b] : result.featureEdges)
		EXPECT_TRUE(onFeature[a] && onFeature[b]);
	EXPECT_EQ(edgesBetween(mesh, std::vector<char>(8, 1)).size(), 10U);
}

} // namespace
} // namespace curvature_lines::test
