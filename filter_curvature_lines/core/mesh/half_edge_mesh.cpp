// Half-edges around vertices, Euler-preserving reductions and face loops (A09 section 6), and an
// independent count of what a polygon mesh is.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "half_edge_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include <Eigen/Geometry>

#include "disjoint_sets.h"

namespace curvature_lines {

namespace {

// Edges that meet at more than 155 degrees continue each other. Others form the corner of a face,
// where two lines end together: along a rim, that is where the quads are.
constexpr double StraightCosine = -0.9;

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

} // namespace

MeshTopology topologyOf(const PolygonMesh& mesh)
{
	MeshTopology result;
	result.faces                       = mesh.faceCount();
	const std::vector<Index>& vertexOf = mesh.faces.indices;
	const Index               corners  = static_cast<Index>(vertexOf.size());
	const std::vector<Index>  next     = nextCorners(mesh.faces);

	DisjointSets      components(mesh.vertexCount());
	std::vector<char> used(mesh.vertexCount(), 0), tangled(mesh.vertexCount(), 0);
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

	// Corners of a vertex that share a side belong to one fan; a rim is followed from fan to fan.
	DisjointSets                fans(corners);
	std::vector<FaceSide>       rim;
	const std::vector<FaceSide> sides = sortedSides(mesh);
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
	for (Index c = 0; c < corners; ++c)
		fanCount[vertexOf[c]] += fans.find(c) == c;
	for (Index v = 0; v < mesh.vertexCount(); ++v) {
		result.vertices += used[v];
		result.components += used[v] && components.find(v) == v;
		result.nonmanifoldVertices += fanCount[v] > 1 || tangled[v];
	}

	result.boundaryEdges = static_cast<Index>(rim.size());
	DisjointSets       loops(result.boundaryEdges);
	std::vector<Index> rimOfFan(corners, -1);
	for (Index e = 0; e < result.boundaryEdges; ++e) {
		for (const Index corner : {rim[e].corner, next[rim[e].corner]}) {
			Index& other = rimOfFan[fans.find(corner)];
			if (other >= 0)
				loops.join(e, other);
			other = e;
		}
	}
	for (Index e = 0; e < result.boundaryEdges; ++e)
		result.boundaryLoops += loops.find(e) == e;

	result.eulerCharacteristic = result.vertices - result.edges + result.faces;
	return result;
}

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
	return a.dot(b) <= StraightCosine * a.norm() * b.norm();
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

// Two lines that run together make slivers; two arcs far apart, as between the poles of a coarse
// sphere, bound a face of their own.
bool HalfEdgeGraph::isThin(Index edgeA, Index edgeB) const
{
	const Edge&  a     = m_edges[edgeA];
	const Edge&  b     = m_edges[edgeB];
	const double width = (a.middle - b.middle).norm();
	const double chord = (m_positions.col(a.from) - m_positions.col(a.to)).norm();
	return width < 0.25 * chord;
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
