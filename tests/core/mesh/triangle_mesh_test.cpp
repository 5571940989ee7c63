// Edges, rims, components and measures of triangulations against counting from scratch and closed forms; the manifold
// part of arbitrary sets of triangles.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "disjoint_sets.h"
#include "point_cloud.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;
using Side = std::pair<Index, Index>;

std::map<Side, std::vector<Index>> directedSides(const std::vector<Triangle>& triangles)
{
	std::map<Side, std::vector<Index>> sides;
	for (Index t = 0; t < static_cast<Index>(triangles.size()); ++t)
		for (int c = 0; c < 3; ++c)
			sides[{triangles[t][c], triangles[t][(c + 1) % 3]}].push_back(t);
	return sides;
}

struct Expected {
	const char*               name;
	test::TriangulatedSurface surface;
	int                       euler, rims;
};

std::vector<Expected> surfaces()
{
	return {
		{"plane", test::triangulatedPlane(7, 0.3), 1, 1},
		{"torus", test::triangulatedTorus(24, 12), 0, 0},
		{"cylinder", test::triangulatedCylinder(20, 9), 0, 2},
		{"sphere", test::triangulatedSphere(2), 2, 0}};
}

TEST(TriangleMesh, EdgesAreThoseOfTheTriangles)
{
	for (const auto& [name, surface, euler, rims] : surfaces()) {
		const TriangleMesh& mesh  = surface.mesh;
		const auto          sides = directedSides(mesh.triangles());
		std::set<Side>      pairs;
		for (const auto& [side, triangles] : sides) {
			ASSERT_EQ(triangles.size(), 1u) << name;
			pairs.insert(std::minmax(side.first, side.second));
		}
		ASSERT_EQ(mesh.edgeCount(), static_cast<Index>(pairs.size())) << name;
		Index e = 0;
		for (const Side& pair : pairs) { // sorted, as the edges are
			const TriangleMesh::Edge& edge = mesh.edges()[e];
			EXPECT_EQ(Side(edge.from, edge.to), pair);
			const auto leftOf = [&](Index a, Index b) {
				const auto at = sides.find({a, b});
				return at == sides.end() ? -1 : at->second[0];
			};
			EXPECT_EQ(edge.left, leftOf(edge.from, edge.to));
			EXPECT_EQ(edge.right, leftOf(edge.to, edge.from));
			EXPECT_EQ(edge.isRim(), edge.left < 0 || edge.right < 0);
			EXPECT_EQ(mesh.edgeBetween(edge.from, edge.to), e);
			EXPECT_EQ(mesh.edgeBetween(edge.to, edge.from), e);
			EXPECT_EQ(mesh.along(e), mesh.vertices.col(edge.to) - mesh.vertices.col(edge.from));
			++e;
		}
		for (Index t = 0; t < mesh.triangleCount(); ++t)
			for (int c = 0; c < 3; ++c) {
				const Index a = mesh.triangles()[t][c], b = mesh.triangles()[t][(c + 1) % 3];
				EXPECT_EQ(mesh.edgeOf(t, c), mesh.edgeBetween(a, b));
				EXPECT_EQ(mesh.isForward(t, c), a < b);
			}
		EXPECT_EQ(mesh.edgeBetween(0, 0), -1);
		EXPECT_EQ(mesh.edgeBetween(0, mesh.vertexCount() / 2), -1);
		EXPECT_EQ(mesh.eulerCharacteristic(), euler) << name;
	}
}

TEST(TriangleMesh, RimsHaveTheSurfaceOnTheirLeft)
{
	for (const auto& [name, surface, euler, rims] : surfaces()) {
		const TriangleMesh& mesh  = surface.mesh;
		const auto          loops = mesh.rims();
		EXPECT_EQ(static_cast<int>(loops.size()), rims) << name;
		const auto  sides    = directedSides(mesh.triangles());
		std::size_t vertices = 0, rimEdges = 0;
		for (const auto& loop : loops) {
			vertices += loop.size();
			for (std::size_t k = 0; k < loop.size(); ++k) {
				const Side side(loop[k], loop[(k + 1) % loop.size()]);
				EXPECT_EQ(sides.count(side), 1u); // the triangle on the left runs along
				EXPECT_EQ(sides.count({side.second, side.first}), 0u);
			}
		}
		for (const TriangleMesh::Edge& edge : mesh.edges())
			rimEdges += edge.isRim();
		EXPECT_EQ(vertices, rimEdges) << name;
	}
}

