// Chords of each triangle, edges of the triangles, and the cyclic order of half-edges around every vertex.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <vector>

#include <Eigen/Geometry>

#include "graph_builder.h"
#include "half_edge_graph.h"
#include "point_cloud.h"
#include "surface_curves.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Where a chord ends on the border of its triangle.
struct BorderPoint {
	Index    vertex = -1; // of the graph
	Index    corner = -1; // the vertex of the triangles there, if it is one
	int      rank   = 0; // counter-clockwise around the triangle, corners among the points on edges
	Vector2d at     = Vector2d::Zero(); // barycentric, of corners 1 and 2
};

struct BorderChord {
	BorderPoint a, b;
	// Whether rank r, not that of an end, lies on the border that runs counter-clockwise from a to b: right of the chord.
	bool isRight(int r) const
	{
		return a.rank < b.rank ? a.rank < r && r < b.rank : r < b.rank || r > a.rank;
	}
	bool meets(int r) const { return a.rank == r || b.rank == r; }
	bool crosses(const BorderChord& o) const
	{
		return !meets(o.a.rank) && !meets(o.b.rank) && isRight(o.a.rank) != isRight(o.b.rank);
	}
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

// Two chords that cross.
struct ChordCrossing {
	Index vertex;
	bool  fromRight; // the second chord comes from the right of the first
	// Forwards and backwards along the first, then along the second.
	std::array<Index, 4> halfEdges;

	// Counter-clockwise from forwards along the first: what lies to its left comes next.
	std::vector<Index> around() const
	{
		const auto& h = halfEdges;
		return fromRight ? std::vector<Index>{h[0], h[2], h[1], h[3]}
		                 : std::vector<Index>{h[0], h[3], h[1], h[2]};
	}
};

// A crossing as one of its two chords passes it.
struct Passage {
	int         order; // along the chord
	std::size_t crossing;
	int         slot; // of the chord's half-edges among those of the crossing
	bool operator<(const Passage& o) const { return order < o.order; }
};

// The end of a chord at a corner of its triangle.
struct Stub {
	Index triangle;
	int   order; // counter-clockwise around the corner
	Index half;  // leaves the corner
	bool operator<(const Stub& o) const
	{
		return std::tie(triangle, order) < std::tie(o.triangle, o.order);
	}
};

class SurfaceGraphBuilder {
public:
	SurfaceGraphBuilder(
		const TriangleMesh&       mesh,
		const Eigen::Matrix3Xd&   normals,
		const SurfaceFeatures&    features,
		const SurfaceCurves&      curves,
		const std::vector<Index>& component,
		const std::vector<char>&  filled) :
			m_mesh(mesh), m_normals(normals), m_features(features), m_curves(curves),
			m_component(component), m_filled(filled)
	{
		m_vertexAt.assign(m_mesh.vertexCount(), -1);
		m_stubs.resize(m_mesh.vertexCount());
		addEdgePoints();
		addChords();
		addMeshEdges();
		sortAtEdgePoints();
		sortAtVertices();
	}

	SurfaceGraph result() const
	{
		return {m_builder.graph(m_around, m_kept), m_vertexComponents, m_isFilling, m_crossings};
	}

private:
	bool isInGraph(Index e) const
	{
		const auto& edge = m_mesh.edges()[e];
		return edge.isRim() || m_features.edge[e] || m_filled[m_component[edge.from]];
	}

	Index addVertex(const Vector3d& position, const Vector3d& normal, Index component)
	{
		m_vertexComponents.push_back(component);
		m_around.emplace_back();
		m_kept.push_back(0);
		return m_builder.addVertex(
			position, normal.norm() > 0.0 ? normal.normalized() : Vector3d(Vector3d::UnitZ()));
	}

	void addEdgePoints()
	{
		m_firstPoint.push_back(0);
		for (Index e = 0; e < m_mesh.edgeCount(); ++e) {
			const auto& edge = m_mesh.edges()[e];
			for (const EdgePoint& p : m_curves.points[e])
				addVertex(
					m_mesh.vertices.col(edge.from) + p.t * m_mesh.along(e),
					(1.0 - p.t) * m_normals.col(edge.from) + p.t * m_normals.col(edge.to),
					m_component[edge.from]);
			m_firstPoint.push_back(m_builder.vertexCount());
		}
		m_chordAt.assign(m_builder.vertexCount(), {-1, -1});
	}

