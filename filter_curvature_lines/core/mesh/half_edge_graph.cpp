// Half-edges around vertices, Euler-preserving reductions and face loops (A09 section 6).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "half_edge_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "point_cloud.h"

namespace curvature_lines {

namespace {

// Edges that meet at more than 155 degrees continue each other. Others form the corner of a face, where two
// lines end together: where lines run across a rim its quads have such corners. By experiment: on a
// helicoid, whose rims do, quads rise from 93 to 100 % by keeping them.
constexpr double straightCosine = -0.9;
// Width of a face of two sides over the distance of its corners, below which it is a sliver. By experiment.
constexpr double sliverWidth = 0.25;

} // namespace

HalfEdgeGraph::HalfEdgeGraph(
	Eigen::Matrix3Xd positions, Eigen::Matrix3Xd normals, std::vector<Edge> edges) :
		m_positions(std::move(positions)), m_normals(std::move(normals)), m_edges(std::move(edges)),
		m_alive(m_edges.size(), 1), m_around(m_positions.cols())
{
	for (Index h = 0; h < 2 * edgeCount(); ++h)
		m_around[origin(h)].push_back(h);
	for (Index v = 0; v < vertexCount(); ++v) {
		const Eigen::Vector3d n = m_normals.col(v);
		const Eigen::Vector3d x = n.unitOrthogonal(), y = n.cross(x);
		const auto            angle = [&](Index h) {
            return std::atan2(tangent(h).dot(y), tangent(h).dot(x));
		};
		std::vector<std::pair<double, Index>> order;
		for (Index h : m_around[v])
			order.emplace_back(angle(h), h);
		std::sort(order.begin(), order.end());
		std::transform(order.begin(), order.end(), m_around[v].begin(), [](const auto& entry) {
			return entry.second;
		});
	}
}

HalfEdgeGraph::HalfEdgeGraph(
	Eigen::Matrix3Xd                positions,
	Eigen::Matrix3Xd                normals,
	std::vector<Edge>               edges,
	std::vector<std::vector<Index>> around,
	std::vector<char>               kept) :
		m_positions(std::move(positions)), m_normals(std::move(normals)), m_edges(std::move(edges)),
		m_alive(m_edges.size(), 1), m_kept(std::move(kept)), m_around(std::move(around))
{
}

bool HalfEdgeGraph::removeEdge(Index edge)
{
	if (!alive(edge))
		return false;
	m_alive[edge] = 0;
	for (const Index h : {2 * edge, 2 * edge + 1}) {
		std::vector<Index>& around = m_around[origin(h)];
		around.erase(std::remove(around.begin(), around.end(), h), around.end());
	}
	return true;
}

bool HalfEdgeGraph::cutDanglingEdges()
{
	bool changed = false;
	for (Index start = 0; start < vertexCount(); ++start) {
		for (Index v = start; m_around[v].size() == 1;) {
			const Index h = m_around[v][0];
			v             = origin(twin(h));
			changed       = removeEdge(h >> 1) || changed;
		}
	}
	return changed;
}

bool HalfEdgeGraph::continuesStraight(Index vertex) const
{
	const Eigen::Vector3d& a = tangent(m_around[vertex][0]);
	const Eigen::Vector3d& b = tangent(m_around[vertex][1]);
	return a.dot(b) <= straightCosine * a.norm() * b.norm();
}

bool HalfEdgeGraph::dissolveDegreeTwo()
{
	bool changed = false;
	for (Index v = 0; v < vertexCount(); ++v) {
		if (m_around[v].size() != 2 || m_around[v][0] >> 1 == m_around[v][1] >> 1)
			continue;
		if (m_kept.empty() ? !continuesStraight(v) : m_kept[v] != 0)
			continue;
		// The first edge grows over the second; its half-edge that left v now leaves the far end.
		const Index grown = m_around[v][0], merged = m_around[v][1];
		const Index end                                 = origin(twin(merged));
		Edge&       edge                                = m_edges[grown >> 1];
		(grown & 1 ? edge.to : edge.from)               = end;
		(grown & 1 ? edge.tangentTo : edge.tangentFrom) = tangent(twin(merged));
		edge.middle                                     = m_positions.col(v);
		edge.middleNormal                               = m_normals.col(v);
		edge.isFeature = edge.isFeature && m_edges[merged >> 1].isFeature;
		std::replace(m_around[end].begin(), m_around[end].end(), twin(merged), grown);
		m_alive[merged >> 1] = 0;
		m_around[v].clear();
		changed = true;
	}
	return changed;
}

// Two lines that run together make slivers; two arcs far apart, as between the poles of a coarse sphere,
// bound a face of their own.
bool HalfEdgeGraph::isThin(Index edgeA, Index edgeB) const
{
	const Edge&  a     = m_edges[edgeA];
	const Edge&  b     = m_edges[edgeB];
	const double width = (a.middle - b.middle).norm();
	const double chord = (m_positions.col(a.from) - m_positions.col(a.to)).norm();
	return width < sliverWidth * chord;
}

bool HalfEdgeGraph::removeDigons()
{
	bool changed = false;
	for (const std::vector<Index>& loop : faceLoops()) {
		if (loop.size() > 2)
			continue;
		const bool live =
			std::all_of(loop.begin(), loop.end(), [&](Index h) { return alive(h >> 1); });
		const Index first = loop[0] >> 1, second = loop.back() >> 1;
		if (!live ||
		    (loop.size() == 2 && (first == second || (m_kept.empty() && !isThin(first, second)))))
			continue;
		const Index gone = m_edges[first].isFeature ? second : first;
		if (!m_edges[gone].isFeature)
			changed = removeEdge(gone) || changed;
	}
	return changed;
}

void HalfEdgeGraph::reduce()
{
	for (bool changed = true; changed;) {
		changed = cutDanglingEdges();
		changed = dissolveDegreeTwo() || changed;
		changed = removeDigons() || changed;
	}
}

Index HalfEdgeGraph::addVertex(const Eigen::Vector3d& position, const Eigen::Vector3d& normal)
{
	const Index v = vertexCount();
	if (v == m_positions.cols()) {
		m_positions.conservativeResize(3, 2 * v + 1);
		m_normals.conservativeResize(3, 2 * v + 1);
	}
	m_positions.col(v) = position;
	m_normals.col(v)   = normal;
	m_around.emplace_back();
	if (!m_kept.empty())
		m_kept.push_back(0);
	return v;
}

void HalfEdgeGraph::splitEdge(Index edge)
{
	const Edge            whole  = m_edges[edge];
	const Index           v      = addVertex(whole.middle, whole.middleNormal);
	const Index           second = edgeCount();
	const Eigen::Vector3d back   = m_positions.col(whole.from) - whole.middle;
	const Eigen::Vector3d on     = m_positions.col(whole.to) - whole.middle;

	Edge first = whole, rest = whole;
	first.to         = v;
	first.tangentTo  = back;
	first.middle     = whole.middle + 0.5 * back;
	rest.from        = v;
	rest.tangentFrom = on;
	rest.middle      = whole.middle + 0.5 * on;
	m_edges[edge]    = first;
	m_edges.push_back(rest);
	m_alive.push_back(1);
	std::vector<Index>& far = m_around[whole.to];
	std::replace(far.begin(), far.end(), 2 * edge + 1, 2 * second + 1);
	m_around[v] = {2 * edge + 1, 2 * second};
}

void HalfEdgeGraph::separateParallelEdges()
{
	std::vector<std::array<Index, 3>> byEnds;
	for (Index e = 0; e < edgeCount(); ++e)
		if (alive(e))
			byEnds.push_back(
				{std::min(edge(e).from, edge(e).to), std::max(edge(e).from, edge(e).to), e});
	std::sort(byEnds.begin(), byEnds.end());
	for (std::size_t i = 0; i < byEnds.size(); ++i) {
		const auto [low, high, e] = byEnds[i];
		const bool loop           = low == high;
		const bool parallel       = i > 0 && byEnds[i - 1][0] == low && byEnds[i - 1][1] == high;
		if (loop || parallel)
			splitEdge(e);
		if (loop)
			splitEdge(edgeCount() - 1);
	}
	m_positions.conservativeResize(3, vertexCount());
	m_normals.conservativeResize(3, vertexCount());
}

std::vector<std::vector<Index>> HalfEdgeGraph::faceLoops() const
{
	std::vector<Index> clockwiseNext(2 * m_edges.size(), -1);
	for (const std::vector<Index>& around : m_around)
		for (std::size_t k = 0; k < around.size(); ++k)
			clockwiseNext[around[(k + 1) % around.size()]] = around[k];

	std::vector<std::vector<Index>> loops;
	std::vector<char>               visited(clockwiseNext.size(), 0);
	for (Index start = 0; start < 2 * edgeCount(); ++start) {
		if (!alive(start >> 1) || visited[start])
			continue;
		loops.emplace_back();
		for (Index h = start; !visited[h]; h = clockwiseNext[twin(h)]) {
			visited[h] = 1;
			loops.back().push_back(h);
		}
	}
	return loops;
}

Index HalfEdgeGraph::eulerCharacteristic() const
{
	const auto used = std::count_if(
		m_around.begin(), m_around.end(), [](const std::vector<Index>& a) { return !a.empty(); });
	const auto edges = std::count(m_alive.begin(), m_alive.end(), 1);
	return static_cast<Index>(used - edges + static_cast<std::ptrdiff_t>(faceLoops().size()));
}

} // namespace curvature_lines
