// Edges, rims, components and weights of a triangulated surface.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "triangle_mesh.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <unordered_set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "disjoint_sets.h"
#include "point_cloud.h"

namespace curvature_lines {

namespace {

// Bounds of the weights of differences along edges: the matrices stay positive definite at obtuse triangles
// and of moderate condition at slivers. Not varied.
constexpr double leastCotangent = 0.05, largestCotangent = 3.0;

// One side of a triangle.
struct Side {
	Index from, to, triangle;
	int   corner;
	Index low() const { return std::min(from, to); }
	Index high() const { return std::max(from, to); }
	// Of the edge: the lower vertex, then the higher.
	std::uint64_t edge() const
	{
		return (static_cast<std::uint64_t>(low()) << 32) | static_cast<std::uint32_t>(high());
	}
};

// By edge, then by triangle. Sides of one lower vertex are collected first: few are left to sort.
std::vector<Side> sortedSides(const std::vector<Triangle>& triangles)
{
	Index vertices = 0;
	for (const Triangle& t : triangles)
		vertices = std::max(vertices, 1 + *std::max_element(t.begin(), t.end()));
	std::vector<Index> first(vertices + 1, 0); // place of the next side of every lower vertex
	const auto         forEachSide = [&](const auto& visit) {
        for (std::size_t t = 0; t < triangles.size(); ++t)
            for (int c = 0; c < 3; ++c)
                visit(Side{triangles[t][c], triangles[t][(c + 1) % 3], static_cast<Index>(t), c});
	};
	forEachSide([&](const Side& side) { ++first[side.low() + 1]; });
	std::partial_sum(first.begin(), first.end(), first.begin());
	std::vector<Side> sides(3 * triangles.size());
	forEachSide([&](const Side& side) { sides[first[side.low()]++] = side; });
	for (Index v = 0, begin = 0; v < vertices; begin = first[v++])
		std::sort(
			sides.begin() + begin, sides.begin() + first[v], [](const Side& a, const Side& b) {
				return a.high() != b.high() ? a.high() < b.high() : a.triangle < b.triangle;
			});
	return sides;
}

bool sameEdge(const Side& a, const Side& b)
{
	return a.edge() == b.edge();
}

} // namespace

std::vector<Triangle>
manifoldPart(const std::vector<Triangle>& triangles, Index vertexCount, std::vector<Index>& copyOf)
{
	const auto key = [](Index a, Index b) {
		return (static_cast<std::uint64_t>(a) << 32) | static_cast<std::uint32_t>(b);
	};
	std::unordered_set<std::uint64_t> used; // directed sides
	std::vector<Triangle>             kept;
	for (const Triangle& t : triangles) {
		bool fits = t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
		for (int c = 0; c < 3 && fits; ++c)
			fits = used.count(key(t[c], t[(c + 1) % 3])) == 0;
		if (!fits)
			continue;
		for (int c = 0; c < 3; ++c)
			used.insert(key(t[c], t[(c + 1) % 3]));
		kept.push_back(t);
	}

	// Corners of a vertex are of one fan when their triangles share a side at it.
	DisjointSets            fans(static_cast<Index>(3 * kept.size()));
	const std::vector<Side> sides = sortedSides(kept);
	for (std::size_t k = 1; k < sides.size(); ++k) {
		const Side &a = sides[k - 1], &b = sides[k];
		if (!sameEdge(a, b))
			continue;
		fans.join(3 * a.triangle + a.corner, 3 * b.triangle + (b.corner + 1) % 3);
		fans.join(3 * a.triangle + (a.corner + 1) % 3, 3 * b.triangle + b.corner);
	}
	std::vector<Index> fanOf(vertexCount, -1), nameOf(3 * kept.size(), -1);
	for (std::size_t t = 0; t < kept.size(); ++t) {
		for (int c = 0; c < 3; ++c) {
			const Index fan = fans.find(static_cast<Index>(3 * t + c)), v = kept[t][c];
			if (nameOf[fan] < 0) {
				if (fanOf[v] < 0) {
					fanOf[v]    = fan;
					nameOf[fan] = v;
				}
				else {
					nameOf[fan] = vertexCount + static_cast<Index>(copyOf.size());
					copyOf.push_back(v);
				}
			}
			kept[t][c] = nameOf[fan];
		}
	}
	return kept;
}

TriangleMesh::TriangleMesh(Eigen::Matrix3Xd positions, std::vector<Triangle> triangles) :
		vertices(std::move(positions)), m_triangles(std::move(triangles)),
		m_sides(m_triangles.size())
{
	for (const Side& side : sortedSides(m_triangles)) {
		if (m_edges.empty() || m_edges.back().from != side.low() ||
		    m_edges.back().to != side.high())
			m_edges.push_back({side.low(), side.high()});
		Edge& edge                                     = m_edges.back();
		(side.from < side.to ? edge.left : edge.right) = side.triangle;
		m_sides[side.triangle][side.corner]            = edgeCount() - 1;
	}
}

Index TriangleMesh::edgeBetween(Index a, Index b) const
{
	const Edge wanted{std::min(a, b), std::max(a, b)};
	const auto found =
		std::lower_bound(m_edges.begin(), m_edges.end(), wanted, [](const Edge& x, const Edge& y) {
			return std::tie(x.from, x.to) < std::tie(y.from, y.to);
		});
	const bool exists =
		found != m_edges.end() && found->from == wanted.from && found->to == wanted.to;
	return exists ? static_cast<Index>(found - m_edges.begin()) : -1;
}

Eigen::Vector3d TriangleMesh::areaVector(Index triangle) const
{
	const Triangle&       t = m_triangles[triangle];
	const Eigen::Vector3d a = vertices.col(t[0]);
	return 0.5 * (vertices.col(t[1]) - a).cross(vertices.col(t[2]) - a);
}

Eigen::VectorXd TriangleMesh::vertexAreas() const
{
	Eigen::VectorXd areas = Eigen::VectorXd::Zero(vertexCount());
	for (Index t = 0; t < triangleCount(); ++t) {
		const double third = areaVector(t).norm() / 3.0;
		for (const Index v : m_triangles[t])
			areas[v] += third;
	}
	return areas;
}

Eigen::Matrix3Xd TriangleMesh::vertexNormals() const
{
	Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, vertexCount());
	for (Index t = 0; t < triangleCount(); ++t) {
		const Eigen::Vector3d area = areaVector(t);
		for (const Index v : m_triangles[t])
			normals.col(v) += area;
	}
	for (Index v = 0; v < vertexCount(); ++v) {
		const double length = normals.col(v).norm();
		normals.col(v) =
			length > 0.0 ? Eigen::Vector3d(normals.col(v) / length) : Eigen::Vector3d::UnitZ();
	}
	return normals;
}

