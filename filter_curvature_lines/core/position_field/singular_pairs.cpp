// Distances over triangles, in cells of the mesh.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "singular_pairs.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "cross_field.h"
#include "point_cloud.h"
#include "scaffold.h"
#include "shortest_paths.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// Guides of rims and creases are heavier; they are not noise.
constexpr double heaviestNoise = 100.0;
constexpr double sameCost      = 1e-9;
// Of moving apart: what a cell of the way costs in cells of room, the least gain, and rounds. By experiment.
constexpr double travelCost = 0.3, leastGain = 0.1;
constexpr int    spreadRounds = 3;

Vector3d centreOf(const TriangleMesh& mesh, Index t)
{
	return mesh.vertices(Eigen::all, mesh.triangles()[t]).rowwise().mean();
}

// Shortest ways from a triangle to others that do not cross creases.
class DualDistances {
public:
	explicit DualDistances(const Scaffold& scaffold) : m_scaffold(scaffold)
	{
		const TriangleMesh&    mesh = scaffold.mesh;
		const Eigen::VectorXd& size = scaffold.size.size() > 0 ? scaffold.size : scaffold.spacing;
		m_half.resize(mesh.triangleCount());
		for (Index t = 0; t < mesh.triangleCount(); ++t) {
			const Triangle& corners = mesh.triangles()[t];
			const Vector3d  centre  = mesh.vertices(Eigen::all, corners).rowwise().mean();
			const double    cell    = size(corners).mean();
			for (int c = 0; c < 3; ++c) {
				const Index e = mesh.edgeOf(t, c);
				m_half[t][c] =
					(mesh.vertices.col(mesh.edges()[e].from) + 0.5 * mesh.along(e) - centre)
						.norm() /
					cell;
			}
		}
	}

	// Visits triangles by increasing distance, the start among them, until `visit` says so or `longest` is reached. Returns
	// the one at which it stopped, -1: none.
	template<class Visit>
	Index from(Index start, double longest, const Visit& visit)
	{
		const TriangleMesh& mesh = m_scaffold.mesh;
		m_paths.start(mesh.triangleCount());
		m_paths.reach(start, 0.0, -1);
		while (m_paths.isOpen()) {
			const auto [distance, t] = m_paths.nearest();
			if (!m_paths.take())
				continue;
			if (distance > longest)
				break;
			if (visit(t, distance))
				return t;
			for (int c = 0; c < 3; ++c) {
				const Index e    = mesh.edgeOf(t, c);
				const auto& edge = mesh.edges()[e];
				const Index next = edge.left == t ? edge.right : edge.left;
				if (next < 0 || m_scaffold.creaseEdge[e])
					continue;
				int d = 0;
				while (mesh.edgeOf(next, d) != e)
					++d;
				m_paths.reach(next, distance + m_half[t][c] + m_half[next][d], t);
			}
		}
		return -1;
	}

	double distance(Index t) const { return m_paths.cost(t); }
	// Of the last run: triangles from `t` back to the start.
	std::vector<Index> wayBack(Index t) const
	{
		std::vector<Index> way;
		for (; t >= 0; t = m_paths.before(t))
			way.push_back(t);
		return way;
	}

private:
	const Scaffold&                    m_scaffold;
	std::vector<std::array<double, 3>> m_half; // per triangle and side: of its centre, in cells
	ShortestPaths                      m_paths;
};

// Vertices around pairs of singular points of different indices; of each pair once.
std::vector<char> aroundPairs(
	const Scaffold&            scaffold,
	const CrossField&          field,
	const SingularPairOptions& options,
	DualDistances&             distances)
{
	const TriangleMesh& mesh = scaffold.mesh;
	std::vector<char>   near(mesh.vertexCount(), 0);
	for (const Index a : singularTriangles(field)) {
		const Index b = distances.from(a, options.near, [&](Index t, double) {
			return field.index[t] != 0 && field.index[t] != field.index[a];
		});
		if (b < 0)
			continue;
		const double             distance = distances.distance(b);
		const std::vector<Index> way      = distances.wayBack(b);
		const Index              middle   = *std::find_if(way.begin(), way.end(), [&](Index t) {
            return distances.distance(t) <= 0.5 * distance;
        });
		distances.from(middle, 0.5 * distance + options.margin, [&](Index t, double) {
			for (const Index v : mesh.triangles()[t])
				near[v] = 1;
			return false;
		});
	}
	return near;
}

