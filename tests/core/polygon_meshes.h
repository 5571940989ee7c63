// Polygon meshes from triangulations of exact surfaces, and what a mesh of quads made of one must keep.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "mesh_quality.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "quad_subdivision.h"
#include "triangle_mesh.h"

namespace curvature_lines::test {

using VertexLoop = std::vector<Index>;

// Seen from above: every vertex has the normal z.
inline PolygonMesh
flatPolygons(const std::vector<Eigen::Vector3d>& vertices, const std::vector<VertexLoop>& loops)
{
	return polygonMesh(
		vertices, std::vector<Eigen::Vector3d>(vertices.size(), Eigen::Vector3d::UnitZ()), loops);
}

inline PolygonMesh polygonsOf(const TriangleMesh& mesh)
{
	std::vector<VertexLoop> loops;
	for (const Triangle& t : mesh.triangles())
		loops.emplace_back(t.begin(), t.end());
	return {mesh.vertices, mesh.vertexNormals(), NeighborLists::fromRows(loops)};
}

// A triangulation whose inner edges are taken away in random order while no face gets more than `largest`
// corners, no vertex less than three edges, and the two faces have nothing else in common.
inline PolygonMesh
randomPolygons(const TriangleMesh& mesh, std::size_t largest, double share, std::uint64_t seed)
{
	samples::Random    random(seed, 0);
	std::vector<Index> order(mesh.edgeCount()), valence(mesh.vertexCount(), 0);
	std::iota(order.begin(), order.end(), Index(0));
	for (std::size_t k = order.size(); k > 1; --k)
		std::swap(
			order[k - 1], order[std::min(k - 1, std::size_t(random.uniform(0.0, double(k))))]);
	std::vector<VertexLoop> loops;
	std::vector<Index>      faceOf(mesh.triangleCount());
	for (Index t = 0; t < mesh.triangleCount(); ++t) {
		loops.emplace_back(mesh.triangles()[t].begin(), mesh.triangles()[t].end());
		faceOf[t] = t;
	}
	for (const TriangleMesh::Edge& edge : mesh.edges()) {
		++valence[edge.from];
		++valence[edge.to];
	}
	const auto face = [&](Index t) {
		while (faceOf[t] != t)
			t = faceOf[t];
		return t;
	};
	for (const Index e : order) {
		const TriangleMesh::Edge& edge = mesh.edges()[e];
		if (edge.isRim() || random.uniform(0.0, 1.0) > share || valence[edge.from] < 4 ||
		    valence[edge.to] < 4)
			continue;
		const Index f = face(edge.left), g = face(edge.right);
		VertexLoop &a = loops[f], &b = loops[g]; // a: from -> to, b: back
		if (f == g || a.size() + b.size() - 2 > largest)
			continue;
		const auto common = std::count_if(a.begin(), a.end(), [&](Index v) {
			return std::find(b.begin(), b.end(), v) != b.end();
		});
		if (common != 2)
			continue;
		std::rotate(a.begin(), std::find(a.begin(), a.end(), edge.to), a.end());
		std::rotate(b.begin(), std::find(b.begin(), b.end(), edge.from), b.end());
		a.insert(a.end(), b.begin() + 1, b.end() - 1);
		b.clear();
		faceOf[g] = f;
		--valence[edge.from];
		--valence[edge.to];
	}
	loops.erase(
		std::remove_if(loops.begin(), loops.end(), [](const VertexLoop& l) { return l.empty(); }),
		loops.end());
	return {mesh.vertices, mesh.vertexNormals(), NeighborLists::fromRows(loops)};
}

// Quads along the lines of curvature of the torus, so many around its axis and around its tube.
inline PolygonMesh torusOfQuads(Index around, Index tube)
{
	std::vector<Eigen::Vector3d> vertices, normals;
	std::vector<VertexLoop>      faces;
	for (Index j = 0; j < tube; ++j)
		for (Index i = 0; i < around; ++i) {
			const double          a = 2.0 * EIGEN_PI * i / around, b = 2.0 * EIGEN_PI * j / tube;
			const Eigen::Vector3d out(std::cos(a), std::sin(a), 0.0);
			normals.push_back(std::cos(b) * out + std::sin(b) * Eigen::Vector3d::UnitZ());
			vertices.push_back(out + 0.4 * normals.back());
			const Index right = (i + 1) % around, up = (j + 1) % tube;
			faces.push_back(
				{j * around + i, j * around + right, up * around + right, up * around + i});
		}
	return polygonMesh(vertices, normals, faces);
}

// Quads of a triangulation: each of its triangles cut into three.
inline PolygonMesh quadsOn(const TriangleMesh& triangles)
{
	PolygonMesh       mesh = polygonsOf(triangles);
	std::vector<char> none(mesh.vertexCount(), 0);
	return subdivided(mesh, none).mesh;
}

inline Index unsoundOf(const PolygonMesh& mesh)
{
	Index count = 0;
	for (Index f = 0; f < mesh.faceCount(); ++f)
		count += scaledJacobian(mesh, f) < 0.0;
	return count;
}

// A share of the vertices moves by so many edges in its tangent plane.
inline void fold(double share, double edges, samples::Random& random, PolygonMesh& mesh)
{
	const double edge =
		(mesh.vertices.col(mesh.faces[0][0]) - mesh.vertices.col(mesh.faces[0][1])).norm();
	for (Index v = 0; v < mesh.vertexCount(); ++v) {
		if (random.uniform(0.0, 1.0) > share)
			continue;
		const Eigen::Vector3d n = mesh.normals.col(v), x = n.unitOrthogonal(), y = n.cross(x);
		const double          a = random.uniform(0.0, 6.28);
		mesh.vertices.col(v) += edges * edge * (std::cos(a) * x + std::sin(a) * y);
	}
}

// A vertex for every triangle of a closed triangulation, a face for every vertex.
inline PolygonMesh dualOf(const TriangleMesh& mesh)
{
	std::vector<Eigen::Vector3d> vertices, normals;
	std::vector<VertexLoop>      loops(mesh.vertexCount());
	for (Index t = 0; t < mesh.triangleCount(); ++t) {
		const Triangle& corners = mesh.triangles()[t];
		vertices.emplace_back(
			(mesh.vertices.col(corners[0]) + mesh.vertices.col(corners[1]) +
		     mesh.vertices.col(corners[2])) /
			3.0);
		normals.push_back(mesh.areaVector(t).normalized());
	}
	for (Index v = 0; v < mesh.vertexCount(); ++v) {
		Index first = 0;
		while (std::count(mesh.triangles()[first].begin(), mesh.triangles()[first].end(), v) == 0)
			++first;
		Index t = first;
		do {
			loops[v].push_back(t);
			int corner = 0;
			while (mesh.triangles()[t][corner] != v)
				++corner;
			const TriangleMesh::Edge& edge = mesh.edges()[mesh.edgeOf(t, (corner + 2) % 3)];
			t                              = edge.left == t ? edge.right : edge.left;
		} while (t != first);
	}
	return polygonMesh(vertices, normals, loops);
}

// Both meshes in one.
inline PolygonMesh together(const PolygonMesh& a, const PolygonMesh& b)
{
	PolygonMesh both;
	both.vertices.resize(3, a.vertexCount() + b.vertexCount());
	both.vertices << a.vertices, b.vertices;
	both.normals.resize(3, a.vertexCount() + b.vertexCount());
	both.normals << a.normals, b.normals;
	std::vector<VertexLoop> loops = faceLoopsOf(a);
	for (VertexLoop loop : faceLoopsOf(b)) {
		for (Index& v : loop)
			v += a.vertexCount();
		loops.push_back(std::move(loop));
	}
	both.faces = NeighborLists::fromRows(loops);
	return both;
}

// The signed volume under the faces, seen from the origin; each is cut around its mean corner.
inline double volumeUnder(const PolygonMesh& mesh)
{
	double sum = 0.0;
	for (Index f = 0; f < mesh.faceCount(); ++f) {
		const NeighborLists::Row face   = mesh.faces[f];
		Eigen::Vector3d          center = Eigen::Vector3d::Zero();
		for (const Index v : face)
			center += mesh.vertices.col(v) / double(face.size());
		for (Index k = 0; k < face.size(); ++k) {
			const Eigen::Vector3d a = mesh.vertices.col(face[k]);
			const Eigen::Vector3d b = mesh.vertices.col(face[(k + 1) % face.size()]);
			sum += center.dot(a.cross(b)) / 6.0;
		}
	}
	return sum;
}

// The sides that have no other face.
inline std::set<std::pair<Index, Index>> rimSides(const PolygonMesh& mesh)
{
	std::set<std::pair<Index, Index>> sides, rims;
	for (Index f = 0; f < mesh.faceCount(); ++f)
		for (Index k = 0; k < mesh.faces[f].size(); ++k)
			sides.emplace(mesh.faces[f][k], mesh.faces[f][(k + 1) % mesh.faces[f].size()]);
	for (const auto& [a, b] : sides)
		if (sides.count({b, a}) == 0)
			rims.emplace(a, b);
	return rims;
}

inline VertexLoop edgesAtVertices(const PolygonMesh& mesh)
{
	std::set<std::pair<Index, Index>> edges;
	for (Index f = 0; f < mesh.faceCount(); ++f)
		for (Index k = 0; k < mesh.faces[f].size(); ++k)
			edges.insert(
				std::minmax(mesh.faces[f][k], mesh.faces[f][(k + 1) % mesh.faces[f].size()]));
	VertexLoop valence(mesh.vertexCount(), 0);
	for (const auto& [a, b] : edges) {
		++valence[a];
		++valence[b];
	}
	return valence;
}

// Inner vertices with other than four edges.
inline Index irregularVertices(const PolygonMesh& mesh)
{
	const VertexLoop  valence = edgesAtVertices(mesh);
	std::vector<char> onRim(mesh.vertexCount(), 0);
	for (const auto& [a, b] : rimSides(mesh))
		onRim[a] = onRim[b] = 1;
	Index count = 0;
	for (Index v = 0; v < mesh.vertexCount(); ++v)
		count += !onRim[v] && valence[v] != 4;
	return count;
}

// Corners of faces that turn back, seen from the side of the surface's normal.
inline Index foldedCorners(const std::string& name, const PolygonMesh& mesh)
{
	const samples::AnalyticSurface& surface = samples::surface(name);
	Index                           count   = 0;
	for (Index f = 0; f < mesh.faceCount(); ++f) {
		const NeighborLists::Row face = mesh.faces[f];
		for (Index k = 0; k < face.size(); ++k) {
			const Eigen::Vector3d a = mesh.vertices.col(face[k]),
								  b = mesh.vertices.col(face[(k + 1) % face.size()]),
								  c = mesh.vertices.col(face[(k + 2) % face.size()]);
			count += (b - a).cross(c - b).dot(surface.frame(surface.project(b)).normal) < 0.0;
		}
	}
	return count;
}

// Every side on a rim before is one after, or several that follow it; there are no others.
inline void expectSameRims(const PolygonMesh& before, const PolygonMesh& after)
{
	std::map<Index, Index> ahead; // along the rim
	for (const auto& [a, b] : rimSides(after))
		EXPECT_TRUE(ahead.emplace(a, b).second);
	for (const auto& [a, b] : rimSides(before)) {
		const Eigen::Vector3d from = before.vertices.col(a), to = before.vertices.col(b);
		for (Index v = a; v != b;) {
			const auto side = ahead.find(v);
			ASSERT_TRUE(side != ahead.end());
			v = side->second;
			ahead.erase(side);
			const Eigen::Vector3d at = after.vertices.col(v);
			EXPECT_NEAR((at - from).norm() + (at - to).norm(), (to - from).norm(), 1e-13);
		}
	}
	EXPECT_TRUE(ahead.empty());
}

// Quads only, of the same surface: its topology, rims, vertices and the side its faces show.
inline void expectQuadsOf(
	const PolygonMesh&       before,
	const std::vector<char>& marksBefore,
	const PolygonMesh&       after,
	const std::vector<char>& marksAfter)
{
	const MeshTopology a = topologyOf(before), b = topologyOf(after);
	EXPECT_EQ(b.quads, b.faces);
	EXPECT_EQ(b.eulerCharacteristic, a.eulerCharacteristic);
	EXPECT_EQ(b.components, a.components);
	EXPECT_EQ(b.boundaryLoops, a.boundaryLoops);
	EXPECT_EQ(b.nonmanifoldEdges + b.nonmanifoldVertices, 0);
	EXPECT_EQ(b.vertices, after.vertexCount());
	ASSERT_EQ(static_cast<Index>(marksAfter.size()), after.vertexCount());
	ASSERT_GE(after.vertexCount(), before.vertexCount());
	EXPECT_EQ(after.vertices.leftCols(before.vertexCount()), before.vertices);
	EXPECT_EQ(after.normals.leftCols(before.vertexCount()), before.normals);
	EXPECT_TRUE(std::equal(marksBefore.begin(), marksBefore.end(), marksAfter.begin()));
	expectSameRims(before, after);

	std::set<VertexLoop> faces;
	for (VertexLoop loop : faceLoopsOf(after)) {
		std::sort(loop.begin(), loop.end());
		EXPECT_TRUE(std::adjacent_find(loop.begin(), loop.end()) == loop.end());
		EXPECT_TRUE(faces.insert(loop).second) << "a face twice";
	}
	const VertexLoop  valence = edgesAtVertices(after);
	std::vector<char> onRim(after.vertexCount(), 0);
	for (const auto& [from, to] : rimSides(after))
		onRim[from] = onRim[to] = 1;
	for (Index v = 0; v < after.vertexCount(); ++v)
		EXPECT_GE(valence[v], onRim[v] ? 2 : 3);
}

} // namespace curvature_lines::test
