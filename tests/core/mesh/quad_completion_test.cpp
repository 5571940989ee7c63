// Odd faces joined in pairs: nothing but quads is left, and the surface stays what it is.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "quad_completion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "linked_faces.h"
#include "mesh_quality.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygon_meshes.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines::test {
namespace {

using Eigen::Vector3d;

std::vector<char> unmarked(const PolygonMesh& mesh)
{
	return std::vector<char>(mesh.vertexCount(), 0);
}

// Completed and checked.
QuadCompletion completed(const PolygonMesh& mesh)
{
	std::vector<char>       onFeature = unmarked(mesh);
	const std::vector<char> before    = onFeature;
	QuadCompletion          result    = completeQuads(mesh, onFeature);
	expectQuadsOf(mesh, before, result.mesh, onFeature);
	EXPECT_EQ(result.left, 0);
	return result;
}

// Unit squares of the plane z = 0, some of them cut in two triangles.
PolygonMesh floorWith(Index cells, const std::vector<Index>& cut)
{
	std::vector<Vector3d>   vertices;
	std::vector<VertexLoop> loops;
	for (Index j = 0; j <= cells; ++j)
		for (Index i = 0; i <= cells; ++i)
			vertices.emplace_back(i, j, 0.0);
	for (Index q = 0; q < cells * cells; ++q) {
		const Index a = q + q / cells, b = a + 1, c = b + cells + 1, d = a + cells + 1;
		if (std::count(cut.begin(), cut.end(), q) == 0) {
			loops.push_back({a, b, c, d});
			continue;
		}
		loops.push_back({a, b, c});
		loops.push_back({a, c, d});
	}
	return flatPolygons(vertices, loops);
}

double leastJacobian(const PolygonMesh& mesh)
{
	double least = 1.0;
	for (Index f = 0; f < mesh.faceCount(); ++f)
		least = std::min(least, scaledJacobian(mesh, f));
	return least;
}

TEST(QuadCompletion, NothingToDo)
{
	EXPECT_EQ(completed(polygonMesh({}, {}, {})).mesh.faceCount(), 0);
	const PolygonMesh    floor  = floorWith(4, {});
	const QuadCompletion result = completed(floor);
	EXPECT_EQ(result.paths + result.rimPaths, 0);
	EXPECT_EQ(result.mesh.faces.indices, floor.faces.indices);
}

TEST(QuadCompletion, TwoTrianglesWithACommonEdgeBecomeOneQuad)
{
	const PolygonMesh    floor  = floorWith(6, {14, 21});
	const QuadCompletion result = completed(floor);
	EXPECT_EQ(result.paths, 2);
	EXPECT_EQ(result.rimPaths, 0);
	EXPECT_EQ(result.mesh.faceCount(), 36);
	EXPECT_EQ(result.mesh.vertexCount(), floor.vertexCount());
	EXPECT_DOUBLE_EQ(leastJacobian(result.mesh), 1.0);
}

// Four corners of three edges each: without an edge its ends would have two.
TEST(QuadCompletion, NoVertexOfTwoEdges)
{
	const PolygonMesh mesh = polygonMesh(
		{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
		{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
		{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}});
	const QuadCompletion result = completed(mesh);
	EXPECT_EQ(result.paths, 2);
	EXPECT_NEAR(volumeUnder(result.mesh) / volumeUnder(mesh), 1.0, 1e-12);
}

// Two pentagons of a coarse torus, with the common edge 0 3 and the common vertex 7 opposite it on both sides.
TEST(QuadCompletion, NoSecondEdgeBetweenTwoVertices)
{
	PolygonMesh mesh = polygonsOf(triangulatedTorus(4, 3).mesh);
	mesh.faces       = NeighborLists::fromRows(
        {{5, 4, 0, 1},
	           {5, 1, 2, 6},
	           {7, 2, 3, 0, 4},
	           {10, 9, 5, 6},
	           {10, 6, 2, 7, 11},
	           {8, 7, 4, 5},
	           {8, 5, 9, 1, 0},
	           {10, 11, 3},
	           {10, 3, 2, 1, 9},
	           {8, 0, 3, 11, 7}});
	completed(mesh);
}

// An edge that is a crease stays, in two halves.
TEST(QuadCompletion, CreasesStay)
{
	const PolygonMesh floor = floorWith(3, {4});
	const VertexPair  crease(5, 10);
	std::vector<char> onFeature = unmarked(floor);
	onFeature[5] = onFeature[10]   = 1;
	const std::vector<char> before = onFeature;
	const QuadCompletion    result = completeQuads(floor, onFeature, {crease});
	expectQuadsOf(floor, before, result.mesh, onFeature);
	if (result.featureEdges == std::vector<VertexPair>{crease})
		return; // both triangles went elsewhere
	ASSERT_EQ(result.featureEdges.size(), 2U);
	const Index middle = result.featureEdges[0].second;
	EXPECT_EQ(result.featureEdges[0], VertexPair(5, middle));
	EXPECT_EQ(result.featureEdges[1], VertexPair(10, middle));
	EXPECT_TRUE(onFeature[middle]);
	EXPECT_EQ(std::count(onFeature.begin(), onFeature.end(), 1), 3);
}

// Middles of edges are marked along features and rims, not from one feature to another.
TEST(QuadCompletion, MarksGrowAlongFeaturesAndRimsOnly)
{
	const PolygonMesh row       = together(floorWith(1, {}), floorWith(1, {}));
	PolygonMesh       mesh      = row;
	std::vector<char> onFeature = unmarked(mesh);
	// two triangles with three squares between them, on a strip all of whose vertices are marked
	mesh = polygonMesh(
		{{0, .5, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, 0}, {2, 1, 0}, {3, 0, 0}, {3, 1, 0}, {4, .5, 0}},
		std::vector<Vector3d>(8, Vector3d::UnitZ()),
		{{0, 1, 2}, {1, 3, 4, 2}, {3, 5, 6, 4}, {5, 7, 6}});
	for (const bool featureAcross : {false, true}) {
		onFeature = std::vector<char>(8, 1);
		const std::vector<VertexPair> edges =
			featureAcross ? std::vector<VertexPair>{{3, 4}} : std::vector<VertexPair>{};
		const std::vector<char> before = onFeature;
		const QuadCompletion    result = completeQuads(mesh, onFeature, edges);
		expectQuadsOf(mesh, before, result.mesh, onFeature);
		ASSERT_EQ(result.paths, 1);
		EXPECT_EQ(result.mesh.vertexCount(), 11);
		EXPECT_EQ(std::count(onFeature.begin(), onFeature.end(), 1), featureAcross ? 9 : 8);
		EXPECT_EQ(result.featureEdges.size(), featureAcross ? 2U : 0U);
	}
	// at the rim
	onFeature               = std::vector<char>(5, 1);
	const PolygonMesh house = polygonMesh(
		{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {.5, 1, 0}, {0, 1, 0}},
		std::vector<Vector3d>(5, Vector3d::UnitZ()),
		{{0, 1, 2, 3, 4}});
	const QuadCompletion result = completeQuads(house, onFeature, {});
	EXPECT_EQ(result.rimPaths, 1);
	EXPECT_EQ(onFeature, std::vector<char>(6, 1));
	EXPECT_NEAR(leastJacobian(result.mesh), 1.0, 1e-12) << "not opposite the flat corner";
}

TEST(QuadCompletion, BallsOfPentagonsAndHexagons)
{
	for (int levels = 0; levels <= 2; ++levels) {
		const PolygonMesh    ball   = dualOf(triangulatedSphere(levels).mesh);
		const QuadCompletion result = completed(ball);
		EXPECT_EQ(result.paths, 6) << "twelve pentagons";
		EXPECT_EQ(result.rimPaths, 0);
		EXPECT_EQ(foldedFaces(result.mesh), 0);
		EXPECT_GT(leastJacobian(result.mesh), 0.0);
		EXPECT_NEAR(volumeUnder(result.mesh) / volumeUnder(ball), 1.0, 0.05);
	}
}

TEST(QuadCompletion, TrianglesOnly)
{
	for (const TriangleMesh& mesh :
	     {triangulatedSphere(2).mesh,
	      triangulatedTorus(20, 12).mesh,
	      triangulatedPlane(9, 0.3).mesh,
	      triangulatedCylinder(13, 9).mesh}) {
		const PolygonMesh    polygons = polygonsOf(mesh);
		const QuadCompletion result   = completed(polygons);
		EXPECT_EQ(foldedFaces(result.mesh), 0);
		EXPECT_EQ(2 * result.paths + result.rimPaths, mesh.triangleCount());
	}
}

// A triangle in rings of three quads; closed meshes have no single odd face.
TEST(QuadCompletion, ASingleOddFaceEndsAtARim)
{
	std::vector<Vector3d>   vertices;
	std::vector<VertexLoop> loops = {{0, 1, 2}};
	const Index             rings = 4;
	for (Index ring = 0; ring <= rings; ++ring)
		for (Index k = 0; k < 3; ++k) {
			const double angle = 2.0 * EIGEN_PI * k / 3.0;
			vertices.push_back((1.0 + ring) * Vector3d(std::cos(angle), std::sin(angle), 0.0));
			const Index v = 3 * ring + k, next = 3 * ring + (k + 1) % 3;
			if (ring < rings)
				loops.push_back({v, v + 3, next + 3, next});
		}
	const PolygonMesh    mesh   = flatPolygons(vertices, loops);
	const QuadCompletion result = completed(mesh);
	EXPECT_EQ(result.paths, 0);
	EXPECT_EQ(result.rimPaths, 1);
	EXPECT_EQ(result.mesh.faceCount(), 1 + 3 * rings + rings);
}

struct Surface {
	const char*  name;
	TriangleMesh mesh;
};
std::vector<Surface> surfaces()
{
	return {
		{"sphere", triangulatedSphere(3).mesh},
		{"torus", triangulatedTorus(36, 20).mesh},
		{"plane", triangulatedPlane(20, 0.3).mesh},
		{"cylinder", triangulatedCylinder(24, 16).mesh}};
}

TEST(QuadCompletion, RandomPolygons)
{
	for (const Surface& surface : surfaces())
		for (std::uint64_t seed = 1; seed <= 12; ++seed)
			for (const std::size_t largest : {4, 5, 9}) {
				SCOPED_TRACE(std::string(surface.name) + " " + std::to_string(seed));
				const double         share  = 0.2 + 0.8 * double(seed % 4) / 3.0;
				const PolygonMesh    mesh   = randomPolygons(surface.mesh, largest, share, seed);
				const QuadCompletion result = completed(mesh);
				EXPECT_TRUE(result.rimPaths == 0 || topologyOf(mesh).boundaryLoops > 0);
				EXPECT_NEAR(
					volumeUnder(result.mesh),
					volumeUnder(mesh),
					0.02 * std::abs(volumeUnder(mesh)) + 1e-12);
				EXPECT_LE(foldedFaces(result.mesh), foldedFaces(mesh) + mesh.faceCount() / 100);
			}
}

TEST(QuadCompletion, ComponentsByThemselves)
{
	const PolygonMesh a = randomPolygons(triangulatedSphere(2).mesh, 6, 0.7, 5);
	PolygonMesh       b = randomPolygons(triangulatedCylinder(12, 7).mesh, 6, 0.7, 6);
	b.vertices.row(0).array() += 3.0;
	const QuadCompletion both = completed(together(a, b)), one = completed(a), other = completed(b);
	EXPECT_EQ(both.paths, one.paths + other.paths);
	EXPECT_EQ(both.rimPaths, one.rimPaths + other.rimPaths);
	EXPECT_EQ(both.mesh.faceCount(), one.mesh.faceCount() + other.mesh.faceCount());
}

// In general position no two paths are equally long.
TEST(QuadCompletion, OrderOfFacesDoesNotMatter)
{
	const auto places = [](const PolygonMesh& quads) {
		std::vector<std::array<std::int64_t, 3>> rounded;
		for (Index v = 0; v < quads.vertexCount(); ++v)
			rounded.push_back(
				{std::llround(1e9 * quads.vertices(0, v)),
			     std::llround(1e9 * quads.vertices(1, v)),
			     std::llround(1e9 * quads.vertices(2, v))});
		std::sort(rounded.begin(), rounded.end());
		return rounded;
	};
	samples::Random random(3, 0);
	for (std::uint64_t seed = 1; seed <= 4; ++seed) {
		TriangleMesh torus = triangulatedTorus(40, 24).mesh;
		for (Index v = 0; v < torus.vertexCount(); ++v)
			for (int k = 0; k < 3; ++k)
				torus.vertices(k, v) += random.uniform(-0.02, 0.02);
		const PolygonMesh       mesh  = randomPolygons(torus, 5, 0.8, seed);
		std::vector<VertexLoop> loops = faceLoopsOf(mesh);
		std::reverse(loops.begin(), loops.end());
		for (std::size_t k = 0; k < loops.size(); ++k)
			std::rotate(loops[k].begin(), loops[k].begin() + std::ptrdiff_t(k % 3), loops[k].end());
		PolygonMesh shuffled = mesh;
		shuffled.faces       = NeighborLists::fromRows(loops);
		EXPECT_TRUE(places(completed(mesh).mesh) == places(completed(shuffled).mesh)) << seed;
	}
}

// Edges of three faces are not crossed; the odd faces that nothing else leads to stay.
TEST(QuadCompletion, EdgesOfThreeFacesAreLeftAlone)
{
	const PolygonMesh mesh = polygonMesh(
		{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}},
		std::vector<Vector3d>(5, Vector3d::UnitZ()),
		{{0, 1, 2}, {0, 1, 3}, {0, 1, 4}});
	std::vector<char>    onFeature(5, 0);
	const QuadCompletion result = completeQuads(mesh, onFeature);
	EXPECT_EQ(result.left, 0); // by the rims
	EXPECT_EQ(result.rimPaths, 3);
	EXPECT_EQ(topologyOf(result.mesh).nonmanifoldEdges, 1);
}

} // namespace
} // namespace curvature_lines::test
