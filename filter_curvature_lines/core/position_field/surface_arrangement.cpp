// From chords to crossings, to an embedded graph, to certified faces.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_arrangement.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "disjoint_sets.h"
#include "half_edge_graph.h"
#include "polygons.h"

namespace curvature_lines {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Where a chord ends on the border of its triangle.
struct BorderPoint {
	Index    node = -1;
	int      rank = 0;                // counter-clockwise around the triangle
	Vector2d at   = Vector2d::Zero(); // barycentric, of corners 1 and 2
};

struct BorderChord {
	BorderPoint a, b;
	// Whether rank r lies on the border that runs counter-clockwise from a to b: right of the chord.
	bool isRight(int r) const
	{
		return a.rank < b.rank ? a.rank < r && r < b.rank : r < b.rank || r > a.rank;
	}
	bool crosses(const BorderChord& o) const { return isRight(o.a.rank) != isRight(o.b.rank); }
	// The end of a crossing chord on the right, counted counter-clockwise from a.
	int orderOf(const BorderChord& o, int ranks) const
	{
		const int r = isRight(o.a.rank) ? o.a.rank : o.b.rank;
		return (r - a.rank + ranks) % ranks;
	}
};

// Where along p the straight chords meet, within (0, 1).
double parameterAlong(const BorderChord& p, const BorderChord& q)
{
	const Vector2d d = p.b.at - p.a.at, e = q.b.at - q.a.at, f = q.a.at - p.a.at;
	const double   det = d.x() * e.y() - d.y() * e.x();
	const double   t   = det != 0.0 ? (f.x() * e.y() - f.y() * e.x()) / det : 0.5;
	return std::isfinite(t) ? std::clamp(t, 0.0, 1.0) : 0.5;
}

class GraphBuilder {
public:
	GraphBuilder(
		const TriangleMesh&       mesh,
		const Eigen::Matrix3Xd&   normals,
		const SurfaceFeatures&    features,
		const SurfaceCurves&      curves,
		const std::vector<Index>& component,
		const std::vector<char>&  filled) :
			// by name of component: all its edges are in the graph
			m_mesh(mesh), m_normals(normals), m_features(features), m_curves(curves),
			m_component(component), m_filled(filled)
	{
		addEdgePoints();
		addChords();
		addMeshEdges();
		finishEdgePoints();
		finishVertices();
	}

	HalfEdgeGraph graph() const
	{
		Eigen::Matrix3Xd positions(3, m_positions.size()), normals(3, m_positions.size());
		for (std::size_t k = 0; k < m_positions.size(); ++k) {
			positions.col(k) = m_positions[k];
			normals.col(k)   = m_nodeNormals[k];
		}
		return {std::move(positions), std::move(normals), m_edges, m_around, m_kept};
	}
	const std::vector<Index>& nodeComponents() const { return m_nodeComponents; }
	const std::vector<char>& removable() const
	{
		return m_removable;
	} // edges only there to be filled
	Index crossings() const { return m_crossings; }

private:
	bool isInGraph(Index e) const
	{
		const auto& edge = m_mesh.edges()[e];
		return edge.isRim() || m_features.edge[e] || m_filled[m_component[edge.from]];
	}

	Index addNode(const Vector3d& position, const Vector3d& normal, Index component)
	{
		m_positions.push_back(position);
		m_nodeNormals.push_back(
			normal.norm() > 0.0 ? normal.normalized() : Vector3d(Vector3d::UnitZ()));
		m_nodeComponents.push_back(component);
		m_around.emplace_back();
		m_kept.push_back(0);
		return static_cast<Index>(m_positions.size()) - 1;
	}

	Index addEdge(Index from, Index to) // its first half-edge
	{
		HalfEdgeGraph::Edge edge;
		edge.from         = from;
		edge.to           = to;
		edge.tangentTo    = m_positions[from] - m_positions[to];
		edge.tangentFrom  = -edge.tangentTo;
		edge.middle       = 0.5 * (m_positions[from] + m_positions[to]);
		edge.middleNormal = (m_nodeNormals[from] + m_nodeNormals[to]).normalized();
		m_edges.push_back(edge);
		m_removable.push_back(0);
		return 2 * static_cast<Index>(m_edges.size()) - 2;
	}

