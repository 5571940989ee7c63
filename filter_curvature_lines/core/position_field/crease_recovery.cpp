// Missing points split the nearest triangle in three; flips walk from one end of a missing edge to the other.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "crease_recovery.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "point_cloud.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;
using Pair = std::pair<Index, Index>;

// Edges flipped to bring in one crease edge. By experiment.
constexpr int mostFlips = 6;

Pair unordered(Index a, Index b)
{
	return {std::min(a, b), std::max(a, b)};
}

double distanceTo(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c)
{
	const auto toSegment = [&](const Vector3d& from, const Vector3d& to) {
		const Vector3d d = to - from;
		const double   t = std::clamp((p - from).dot(d) / (d.squaredNorm() + 1e-300), 0.0, 1.0);
		return (p - from - t * d).norm();
	};
	const Vector3d n  = (b - a).cross(c - a);
	const bool inside = (b - a).cross(p - a).dot(n) >= 0.0 && (c - b).cross(p - b).dot(n) >= 0.0 &&
	                    (a - c).cross(p - c).dot(n) >= 0.0;
	if (inside && n.norm() > 0.0)
		return std::abs((p - a).dot(n.normalized()));
	return std::min({toSegment(a, b), toSegment(b, c), toSegment(c, a)});
}

void insertMissing(
	const Eigen::Matrix3Xd&  points,
	const std::vector<Pair>& wanted,
	std::vector<Triangle>&   triangles)
{
	std::vector<char> used(points.cols(), 0);
	for (const Triangle& t : triangles)
		for (const Index v : t)
			used[v] = 1;
	const auto insert = [&](Index v) {
		if (used[v])
			return;
		used[v]             = 1;
		std::size_t nearest = 0;
		double      least   = std::numeric_limits<double>::infinity();
		for (std::size_t k = 0; k < triangles.size(); ++k) {
			const Triangle& t = triangles[k];
			const double    d =
				distanceTo(points.col(v), points.col(t[0]), points.col(t[1]), points.col(t[2]));
			if (d < least) {
				least   = d;
				nearest = k;
			}
		}
		const Triangle t   = triangles[nearest];
		triangles[nearest] = {t[0], t[1], v};
		triangles.push_back({t[1], t[2], v});
		triangles.push_back({t[2], t[0], v});
	};
	// From where the crease is known outwards.
	bool found = !triangles.empty();
	while (found) {
		found = false;
		for (const auto& [a, b] : wanted) {
			if (used[a] == used[b])
				continue;
			insert(used[a] ? b : a);
			found = true;
		}
	}
}

// Flips the edge opposite a that b lies behind, until a and b are joined. Returns whether they are.
bool joinByFlips(
	const Eigen::Matrix3Xd& points,
	Index                   a,
	Index                   b,
	const std::set<Pair>&   wanted,
	std::vector<Triangle>&  triangles)
{
	for (int flip = 0; flip < mostFlips; ++flip) {
		const TriangleMesh mesh(points, triangles);
		if (mesh.edgeBetween(a, b) >= 0)
			return true;
		Index  towards = -1;
		double best    = 0.0;
		for (Index t = 0; t < mesh.triangleCount(); ++t)
			for (int c = 0; c < 3; ++c) {
				if (triangles[t][c] != a)
					continue;
				const Vector3d middle = 0.5 * (points.col(triangles[t][(c + 1) % 3]) +
				                               points.col(triangles[t][(c + 2) % 3]));
				const double   cosine = (middle - points.col(a))
				                          .normalized()
				                          .dot((points.col(b) - points.col(a)).normalized());
				if (cosine > best) {
					best    = cosine;
					towards = mesh.edgeOf(t, (c + 1) % 3);
				}
			}
		if (towards < 0)
			return false;
		const TriangleMesh::Edge edge = mesh.edges()[towards];
		if (edge.isRim() || wanted.count({edge.from, edge.to}))
			return false;
		const auto apexOf = [&](Index t) {
			const Triangle& corners = triangles[t];
			return *std::find_if(corners.begin(), corners.end(), [&](Index v) {
				return v != edge.from && v != edge.to;
			});
		};
		const Index left = apexOf(edge.left), right = apexOf(edge.right);
		if (mesh.edgeBetween(left, right) >= 0)
			return false;
		triangles[edge.left]  = {left, edge.from, right};
		triangles[edge.right] = {right, edge.to, left};
	}
	return TriangleMesh(points, triangles).edgeBetween(a, b) >= 0;
}

} // namespace

void recoverCreaseEdges(
	const Eigen::Matrix3Xd&                     points,
	const std::vector<std::pair<Index, Index>>& wanted,
	std::vector<Triangle>&                      triangles)
{
	if (wanted.empty())
		return;
	insertMissing(points, wanted, triangles);
	std::set<Pair> edges;
	for (const auto& [a, b] : wanted)
		edges.insert(unordered(a, b));
	const TriangleMesh mesh(points, triangles);
	for (const auto& [a, b] : edges) {
		if (mesh.edgeBetween(a, b) >= 0)
			continue;
		std::vector<Triangle> flipped = triangles;
		bool                  joined  = joinByFlips(points, a, b, edges, flipped);
		if (!joined) {
			flipped = triangles;
			joined  = joinByFlips(points, b, a, edges, flipped);
		}
		if (joined)
			triangles = std::move(flipped);
	}
}

} // namespace curvature_lines
