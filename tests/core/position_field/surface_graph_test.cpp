// Graphs of level sets on planes and spheres: how many vertices and edges, where curves cross, and that half-edges are in
// the order in which they lie around their vertices.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_graph.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "closed_surfaces.h"
#include "cross_field.h"
#include "gauged_fields.h"
#include "half_edge_graph.h"
#include "level_sets.h"
#include "point_cloud.h"
#include "position_field.h"
#include "singular_vertices.h"
#include "surface_curves.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines::test {
namespace {

using Eigen::Vector3d;

double across(const Vector3d& p)
{
	return 3.7 * p.x() + 0.13;
}
double along(const Vector3d& p)
{
	return 4.3 * p.y() - 0.21;
}
double aslant(const Vector3d& p)
{
	return 2.9 * (p.x() + 0.7 * p.z()) + 0.37;
}

double awayFromWhole(double value)
{
	return std::abs(value - std::round(value));
}

SurfaceFeatures noFeatures(const TriangleMesh& mesh)
{
	return {std::vector<char>(mesh.edgeCount(), 0), std::vector<char>(mesh.vertexCount(), 0)};
}

SurfaceGraph graphOf(
	const TriangleMesh&      mesh,
	const SurfaceFeatures&   features,
	const SurfaceCurves&     curves,
	const std::vector<char>& filled = {})
{
	return surfaceGraph(
		mesh,
		mesh.vertexNormals(),
		features,
		curves,
		mesh.components(),
		filled.empty() ? std::vector<char>(mesh.vertexCount(), 0) : filled);
}

Index pointsOn(const SurfaceCurves& curves)
{
	Index count = 0;
	for (const auto& points : curves.points)
		count += static_cast<Index>(points.size());
	return count;
}

// Where the other end of a straight half-edge lies.
Vector3d directionOf(const HalfEdgeGraph& graph, Index h)
{
	return graph.positions().col(graph.origin(HalfEdgeGraph::twin(h))) -
	       graph.positions().col(graph.origin(h));
}

// Turns from each half-edge around a vertex to the next, counter-clockwise, 0..2 pi: together one turn if they are in
// order.
double turnAround(const HalfEdgeGraph& graph, Index v)
{
	const auto& around = graph.around(v);
	double      sum    = 0.0;
	for (std::size_t k = 0; k < around.size(); ++k) {
		const Vector3d a    = directionOf(graph, around[k]);
		const Vector3d b    = directionOf(graph, around[(k + 1) % around.size()]);
		const double   turn = std::atan2(a.cross(b).dot(graph.normals().col(v)), a.dot(b));
		sum += turn > 0.0 ? turn : turn + 2.0 * EIGEN_PI;
	}
	return sum;
}

std::vector<Index> crossingsOf(const HalfEdgeGraph& graph)
{
	std::vector<Index> crossings;
	for (Index v = 0; v < graph.vertexCount(); ++v)
		if (graph.around(v).size() == 4)
			crossings.push_back(v);
	return crossings;
}

TEST(SurfaceGraph, CountsOfStraightLinesOnAPlane)
{
	const TriangleMesh  mesh = triangulatedPlane(9, 0.25).mesh; // the unit square around the origin
	const SurfaceCurves curves = levelSets(mesh, {across, along});
	const SurfaceGraph  drawn  = graphOf(mesh, noFeatures(mesh), curves);
	// across: -1 .. 1 without -1.72, 1.98; along: -2 .. 1 without -2.36, 1.94
	EXPECT_EQ(drawn.crossings, 3 * 4);
	Index rimEdges = 0, rimPoints = 0;
	for (Index e = 0; e < mesh.edgeCount(); ++e)
		if (mesh.edges()[e].isRim()) {
			++rimEdges;
			rimPoints += static_cast<Index>(curves.points[e].size());
		}
	ASSERT_EQ(rimEdges, 4 * 9);
	ASSERT_EQ(rimPoints, 2 * (3 + 4));
	EXPECT_EQ(drawn.graph.vertexCount(), pointsOn(curves) + drawn.crossings + rimEdges);
	// A crossing cuts two chords, an edge point on a rim the rim.
	EXPECT_EQ(
		drawn.graph.edgeCount(),
		static_cast<Index>(curves.chords.size()) + 2 * drawn.crossings + rimEdges + rimPoints);
	// The faces are the rectangles between the lines, and what lies outside.
	EXPECT_EQ(drawn.graph.faceLoops().size(), 4u * 5u + 1u);
	EXPECT_EQ(drawn.graph.eulerCharacteristic(), 2);
	EXPECT_EQ(
		std::count(drawn.isFilling.begin(), drawn.isFilling.end(), 0), drawn.graph.edgeCount());
}

TEST(SurfaceGraph, LinesCrossWhereTheFormulasSay)
{
	const SurfaceGraph drawn = [] {
		const TriangleMesh mesh = triangulatedPlane(7, 0.3).mesh;
		return graphOf(mesh, noFeatures(mesh), levelSets(mesh, {across, along}));
	}();
	const std::vector<Index> crossings = crossingsOf(drawn.graph);
	ASSERT_EQ(static_cast<Index>(crossings.size()), drawn.crossings);
	for (const Index v : crossings) {
		EXPECT_LT(awayFromWhole(across(drawn.graph.positions().col(v))), 1e-9);
		EXPECT_LT(awayFromWhole(along(drawn.graph.positions().col(v))), 1e-9);
		// A curve goes on straight: half-edges opposite each other are of the same one.
		const auto& around = drawn.graph.around(v);
		for (int k = 0; k < 2; ++k)
			EXPECT_NEAR(
				directionOf(drawn.graph, around[k])
					.normalized()
					.dot(directionOf(drawn.graph, around[k + 2]).normalized()),
				-1.0,
				1e-9);
	}
}

TEST(SurfaceGraph, HalfEdgesAreInTheOrderAroundTheirVertices)
{
	const TriangleMesh mesh     = triangulatedPlane(8, 0.3).mesh;
	SurfaceFeatures    features = noFeatures(mesh);
	for (Index e = 0; e < mesh.edgeCount(); e += 3) // whatever comes together at vertices
		features.edge[e] = 1;
	const SurfaceCurves curves = levelSets(mesh, {across, along, aslant});
	for (const char fill : {0, 1}) {
		const SurfaceGraph drawn =
			graphOf(mesh, features, curves, std::vector<char>(mesh.vertexCount(), fill));
		for (Index v = 0; v < drawn.graph.vertexCount(); ++v) {
			ASSERT_FALSE(drawn.graph.around(v).empty());
			for (const Index h : drawn.graph.around(v))
				ASSERT_EQ(drawn.graph.origin(h), v);
			EXPECT_NEAR(turnAround(drawn.graph, v), 2.0 * EIGEN_PI, 1e-9) << v;
		}
	}
}

// A plane of one family and a plane of the other meet in a line, which leaves a convex body at two points.
TEST(SurfaceGraph, CirclesOnASphereCrossTwice)
{
	const TriangleMesh  mesh   = triangulatedSphere(3).mesh;
	const auto          up     = [](const Vector3d& p) { return 2.6 * p.z() + 0.3; };
	const SurfaceCurves curves = levelSets(mesh, {across, up});
	const SurfaceGraph  drawn  = graphOf(mesh, noFeatures(mesh), curves);
	Index               pairs  = 0;
	for (int a = -4; a <= 4; ++a)
		for (int b = -4; b <= 4; ++b) {
			const double square = std::pow((a - 0.13) / 3.7, 2) + std::pow((b - 0.3) / 2.6, 2);
			ASSERT_FALSE(square > 0.98 && square < 1.0) << "too near to a tangent";
			pairs += square < 1.0;
		}
	ASSERT_GT(pairs, 20);
	EXPECT_EQ(drawn.crossings, 2 * pairs);
	for (const Index v : crossingsOf(drawn.graph)) {
		EXPECT_LT(awayFromWhole(across(drawn.graph.positions().col(v))), 1e-9);
		EXPECT_LT(awayFromWhole(up(drawn.graph.positions().col(v))), 1e-9);
		EXPECT_NEAR(drawn.graph.normals().col(v).norm(), 1.0, 1e-12);
		EXPECT_GT(
			drawn.graph.normals().col(v).dot(drawn.graph.positions().col(v).normalized()), 0.99);
	}
	// No rim, nothing filled: curves alone.
	EXPECT_EQ(drawn.graph.vertexCount(), pointsOn(curves) + drawn.crossings);
	EXPECT_EQ(
		drawn.graph.edgeCount(), static_cast<Index>(curves.chords.size()) + 2 * drawn.crossings);
}

// Two spheres in one mesh, of which one is filled.
TEST(SurfaceGraph, FillsTheComponentsItIsTold)
{
	const TriangleMesh    sphere = triangulatedSphere(1).mesh;
	const Index           n      = sphere.vertexCount();
	Eigen::Matrix3Xd      vertices(3, 2 * n);
	std::vector<Triangle> triangles = sphere.triangles();
	vertices << sphere.vertices, sphere.vertices.colwise() + Vector3d(5.0, 0.0, 0.0);
	for (const Triangle& t : sphere.triangles())
		triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
	const TriangleMesh mesh(vertices, triangles);
	std::vector<char>  filled(mesh.vertexCount(), 0);
	filled[n] = 1; // the name of the second
	ASSERT_EQ(mesh.components()[n + 5], n);

	const SurfaceGraph bare = graphOf(mesh, noFeatures(mesh), levelSets(mesh, {}), filled);
	EXPECT_EQ(bare.graph.vertexCount(), n);
	EXPECT_EQ(bare.graph.edgeCount(), sphere.edgeCount());
	EXPECT_EQ(static_cast<Index>(bare.graph.faceLoops().size()), sphere.triangleCount());
	EXPECT_EQ(std::count(bare.isFilling.begin(), bare.isFilling.end(), 1), sphere.edgeCount());

	const SurfaceCurves curves =
		levelSets(mesh, {[](const Vector3d& p) { return 0.9 * p.z() + 0.05; }});
	const SurfaceGraph drawn = graphOf(mesh, noFeatures(mesh), curves, filled);
	ASSERT_EQ(static_cast<Index>(drawn.component.size()), drawn.graph.vertexCount());
	ASSERT_EQ(static_cast<Index>(drawn.isFilling.size()), drawn.graph.edgeCount());
	for (Index v = 0; v < drawn.graph.vertexCount(); ++v)
		EXPECT_EQ(drawn.component[v], drawn.graph.positions()(0, v) < 2.5 ? 0 : n);
	for (Index e = 0; e < drawn.graph.edgeCount(); ++e) {
		EXPECT_FALSE(drawn.graph.edge(e).isFeature);
		EXPECT_TRUE(!drawn.isFilling[e] || drawn.component[drawn.graph.edge(e).from] == n);
	}
}

TEST(SurfaceGraph, RimsAndCreasesAreFeaturesAndCornersStay)
{
	const TriangleMesh mesh     = triangulatedPlane(6).mesh;
	SurfaceFeatures    features = noFeatures(mesh);
	const Index        corner   = mesh.rims()[0][2];
	Index              creases  = 0;
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		const auto& edge = mesh.edges()[e];
		// The middle line of the square.
		if (mesh.vertices.row(0)(std::vector<Index>{edge.from, edge.to}).cwiseAbs().maxCoeff() <
		    1e-9) {
			features.edge[e] = 1;
			++creases;
		}
	}
	ASSERT_EQ(creases, 6);
	features.corner[corner] = 1;
	SurfaceGraph drawn      = graphOf(mesh, features, levelSets(mesh, {}));
	EXPECT_EQ(drawn.graph.edgeCount(), 4 * 6 + creases);
	for (Index e = 0; e < drawn.graph.edgeCount(); ++e) {
		EXPECT_TRUE(drawn.graph.edge(e).isFeature);
		EXPECT_FALSE(drawn.isFilling[e]);
		const bool rim =
			std::abs(drawn.graph.edge(e).middle.head<2>().cwiseAbs().maxCoeff() - 0.5) < 1e-9;
		EXPECT_EQ(drawn.graph.isOutside(2 * e) || drawn.graph.isOutside(2 * e + 1), rim);
	}
	EXPECT_EQ(drawn.graph.faceLoops().size(), 3u); // two halves, and outside
	// Vertices of degree two dissolve: what stays are the corner and the two ends of the crease.
	drawn.graph.reduce();
	Index left        = 0;
	bool  cornerStays = false;
	for (Index v = 0; v < drawn.graph.vertexCount(); ++v)
		if (!drawn.graph.around(v).empty()) {
			++left;
			cornerStays |=
				(drawn.graph.positions().col(v) - mesh.vertices.col(corner)).norm() < 1e-12;
		}
	EXPECT_TRUE(cornerStays);
	EXPECT_EQ(left, 3);
}

