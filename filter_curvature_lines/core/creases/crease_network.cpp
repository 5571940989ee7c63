// Gaps, corners, junctions and stubs, until nothing changes.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "crease_network.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "crease_curves.h"
#include "crease_ends.h"
#include "crease_points.h"
#include "crease_tracing.h"
#include "disjoint_sets.h"
#include "neighborhoods.h"
#include "point_cloud.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// By experiment (benchmarks/creases.py).
// Cosine, 26 degrees: a crease that runs alongside makes no junction.
constexpr double parallel  = 0.9;
constexpr double minLength = 5.0; // spacings; a shorter curve needs corners at both ends
constexpr int    maxRounds = 20;  // each drops a stub; three or so are usual
// Weight of the ends of the curves against the planes of their faces, which place a corner: decides only along
// directions that the faces leave free.
constexpr double pull = 1e-3;

// The point nearest to all faces of the vertices.
Vector3d cornerOf(const std::vector<const CreasePoint*>& vertices)
{
	Vector3d mean = Vector3d::Zero();
	for (const CreasePoint* v : vertices)
		mean += v->position / double(vertices.size());
	Eigen::Matrix3d a = Eigen::Matrix3d::Identity() * pull * double(vertices.size());
	Vector3d        b = Vector3d::Zero();
	for (const CreasePoint* v : vertices)
		for (const Vector3d* n : {&v->left, &v->right}) {
			a += *n * n->transpose();
			b += *n * n->dot(v->position - mean);
		}
	return mean + a.ldlt().solve(b);
}

class Network {
public:
	Network(const CreaseTracing& tracing, double step, std::vector<CreaseTrace> traces) :
			m_tracing(tracing), m_step(step), m_traces(std::move(traces))
	{
	}

	void build()
	{
		int round = 0;
		do {
			joinGaps(m_tracing, m_step, m_traces);
			findCorners();
			cutAtCorners();
		} while (dropStubs() && ++round < maxRounds);
	}

	Creases result(double spacing) const;

private:
	double reach(const CreasePoint& v) const { return reachOf(v, m_tracing.faceDeviation()); }
	// Whether the crease that ends there may end in `corner` instead.
	bool accepts(const CreasePoint& end, const Vector3d& corner) const
	{
		const Vector3d d     = corner - end.position;
		const double   along = d.dot(end.tangent);
		return d.norm() <= reach(end) && along >= -spacingsBehind * end.spacing &&
		       (d - along * end.tangent).norm() <= m_tracing.width(end);
	}
	void findCorners();
	void findJunction(const CreaseEnd& end, Index& corner);
	void cutAtCorners();
	bool dropStubs();
	std::vector<CreasePoint> betweenCorners(Index trace) const;
	CreaseCurve resampled(Index trace, double spacing) const;

	const CreaseTracing&              m_tracing;
	double                            m_step;
	std::vector<CreaseTrace>          m_traces;
	std::vector<std::array<Index, 2>> m_corner; // per trace: at its front and back, -1: none
	std::vector<Vector3d>             m_corners;
};

void Network::findCorners()
{
	m_corners.clear();
	m_corner.assign(m_traces.size(), {-1, -1});
	const std::vector<CreaseEnd> ends = endsOf(m_traces);
	if (ends.empty())
		return;
	const Eigen::Matrix3Xd positions = positionsOf(ends);
	const NeighborSearch   search(positions);
	DisjointSets           groups(static_cast<Index>(ends.size()));
	for (Index a = 0; a < static_cast<Index>(ends.size()); ++a)
		for (const Index b : search.within(positions.col(a), 2.0 * reach(ends[a].vertex))) {
			if (b <= a || (ends[a].trace == ends[b].trace &&
			               lengthInSpacings(m_traces[ends[a].trace]) < shortestLoop))
				continue;
			const Vector3d corner = cornerOf({&ends[a].vertex, &ends[b].vertex});
			if (accepts(ends[a].vertex, corner) && accepts(ends[b].vertex, corner))
				groups.join(a, b);
		}
	std::vector<std::vector<Index>> members(ends.size());
	for (Index e = 0; e < static_cast<Index>(ends.size()); ++e)
		members[groups.find(e)].push_back(e);
	for (std::vector<Index>& list : members) {
		Vector3d corner;
		while (list.size() > 1) {
			std::vector<const CreasePoint*> vertices;
			vertices.reserve(list.size());
			for (const Index e : list)
				vertices.push_back(&ends[e].vertex);
			corner           = cornerOf(vertices);
			const auto worst = std::max_element(list.begin(), list.end(), [&](Index a, Index b) {
				return (corner - positions.col(a)).norm() < (corner - positions.col(b)).norm();
			});
			const bool fits  = std::all_of(
                list.begin(), list.end(), [&](Index e) { return accepts(ends[e].vertex, corner); });
			if (fits)
				break;
			list.erase(worst);
		}
		if (list.size() < 2)
			continue;
		for (const Index e : list)
			m_corner[ends[e].trace][ends[e].atBack] = static_cast<Index>(m_corners.size());
		m_corners.push_back(corner);
	}
	for (const CreaseEnd& end : ends)
		if (Index& corner = m_corner[end.trace][end.atBack]; corner < 0)
			findJunction(end, corner);
}

