// Vertices from clusters of crossings, edges from the lines between them, and the loop that merges
// crossings until the graph is embedded.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "line_arrangement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "disjoint_sets.h"
#include "face_loops.h"
#include "graph_builder.h"
#include "half_edge_graph.h"
#include "line_crossing.h"
#include "line_intersections.h"
#include "line_network.h"
#include "point_cloud.h"
#include "voronoi_cells.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// Distances in spacings of the cloud. Crossings that follow each other on a line nearer than this are one
// vertex: the "existing intersection" at which A09 section 6 lets further lines meet. Far below what a
// cloud can resolve, above rounding errors.
constexpr double samePlace = 1e-3;
// Crossings of a loop that turns twice are merged up to this distance, which doubles until no such loop is
// left or it reaches the last one: beyond a spacing, crossings are no error of projection. By experiment.
constexpr double firstMergeDistance = 0.06;
constexpr double lastMergeDistance  = 1.0;
// Turns of a loop (turningNumber) from which on it is tangled: 1 bounds a disk, 2 is a crossing in the
// wrong order; the Gaussian curvature inside takes its share of either.
constexpr double tangledTurns = 1.8;

class Arranger {
public:
	Arranger(const VoronoiCells& cells, const LineNetwork& lines, const LineIntersections& found) :
			m_lines(lines), m_found(found), m_clusters(static_cast<Index>(found.crossings.size()))
	{
		Index site = 0;
		for (const LineCrossing& crossing : found.crossings) {
			site = cells.locate(crossing.position, site);
			m_spacing.push_back(siteSpacing(cells, site));
		}
		for (const std::vector<Index>& entries : found.alongLine)
			for (std::size_t k = 1; k < entries.size(); ++k) {
				const Index a = entries[k - 1] >> 1, b = entries[k] >> 1;
				joinIfNear(
					a,
					b,
					(found.crossings[a].position - found.crossings[b].position).norm(),
					samePlace);
			}
	}

	HalfEdgeGraph graph()
	{
		placeVertices();
		std::vector<Piece> pieces;
		for (Index line = 0; line < m_lines.lines(); ++line) {
			const std::vector<Index>& entries = m_found.alongLine[line];
			for (std::size_t k = 1; k < entries.size(); ++k)
				addPiece(line, entries[k - 1], entries[k], 0.0, pieces);
			if (isClosed(m_lines, line) && !entries.empty())
				addPiece(
					line, entries.back(), entries.front(), segmentCount(m_lines, line), pieces);
		}
		std::vector<double> reach(m_first.size(), std::numeric_limits<double>::max());
		for (const Piece& p : pieces)
			for (const Index v : {p.from, p.to})
				reach[v] = std::min(reach[v], (p.middle - m_positions.col(v)).norm());

		GraphBuilder builder;
		for (Index v = 0; v < m_positions.cols(); ++v)
			builder.addVertex(m_positions.col(v), m_normals.col(v));
		for (const Piece& p : pieces) {
			HalfEdgeGraph::Edge& edge = builder.edgeOf(builder.addEdge(p.from, p.to));
			edge.tangentFrom = tangentAt(p.from, reach[p.from], p.line, p.entryFrom, p.half, 1.0);
			edge.tangentTo = tangentAt(p.to, reach[p.to], p.line, p.entryTo, p.half - p.wrap, -1.0);
			edge.middle    = p.middle;
		}
		return builder.graph();
	}

	// Joins the ends of edges of tangled loops that are shorter than `distance` spacings.
	bool joinTangled(
		const HalfEdgeGraph& graph, const std::vector<std::vector<Index>>& tangled, double distance)
	{
		bool joined = false;
		for (const std::vector<Index>& loop : tangled) {
			for (Index h : loop) {
				const Index  v = graph.origin(h), w = graph.origin(HalfEdgeGraph::twin(h));
				const double apart = (m_positions.col(v) - m_positions.col(w)).norm();
				joined             = joinIfNear(m_first[v], m_first[w], apart, distance) || joined;
			}
		}
		return joined;
	}

	Index merged() const
	{
		return static_cast<Index>(m_vertexOf.size()) - static_cast<Index>(m_first.size());
	}

private:
	bool joinIfNear(Index a, Index b, double apart, double distance)
	{
		return apart < distance * m_spacing[a] && m_clusters.join(a, b);
	}