// Lines of both families through a vertex, each a chord on either side of it.
TEST(SurfaceGraph, ChordsThatEndAtAVertexAreSortedAroundIt)
{
	const TriangleMesh mesh = triangulatedPlane(8, 0.3).mesh;
	for (const Index inner : {40, 30, 41})
		for (const double angle : {0.3, 0.8, 1.2}) {
			const CrossField field = alongTheAxes(mesh);
			PositionField    positions;
			positions.phase.resize(mesh.vertexCount());
			for (Index v = 0; v < mesh.vertexCount(); ++v) {
				const Vector3d d   = mesh.vertices.col(v) - mesh.vertices.col(inner);
				positions.phase[v] = 4.7 * std::polar(1.0, angle) * Complex(d.x(), d.y());
			}
			positions.translations.setZero(mesh.edgeCount());
			finishPositions(mesh, field, positions);
			const SurfaceCurves curves = integerLines(mesh, field, positions);
			ASSERT_EQ(curves.ends, 0);
			for (const char fill : {0, 1}) {
				const SurfaceGraph drawn = graphOf(
					mesh, noFeatures(mesh), curves, std::vector<char>(mesh.vertexCount(), fill));
				Index at = -1;
				for (Index v = 0; v < drawn.graph.vertexCount(); ++v) {
					ASSERT_FALSE(drawn.graph.around(v).empty());
					EXPECT_NEAR(turnAround(drawn.graph, v), 2.0 * EIGEN_PI, 1e-9) << v;
					if ((drawn.graph.positions().col(v) - mesh.vertices.col(inner)).norm() < 1e-12)
						at = v;
				}
				ASSERT_GE(at, 0);
				Index degree = 4; // and the edges of the triangles, if they are drawn
				for (const auto& edge : mesh.edges())
					degree += fill && (edge.from == inner || edge.to == inner);
				EXPECT_EQ(static_cast<Index>(drawn.graph.around(at).size()), degree);
				EXPECT_EQ(drawn.graph.eulerCharacteristic(), 2);
				if (fill)
					continue;
				// Lines that cross at the vertex cross nowhere else, and the others as the formulas say.
				for (const Index v : crossingsOf(drawn.graph)) {
					const Vector3d d =
						drawn.graph.positions().col(v) - Vector3d(mesh.vertices.col(inner));
					const Complex w = 4.7 * std::polar(1.0, angle) * Complex(d.x(), d.y());
					EXPECT_LT(awayFromWhole(w.real()), 1e-9);
					EXPECT_LT(awayFromWhole(w.imag()), 1e-9);
				}
			}
		}
}