	void addEdgePoints()
	{
		m_firstPoint.push_back(0);
		for (Index e = 0; e < m_mesh.edgeCount(); ++e) {
			const auto& edge = m_mesh.edges()[e];
			for (const EdgePoint& p : m_curves.points[e])
				addNode(
					m_mesh.vertices.col(edge.from) + p.t * m_mesh.along(e),
					(1.0 - p.t) * m_normals.col(edge.from) + p.t * m_normals.col(edge.to),
					m_component[edge.from]);
			m_firstPoint.push_back(static_cast<Index>(m_positions.size()));
		}
		m_chordAt.assign(m_positions.size(), {-1, -1});
	}

	Index nodeOf(const SurfaceCurves::End& end) const { return m_firstPoint[end.edge] + end.point; }

	BorderPoint borderPoint(Index t, const SurfaceCurves::End& end) const
	{
		BorderPoint p;
		p.node   = nodeOf(end);
		int side = 0;
		while (m_mesh.edgeOf(t, side) != end.edge)
			++side;
		const auto count = static_cast<int>(m_curves.points[end.edge].size());
		const bool ahead = m_mesh.isForward(t, side);
		for (int c = 0; c < side; ++c)
			p.rank += static_cast<int>(m_curves.points[m_mesh.edgeOf(t, c)].size());
		p.rank += ahead ? end.point : count - 1 - end.point;
		const double   along     = m_curves.points[end.edge][end.point].t;
		const Vector2d corners[] = {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}};
		const double   s         = ahead ? along : 1.0 - along;
		p.at                     = (1.0 - s) * corners[side] + s * corners[(side + 1) % 3];
		return p;
	}

	void addChords()
	{
		const auto& chords = m_curves.chords;
		for (std::size_t begin = 0, end; begin < chords.size(); begin = end) {
			for (end = begin;
			     end < chords.size() && chords[end].triangle == chords[begin].triangle;)
				++end;
			const Index t = chords[begin].triangle;
			m_local.clear();
			for (std::size_t k = begin; k < end; ++k)
				m_local.push_back({borderPoint(t, chords[k].a), borderPoint(t, chords[k].b)});
			arrangeTriangle(t);
		}
	}