	Index vertexOf(const SurfaceCurves::End& end) const
	{
		return m_firstPoint[end.edge] + end.point;
	}

	// Of corner c of a triangle, or the number of all if c is 3.
	int rankOf(Index t, int c) const
	{
		int rank = c;
		for (int side = 0; side < c; ++side)
			rank += static_cast<int>(m_curves.points[m_mesh.edgeOf(t, side)].size());
		return rank;
	}

	BorderPoint borderPoint(Index t, const SurfaceCurves::End& end)
	{
		const std::array<Vector2d, 3> corners = {
			Vector2d(0.0, 0.0), Vector2d(1.0, 0.0), Vector2d(0.0, 1.0)};
		BorderPoint p;
		if (end.edge < 0) {
			int c = 0;
			while (m_mesh.triangles()[t][c] != end.point)
				++c;
			p.vertex = graphVertexOf(end.point);
			p.corner = end.point;
			p.rank   = rankOf(t, c);
			p.at     = corners[c];
			return p;
		}
		p.vertex = vertexOf(end);
		int side = 0;
		while (m_mesh.edgeOf(t, side) != end.edge)
			++side;
		const auto   count = static_cast<int>(m_curves.points[end.edge].size());
		const bool   ahead = m_mesh.isForward(t, side);
		const double along = m_curves.points[end.edge][end.point].t;
		const double s     = ahead ? along : 1.0 - along;
		p.rank             = rankOf(t, side) + 1 + (ahead ? end.point : count - 1 - end.point);
		p.at               = (1.0 - s) * corners[side] + s * corners[(side + 1) % 3];
		return p;
	}

	Index graphVertexOf(Index v)
	{
		if (m_vertexAt[v] < 0) {
			m_vertexAt[v] = addVertex(m_mesh.vertices.col(v), m_normals.col(v), m_component[v]);
			m_kept[m_vertexAt[v]] = m_features.corner[v];
		}
		return m_vertexAt[v];
	}

	void addChords()
	{
		const auto&              chords = m_curves.chords;
		std::vector<BorderChord> inTriangle;
		for (std::size_t begin = 0, end; begin < chords.size(); begin = end) {
			for (end = begin;
			     end < chords.size() && chords[end].triangle == chords[begin].triangle;)
				++end;
			const Index t = chords[begin].triangle;
			inTriangle.clear();
			for (std::size_t k = begin; k < end; ++k)
				inTriangle.push_back({borderPoint(t, chords[k].a), borderPoint(t, chords[k].b)});
			addChordsOf(t, inTriangle);
		}
	}

	void addChordsOf(Index t, const std::vector<BorderChord>& chords)
	{
		std::vector<ChordCrossing>        crossings;
		std::vector<std::vector<Passage>> passages = crossChords(t, chords, crossings);
		for (std::size_t k = 0; k < chords.size(); ++k) {
			std::sort(passages[k].begin(), passages[k].end());
			addChord(t, chords[k], passages[k], crossings);
		}
		for (const ChordCrossing& crossing : crossings)
			m_around[crossing.vertex] = crossing.around();
		m_crossings += static_cast<Index>(crossings.size());
	}

	// Adds the vertices where chords of the triangle cross. Returns the passages of every chord, unsorted.
	std::vector<std::vector<Passage>> crossChords(
		Index t, const std::vector<BorderChord>& chords, std::vector<ChordCrossing>& crossings)
	{
		const int                         ranks = rankOf(t, 3);
		std::vector<std::vector<Passage>> passages(chords.size());
		for (std::size_t p = 0; p < chords.size(); ++p) {
			for (std::size_t q = p + 1; q < chords.size(); ++q) {
				const BorderChord &first = chords[p], &second = chords[q];
				if (!first.crosses(second))
					continue;
				passages[p].push_back({first.orderOf(second, ranks), crossings.size(), 0});
				passages[q].push_back({second.orderOf(first, ranks), crossings.size(), 2});
				crossings.push_back(
					{addCrossing(t, first, second),
				     first.isRight(second.a.rank),
				     {-1, -1, -1, -1}});
			}
		}
		return passages;
	}