// Three lines come together at every singular point of a sphere: all faces are quads, six of them around the whole.
TEST(SurfaceGraph, LinesThatMeetAtSingularPointsBoundQuads)
{
	const ClosedSurface    sphere(triangulatedSphere(4), 0.0, 2.7);
	const SingularVertices on = splitSingularTriangles(
		sphere.scaffold, sphere.closed.field, sphere.closed.positions, sphere.alignment.features);
	ASSERT_TRUE(sphere.closed.turnedOver.empty());
	const SurfaceCurves curves =
		integerLines(on.scaffold.mesh, on.field, on.positions, on.singular);
	SurfaceGraph drawn = graphOf(on.scaffold.mesh, on.features, curves);
	EXPECT_EQ(drawn.graph.eulerCharacteristic(), 2);
	drawn.graph.reduce();
	Index three = 0;
	for (Index v = 0; v < drawn.graph.vertexCount(); ++v) {
		const auto degree = static_cast<Index>(drawn.graph.around(v).size());
		EXPECT_TRUE(degree == 0 || degree == 3 || degree == 4) << degree;
		three += degree == 3;
	}
	EXPECT_EQ(three, 8);
	for (const auto& loop : drawn.graph.faceLoops())
		EXPECT_EQ(loop.size(), 4u);
}

} // namespace
} // namespace curvature_lines::test