	void arrangeTriangle(Index t)
	{
		const Triangle& corners = m_mesh.triangles()[t];
		int             ranks   = 0;
		for (int c = 0; c < 3; ++c)
			ranks += static_cast<int>(m_curves.points[m_mesh.edgeOf(t, c)].size());
		const auto n = m_local.size();
		// Of every chord: its crossings in order, as (order, node, whether the other one comes from the right).
		struct Crossing {
			int   order;
			Index node;
			bool  first; // of the two chords: owns the order of half-edges
			bool operator<(const Crossing& o) const { return order < o.order; }
		};
		std::vector<std::vector<Crossing>> along(n);
		struct Meeting {
			bool  otherFromRight;
			Index half[4]; // forward, and backward, along the first; the same along the second
		};
		std::vector<Meeting> meetings;
		const Index          firstNode = static_cast<Index>(m_positions.size());
		for (std::size_t p = 0; p < n; ++p) {
			for (std::size_t q = p + 1; q < n; ++q) {
				if (!m_local[p].crosses(m_local[q]))
					continue;
				const double   s        = parameterAlong(m_local[p], m_local[q]);
				const Vector2d at       = (1.0 - s) * m_local[p].a.at + s * m_local[p].b.at;
				Vector3d       position = Vector3d::Zero(), normal = Vector3d::Zero();
				const double   share[] = {1.0 - at.sum(), at.x(), at.y()};
				for (int c = 0; c < 3; ++c) {
					position += share[c] * m_mesh.vertices.col(corners[c]);
					normal += share[c] * m_normals.col(corners[c]);
				}
				const Index node = addNode(position, normal, m_component[corners[0]]);
				meetings.push_back({m_local[p].isRight(m_local[q].a.rank), {-1, -1, -1, -1}});
				along[p].push_back({m_local[p].orderOf(m_local[q], ranks), node, true});
				along[q].push_back({m_local[q].orderOf(m_local[p], ranks), node, false});
				++m_crossings;
			}
		}
		for (std::size_t k = 0; k < n; ++k) {
			std::sort(along[k].begin(), along[k].end());
			Index      last = m_local[k].a.node, back = -1;
			const auto arrive = [&](Index node) {
				const Index h = addEdge(last, node);
				if (back < 0)
					leaveBorder(t, m_local[k].a.node, h);
				else
					meetings[last - firstNode].half[back] = h;
				return h + 1;
			};
			for (const Crossing& crossing : along[k]) {
				const Index twin                                   = arrive(crossing.node);
				const Index slot                                   = crossing.first ? 0 : 2;
				meetings[crossing.node - firstNode].half[slot + 1] = twin;
				last                                               = crossing.node;
				back                                               = slot;
			}
			leaveBorder(t, m_local[k].b.node, arrive(m_local[k].b.node));
		}
		for (std::size_t m = 0; m < meetings.size(); ++m) {
			// Counter-clockwise from forward along the first: what lies to its left comes next.
			const auto& h = meetings[m].half;
			m_around[firstNode + static_cast<Index>(m)] =
				meetings[m].otherFromRight ? std::vector<Index>{h[0], h[2], h[1], h[3]}
										   : std::vector<Index>{h[0], h[3], h[1], h[2]};
		}
	}

	// Half-edge h leaves an edge point into triangle t.
	void leaveBorder(Index t, Index node, Index h)
	{
		const auto e = static_cast<Index>(
						   std::upper_bound(m_firstPoint.begin(), m_firstPoint.end(), node) -
						   m_firstPoint.begin()) -
		               1;
		m_chordAt[node][m_mesh.edges()[e].left == t ? 0 : 1] = h;
	}

	void addMeshEdges()
	{
		m_vertexNode.assign(m_mesh.vertexCount(), -1);
		m_leaving.assign(m_mesh.edgeCount(), {-1, -1});
		m_alongAt.assign(m_chordAt.size(), {-1, -1});
		for (Index e = 0; e < m_mesh.edgeCount(); ++e) {
			if (!isInGraph(e))
				continue;
			const auto& edge = m_mesh.edges()[e];
			for (const Index v : {edge.from, edge.to}) {
				if (m_vertexNode[v] >= 0)
					continue;
				m_vertexNode[v] = addNode(m_mesh.vertices.col(v), m_normals.col(v), m_component[v]);
				m_kept[m_vertexNode[v]] = m_features.corner[v];
			}
			const bool feature = edge.isRim() || m_features.edge[e];
			Index      last    = m_vertexNode[edge.from];
			for (Index p = m_firstPoint[e]; p <= m_firstPoint[e + 1]; ++p) {
				const bool  atEnd        = p == m_firstPoint[e + 1];
				const Index next         = atEnd ? m_vertexNode[edge.to] : p;
				const Index h            = addEdge(last, next);
				m_edges.back().isFeature = feature;
				m_edges.back().outside   = edge.left < 0 ? 0 : edge.right < 0 ? 1 : -1;
				m_removable.back()       = !feature;
				if (p == m_firstPoint[e])
					m_leaving[e][0] = h;
				else
					m_alongAt[last][0] = h;
				if (atEnd)
					m_leaving[e][1] = h + 1;
				else
					m_alongAt[next][1] = h + 1;
				last = next;
			}
		}
	}