TEST(TriangleMesh, ComponentsAreNamedByTheirSmallestVertex)
{
	const auto            torus     = test::triangulatedTorus(12, 6).mesh;
	const auto            plane     = test::triangulatedPlane(3).mesh;
	const Index           first     = torus.vertexCount();
	std::vector<Triangle> triangles = torus.triangles();
	for (Triangle t : plane.triangles()) {
		for (Index& v : t)
			v += first;
		triangles.push_back(t);
	}
	Eigen::Matrix3Xd vertices(3, first + plane.vertexCount() + 1); // the last is not used
	vertices << torus.vertices, plane.vertices, Vector3d(9, 9, 9);
	const TriangleMesh       both(vertices, triangles);
	const std::vector<Index> component = both.components();
	for (Index v = 0; v < both.vertexCount(); ++v)
		EXPECT_EQ(component[v], v < first ? 0 : v + 1 < both.vertexCount() ? first : v);
	EXPECT_EQ(both.eulerCharacteristic(), 1); // 0 + 1: of used vertices
}

TEST(TriangleMesh, AreasAndNormalsOfKnownSurfaces)
{
	EXPECT_NEAR(test::triangulatedPlane(9, 0.3).mesh.vertexAreas().sum(), 1.0, 1e-12);
	const auto torus = test::triangulatedTorus(120, 60);
	EXPECT_NEAR(torus.mesh.vertexAreas().sum(), 4.0 * EIGEN_PI * EIGEN_PI * 0.4, 0.02);
	const auto sphere = test::triangulatedSphere(4);
	EXPECT_NEAR(sphere.mesh.vertexAreas().sum(), 4.0 * EIGEN_PI, 0.02);
	for (const auto* surface : {&torus, &sphere}) {
		const Eigen::Matrix3Xd normals = surface->mesh.vertexNormals();
		for (Index v = 0; v < surface->size(); ++v) {
			EXPECT_NEAR(normals.col(v).norm(), 1.0, 1e-12);
			EXPECT_GT(normals.col(v).dot(surface->truth.normals.col(v)), std::cos(0.02));
		}
		double sum = 0.0;
		for (Index t = 0; t < surface->mesh.triangleCount(); ++t)
			sum += surface->mesh.areaVector(t).norm();
		EXPECT_NEAR(sum, surface->mesh.vertexAreas().sum(), 1e-9);
	}
}

TEST(TriangleMesh, CotangentWeightsAreHalfTheSumOfBothCotangents)
{
	for (const auto& [name, surface, euler, rims] : surfaces()) {
		const TriangleMesh&   mesh    = surface.mesh;
		const Eigen::VectorXd weights = mesh.cotangentWeights();
		Eigen::VectorXd       sums    = Eigen::VectorXd::Zero(mesh.edgeCount());
		for (const Triangle& t : mesh.triangles())
			for (int c = 0; c < 3; ++c) {
				const Vector3d a = mesh.vertices.col(t[c]) - mesh.vertices.col(t[(c + 2) % 3]),
							   b = mesh.vertices.col(t[(c + 1) % 3]) -
				                   mesh.vertices.col(t[(c + 2) % 3]);
				sums[mesh.edgeBetween(t[c], t[(c + 1) % 3])] += 0.5 * a.dot(b) / a.cross(b).norm();
			}
		EXPECT_LT((weights - sums.cwiseMax(0.05).cwiseMin(3.0)).cwiseAbs().maxCoeff(), 1e-9)
			<< name;
	}

	// Two equilateral triangles: twice half the cotangent of 60 degrees inside, once at the rim.
	Eigen::Matrix3Xd points(3, 4);
	points << 0, 1, 0.5, 1.5, 0, 0, std::sqrt(0.75), std::sqrt(0.75), 0, 0, 0, 0;
	const TriangleMesh pair(points, {{0, 1, 2}, {1, 3, 2}});
	const auto         w = pair.cotangentWeights();
	EXPECT_NEAR(w[pair.edgeBetween(1, 2)], 1.0 / std::sqrt(3.0), 1e-12);
	EXPECT_NEAR(w[pair.edgeBetween(0, 1)], 0.5 / std::sqrt(3.0), 1e-12);
}

