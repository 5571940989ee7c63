// Quad meshes from analytic lines: topology on closed and open surfaces, holes, options, bad input.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "quad_mesh.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "line_network.h"
#include "line_networks.h"
#include "mesh_finishing.h"
#include "point_cloud.h"
#include "voronoi_cells.h"

namespace curvature_lines {
namespace {

using namespace tests;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

QuadMeshResult
build(const PointCloud& cloud, const LineNetwork& lines, const MeshFinishingOptions& options = {})
{
	return buildQuadMesh(cloud, VoronoiCells(cloud.positions), lines, options);
}

void expectManifold(const QuadMeshResult& result)
{
	EXPECT_EQ(result.topology.nonmanifoldEdges, 0);
	EXPECT_EQ(result.topology.nonmanifoldVertices, 0);
	EXPECT_TRUE(result.mesh.vertices.allFinite());
	EXPECT_EQ(result.topology.vertices, result.mesh.vertexCount());
}

void expectClosed(const QuadMeshResult& result, Index eulerCharacteristic)
{
	expectManifold(result);
	EXPECT_EQ(result.topology.boundaryEdges, 0);
	EXPECT_EQ(result.topology.components, 1);
	EXPECT_EQ(result.topology.eulerCharacteristic, eulerCharacteristic);
}

double areaOf(const PolygonMesh& mesh)
{
	double area = 0.0;
	for (Index f = 0; f < mesh.faceCount(); ++f) {
		Vector3d sum = Vector3d::Zero();
		for (Index k = 0; k < mesh.faces[f].size(); ++k) {
			const Vector3d a = mesh.vertices.col(mesh.faces[f][k]);
			const Vector3d b = mesh.vertices.col(mesh.faces[f][(k + 1) % mesh.faces[f].size()]);
			sum += 0.5 * a.cross(b);
		}
		area += sum.norm();
	}
	return area;
}

// n x n points of the unit square, without those for which `missing` holds.
template<class Missing>
PointCloud squareCloud(Index n, const Missing& missing)
{
	samples::Random       random(1, 1);
	std::vector<Vector3d> points;
	for (Index i = 0; i < n * n; ++i) {
		const Vector3d p((i % n + random.uniform()) / n, (i / n + random.uniform()) / n, 0.0);
		if (!missing(p))
			points.push_back(p);
	}
	PointCloud cloud{Matrix3Xd(3, points.size()), Matrix3Xd(3, points.size())};
	cloud.normals.colwise() = Vector3d::UnitZ();
	for (std::size_t i = 0; i < points.size(); ++i)
		cloud.positions.col(i) = points[i];
	return cloud;
}

// Lines of the unit square at multiples of 1 / n, interrupted where `missing` holds.
template<class Missing>
LineNetwork squareLines(Index n, const Missing& missing)
{
	NetworkBuilder builder(planeNormal());
	for (const int family : {1, 2}) {
		for (Index i = 0; i < n; ++i) {
			const double   at    = (i + 0.5) / n;
			const Vector3d start = family == 1 ? Vector3d(0, at, 0) : Vector3d(at, 0, 0);
			const Vector3d along = family == 1 ? Vector3d::UnitX() : Vector3d::UnitY();
			double         from  = 0.01;
			const auto     flush = [&](double to) {
                if (to - from > 0.02)
                    builder.addSegment(family, start + from * along, start + to * along, 40);
			};
			for (double t = 0.01; t < 0.99; t += 0.01) {
				if (missing(Vector3d(start + t * along))) {
					flush(t);
					from = t + 0.01;
				}
			}
			flush(0.99);
		}
	}
	return builder.lines();
}

bool never(const Vector3d&)
{
	return false;
}
bool inDisk(const Vector3d& p)
{
	return (p - Vector3d(0.5, 0.5, 0.0)).norm() < 0.17;
}

TEST(QuadMesh, NoisyTorusIsClosedForEverySeed)
{
	for (std::uint64_t seed = 1; seed <= 12; ++seed) {
		const PointCloud     cloud  = sampleCloud("torus", 2000, seed);
		const QuadMeshResult result = build(cloud, torusNetwork(30, 14, 60, 0.009, seed));
		expectClosed(result, 0);
		EXPECT_EQ(result.crossings, 30 * 14);
		EXPECT_EQ(result.topology.quads, 30 * 14);
		EXPECT_EQ(result.discardedLoops, 0);
	}
}

TEST(QuadMesh, GreatCirclesCloseTheSphereForEverySeed)
{
	for (std::uint64_t seed = 1; seed <= 12; ++seed) {
		const PointCloud cloud = sampleCloud("sphere", 2000, seed);
		expectClosed(build(cloud, greatCircles(12, 200, 0.0, seed)), 2);
	}
}

// All meridians meet in the poles: two vertices of degree 16.
TEST(QuadMesh, MeridiansThroughThePolesMeetInOneVertex)
{
	const PointCloud cloud = sampleCloud("sphere", 3000, 1);
	NetworkBuilder   builder([](const Vector3d& p) { return p.normalized(); });
	for (int i = 0; i < 8; ++i) {
		const Vector3d x(std::cos(i * Pi / 8), std::sin(i * Pi / 8), 0.0);
		builder.add(1, true, 120, [&](double t) {
			return Vector3d(std::cos(2 * Pi * t) * x + std::sin(2 * Pi * t) * Vector3d::UnitZ());
		});
	}
	for (int i = 1; i < 8; ++i) {
		const double v = (i / 8.0 - 0.5) * Pi;
		builder.add(2, true, 120, [&](double t) {
			const double u = 2 * Pi * t + 0.1;
			return Vector3d(std::cos(u) * std::cos(v), std::sin(u) * std::cos(v), std::sin(v));
		});
	}
	const QuadMeshResult result = build(cloud, builder.lines());
	expectClosed(result, 2);
	EXPECT_EQ(result.topology.vertices, 16 * 7 + 2);
	EXPECT_EQ(result.topology.triangles, 2 * 16);
	EXPECT_EQ(result.topology.quads, 16 * 6);
}

TEST(QuadMesh, OpenSurfacesHaveTheirRims)
{
	const PointCloud cylinder = sampleCloud("cylinder", 2000, 1);
	NetworkBuilder   tube(normalOf("cylinder"), 0.003);
	for (int i = 0; i < 20; ++i)
		tube.add(1, false, 60, [&](double t) {
			return Vector3d(
				0.5 * std::cos(i * Pi / 10), 0.5 * std::sin(i * Pi / 10), 1.96 * (t - 0.5));
		});
	for (int i = 0; i < 12; ++i)
		tube.add(2, true, 90, [&](double t) {
			return Vector3d(
				0.5 * std::cos(2 * Pi * t), 0.5 * std::sin(2 * Pi * t), 0.15 * (i - 5.5));
		});
	const QuadMeshResult cylinderMesh = build(cylinder, tube.lines());
	expectManifold(cylinderMesh);
	EXPECT_EQ(cylinderMesh.topology.eulerCharacteristic, 0);
	EXPECT_EQ(cylinderMesh.topology.boundaryLoops, 2);
	EXPECT_EQ(cylinderMesh.topology.quads, 20 * 11);

	const PointCloud helicoid = sampleCloud("helicoid", 3000, 1);
	NetworkBuilder   screw(normalOf("helicoid"), 0.003);
	const auto       at = [](double u, double v) {
        return Vector3d(u * std::cos(v), u * std::sin(v), 0.5 * v);
	};
	for (int i = 0; i < 30; ++i)
		screw.add(1, false, 60, [&](double t) { return at(1.9 * (t - 0.5), 0.2 * (i - 14.5)); });
	for (int i = 0; i < 10; ++i)
		screw.add(2, false, 150, [&](double t) { return at(0.2 * (i - 4.5), 6.1 * (t - 0.5)); });
	const QuadMeshResult helicoidMesh = build(helicoid, screw.lines());
	expectManifold(helicoidMesh);
	EXPECT_EQ(helicoidMesh.topology.eulerCharacteristic, 1);
	EXPECT_EQ(helicoidMesh.topology.boundaryLoops, 1);
	EXPECT_EQ(helicoidMesh.topology.components, 1);
	EXPECT_EQ(helicoidMesh.topology.quads, 29 * 9);
}

TEST(QuadMesh, HolesInTheCloudStayOpenUnlessClosed)
{
	const PointCloud     cloud = squareCloud(60, inDisk);
	const LineNetwork    lines = squareLines(11, inDisk);
	const QuadMeshResult open  = build(cloud, lines);
	expectManifold(open);
	EXPECT_EQ(open.topology.boundaryLoops, 2);
	EXPECT_EQ(open.topology.eulerCharacteristic, 0);
	EXPECT_EQ(open.discardedLoops, 2);

	MeshFinishingOptions options;
	options.closeHoles          = true;
	const QuadMeshResult closed = build(cloud, lines, options);
	expectManifold(closed);
	// The rim around the hole is 14 edges long, the outer one 40: neither is small.
	EXPECT_EQ(closed.topology.boundaryLoops, 2);
	const auto small = [](const Vector3d& p) { return (p - Vector3d(0.5, 0.5, 0)).norm() < 0.1; };
	const QuadMeshResult patched = build(squareCloud(60, small), squareLines(11, small), options);
	expectManifold(patched);
	EXPECT_EQ(patched.topology.boundaryLoops, 1);
	EXPECT_EQ(patched.topology.eulerCharacteristic, 1);
	EXPECT_NEAR(areaOf(patched.mesh), std::pow(10.0 / 11.0, 2), 1e-6);
}

// Few lines over many points: the faces are large against the spacing, and yet no holes.
TEST(QuadMesh, LargeFacesOfFlatRegionsStay)
{
	const QuadMeshResult result = build(squareCloud(60, never), squareLines(3, never));
	expectManifold(result);
	EXPECT_EQ(result.topology.quads, 4);
	EXPECT_NEAR(areaOf(result.mesh), 4.0 / 9.0, 1e-9);
}

TEST(QuadMesh, TriangulationAndConcaveSplitKeepAreaAndTopology)
{
	const PointCloud     cloud = squareCloud(60, inDisk);
	const LineNetwork    lines = squareLines(11, inDisk);
	MeshFinishingOptions options;
	options.splitConcave           = false;
	const QuadMeshResult plain     = build(cloud, lines, options);
	options.splitConcave           = true;
	const QuadMeshResult split     = build(cloud, lines, options);
	options.triangulate            = true;
	const QuadMeshResult triangles = build(cloud, lines, options);
	EXPECT_EQ(triangles.topology.triangles, triangles.topology.faces);
	for (const QuadMeshResult* result : {&split, &triangles}) {
		expectManifold(*result);
		EXPECT_EQ(result->topology.eulerCharacteristic, plain.topology.eulerCharacteristic);
		EXPECT_EQ(result->topology.boundaryEdges, plain.topology.boundaryEdges);
		EXPECT_NEAR(areaOf(result->mesh), areaOf(plain.mesh), 1e-9);
	}
}

TEST(QuadMesh, LinesThatEndLeaveNoDanglingEdges)
{
	const PointCloud cloud = sampleCloud("torus", 2000, 3);
	// Every line a spiral that ends: no two ends at the same place.
	NetworkBuilder  builder(normalOf("torus"), 0.005);
	samples::Random random(3, 4);
	for (int i = 0; i < 40; ++i) {
		const double u0 = random.uniform(0, 2 * Pi), v0 = random.uniform(0, 2 * Pi);
		const double along = i % 2 ? 0.2 : random.uniform(2.5, 5.5), around = i % 2 ? 5.5 : 0.1;
		builder.add(1 + i % 2, false, 120, [&](double t) {
			const double u = u0 + along * t, v = v0 + around * t, rho = 1.0 + 0.4 * std::cos(v);
			return Vector3d(rho * std::cos(u), rho * std::sin(u), 0.4 * std::sin(v));
		});
	}
	const QuadMeshResult result = build(cloud, builder.lines());
	expectClosed(result, 0);
}

TEST(QuadMesh, IslandsInsideAFaceAreLeftOut)
{
	const PointCloud cloud = squareCloud(60, never);
	NetworkBuilder   builder(planeNormal());
	for (const double at : {0.1, 0.5, 0.9}) {
		builder.addSegment(1, {0.01, at, 0}, {0.99, at, 0}, 60);
		builder.addSegment(2, {at, 0.01, 0}, {at, 0.99, 0}, 60);
	}
	for (int i = 0; i < 4; ++i) { // three by three small faces in the middle of one of the four
		const double at = 0.2 + 0.05 * i;
		builder.addSegment(1, {0.15, at, 0}, {0.45, at, 0}, 20);
		builder.addSegment(2, {at, 0.15, 0}, {at, 0.45, 0}, 20);
	}
	for (int i = 0; i < 9; ++i) // more faces outside than on the island
		builder.addSegment(1, {0.51, 0.54 + 0.04 * i, 0}, {0.95, 0.54 + 0.04 * i, 0}, 20);
	builder.addSegment(2, {0.7, 0.51, 0}, {0.7, 0.95, 0}, 20);
	const QuadMeshResult result = build(cloud, builder.lines());
	expectManifold(result);
	EXPECT_EQ(result.islands, 1);
	EXPECT_EQ(result.topology.components, 1);
	EXPECT_NEAR(areaOf(result.mesh), 0.64, 1e-9);
}

TEST(QuadMesh, OrderOfLinesAndFlippedNormalsChangeNoCount)
{
	const PointCloud   cloud = sampleCloud("torus", 2000, 5);
	const LineNetwork  lines = torusNetwork(20, 9, 60, 0.009, 5);
	const MeshTopology first = build(cloud, lines).topology;

	LineNetwork reversed = lines;
	Index       next     = 0;
	reversed.offsets     = {0};
	for (Index l = lines.lines(); l-- > 0;) {
		for (Index v = lines.offsets[l]; v < lines.offsets[l + 1]; ++v, ++next) {
			reversed.vertices.col(next) = lines.vertices.col(v);
			reversed.normals.col(next)  = lines.normals.col(v);
		}
		reversed.offsets.push_back(next);
		reversed.family[lines.lines() - 1 - l] = lines.family[l];
		reversed.closed[lines.lines() - 1 - l] = lines.closed[l];
	}
	const MeshTopology second = build(cloud, reversed).topology;
	PointCloud         inside = cloud;
	inside.normals            = -cloud.normals;
	LineNetwork flipped       = lines;
	flipped.normals           = -lines.normals;
	const MeshTopology third  = build(inside, flipped).topology;
	for (const MeshTopology& t : {second, third}) {
		EXPECT_EQ(t.vertices, first.vertices);
		EXPECT_EQ(t.edges, first.edges);
		EXPECT_EQ(t.quads, first.quads);
		EXPECT_EQ(t.eulerCharacteristic, first.eulerCharacteristic);
	}
}

TEST(QuadMesh, TooFewLinesGiveAnEmptyMesh)
{
	const PointCloud cloud = squareCloud(8, never);
	EXPECT_EQ(build(cloud, LineNetwork()).mesh.faceCount(), 0);
	NetworkBuilder cross(planeNormal());
	cross.addSegment(1, {0.1, 0.5, 0}, {0.9, 0.5, 0}, 9)
		.addSegment(2, {0.5, 0.1, 0}, {0.5, 0.9, 0}, 9);
	MeshFinishingOptions options;
	options.triangulate = options.closeHoles = true;
	const QuadMeshResult result              = build(cloud, cross.lines(), options);
	EXPECT_EQ(result.crossings, 1);
	EXPECT_EQ(result.mesh.faceCount(), 0);
	EXPECT_EQ(result.topology.vertices, 0);
}

} // namespace
} // namespace curvature_lines
