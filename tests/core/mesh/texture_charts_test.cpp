// Texture coordinates: unit squares, no overlap, few charts, seams only where they must be.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture_charts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "closed_surfaces.h"
#include "linked_faces.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygon_meshes.h"
#include "polygon_triangulation.h"
#include "quad_subdivision.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines::test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector2d
cornerOf(const PolygonMesh& mesh, const TextureCoordinates& texture, Index face, Index corner)
{
	const Index n = mesh.faces[face].size();
	return texture.cells * texture.corners.col(mesh.faces.offsets[face] + (corner % n));
}

// What the coordinates of every mesh are.
void expectSound(const PolygonMesh& mesh, const TextureCoordinates& texture)
{
	ASSERT_EQ(texture.corners.cols(), static_cast<Index>(mesh.faces.indices.size()));
	ASSERT_EQ(texture.chart.size(), static_cast<std::size_t>(mesh.faceCount()));
	EXPECT_GE(texture.corners.minCoeff(), 0.0);
	EXPECT_LE(texture.corners.maxCoeff(), 1.0);
	std::set<std::pair<long, long>>      taken;
	std::map<Index, Eigen::AlignedBox2d> boxes;
	for (Index f = 0; f < mesh.faceCount(); ++f) {
		const Index n    = mesh.faces[f].size();
		double      area = 0.0;
		Vector2d    mean = Vector2d::Zero();
		for (Index k = 0; k < n; ++k) {
			const Vector2d a = cornerOf(mesh, texture, f, k), b = cornerOf(mesh, texture, f, k + 1);
			area += 0.5 * (a.x() * b.y() - a.y() * b.x());
			mean += a / double(n);
			boxes[texture.chart[f]].extend(a);
			if (n == 4) {
				EXPECT_NEAR((b - a).norm(), 1.0, 1e-9);
				EXPECT_NEAR(a.x(), std::round(a.x()), 1e-9);
				EXPECT_NEAR(a.y(), std::round(a.y()), 1e-9);
			}
		}
		EXPECT_GT(area, 0.0) << "turned over";
		if (n == 4) {
			EXPECT_NEAR(area, 1.0, 1e-9);
		}
		const std::pair<long, long> cell{
			std::lround(std::floor(mean.x())), std::lround(std::floor(mean.y()))};
		EXPECT_TRUE(taken.insert(cell).second) << "two faces in one cell";
	}
	EXPECT_EQ(static_cast<Index>(boxes.size()), texture.charts);
	for (const auto& [chart, box] : boxes)
		for (const auto& [other, its] : boxes)
			if (chart < other) {
				const Eigen::AlignedBox2d common = box.intersection(its);
				EXPECT_FALSE(
					common.min().x() < common.max().x() + 0.5 &&
					common.min().y() < common.max().y() + 0.5)
					<< "less than a cell between charts";
			}
}

// Inner edges over which the coordinates do not run on.
std::set<VertexPair> seamsOf(const PolygonMesh& mesh, const TextureCoordinates& texture)
{
	std::map<VertexPair, std::array<Vector2d, 2>> sides;
	std::set<VertexPair>                          seams;
	for (Index f = 0; f < mesh.faceCount(); ++f)
		for (Index k = 0; k < mesh.faces[f].size(); ++k) {
			const Index    a = mesh.faces[f][k], b = mesh.faces[f][(k + 1) % mesh.faces[f].size()];
			const Vector2d at = cornerOf(mesh, texture, f, k),
						   to = cornerOf(mesh, texture, f, k + 1);
			sides[{a, b}]     = {at, to};
			const auto other  = sides.find({b, a});
			if (other != sides.end() &&
			    (other->second[0] - to).norm() + (other->second[1] - at).norm() > 1e-9)
				seams.insert({std::min(a, b), std::max(a, b)});
		}
	return seams;
}

Index innerEdges(const PolygonMesh& mesh)
{
	const MeshTopology topology = topologyOf(mesh);
	return topology.edges - topology.boundaryEdges;
}