// An end that meets another crease on its way.
void Network::findJunction(const CreaseEnd& end, Index& corner)
{
	double   nearest = std::numeric_limits<double>::infinity();
	Vector3d best;
	for (Index t = 0; t < static_cast<Index>(m_traces.size()); ++t) {
		const auto& path = m_traces[t].vertices;
		for (std::size_t v = 0; v < path.size(); ++v) {
			const double distance = (path[v].position - end.vertex.position).norm();
			if (distance > reach(end.vertex) ||
			    std::abs(path[v].tangent.dot(end.vertex.tangent)) > parallel)
				continue;
			const std::size_t fromEnd = end.atBack ? path.size() - 1 - v : v;
			if (t == end.trace && fromEnd * m_step < shortestLoop * end.vertex.spacing)
				continue;
			const Vector3d place = cornerOf({&end.vertex, &path[v]});
			const double   move  = (place - end.vertex.position).norm();
			if (move < nearest && accepts(end.vertex, place) &&
			    (place - path[v].position).norm() < m_tracing.width(path[v])) {
				nearest = move;
				best    = place;
			}
		}
	}
	if (!(nearest < std::numeric_limits<double>::infinity()))
		return;
	corner = static_cast<Index>(m_corners.size());
	m_corners.push_back(best);
}

// Creases that pass a corner of others end there, too.
void Network::cutAtCorners()
{
	std::vector<CreaseTrace>          pieces;
	std::vector<std::array<Index, 2>> corners;
	for (std::size_t t = 0; t < m_traces.size(); ++t) {
		CreaseTrace&                         trace = m_traces[t];
		auto                                 path  = trace.vertices;
		std::vector<std::pair<Index, Index>> cuts; // vertex, corner
		for (Index c = 0; c < static_cast<Index>(m_corners.size()); ++c) {
			if (m_corner[t][0] == c || m_corner[t][1] == c)
				continue;
			const auto nearest =
				std::min_element(path.begin(), path.end(), [&](const auto& a, const auto& b) {
					return (a.position - m_corners[c]).norm() < (b.position - m_corners[c]).norm();
				});
			if ((nearest->position - m_corners[c]).norm() > m_tracing.width(*nearest))
				continue;
			const auto  v    = static_cast<Index>(nearest - path.begin());
			const auto  last = static_cast<Index>(path.size()) - 1;
			const Index room = static_cast<Index>(spacingsBehind * nearest->spacing / m_step);
			if (!trace.closed && v <= room) {
				if (m_corner[t][0] < 0)
					m_corner[t][0] = c;
			}
			else if (!trace.closed && v >= last - room) {
				if (m_corner[t][1] < 0)
					m_corner[t][1] = c;
			}
			else {
				cuts.emplace_back(v, c);
			}
		}
		std::sort(cuts.begin(), cuts.end());
		if (trace.closed && !cuts.empty()) { // open it at the first cut
			const auto [v, c] = cuts.front();
			std::rotate(path.begin(), path.begin() + v, path.end());
			path.push_back(path.front());
			for (auto& cut : cuts)
				cut.first -= v;
			cuts.erase(cuts.begin());
			m_corner[t]  = {c, c};
			trace.closed = false;
		}
		Index from = 0, corner = m_corner[t][0];
		for (const auto& [v, c] : cuts) {
			pieces.push_back({{path.begin() + from, path.begin() + v + 1}, false});
			corners.push_back({corner, c});
			from   = v;
			corner = c;
		}
		pieces.push_back({{path.begin() + from, path.end()}, trace.closed});
		corners.push_back({corner, m_corner[t][1]});
	}
	m_traces = std::move(pieces);
	m_corner = std::move(corners);
}