	Index addCrossing(Index t, const BorderChord& first, const BorderChord& second)
	{
		const Triangle& corners  = m_mesh.triangles()[t];
		const double    s        = parameterAlong(first, second);
		const Vector2d  at       = (1.0 - s) * first.a.at + s * first.b.at;
		Vector3d        position = Vector3d::Zero(), normal = Vector3d::Zero();
		const double    share[] = {1.0 - at.sum(), at.x(), at.y()};
		for (int c = 0; c < 3; ++c) {
			position += share[c] * m_mesh.vertices.col(corners[c]);
			normal += share[c] * m_normals.col(corners[c]);
		}
		return addVertex(position, normal, m_component[corners[0]]);
	}

	// The pieces of a chord of triangle t between its passages in order.
	void addChord(
		Index                       t,
		const BorderChord&          chord,
		const std::vector<Passage>& passages,
		std::vector<ChordCrossing>& crossings)
	{
		std::vector<Index> path = {chord.a.vertex};
		for (const Passage& passage : passages)
			path.push_back(crossings[passage.crossing].vertex);
		path.push_back(chord.b.vertex);
		const std::vector<Index> half = m_builder.addPath(path);
		m_isFilling.resize(m_builder.edgeCount(), 0);
		for (std::size_t k = 0; k < passages.size(); ++k) {
			auto& atCrossing                 = crossings[passages[k].crossing].halfEdges;
			atCrossing[passages[k].slot]     = half[k + 1];
			atCrossing[passages[k].slot + 1] = HalfEdgeGraph::twin(half[k]);
		}
		leaveBorder(t, chord.a, chord.b, half.front());
		leaveBorder(t, chord.b, chord.a, HalfEdgeGraph::twin(half.back()));
	}

	// Half-edge h of a chord leaves one of its ends into triangle t.
	void leaveBorder(Index t, const BorderPoint& at, const BorderPoint& other, Index h)
	{
		if (at.corner >= 0) {
			const int ranks = rankOf(t, 3);
			m_stubs[at.corner].push_back({t, (other.rank - at.rank + ranks) % ranks, h});
			return;
		}
		const Index point = at.vertex;
		const auto  e     = static_cast<Index>(
                           std::upper_bound(m_firstPoint.begin(), m_firstPoint.end(), point) -
                           m_firstPoint.begin()) -
		               1;
		m_chordAt[point][m_mesh.edges()[e].left == t ? 0 : 1] = h;
	}

	void addMeshEdges()
	{
		m_leaving.assign(m_mesh.edgeCount(), {-1, -1});
		m_alongAt.assign(m_chordAt.size(), {-1, -1});
		for (Index e = 0; e < m_mesh.edgeCount(); ++e) {
			if (!isInGraph(e))
				continue;
			addMeshEdge(e);
		}
	}

	// The pieces of an edge of the triangles between its edge points.
	void addMeshEdge(Index e)
	{
		const auto&        edge    = m_mesh.edges()[e];
		const bool         feature = edge.isRim() || m_features.edge[e];
		std::vector<Index> path    = {graphVertexOf(edge.from)};
		for (Index p = m_firstPoint[e]; p < m_firstPoint[e + 1]; ++p)
			path.push_back(p);
		path.push_back(graphVertexOf(edge.to));
		const std::vector<Index> half = m_builder.addPath(path);
		m_isFilling.resize(m_builder.edgeCount(), !feature);
		for (const Index h : half) {
			m_builder.edgeOf(h).isFeature = feature;
			m_builder.edgeOf(h).outside   = edge.left < 0 ? 0 : edge.right < 0 ? 1 : -1;
		}
		m_leaving[e] = {half.front(), HalfEdgeGraph::twin(half.back())};
		for (std::size_t k = 1; k + 1 < path.size(); ++k)
			m_alongAt[path[k]] = {half[k], HalfEdgeGraph::twin(half[k - 1])};
	}