	void placeVertices()
	{
		const Index crossings = static_cast<Index>(m_found.crossings.size());
		m_vertexOf.assign(crossings, -1);
		m_first.clear();
		std::vector<Index> members;
		for (Index c = 0; c < crossings; ++c) {
			if (m_clusters.find(c) == c) {
				m_vertexOf[c] = static_cast<Index>(m_first.size());
				m_first.push_back(c);
			}
			m_vertexOf[c] = m_vertexOf[m_clusters.find(c)];
		}
		const Index vertices = static_cast<Index>(m_first.size());
		m_positions.setZero(3, vertices);
		m_normals.setZero(3, vertices);
		members.assign(vertices, 0);
		for (Index c = 0; c < crossings; ++c) {
			m_positions.col(m_vertexOf[c]) += m_found.crossings[c].position;
			m_normals.col(m_vertexOf[c]) += m_found.crossings[c].normal;
			++members[m_vertexOf[c]];
		}
		for (Index v = 0; v < vertices; ++v)
			m_positions.col(v) /= members[v];
		m_normals.colwise().normalize();
		m_radius.assign(vertices, 0.0);
		for (Index c = 0; c < crossings; ++c) {
			double& radius = m_radius[m_vertexOf[c]];
			radius         = std::max(
                radius, (m_found.crossings[c].position - m_positions.col(m_vertexOf[c])).norm());
		}
	}

	double parameterOf(Index entry) const
	{
		return m_found.crossings[entry >> 1].parameter[entry & 1];
	}

	// A point of a line at a parameter that may have run past a closed line's end.
	Vector3d pointAt(Index line, double parameter) const
	{
		const double n = segmentCount(m_lines, line);
		return pointOnLine(m_lines, line, parameter < n ? parameter : parameter - n);
	}

	// A piece of line between two crossings.
	struct Piece {
		Index  from, to; // vertices
		Index  line, entryFrom, entryTo;
		double half,
			wrap; // parameter half-way; what it exceeds the end's by where it runs over the end
		Vector3d middle;
	};

	void addPiece(Index line, Index from, Index to, double wrap, std::vector<Piece>& pieces) const
	{
		const Index    v = m_vertexOf[from >> 1], w = m_vertexOf[to >> 1];
		const double   start = parameterOf(from), end = parameterOf(to);
		const double   half   = 0.5 * (start + end + wrap);
		const Vector3d middle = pointAt(line, half);
		const double   extent = 2.0 * m_radius[v] + samePlace * m_spacing[m_first[v]];
		const bool     inside = v == w && (middle - m_positions.col(v)).norm() < extent;
		if (!inside)
			pieces.push_back({v, w, line, from, to, half, wrap, middle});
	}

	// Direction in which a line leaves the vertex of a crossing towards parameter `half`. From a
	// cluster it is where the line leaves a disk common to all its lines: that is their cyclic
	// order.
	Vector3d
	tangentAt(Index v, double reach, Index line, Index entry, double half, double sense) const
	{
		if (m_radius[v] == 0.0)
			return sense * m_found.crossings[entry >> 1].tangent[entry & 1];
		const double   n      = segmentCount(m_lines, line);
		const Vector3d center = m_positions.col(v);
		double         t      = parameterOf(entry);
		Vector3d       leg;
		do {
			t   = sense > 0.0 ? std::min(std::floor(t) + 1.0, half)
			                  : std::max(std::ceil(t) - 1.0, half);
			leg = pointAt(line, t < 0.0 ? t + n : t) - center;
		} while (t != half && leg.norm() < reach);
		return leg;
	}

	const LineNetwork&       m_lines;
	const LineIntersections& m_found;
	std::vector<double>      m_spacing;  // at every crossing
	DisjointSets             m_clusters; // of crossings that are one vertex
	std::vector<Index>       m_vertexOf; // of every crossing
	std::vector<Index>       m_first;    // crossing of every vertex
	std::vector<double>      m_radius;   // of every vertex's cluster
	Eigen::Matrix3Xd         m_positions, m_normals;
};

std::vector<std::vector<Index>> tangledLoops(const HalfEdgeGraph& graph)
{
	std::vector<std::vector<Index>> tangled;
	for (std::vector<Index>& loop : graph.faceLoops())
		if (turningNumber(graph, loop) > tangledTurns)
			tangled.push_back(std::move(loop));
	return tangled;
}

} // namespace

LineArrangement
arrangeLines(const VoronoiCells& cells, const LineNetwork& lines, const LineIntersections& found)
{
	Arranger      arranger(cells, lines, found);
	HalfEdgeGraph graph = arranger.graph();
	graph.reduce();
	std::vector<std::vector<Index>> tangled = tangledLoops(graph);
	for (double distance = firstMergeDistance; !tangled.empty() && distance < lastMergeDistance;) {
		if (arranger.joinTangled(graph, tangled, distance)) {
			graph = arranger.graph();
			graph.reduce();
			tangled = tangledLoops(graph);
		}
		else {
			distance *= 2.0;
		}
	}
	graph.separateParallelEdges();
	return {std::move(graph), arranger.merged()};
}

} // namespace curvature_lines