// The singular point whose index makes up for that of `a`, if it is the first that is met. Two of index 2 do not: either
// may be a half turn one way or the other, and where the surface is bent sharply, as at tips, both are the same.
Index partnerOf(Index a, const CrossField& field, double longest, DualDistances& distances)
{
	const Index b =
		distances.from(a, longest, [&](Index t, double) { return t != a && field.index[t] != 0; });
	return b >= 0 && field.index[a] + field.index[b] == 4 && field.index[a] != 2 ? b : -1;
}

// Carries the index of the first triangle of a way to its last one.
void carry(const TriangleMesh& mesh, const std::vector<Index>& way, CrossField& field)
{
	const int index = field.index[way.front()];
	for (std::size_t k = 0; k + 1 < way.size(); ++k)
		for (int c = 0; c < 3; ++c) {
			const Index e    = mesh.edgeOf(way[k], c);
			const auto& edge = mesh.edges()[e];
			if ((edge.left == way[k] ? edge.right : edge.left) != way[k + 1])
				continue;
			const int change = edge.left == way[k] ? -index : index;
			field.turns[e]   = static_cast<std::uint8_t>((field.turns[e] + change) & 3);
			break;
		}
	field.index[way.back()]  = static_cast<std::uint8_t>((field.index[way.back()] + index) & 3);
	field.index[way.front()] = 0;
}

} // namespace

CrossField
calmCrossField(const Scaffold& scaffold, DirectionGuide& guide, const SingularPairOptions& options)
{
	CrossField    field = smoothCrossField(scaffold.mesh, guide);
	DualDistances distances(scaffold);
	for (int round = 0; round < options.rounds; ++round) {
		const std::vector<char> near    = aroundPairs(scaffold, field, options, distances);
		bool                    changed = false;
		for (std::size_t v = 0; v < near.size(); ++v) {
			double& weight = guide.weights[static_cast<Index>(v)];
			if (!near[v] || !(weight > 0.0) || weight > heaviestNoise)
				continue;
			weight *= options.fade;
			changed = true;
		}
		if (!changed)
			break;
		field = smoothCrossField(scaffold.mesh, guide);
	}
	return field;
}

Index joinSingularPairs(
	const Scaffold& scaffold, CrossField& field, const SingularPairOptions& options)
{
	DualDistances distances(scaffold);
	using Candidate = std::pair<double, Index>; // distance of the partner, triangle
	std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> candidates;
	for (const Index a : singularTriangles(field))
		candidates.emplace(0.0, a);
	Index joined = 0;
	while (!candidates.empty()) {
		const auto [known, a] = candidates.top();
		candidates.pop();
		if (field.index[a] == 0)
			continue;
		const Index b = partnerOf(a, field, options.joined, distances);
		if (b < 0)
			continue;
		if (distances.distance(b) > known + sameCost) {
			candidates.emplace(distances.distance(b), a);
			continue;
		}
		std::vector<Index> way = distances.wayBack(b);
		std::reverse(way.begin(), way.end());
		carry(scaffold.mesh, way, field);
		++joined;
	}
	return joined;
}

Index spreadSingularPoints(
	const Scaffold& scaffold, CrossField& field, const SingularPairOptions& options)
{
	const TriangleMesh&    mesh = scaffold.mesh;
	const Eigen::VectorXd& size = scaffold.size.size() > 0 ? scaffold.size : scaffold.spacing;
	DualDistances          distances(scaffold);
	Index                  moved = 0;
	for (int round = 0; round < spreadRounds; ++round) {
		const Index before = moved;
		for (const Index a : singularTriangles(field)) {
			// Those around, as far as they matter wherever the point may move.
			std::vector<Index> others;
			double             nearest = options.apart;
			distances.from(a, 2.0 * options.apart, [&](Index t, double distance) {
				if (t != a && field.index[t] != 0) {
					others.push_back(t);
					nearest = std::min(nearest, distance);
				}
				return false;
			});
			if (nearest >= options.apart)
				continue;
			const auto room = [&](Index t) {
				double least = options.apart;
				for (const Index other : others)
					least = std::min(
						least,
						(centreOf(mesh, t) - centreOf(mesh, other)).norm() /
							size[mesh.triangles()[t][0]]);
				return least;
			};
			double best   = room(a) + leastGain;
			Index  target = -1;
			distances.from(a, options.apart, [&](Index t, double distance) {
				const double value = room(t) - travelCost * distance;
				if (field.index[t] == 0 && value > best) {
					best   = value;
					target = t;
				}
				return false;
			});
			if (target < 0)
				continue;
			std::vector<Index> way = distances.wayBack(target);
			std::reverse(way.begin(), way.end());
			carry(mesh, way, field);
			++moved;
		}
		if (moved == before)
			break;
	}
	return moved;
}

} // namespace curvature_lines