Eigen::VectorXd TriangleMesh::cotangentWeights() const
{
	Eigen::VectorXd weights = Eigen::VectorXd::Zero(edgeCount());
	for (Index t = 0; t < triangleCount(); ++t) {
		const double doubleArea = 2.0 * areaVector(t).norm() + 1e-300;
		for (int c = 0; c < 3; ++c) {
			const Eigen::Vector3d apex = vertices.col(m_triangles[t][(c + 2) % 3]);
			const Eigen::Vector3d a    = vertices.col(m_triangles[t][c]),
								  b    = vertices.col(m_triangles[t][(c + 1) % 3]);
			weights[edgeOf(t, c)] += 0.5 * (a - apex).dot(b - apex) / doubleArea;
		}
	}
	return weights.cwiseMax(leastCotangent).cwiseMin(largestCotangent);
}

std::vector<std::vector<Index>> TriangleMesh::rims() const
{
	std::vector<Index> ahead(vertexCount(), -1);
	for (const Edge& edge : m_edges)
		if (edge.left < 0)
			ahead[edge.to] = edge.from;
		else if (edge.right < 0)
			ahead[edge.from] = edge.to;
	std::vector<std::vector<Index>> loops;
	for (Index start = 0; start < vertexCount(); ++start) {
		if (ahead[start] < 0)
			continue;
		loops.emplace_back();
		for (Index v = start; ahead[v] >= 0;) {
			loops.back().push_back(v);
			v = std::exchange(ahead[v], -1);
		}
	}
	return loops;
}

std::vector<Index> TriangleMesh::components() const
{
	DisjointSets sets(vertexCount());
	for (const Edge& edge : m_edges)
		sets.join(edge.from, edge.to);
	std::vector<Index> result(vertexCount());
	for (Index v = 0; v < vertexCount(); ++v)
		result[v] = sets.find(v);
	return result;
}

Index TriangleMesh::eulerCharacteristic() const
{
	std::vector<char> used(vertexCount(), 0);
	for (const Edge& edge : m_edges)
		used[edge.from] = used[edge.to] = 1;
	const auto count = static_cast<Index>(std::count(used.begin(), used.end(), char(1)));
	return count - edgeCount() + triangleCount();
}

} // namespace curvature_lines