TEST(TriangleMesh, EmptyMesh)
{
	const TriangleMesh mesh;
	EXPECT_EQ(mesh.vertexCount() + mesh.edgeCount() + mesh.triangleCount(), 0);
	EXPECT_EQ(mesh.eulerCharacteristic(), 0);
	EXPECT_TRUE(mesh.rims().empty());
	EXPECT_TRUE(mesh.components().empty());
}

TEST(ManifoldPart, RefusesThirdTrianglesAndSplitsVertices)
{
	std::vector<Index>          copies;
	const std::vector<Triangle> book = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
	EXPECT_EQ(manifoldPart(book, 5, copies).size(), 2u);
	EXPECT_TRUE(copies.empty());

	const std::vector<Triangle> bowTie = {{0, 1, 2}, {0, 3, 4}};
	const auto                  split  = manifoldPart(bowTie, 5, copies);
	ASSERT_EQ(copies, std::vector<Index>{0});
	EXPECT_EQ(split[1][0], 5);
	EXPECT_EQ(TriangleMesh(Eigen::Matrix3Xd::Random(3, 6), split).rims().size(), 2u);
}

TEST(ManifoldPart, OfAManifoldIsAllOfIt)
{
	for (const auto& [name, surface, euler, rims] : surfaces()) {
		std::vector<Index> copies;
		EXPECT_EQ(
			manifoldPart(surface.mesh.triangles(), surface.size(), copies),
			surface.mesh.triangles())
			<< name;
		EXPECT_TRUE(copies.empty());
	}
}

// Whatever triangles are given: every directed side belongs to one, the triangles around every vertex hang together by
// sides, and none is left out that the earlier ones have room for.
TEST(ManifoldPart, OfRandomTrianglesIsManifold)
{
	samples::Random random(3, 0);
	for (int trial = 0; trial < 200; ++trial) {
		const Index           vertices = 4 + static_cast<Index>(random.index(8));
		std::vector<Triangle> triangles;
		for (int k = 0; k < 25; ++k) {
			std::vector<Index> corners(vertices);
			std::iota(corners.begin(), corners.end(), 0);
			for (int c = 0; c < 3; ++c)
				std::swap(corners[c], corners[c + random.index(vertices - c)]);
			triangles.push_back({corners[0], corners[1], corners[2]});
		}
		std::vector<Index> copies;
		const auto         kept = manifoldPart(triangles, vertices, copies);
		for (const auto& [side, users] : directedSides(kept))
			EXPECT_EQ(users.size(), 1u);

		const auto     original = [&](Index v) { return v < vertices ? v : copies[v - vertices]; };
		std::set<Side> taken; // greedily, in order
		std::size_t    expected = 0;
		for (const Triangle& t : triangles) {
			const bool fits = !taken.count({t[0], t[1]}) && !taken.count({t[1], t[2]}) &&
			                  !taken.count({t[2], t[0]});
			if (!fits)
				continue;
			for (int c = 0; c < 3; ++c)
				taken.insert({t[c], t[(c + 1) % 3]});
			ASSERT_LT(expected, kept.size());
			for (int c = 0; c < 3; ++c)
				EXPECT_EQ(original(kept[expected][c]), t[c]);
			++expected;
		}
		EXPECT_EQ(kept.size(), expected);

		// One fan a vertex.
		std::map<Index, std::vector<Index>> around;
		for (Index t = 0; t < static_cast<Index>(kept.size()); ++t)
			for (const Index v : kept[t])
				around[v].push_back(t);
		for (const auto& [v, fan] : around) {
			DisjointSets sets(static_cast<Index>(fan.size()));
			for (std::size_t a = 0; a < fan.size(); ++a)
				for (std::size_t b = a + 1; b < fan.size(); ++b) {
					const auto& s = kept[fan[a]];
					const auto& t = kept[fan[b]];
					for (int c = 0; c < 3; ++c)
						for (int d = 0; d < 3; ++d)
							if (s[c] == t[(d + 1) % 3] && s[(c + 1) % 3] == t[d] &&
							    (s[c] == v || t[d] == v))
								sets.join(static_cast<Index>(a), static_cast<Index>(b));
				}
			for (std::size_t a = 0; a < fan.size(); ++a)
				EXPECT_EQ(sets.find(static_cast<Index>(a)), 0);
		}
	}
}

} // namespace
} // namespace curvature_lines