	void finishEdgePoints()
	{
		// Counter-clockwise from forward along the edge: its left triangle comes next.
		for (std::size_t node = 0; node < m_chordAt.size(); ++node)
			for (const Index h :
			     {m_alongAt[node][0], m_chordAt[node][0], m_alongAt[node][1], m_chordAt[node][1]})
				if (h >= 0)
					m_around[node].push_back(h);
	}

	void finishVertices()
	{
		// Counter-clockwise around a corner, the edge that begins there is followed by the one that ends there.
		std::vector<std::vector<std::pair<Index, Index>>> follows(m_mesh.vertexCount());
		for (Index t = 0; t < m_mesh.triangleCount(); ++t)
			for (int c = 0; c < 3; ++c)
				if (m_vertexNode[m_mesh.triangles()[t][c]] >= 0)
					follows[m_mesh.triangles()[t][c]].emplace_back(
						m_mesh.edgeOf(t, c), m_mesh.edgeOf(t, (c + 2) % 3));
		for (Index v = 0; v < m_mesh.vertexCount(); ++v) {
			auto& pairs = follows[v];
			if (pairs.empty())
				continue;
			Index first = pairs[0].first;
			for (const auto& pair : pairs) // at a rim the fan has a beginning
				if (m_mesh.edges()[pair.first].isRim() &&
				    std::none_of(pairs.begin(), pairs.end(), [&](const auto& o) {
						return o.second == pair.first;
					}))
					first = pair.first;
			std::vector<Index>& around = m_around[m_vertexNode[v]];
			Index               e      = first;
			do {
				if (isInGraph(e))
					around.push_back(m_leaving[e][m_mesh.edges()[e].from == v ? 0 : 1]);
				const auto next = std::find_if(
					pairs.begin(), pairs.end(), [&](const auto& p) { return p.first == e; });
				e = next == pairs.end() ? first : next->second;
			} while (e != first);
		}
	}

	const TriangleMesh&       m_mesh;
	const Eigen::Matrix3Xd&   m_normals;
	const SurfaceFeatures&    m_features;
	const SurfaceCurves&      m_curves;
	const std::vector<Index>& m_component;
	const std::vector<char>&  m_filled;

	std::vector<Vector3d>            m_positions, m_nodeNormals;
	std::vector<Index>               m_nodeComponents;
	std::vector<HalfEdgeGraph::Edge> m_edges;
	std::vector<std::vector<Index>>  m_around;
	std::vector<char>                m_kept, m_removable;
	Index                            m_crossings = 0;

	std::vector<Index> m_firstPoint; // node of the first point of every edge
	std::vector<std::array<Index, 2>>
		m_chordAt; // of every edge point: half-edges into the left and right
	std::vector<std::array<Index, 2>> m_alongAt; // and forward and backward along the edge
	std::vector<std::array<Index, 2>>
							 m_leaving; // of every edge: half-edges at from and to along it
	std::vector<Index>       m_vertexNode;
	std::vector<BorderChord> m_local; // of one triangle
};

// Deletes removable edges between different faces: what stays joins every face to one disk.
void mergeFaces(HalfEdgeGraph& graph, const std::vector<char>& removable)
{
	const auto         loops = graph.faceLoops();
	std::vector<Index> faceOf(2 * graph.edgeCount(), -1);
	for (std::size_t f = 0; f < loops.size(); ++f)
		for (const Index h : loops[f])
			faceOf[h] = static_cast<Index>(f);
	DisjointSets faces(static_cast<Index>(loops.size()));
	for (Index e = 0; e < graph.edgeCount(); ++e)
		if (removable[e] && faces.join(faceOf[2 * e], faceOf[2 * e + 1]))
			graph.removeEdge(e);
}

bool isOutside(const HalfEdgeGraph& graph, const std::vector<Index>& loop)
{
	return std::any_of(loop.begin(), loop.end(), [&](Index h) { return graph.isOutside(h); });
}