bool Network::dropStubs()
{
	std::size_t kept = 0;
	for (std::size_t t = 0; t < m_traces.size(); ++t) {
		const double length = lengthInSpacings(m_traces[t]);
		const bool   free   = m_corner[t][0] < 0 || m_corner[t][1] < 0;
		const bool   loop   = m_traces[t].closed || (!free && m_corner[t][0] == m_corner[t][1]);
		if (length < (loop ? shortestLoop : free ? minLength : 0.0))
			continue;
		if (kept != t)
			m_traces[kept] = std::move(m_traces[t]);
		m_corner[kept++] = m_corner[t];
	}
	const bool dropped = kept < m_traces.size();
	m_traces.resize(kept);
	m_corner.resize(kept);
	return dropped;
}

// The vertices of a trace with its corners instead of what lies beyond.
std::vector<CreasePoint> Network::betweenCorners(Index trace) const
{
	std::vector<CreasePoint> path = m_traces[trace].vertices;
	for (const int side : {0, 1}) {
		std::reverse(path.begin(), path.end()); // first the front comes last, then the back
		const Index corner = m_corner[trace][side];
		if (corner < 0)
			continue;
		const double outward = side == 0 ? -1.0 : 1.0;
		while (path.size() > 1 &&
		       (m_corners[corner] - path.back().position).dot(outward * path.back().tangent) <
		           0.4 * m_step)
			path.pop_back();
		CreasePoint vertex = path.back();
		vertex.position    = m_corners[corner];
		path.push_back(vertex);
	}
	return path;
}

CreaseCurve Network::resampled(Index trace, double spacing) const
{
	std::vector<CreasePoint> path   = betweenCorners(trace);
	const bool               closed = m_traces[trace].closed;
	if (closed)
		path.push_back(path.front());
	std::vector<double> at = {0.0};
	for (std::size_t v = 1; v < path.size(); ++v)
		at.push_back(at.back() + (path[v].position - path[v - 1].position).norm());
	const Index segments = std::max<Index>(closed ? 3 : 1, std::lround(at.back() / spacing));
	const Index count    = closed ? segments : segments + 1;
	CreaseCurve curve;
	curve.closed = closed;
	curve.start  = closed ? -1 : m_corner[trace][0];
	curve.end    = closed ? -1 : m_corner[trace][1];
	for (auto* vectors : {&curve.positions, &curve.tangents, &curve.left, &curve.right})
		vectors->resize(3, count);
	curve.angle.resize(count);
	std::size_t before = 0;
	for (Index k = 0; k < count; ++k) {
		const double s = at.back() * k / segments;
		while (before + 2 < path.size() && at[before + 1] < s)
			++before;
		const CreasePoint& a     = path[before];
		const CreasePoint& b     = path[before + 1];
		const double       along = (s - at[before]) / std::max(at[before + 1] - at[before], 1e-300);
		const double       t     = std::clamp(along, 0.0, 1.0);
		CreasePoint        vertex = t < 0.5 ? a : b;
		vertex.position           = (1.0 - t) * a.position + t * b.position;
		vertex.tangent            = ((1.0 - t) * a.tangent + t * b.tangent).normalized();
		vertex.left               = ((1.0 - t) * a.left + t * b.left).normalized();
		vertex.right              = ((1.0 - t) * a.right + t * b.right).normalized();
		const bool corner =
			!closed && ((k == 0 && curve.start >= 0) || (k == segments && curve.end >= 0));
		if (!corner)
			if (const auto fitted = m_tracing.curveAt(vertex))
				vertex = *fitted;
		curve.positions.col(k) = vertex.position;
		curve.tangents.col(k)  = vertex.tangent;
		curve.left.col(k)      = vertex.left;
		curve.right.col(k)     = vertex.right;
		curve.angle[k]         = vertex.angle;
	}
	return curve;
}

Creases Network::result(double spacing) const
{
	Creases creases;
	for (Index t = 0; t < static_cast<Index>(m_traces.size()); ++t)
		creases.curves.push_back(resampled(t, spacing));
	std::stable_sort(
		creases.curves.begin(), creases.curves.end(), [](const auto& a, const auto& b) {
			return a.length() > b.length();
		});
	creases.corners.resize(m_corners.size());
	for (std::size_t c = 0; c < m_corners.size(); ++c)
		creases.corners[c].position = m_corners[c];
	for (Index k = 0; k < static_cast<Index>(creases.curves.size()); ++k)
		for (const Index corner : {creases.curves[k].start, creases.curves[k].end})
			if (corner >= 0)
				creases.corners[corner].curves.push_back(k);
	return creases;
}

} // namespace

Creases creaseNetwork(
	const CreaseTracing& tracing, std::vector<CreaseTrace> traces, double step, double spacing)
{
	Network network(tracing, step, std::move(traces));
	network.build();
	return network.result(spacing);
}

} // namespace curvature_lines
