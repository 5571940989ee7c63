// Ends that point at each other, the nearest first, and the chains they make.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "crease_ends.h"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "crease_points.h"
#include "crease_tracing.h"
#include "neighborhoods.h"
#include "point_cloud.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// Length over which points may be missing at the end of a crease, where two faces are hard to tell apart: so many
// spacings plus so many faceDeviations. By experiment (benchmarks/creases.py).
constexpr double reachSpacings   = 4.0;
constexpr double reachDeviations = 4.0;
// Cosine, 32 degrees: tangents and normals of ends that continue each other.
constexpr double straightOn = 0.85;

double lengthOf(const CreaseTrace& trace)
{
	double sum = 0.0;
	for (std::size_t v = 1; v < trace.vertices.size(); ++v)
		sum += (trace.vertices[v].position - trace.vertices[v - 1].position).norm();
	return sum;
}

void reverse(CreaseTrace& trace)
{
	std::reverse(trace.vertices.begin(), trace.vertices.end());
	for (CreasePoint& v : trace.vertices)
		v = v.reversed();
}

// Whether b is the other side of a gap in the crease that ends in a.
bool continues(const CreaseEnd& a, const CreaseEnd& b, const CreaseTracing& tracing)
{
	const CreasePoint onward = b.vertex.reversed();
	const Vector3d    d      = onward.position - a.vertex.position;
	const double      along  = d.dot(a.vertex.tangent);
	return a.vertex.angle * onward.angle > 0.0 &&
	       a.vertex.tangent.dot(onward.tangent) > straightOn &&
	       a.vertex.left.dot(onward.left) > straightOn &&
	       a.vertex.right.dot(onward.right) > straightOn &&
	       d.norm() < reachOf(a.vertex, tracing.faceDeviation()) &&
	       along > -spacingsBehind * a.vertex.spacing &&
	       (d - along * a.vertex.tangent).norm() < tracing.width(a.vertex);
}

// The end on the other side of a gap for each end, the nearest pairs first; -1: none.
std::vector<Index> matesOf(
	const std::vector<CreaseEnd>&   ends,
	const std::vector<CreaseTrace>& traces,
	const CreaseTracing&            tracing)
{
	const Eigen::Matrix3Xd positions = positionsOf(ends);
	const NeighborSearch   search(positions);
	const auto             mayJoin = [&](const CreaseEnd& a, const CreaseEnd& b) {
        return (a.trace != b.trace || lengthInSpacings(traces[a.trace]) >= shortestLoop) &&
               continues(a, b, tracing) && continues(b, a, tracing);
	};
	std::vector<std::tuple<double, Index, Index>> candidates; // distance, two ends
	for (Index a = 0; a < static_cast<Index>(ends.size()); ++a)
		for (const Index b :
		     search.within(positions.col(a), reachOf(ends[a].vertex, tracing.faceDeviation())))
			if (a < b && mayJoin(ends[a], ends[b]))
				candidates.emplace_back((positions.col(b) - positions.col(a)).norm(), a, b);
	std::sort(candidates.begin(), candidates.end());
	std::vector<Index> mate(ends.size(), -1);
	for (const auto& [distance, a, b] : candidates)
		if (mate[a] < 0 && mate[b] < 0) {
			mate[a] = b;
			mate[b] = a;
		}
	return mate;
}

// The traces from end `first` on, over all gaps, as one. Ends come in pairs, front and back of a trace: e ^ 1 is the
// other end.
CreaseTrace chainFrom(
	Index                         first,
	const std::vector<CreaseEnd>& ends,
	const std::vector<Index>&     mate,
	double                        step,
	std::vector<CreaseTrace>&     traces,
	std::vector<char>&            used)
{
	CreaseTrace chain;
	Index       entry = first;
	do {
		used[entry] = used[entry ^ 1] = 1;
		CreaseTrace& next             = traces[ends[entry].trace];
		if (ends[entry].atBack)
			reverse(next);
		auto from = next.vertices.begin();
		if (!chain.vertices.empty()) { // without what overlaps
			const CreasePoint last = chain.vertices.back();
			while (from + 1 != next.vertices.end() &&
			       (from->position - last.position).dot(last.tangent) < 0.3 * step)
				++from;
		}
		chain.vertices.insert(chain.vertices.end(), from, next.vertices.end());
		entry = mate[entry ^ 1];
	} while (entry >= 0 && entry != first);
	chain.closed = entry == first;
	return chain;
}

} // namespace

std::vector<CreaseEnd> endsOf(const std::vector<CreaseTrace>& traces)
{
	std::vector<CreaseEnd> ends;
	for (Index t = 0; t < static_cast<Index>(traces.size()); ++t)
		if (!traces[t].closed) {
			ends.push_back({t, false, traces[t].vertices.front().reversed()});
			ends.push_back({t, true, traces[t].vertices.back()});
		}
	return ends;
}

Eigen::Matrix3Xd positionsOf(const std::vector<CreaseEnd>& ends)
{
	Eigen::Matrix3Xd positions(3, ends.size());
	for (std::size_t e = 0; e < ends.size(); ++e)
		positions.col(e) = ends[e].vertex.position;
	return positions;
}

double reachOf(const CreasePoint& end, double deviation)
{
	return reachSpacings * end.spacing + reachDeviations * deviation;
}

double lengthInSpacings(const CreaseTrace& trace)
{
	return lengthOf(trace) / trace.vertices[trace.vertices.size() / 2].spacing;
}

void joinGaps(const CreaseTracing& tracing, double step, std::vector<CreaseTrace>& traces)
{
	const std::vector<CreaseEnd> ends = endsOf(traces);
	if (ends.empty())
		return;
	const std::vector<Index> mate = matesOf(ends, traces, tracing);

	std::vector<CreaseTrace> joined;
	std::vector<char>        used(ends.size(), 0);
	for (CreaseTrace& trace : traces)
		if (trace.closed)
			joined.push_back(std::move(trace));
	const auto count = static_cast<Index>(ends.size());
	for (Index e = 0; e < count; ++e) // open chains first, from an end that has no mate
		if (!used[e] && mate[e] < 0)
			joined.push_back(chainFrom(e, ends, mate, step, traces, used));
	for (Index e = 0; e < count; ++e)
		if (!used[e])
			joined.push_back(chainFrom(e, ends, mate, step, traces, used));
	traces = std::move(joined);
}

} // namespace curvature_lines
