// Turning numbers of loops on plane, sphere cap and cylinder, and what the cloud says about their
// inside. SPDX-License-Identifier: GPL-3.0-or-later
#include "face_loops.h"

#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "half_edge_graph.h"
#include "line_networks.h"
#include "point_cloud.h"
#include "voronoi_cells.h"

namespace curvature_lines {
namespace {

using namespace tests;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// A closed polygon as a graph, its edges' middles given by `curve` as well.
HalfEdgeGraph
ring(Index corners, const NetworkBuilder::Curve& curve, const NetworkBuilder::Normal& normal)
{
	Matrix3Xd points(3, corners), normals(3, corners);
	for (Index k = 0; k < corners; ++k) {
		points.col(k)  = curve(double(k) / corners);
		normals.col(k) = normal(points.col(k));
	}
	std::vector<HalfEdgeGraph::Edge> edges;
	for (Index k = 0; k < corners; ++k) {
		const Index    next   = (k + 1) % corners;
		const Vector3d middle = curve((k + 0.5) / corners);
		edges.push_back(
			{k, next, middle - points.col(k), middle - points.col(next), middle, normal(middle)});
	}
	return HalfEdgeGraph(points, normals, edges);
}

// Counter-clockwise about +z.
NetworkBuilder::Curve circle(double radius, double height)
{
	return [=](double t) {
		return Vector3d(radius * std::cos(2 * Pi * t), radius * std::sin(2 * Pi * t), height);
	};
}

// The loop that runs forward along edge 0, and the one that runs back.
std::pair<std::vector<Index>, std::vector<Index>> bothLoops(const HalfEdgeGraph& graph)
{
	auto loops = graph.faceLoops();
	EXPECT_EQ(loops.size(), 2u);
	return {loops[0], loops[1]};
}

TEST(TurningNumber, PlanarLoopsTurnOnce)
{
	for (const Index corners : {3, 4, 7, 40}) {
		const HalfEdgeGraph graph = ring(corners, circle(1.0, 0.0), planeNormal());
		const auto [inner, outer] = bothLoops(graph);
		EXPECT_NEAR(turningNumber(graph, inner), 1.0, 1e-9);
		EXPECT_NEAR(turningNumber(graph, outer), -1.0, 1e-9);
	}
	// A star with reflex corners.
	const auto star = [](double t) {
		const double r = 1.0 + 0.5 * std::cos(10 * Pi * t);
		return Vector3d(r * std::cos(2 * Pi * t), r * std::sin(2 * Pi * t), 0.0);
	};
	EXPECT_NEAR(
		turningNumber(ring(10, star, planeNormal()), {0, 2, 4, 6, 8, 10, 12, 14, 16, 18}),
		1.0,
		1e-9);
}

// Gauss-Bonnet on the unit sphere: the cap above height z has curvature 2 pi (1 - z).
TEST(TurningNumber, CurvatureInsideIsTakenOff)
{
	const auto radial = [](const Vector3d& p) { return p.normalized(); };
	for (const double z : {0.9, 0.5, 0.0, -0.5}) {
		const HalfEdgeGraph graph = ring(60, circle(std::sqrt(1.0 - z * z), z), radial);
		const auto [cap, rest]    = bothLoops(graph);
		EXPECT_NEAR(turningNumber(graph, cap), z, 0.01);
		EXPECT_NEAR(turningNumber(graph, rest), -z, 0.01);
	}
}

TEST(LoopClassifier, CapsAreFacesAndMouthsAreHoles)
{
	const PointCloud   sphere = sampleCloud("sphere", 3000, 1);
	const VoronoiCells sphereCells(sphere.positions);
	const auto         radial = [](const Vector3d& p) { return p.normalized(); };
	for (const double z : {0.9, 0.4, 0.0}) {
		const HalfEdgeGraph graph = ring(12, circle(std::sqrt(1.0 - z * z), z), radial);
		EXPECT_EQ(
			LoopClassifier(sphere, sphereCells, graph)(bothLoops(graph).first), LoopKind::Face);
		// The same loop where the cap has not been scanned.
		std::vector<Index> below;
		for (Index i = 0; i < sphere.size(); ++i)
			if (sphere.positions(2, i) < z)
				below.push_back(i);
		const PointCloud open{
			sphere.positions(Eigen::all, below), sphere.normals(Eigen::all, below)};
		const VoronoiCells openCells(open.positions);
		EXPECT_EQ(LoopClassifier(open, openCells, graph)(bothLoops(graph).first), LoopKind::Hole);
	}

	const PointCloud     tube = sampleCloud("cylinder", 3000, 1);
	const VoronoiCells   tubeCells(tube.positions);
	const HalfEdgeGraph  mouth = ring(20, circle(0.5, 0.97), normalOf("cylinder"));
	const LoopClassifier kindOf(tube, tubeCells, mouth);
	const auto [above, under] = bothLoops(mouth);
	EXPECT_NEAR(turningNumber(mouth, above), 0.0, 0.01);
	EXPECT_EQ(kindOf(above), LoopKind::Hole);
	EXPECT_EQ(kindOf(under), LoopKind::Hole);

	const PointCloud     sheet = sampleCloud("plane", 2000, 1);
	const VoronoiCells   sheetCells(sheet.positions);
	const HalfEdgeGraph  patch = ring(9, circle(0.3, 0.0), planeNormal());
	const LoopClassifier sheetKind(sheet, sheetCells, patch);
	EXPECT_EQ(sheetKind(bothLoops(patch).first), LoopKind::Face);
	EXPECT_EQ(sheetKind(bothLoops(patch).second), LoopKind::Rim);
}

} // namespace
} // namespace curvature_lines
