// Coarse tubes get round, and what is no bend stays as it is.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "scaffold_refinement.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "point_cloud.h"
#include "scaffold.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines::test {
namespace {

using Eigen::Vector3d;

// Every vertex has other values, so that new ones can be told.
Scaffold scaffoldOf(const TriangleMesh& mesh)
{
	Scaffold    scaffold;
	const Index count = mesh.vertexCount();
	scaffold.mesh     = mesh;
	scaffold.source.resize(count);
	std::iota(scaffold.source.begin(), scaffold.source.end(), 7);
	scaffold.place.resize(count);
	std::iota(scaffold.place.begin(), scaffold.place.end(), 100);
	scaffold.spacing.setLinSpaced(count, 1.0, 2.0);
	scaffold.size.setLinSpaced(count, 3.0, 4.0);
	scaffold.creaseEdge.assign(mesh.edgeCount(), 0);
	return scaffold;
}

// Radius .5, length 4, open.
TriangleMesh tube(int around, int along)
{
	return triangulatedGrid(around, along, true, false, [](double u, double v) {
		const double angle = 2.0 * EIGEN_PI * u;
		return Vector3d(0.5 * std::cos(angle), 0.5 * std::sin(angle), 4.0 * v);
	});
}

// Largest distance of the middles of edges and triangles to the cylinder, between these heights.
double offCylinder(const TriangleMesh& mesh, double from, double to)
{
	double     largest = 0.0;
	const auto judge   = [&](const Vector3d& p) {
        if (p.z() > from && p.z() < to)
            largest = std::max(largest, std::abs(p.head<2>().norm() - 0.5));
	};
	for (const TriangleMesh::Edge& edge : mesh.edges())
		judge(0.5 * (mesh.vertices.col(edge.from) + mesh.vertices.col(edge.to)));
	for (const Triangle& t : mesh.triangles())
		judge((mesh.vertices.col(t[0]) + mesh.vertices.col(t[1]) + mesh.vertices.col(t[2])) / 3.0);
	return largest;
}

// Not folded: no edge over which triangles look in opposite directions.
double sharpestTurn(const TriangleMesh& mesh)
{
	double least = 1.0;
	for (const TriangleMesh::Edge& edge : mesh.edges())
		if (!edge.isRim())
			least = std::min(
				least,
				mesh.areaVector(edge.left).normalized().dot(
					mesh.areaVector(edge.right).normalized()));
	return least;
}

void expectManifold(const TriangleMesh& mesh, int euler, int rims)
{
	EXPECT_TRUE(mesh.vertices.allFinite());
	EXPECT_EQ(mesh.eulerCharacteristic(), euler);
	EXPECT_EQ(static_cast<int>(mesh.rims().size()), rims);
	std::vector<Index> copies;
	EXPECT_EQ(manifoldPart(mesh.triangles(), mesh.vertexCount(), copies), mesh.triangles());
	EXPECT_TRUE(copies.empty());
	std::set<Index> used;
	for (const Triangle& t : mesh.triangles())
		used.insert(t.begin(), t.end());
	EXPECT_EQ(static_cast<Index>(used.size()), mesh.vertexCount());
}

struct Tube {
	int    around;
	double left; // of its distance to the cylinder
};

// Two rounds: three vertices around become twelve.
TEST(ScaffoldRefinement, ATubeOfFewVerticesAroundGetsRound)
{
	for (const Tube& wanted : {Tube{3, 0.75}, Tube{4, 0.45}, Tube{5, 0.52}}) {
		SCOPED_TRACE(wanted.around);
		Scaffold     scaffold = scaffoldOf(tube(wanted.around, 16));
		const double before   = offCylinder(scaffold.mesh, 0.5, 3.5);
		EXPECT_NEAR(before, 0.5 * (1.0 - std::cos(EIGEN_PI / wanted.around)), 1e-9);
		EXPECT_GT(refineBends(scaffold), 0);
		EXPECT_LT(offCylinder(scaffold.mesh, 0.5, 3.5), wanted.left * before);
		EXPECT_GT(sharpestTurn(scaffold.mesh), -0.51); // the ends stay polygons
		expectManifold(scaffold.mesh, 0, 2);
		// Where a plane cuts the tube: as many edges as there are sides around.
		int cut = 0;
		for (const TriangleMesh::Edge& edge : scaffold.mesh.edges())
			cut += (scaffold.mesh.vertices(2, edge.from) < 2.06) !=
			       (scaffold.mesh.vertices(2, edge.to) < 2.06);
		EXPECT_GE(cut, wanted.around == 3 ? 24 : 4 * wanted.around);
	}
}

TEST(ScaffoldRefinement, EverythingIsKnownOfNewVertices)
{
	Scaffold       scaffold = scaffoldOf(tube(4, 12));
	const Scaffold before   = scaffold;
	const Index    count = before.mesh.vertexCount(), added = refineBends(scaffold);
	const Index    total = count + added;
	ASSERT_GT(added, 0);
	ASSERT_EQ(scaffold.mesh.vertexCount(), total);
	ASSERT_EQ(static_cast<Index>(scaffold.source.size()), total);
	ASSERT_EQ(static_cast<Index>(scaffold.place.size()), total);
	ASSERT_EQ(static_cast<Index>(scaffold.spacing.size()), total);
	ASSERT_EQ(static_cast<Index>(scaffold.size.size()), total);
	ASSERT_EQ(static_cast<Index>(scaffold.creaseEdge.size()), scaffold.mesh.edgeCount());
	EXPECT_EQ(scaffold.mesh.vertices.leftCols(count), before.mesh.vertices);
	EXPECT_EQ(scaffold.spacing.head(count), before.spacing);
	EXPECT_EQ(scaffold.size.head(count), before.size);
	for (Index v = 0; v < count; ++v) {
		EXPECT_EQ(scaffold.source[v], before.source[v]);
		EXPECT_EQ(scaffold.place[v], before.place[v]);
	}
	for (Index v = count; v < total; ++v) {
		EXPECT_EQ(scaffold.source[v], -1);
		// All from one old vertex, and not from far away.
		const Index from = scaffold.place[v] - 100;
		ASSERT_GE(from, 0);
		ASSERT_LT(from, count);
		EXPECT_EQ(scaffold.spacing[v], before.spacing[from]);
		EXPECT_EQ(scaffold.size[v], before.size[from]);
		EXPECT_LT((scaffold.mesh.vertices.col(v) - before.mesh.vertices.col(from)).norm(), 1.1);
	}
}

// Sizes are not everybody's.
TEST(ScaffoldRefinement, AScaffoldOfAnySizeHasNoneAfterwards)
{
	Scaffold scaffold = scaffoldOf(tube(4, 12));
	scaffold.size.resize(0);
	EXPECT_GT(refineBends(scaffold), 0);
	EXPECT_EQ(scaffold.size.size(), 0);
}

TEST(ScaffoldRefinement, GentleBendsAndPlanesStay)
{
	for (const TriangleMesh& mesh :
	     {triangulatedPlane(8, 0.3).mesh,
	      triangulatedSphere(2).mesh,
	      triangulatedTorus(60, 30).mesh,
	      tube(16, 20)}) {
		Scaffold scaffold = scaffoldOf(mesh);
		EXPECT_EQ(refineBends(scaffold), 0);
		EXPECT_EQ(scaffold.mesh.vertices, mesh.vertices);
		EXPECT_EQ(scaffold.mesh.triangles(), mesh.triangles());
	}
}

TEST(ScaffoldRefinement, ClosedSurfacesStayClosed)
{
	// A ring of three around, and an icosahedron.
	Scaffold ring = scaffoldOf(triangulatedTorus(40, 3).mesh);
	EXPECT_GT(refineBends(ring), 0);
	expectManifold(ring.mesh, 0, 0);
	Scaffold ball = scaffoldOf(triangulatedSphere(0).mesh);
	EXPECT_GT(refineBends(ball), 0);
	expectManifold(ball.mesh, 2, 0);
	const Eigen::VectorXd radii = ball.mesh.vertices.colwise().norm();
	EXPECT_GT(radii.minCoeff(), 0.96); // middles of straight edges: .85
	EXPECT_LT(radii.maxCoeff(), 1.02);
}

// Edges of a tube of four around are creases along one of its four sides; its ends are rims.
TEST(ScaffoldRefinement, CreasesAndRimsStay)
{
	const int                             along    = 12;
	Scaffold                              scaffold = scaffoldOf(tube(4, along));
	std::set<std::pair<Index, Index>>     creases;
	const std::vector<std::vector<Index>> rims = scaffold.mesh.rims();
	for (int j = 0; j < along; ++j) {
		creases.emplace(4 * j, 4 * (j + 1));
		scaffold.creaseEdge[scaffold.mesh.edgeBetween(4 * j, 4 * (j + 1))] = 1;
	}
	EXPECT_GT(refineBends(scaffold), 0);
	EXPECT_EQ(scaffold.mesh.rims(), rims);
	std::set<std::pair<Index, Index>> after;
	for (Index e = 0; e < scaffold.mesh.edgeCount(); ++e)
		if (scaffold.creaseEdge[e])
			after.emplace(scaffold.mesh.edges()[e].from, scaffold.mesh.edges()[e].to);
	EXPECT_EQ(after, creases);
	// Edges that end on a crease are not split: those around from it are there still.
	for (int j = 0; j <= along; ++j) {
		EXPECT_GE(scaffold.mesh.edgeBetween(4 * j, 4 * j + 1), 0);
		EXPECT_GE(scaffold.mesh.edgeBetween(4 * j, 4 * j + 3), 0);
	}
	expectManifold(scaffold.mesh, 0, 2);
}

TEST(ScaffoldRefinement, MovesAndGrowsWithTheSurface)
{
	const TriangleMesh mesh  = tube(4, 12);
	TriangleMesh       other = mesh;
	const RigidMotion  motion;
	other.vertices = 100.0 * motion.ofPoints(mesh.vertices);
	Scaffold a = scaffoldOf(mesh), b = scaffoldOf(other);
	EXPECT_EQ(refineBends(a), refineBends(b));
	ASSERT_EQ(a.mesh.vertexCount(), b.mesh.vertexCount());
	EXPECT_LT(
		(b.mesh.vertices - 100.0 * motion.ofPoints(a.mesh.vertices)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(ScaffoldRefinement, NothingStaysNothing)
{
	Scaffold empty;
	EXPECT_EQ(refineBends(empty), 0);
	EXPECT_EQ(empty.mesh.triangleCount(), 0);
}

} // namespace
} // namespace curvature_lines::test
