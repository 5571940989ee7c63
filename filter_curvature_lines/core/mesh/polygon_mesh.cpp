// Sides of faces sorted so that those of one edge follow each other, and what that tells about the mesh.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "polygon_mesh.h"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <vector>

#include <Eigen/Core>

#include "disjoint_sets.h"
#include "point_cloud.h"

namespace curvature_lines {

namespace {

// One side of a face, named so that both faces of an edge sort together.
struct FaceSide {
	Index low, high, corner; // corner: position in mesh.faces.indices of the side's first vertex
	bool  forward;           // from low to high
	bool sameEdge(const FaceSide& o) const { return low == o.low && high == o.high; }
};

std::vector<FaceSide> sortedSides(const PolygonMesh& mesh)
{
	std::vector<FaceSide> sides;
	sides.reserve(mesh.faces.indices.size());
	for (Index f = 0; f < mesh.faceCount(); ++f) {
		const NeighborLists::Row face = mesh.faces[f];
		for (Index k = 0; k < face.size(); ++k) {
			const Index a = face[k], b = face[(k + 1) % face.size()];
			sides.push_back({std::min(a, b), std::max(a, b), mesh.faces.offsets[f] + k, a < b});
		}
	}
	std::sort(sides.begin(), sides.end(), [](const FaceSide& a, const FaceSide& b) {
		return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
	});
	return sides;
}

std::vector<Index> nextCorners(const NeighborLists& faces)
{
	std::vector<Index> next(faces.indices.size());
	for (Index f = 0; f < faces.size(); ++f)
		for (Index c = faces.offsets[f]; c < faces.offsets[f + 1]; ++c)
			next[c] = c + 1 == faces.offsets[f + 1] ? faces.offsets[f] : c + 1;
	return next;
}

// Used vertices, faces by their number of sides, components.
void countFaces(const PolygonMesh& mesh, MeshTopology& result)
{
	result.faces = mesh.faceCount();
	DisjointSets      components(mesh.vertexCount());
	std::vector<char> used(mesh.vertexCount(), 0);
	for (Index f = 0; f < result.faces; ++f) {
		const Index sides = mesh.faces[f].size();
		result.triangles += sides == 3;
		result.quads += sides == 4;
		result.largestFace = std::max(result.largestFace, sides);
		for (Index v : mesh.faces[f]) {
			used[v] = 1;
			components.join(mesh.faces[f][0], v);
		}
	}
	for (Index v = 0; v < mesh.vertexCount(); ++v) {
		result.vertices += used[v];
		result.components += used[v] && components.find(v) == v;
	}
}

// Edges by the faces on them, and vertices by the fans of faces around them. Corners of a vertex that share
// a side belong to one fan. Returns the sides on rims.
std::vector<FaceSide> countEdges(const PolygonMesh& mesh, DisjointSets& fans, MeshTopology& result)
{
	const std::vector<Index>&   vertexOf = mesh.faces.indices;
	const std::vector<Index>    next     = nextCorners(mesh.faces);
	const std::vector<FaceSide> sides    = sortedSides(mesh);
	std::vector<char>           tangled(mesh.vertexCount(), 0); // at an edge that is not manifold
	std::vector<FaceSide>       rim;
	for (std::size_t i = 0, j; i < sides.size(); i = j) {
		for (j = i + 1; j < sides.size() && sides[j].sameEdge(sides[i]); ++j) {
			for (const Index v : {sides[i].low, sides[i].high}) {
				const auto cornerAt = [&](const FaceSide& s) {
					return vertexOf[s.corner] == v ? s.corner : next[s.corner];
				};
				fans.join(cornerAt(sides[i]), cornerAt(sides[j]));
			}
		}
		++result.edges;
		const bool loop = sides[i].low == sides[i].high;
		const bool manifold =
			j - i == 1 || (j - i == 2 && sides[i].forward != sides[i + 1].forward);
		if (loop || !manifold) {
			++result.nonmanifoldEdges;
			tangled[sides[i].low] = tangled[sides[i].high] = 1;
		}
		if (j - i == 1)
			rim.push_back(sides[i]);
	}
	std::vector<Index> fanCount(mesh.vertexCount(), 0);
	for (Index c = 0; c < static_cast<Index>(vertexOf.size()); ++c)
		fanCount[vertexOf[c]] += fans.find(c) == c;
	for (Index v = 0; v < mesh.vertexCount(); ++v)
		result.nonmanifoldVertices += fanCount[v] > 1 || tangled[v];
	return rim;
}

// A rim is followed from fan to fan.
Index countLoops(const PolygonMesh& mesh, const std::vector<FaceSide>& rim, DisjointSets& fans)
{
	const std::vector<Index> next = nextCorners(mesh.faces);
	DisjointSets             loops(static_cast<Index>(rim.size()));
	std::vector<Index>       rimOfFan(next.size(), -1);
	for (Index e = 0; e < static_cast<Index>(rim.size()); ++e) {
		for (const Index corner : {rim[e].corner, next[rim[e].corner]}) {
			Index& other = rimOfFan[fans.find(corner)];
			if (other >= 0)
				loops.join(e, other);
			other = e;
		}
	}
	Index count = 0;
	for (Index e = 0; e < static_cast<Index>(rim.size()); ++e)
		count += loops.find(e) == e;
	return count;
}

} // namespace

Eigen::Matrix3Xd asColumns(const std::vector<Eigen::Vector3d>& vectors)
{
	Eigen::Matrix3Xd columns(3, vectors.size());
	for (std::size_t k = 0; k < vectors.size(); ++k)
		columns.col(k) = vectors[k];
	return columns;
}

PolygonMesh polygonMesh(
	const std::vector<Eigen::Vector3d>&    vertices,
	const std::vector<Eigen::Vector3d>&    normals,
	const std::vector<std::vector<Index>>& faces)
{
	return {asColumns(vertices), asColumns(normals), NeighborLists::fromRows(faces)};
}

std::vector<std::vector<Index>> faceLoopsOf(const PolygonMesh& mesh)
{
	std::vector<std::vector<Index>> faces;
	faces.reserve(mesh.faceCount());
	for (Index f = 0; f < mesh.faceCount(); ++f)
		faces.emplace_back(mesh.faces[f].begin(), mesh.faces[f].end());
	return faces;
}

MeshTopology topologyOf(const PolygonMesh& mesh)
{
	MeshTopology result;
	countFaces(mesh, result);
	DisjointSets                fans(static_cast<Index>(mesh.faces.indices.size()));
	const std::vector<FaceSide> rim = countEdges(mesh, fans, result);
	result.boundaryEdges            = static_cast<Index>(rim.size());
	result.boundaryLoops            = countLoops(mesh, rim, fans);
	result.eulerCharacteristic      = result.vertices - result.edges + result.faces;
	return result;
}

} // namespace curvature_lines