	void sortAtEdgePoints()
	{
		// Counter-clockwise from forward along the edge: its left triangle comes next.
		for (std::size_t point = 0; point < m_chordAt.size(); ++point)
			for (const Index h :
			     {m_alongAt[point][0],
			      m_chordAt[point][0],
			      m_alongAt[point][1],
			      m_chordAt[point][1]})
				if (h >= 0)
					m_around[point].push_back(h);
	}

	void sortAtVertices()
	{
		// Counter-clockwise around a corner, the edge that begins there is followed by the chords that end there, then by
		// the edge that ends there.
		struct Corner {
			Index triangle, first, second;
		};
		std::vector<std::vector<Corner>> fans(m_mesh.vertexCount());
		for (Index t = 0; t < m_mesh.triangleCount(); ++t)
			for (int c = 0; c < 3; ++c)
				if (m_vertexAt[m_mesh.triangles()[t][c]] >= 0)
					fans[m_mesh.triangles()[t][c]].push_back(
						{t, m_mesh.edgeOf(t, c), m_mesh.edgeOf(t, (c + 2) % 3)});
		for (Index v = 0; v < m_mesh.vertexCount(); ++v) {
			const auto& fan = fans[v];
			if (fan.empty())
				continue;
			std::sort(m_stubs[v].begin(), m_stubs[v].end());
			Index first = fan[0].first;
			for (const Corner& corner : fan) // at a rim the fan has a beginning
				if (m_mesh.edges()[corner.first].isRim() &&
				    std::none_of(fan.begin(), fan.end(), [&](const Corner& o) {
						return o.second == corner.first;
					}))
					first = corner.first;
			std::vector<Index>& around = m_around[m_vertexAt[v]];
			Index               e      = first;
			do {
				if (isInGraph(e))
					around.push_back(m_leaving[e][m_mesh.edges()[e].from == v ? 0 : 1]);
				const auto corner = std::find_if(
					fan.begin(), fan.end(), [&](const Corner& c) { return c.first == e; });
				if (corner == fan.end()) {
					e = first;
					continue;
				}
				for (const Stub& stub : m_stubs[v])
					if (stub.triangle == corner->triangle)
						around.push_back(stub.half);
				e = corner->second;
			} while (e != first);
		}
	}

	const TriangleMesh&       m_mesh;
	const Eigen::Matrix3Xd&   m_normals;
	const SurfaceFeatures&    m_features;
	const SurfaceCurves&      m_curves;
	const std::vector<Index>& m_component;
	const std::vector<char>&  m_filled; // by name of component

	GraphBuilder                    m_builder;
	std::vector<Index>              m_vertexComponents;
	std::vector<std::vector<Index>> m_around;
	std::vector<char>               m_kept, m_isFilling;
	Index                           m_crossings = 0;

	// Of every edge of the triangles: the vertex of its first edge point; those of all edges come first.
	std::vector<Index> m_firstPoint;
	// Of every edge point: half-edges into the triangle on the left and on the right,
	std::vector<std::array<Index, 2>> m_chordAt;
	// and forwards and backwards along its edge.
	std::vector<std::array<Index, 2>> m_alongAt;
	// Of every edge of the triangles: the half-edges along it at its start and at its end.
	std::vector<std::array<Index, 2>> m_leaving;
	std::vector<Index>                m_vertexAt; // of every vertex of the triangles, -1: none
	std::vector<std::vector<Stub>>    m_stubs;    // of every vertex of the triangles
};

} // namespace

SurfaceGraph surfaceGraph(
	const TriangleMesh&       mesh,
	const Eigen::Matrix3Xd&   normals,
	const SurfaceFeatures&    features,
	const SurfaceCurves&      curves,
	const std::vector<Index>& component,
	const std::vector<char>&  filled)
{
	return SurfaceGraphBuilder(mesh, normals, features, curves, component, filled).result();
}

} // namespace curvature_lines