// By name of component: V - E + loops, those outside of rims left out, minus its Euler characteristic. Not 0
// either where there is no graph at all.
std::vector<Index> certificate(
	const TriangleMesh&       mesh,
	const std::vector<Index>& component,
	const HalfEdgeGraph&      graph,
	const std::vector<Index>& nodeComponents)
{
	std::vector<Index> excess(mesh.vertexCount(), 0);
	std::vector<char>  empty(mesh.vertexCount(), 0);
	for (Index v = 0; v < mesh.vertexCount(); ++v) {
		--excess[component[v]];
		empty[component[v]] = 1;
	}
	for (const auto& edge : mesh.edges())
		++excess[component[edge.from]];
	for (const Triangle& t : mesh.triangles())
		--excess[component[t[0]]];
	for (Index v = 0; v < graph.vertexCount(); ++v) {
		if (graph.around(v).empty())
			continue;
		++excess[nodeComponents[v]];
		empty[nodeComponents[v]] = 0;
	}
	for (Index e = 0; e < graph.edgeCount(); ++e)
		if (graph.alive(e))
			--excess[nodeComponents[graph.edge(e).from]];
	for (const auto& loop : graph.faceLoops())
		if (!isOutside(graph, loop))
			++excess[nodeComponents[graph.origin(loop[0])]];
	for (std::size_t c = 0; c < empty.size(); ++c)
		if (empty[c])
			excess[c] = 1;
	return excess;
}

} // namespace

SurfaceArrangement arrangeOnSurface(
	const TriangleMesh&     mesh,
	const Eigen::Matrix3Xd& normals,
	const SurfaceFeatures&  features,
	const SurfaceCurves&    curves)
{
	SurfaceArrangement       result;
	const std::vector<Index> component = mesh.components();
	std::vector<char>        filled(mesh.vertexCount(), 0);

	GraphBuilder builder(mesh, normals, features, curves, component, filled);
	result.crossings    = builder.crossings();
	HalfEdgeGraph graph = builder.graph();
	graph.reduce();
	std::vector<Index> nodeComponents = builder.nodeComponents();
	std::vector<Index> excess         = certificate(mesh, component, graph, nodeComponents);
	if (std::any_of(excess.begin(), excess.end(), [](Index e) { return e != 0; })) {
		std::transform(
			excess.begin(), excess.end(), filled.begin(), [](Index e) { return e != 0; });
		const GraphBuilder whole(mesh, normals, features, curves, component, filled);
		graph = whole.graph();
		mergeFaces(graph, whole.removable());
		graph.reduce();
		nodeComponents = whole.nodeComponents();
		result.repairedComponents =
			static_cast<Index>(std::count(filled.begin(), filled.end(), char(1)));
		excess                = certificate(mesh, component, graph, nodeComponents);
		result.lostComponents = static_cast<Index>(
			std::count_if(excess.begin(), excess.end(), [](Index e) { return e != 0; }));
		result.repairedComponents -= result.lostComponents;
	}

	const auto certified = static_cast<Index>(nodeComponents.size());
	graph.separateParallelEdges();
	Polygons polygons(graph);
	for (const auto& loop : graph.faceLoops()) {
		Index node = graph.origin(loop[0]); // an edge has one end at least that was there before
		if (node >= certified)
			node = graph.origin(HalfEdgeGraph::twin(loop[0]));
		if (node >= certified)
			node = graph.origin(loop[1]);
		if (isOutside(graph, loop) || excess[nodeComponents[node]] != 0)
			continue;
		std::vector<Index> border;
		for (const Index h : loop)
			border.push_back(graph.origin(h));
		polygons.addDisk(border);
	}
	std::vector<Index> nameOf;
	result.mesh = polygons.mesh(&nameOf);
	result.onFeature.assign(result.mesh.vertexCount(), 0);
	for (Index v = 0; v < graph.vertexCount(); ++v)
		for (const Index h : graph.around(v))
			if (nameOf[v] >= 0 && graph.edge(h >> 1).isFeature)
				result.onFeature[nameOf[v]] = 1;
	return result;
}

} // namespace curvature_lines