// Squares in rows and columns, joined at the ends or not.
PolygonMesh grid(Index columns, Index rows, bool joined)
{
	std::vector<Vector3d>   vertices, normals;
	std::vector<VertexLoop> loops;
	const Index             across = columns + !joined, up = rows + !joined;
	for (Index j = 0; j < up; ++j)
		for (Index i = 0; i < across; ++i) {
			const double   a = 2.0 * EIGEN_PI * i / columns, b = 2.0 * EIGEN_PI * j / rows;
			const Vector3d out(std::cos(a), std::sin(a), 0.0);
			normals.emplace_back(
				joined ? Vector3d(std::cos(b) * out + std::sin(b) * Vector3d::UnitZ())
					   : Vector3d::UnitZ());
			vertices.emplace_back(
				joined ? Vector3d(2.0 * out + 0.7 * normals.back()) : Vector3d(i, j, 0.0));
		}
	for (Index j = 0; j < rows; ++j)
		for (Index i = 0; i < columns; ++i) {
			const Index k = (i + 1) % across, l = (j + 1) % up;
			loops.push_back({i + across * j, k + across * j, k + across * l, i + across * l});
		}
	return polygonMesh(vertices, normals, loops);
}

PolygonMesh quadsOf(const TriangleMesh& mesh)
{
	std::vector<char> onFeature(mesh.vertexCount(), 0);
	return subdivided(polygonsOf(mesh), onFeature, {}).mesh;
}

TEST(TextureCharts, NothingOfNothing)
{
	const TextureCoordinates none = textureCoordinates(polygonMesh({}, {}, {}));
	EXPECT_EQ(none.charts, 0);
	EXPECT_EQ(none.corners.cols(), 0);
}

TEST(TextureCharts, APlaneIsOneChartWithoutSeams)
{
	const PolygonMesh        plane   = grid(7, 4, false);
	const TextureCoordinates texture = textureCoordinates(plane);
	expectSound(plane, texture);
	EXPECT_EQ(texture.charts, 1);
	EXPECT_EQ(texture.cells, 7);
	EXPECT_TRUE(seamsOf(plane, texture).empty());
}

// Cut along one line of either family's length: no more edges than the grid needs to become a plane, but for the steps of
// a seam that is not straight.
TEST(TextureCharts, ATorusIsOneChart)
{
	const PolygonMesh        torus   = grid(24, 10, true);
	const TextureCoordinates texture = textureCoordinates(torus);
	expectSound(torus, texture);
	EXPECT_EQ(texture.charts, 1);
	EXPECT_LE(seamsOf(torus, texture).size(), 2U * (24 + 10));
}

TEST(TextureCharts, SeamsAtCreasesOnly)
{
	const PolygonMesh plane = grid(6, 4, false);
	// the line i = 2 from side to side
	std::vector<VertexPair> crease;
	for (Index j = 0; j < 4; ++j)
		crease.emplace_back(2 + 7 * j, 2 + 7 * (j + 1));
	const TextureCoordinates texture = textureCoordinates(plane, crease);
	expectSound(plane, texture);
	EXPECT_EQ(texture.charts, 2);
	EXPECT_EQ(seamsOf(plane, texture), std::set<VertexPair>(crease.begin(), crease.end()));
	// one that ends inside need not part the chart, but its edges may be seams
	const TextureCoordinates open = textureCoordinates(plane, {crease[0], crease[1]});
	expectSound(plane, open);
	EXPECT_EQ(open.charts, 1);
}

// The sides of a cube, by its creases, and without: one that unfolds.
TEST(TextureCharts, ACubeHasSixSides)
{
	const CreasedCube       cube(6);
	std::vector<VertexLoop> squares;
	// the grid that the triangles were made of
	const TriangleMesh& mesh = cube.scaffold.mesh;
	for (Index t = 0; t < mesh.triangleCount(); t += 2)
		squares.push_back(
			{mesh.triangles()[t][0],
		     mesh.triangles()[t][1],
		     mesh.triangles()[t][2],
		     mesh.triangles()[t + 1][2]});
	const PolygonMesh sides = {
		mesh.vertices, mesh.vertexNormals(), NeighborLists::fromRows(squares)};
	std::vector<char> marked(mesh.vertexCount(), 0);
	for (Index v = 0; v < mesh.vertexCount(); ++v)
		marked[v] = cube.guide.onCrease[v];
	const std::vector<VertexPair> creases = bentEdgesBetween(sides, marked);
	EXPECT_EQ(creases.size(), 12U * 6);
	const TextureCoordinates texture = textureCoordinates(sides, creases);
	expectSound(sides, texture);
	EXPECT_EQ(texture.charts, 6);
	EXPECT_EQ(seamsOf(sides, texture), std::set<VertexPair>(creases.begin(), creases.end()));
	const TextureCoordinates unfolded = textureCoordinates(sides);
	expectSound(sides, unfolded);
	EXPECT_LE(unfolded.charts, 6);
}

// Marks of all vertices, but only what bends is a crease.
TEST(TextureCharts, FlatEdgesBetweenMarkedVerticesAreNoCreases)
{
	const PolygonMesh plane = grid(5, 5, false);
	EXPECT_TRUE(bentEdgesBetween(plane, std::vector<char>(plane.vertexCount(), 1)).empty());
}

// Quads of every kind: with irregular vertices everywhere, three or six faces around them.
TEST(TextureCharts, IrregularMeshes)
{
	for (const TriangleMesh& mesh :
	     {triangulatedSphere(2).mesh,
	      triangulatedTorus(20, 12).mesh,
	      triangulatedPlane(9, 0.3).mesh,
	      triangulatedCylinder(13, 9).mesh}) {
		const PolygonMesh        quads   = quadsOf(mesh);
		const TextureCoordinates texture = textureCoordinates(quads);
		expectSound(quads, texture);
		EXPECT_LE(texture.charts, quads.faceCount() / 3);
		EXPECT_LE(seamsOf(quads, texture).size(), static_cast<std::size_t>(innerEdges(quads)) / 2);
	}
}

TEST(TextureCharts, FacesThatAreNoQuadsFillCells)
{
	// a pentagon and a triangle in a row of squares
	const PolygonMesh row = flatPolygons(
		{{0, 0, 0},
	     {1, 0, 0},
	     {2, 0, 0},
	     {3, 0, 0},
	     {0, 1, 0},
	     {1, 1, 0},
	     {2, 1, 0},
	     {3, 1, 0},
	     {2.5, 1.5, 0},
	     {4, .5, 0}},
		{{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 8, 6}, {3, 9, 7}});
	const TextureCoordinates texture = textureCoordinates(row);
	expectSound(row, texture);
	EXPECT_EQ(texture.charts, 2) << "the triangle has no quad beside it";
	EXPECT_EQ(seamsOf(row, texture), (std::set<VertexPair>{{3, 7}}));
	for (std::uint64_t seed = 1; seed <= 4; ++seed) {
		const PolygonMesh mesh = randomPolygons(triangulatedSphere(3).mesh, 7, 0.7, seed);
		expectSound(mesh, textureCoordinates(mesh));
	}
}

TEST(TextureCharts, TrianglesKeepTheCornersOfTheirPolygons)
{
	const PolygonMesh          mesh    = randomPolygons(triangulatedTorus(24, 12).mesh, 7, 0.7, 3);
	const TextureCoordinates   texture = textureCoordinates(mesh);
	const PolygonTriangulation cut     = triangulatePolygons(mesh);
	const Eigen::Matrix2Xd     corners = cornersOfTriangles(mesh, texture.corners, cut);
	ASSERT_EQ(corners.cols(), 3 * cut.triangles.faceCount());
	double whole = 0.0, parts = 0.0;
	for (Index f = 0; f < mesh.faceCount(); ++f)
		for (Index k = 0; k < mesh.faces[f].size(); ++k) {
			const Vector2d a = cornerOf(mesh, texture, f, k), b = cornerOf(mesh, texture, f, k + 1);
			whole += 0.5 * (a.x() * b.y() - a.y() * b.x());
		}
	for (Index t = 0; t < cut.triangles.faceCount(); ++t) {
		const Eigen::Matrix<double, 2, 3> p = texture.cells * corners.middleCols<3>(3 * t);
		const Vector2d                    u = p.col(1) - p.col(0), v = p.col(2) - p.col(0);
		parts += 0.5 * (u.x() * v.y() - u.y() * v.x());
	}
	EXPECT_NEAR(parts, whole, 1e-9 * whole);
}

TEST(TextureCharts, EdgesOfThreeFacesAreSeams)
{
	const PolygonMesh mesh = flatPolygons(
		{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, -1, 0}, {0, -1, 0}, {1, 0, 1}, {0, 0, 1}},
		{{0, 1, 2, 3}, {1, 0, 5, 4}, {0, 1, 6, 7}});
	const TextureCoordinates texture = textureCoordinates(mesh);
	expectSound(mesh, texture);
	EXPECT_EQ(texture.charts, 3);
}

} // namespace
} // namespace curvature_lines::test
