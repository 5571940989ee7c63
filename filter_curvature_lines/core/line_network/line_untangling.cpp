// Crossings of segments, the cheapest cut for each, and again until there are none.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "line_untangling.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "line_network.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// Segments of faces whose normals differ by more than 60 degrees (dot product) do not cross, wherever they
// pass each other in space: one of them is on the other side of a thin part.
constexpr double sameFace = 0.5;
constexpr int    rounds   = 1000; // a safeguard: each cuts one vertex at least, and a few do

struct Line {
	std::vector<Index>     vertices;
	int                    family = 1;
	bool                   closed = false;
	std::array<LineEnd, 2> ends{};

	Index size() const { return static_cast<Index>(vertices.size()); }
	Index segments() const { return closed ? size() : size() - 1; }
	bool isLine() const { return size() >= (closed ? 3 : 2); }
};

struct Segment {
	Index line, at; // from vertex `at` of the line to the next one
	Index from, to;
};

struct Crossing {
	Segment a, b; // of the same line: a comes first
};

bool areCrossing(const LineNetwork& lines, const Segment& a, const Segment& b)
{
	if (a.from == b.to || a.to == b.from)
		return false;
	const auto     vertex = [&](Index v) -> Vector3d { return lines.vertices.col(v); };
	const Vector3d alongA = vertex(a.to) - vertex(a.from), alongB = vertex(b.to) - vertex(b.from);
	const Vector3d normals[] = {lines.normals.col(a.from), lines.normals.col(b.from)};
	if (normals[0].dot(normals[1]) < sameFace)
		return false;
	return std::any_of(std::begin(normals), std::end(normals), [&](const Vector3d& normal) {
		const auto parted = [&](const Segment& s, const Vector3d& along, const Segment& other) {
			const auto side = [&](Index v) {
				return along.cross(vertex(v) - vertex(s.from)).dot(normal);
			};
			return side(other.from) * side(other.to) < 0.0;
		};
		return parted(a, alongA, b) && parted(b, alongB, a);
	});
}

std::vector<Crossing> findCrossings(const LineNetwork& lines, const std::vector<Line>& parts)
{
	std::vector<Segment> segments;
	for (std::size_t l = 0; l < parts.size(); ++l)
		for (Index k = 0; k < parts[l].segments(); ++k)
			segments.push_back(
				{Index(l), k, parts[l].vertices[k], parts[l].vertices[(k + 1) % parts[l].size()]});
	const auto       count = static_cast<Index>(segments.size());
	Eigen::Matrix3Xd middles(3, count);
	Eigen::VectorXd  lengths(count);
	for (Index s = 0; s < count; ++s) {
		const Vector3d from = lines.vertices.col(segments[s].from),
					   to   = lines.vertices.col(segments[s].to);
		middles.col(s)      = 0.5 * (from + to);
		lengths[s]          = (to - from).norm();
	}
	if (count == 0)
		return {};
	const NeighborSearch            search(middles);
	std::vector<std::vector<Index>> crossed(count); // shorter segments
	parallelFor(count, {}, [&](Index s) {
		std::vector<Index> near;
		// Those that cross it in space are within its length, those on the other sheet of a fold a little
		// further.
		search.within(middles.col(s), 2.0 * lengths[s], near);
		for (const Index other : near) {
			const auto& [a, b] = std::minmax(s, other);
			const bool shorter =
				std::make_pair(lengths[other], other) < std::make_pair(lengths[s], s);
			if (shorter && parts[segments[a].line].family == parts[segments[b].line].family &&
			    areCrossing(lines, segments[a], segments[b]))
				crossed[s].push_back(other);
		}
		std::sort(crossed[s].begin(), crossed[s].end());
	});
	std::vector<Crossing> crossings;
	for (Index s = 0; s < count; ++s)
		for (const Index other : crossed[s])
			crossings.push_back({segments[std::min(s, other)], segments[std::max(s, other)]});
	return crossings;
}

// Vertices [begin, end) of a line.
void erase(Line& line, Index begin, Index end)
{
	line.vertices.erase(line.vertices.begin() + begin, line.vertices.begin() + end);
}

void endBehind(Line& line, Index at)
{
	erase(line, at + 1, line.size());
	line.ends[1] = LineEnd::Line;
}

void startBehind(Line& line, Index at)
{
	erase(line, 0, at + 1);
	line.ends[0] = LineEnd::Line;
}

void cutLoop(Line& line, Index first, Index second)
{
	const Index loop = second - first;
	if (line.closed && 2 * loop > line.size()) { // the other side is the loop
		endBehind(line, second);
		startBehind(line, first);
		line.ends = {LineEnd::None, LineEnd::None};
	}
	else if (line.closed || loop <= std::min(first + 1, line.size() - 1 - second)) {
		erase(line, first + 1, second + 1);
	}
	else if (first + 1 <= line.size() - 1 - second) {
		startBehind(line, first);
	}
	else {
		endBehind(line, second);
	}
}

// Without its segment `at`; of an open line the longer part stays.
Index costOfEnding(const Line& line, Index at)
{
	return line.closed ? line.size() : std::min(at + 1, line.size() - 1 - at);
}

void endAt(Line& line, Index at)
{
	if (line.closed) {
		std::rotate(
			line.vertices.begin(),
			line.vertices.begin() + (at + 1) % line.size(),
			line.vertices.end());
		line.closed = false;
		line.ends   = {LineEnd::Line, LineEnd::Line};
	}
	else if (at + 1 <= line.size() - 1 - at) {
		startBehind(line, at);
	}
	else {
		endBehind(line, at);
	}
}

LineNetwork assembled(const LineNetwork& lines, const std::vector<Line>& parts)
{
	LineNetwork result;
	result.epsilon   = lines.epsilon;
	result.crossings = lines.crossings;
	std::vector<Index> kept;
	for (const Line& line : parts) {
		if (!line.isLine())
			continue;
		kept.insert(kept.end(), line.vertices.begin(), line.vertices.end());
		result.offsets.push_back(static_cast<Index>(kept.size()));
		result.family.push_back(line.family);
		result.closed.push_back(line.closed);
		result.ends.push_back(line.ends);
	}
	const auto count = static_cast<Index>(kept.size());
	result.vertices.resize(3, count);
	result.normals.resize(3, count);
	result.curvature.resize(count);
	for (Index v = 0; v < count; ++v) {
		result.vertices.col(v) = lines.vertices.col(kept[v]);
		result.normals.col(v)  = lines.normals.col(kept[v]);
		result.curvature[v]    = lines.curvature[kept[v]];
	}
	return result;
}

} // namespace

LineNetwork untangled(const LineNetwork& lines)
{
	std::vector<Line> parts(lines.lines());
	for (Index l = 0; l < lines.lines(); ++l) {
		parts[l].vertices.resize(lines.offsets[l + 1] - lines.offsets[l]);
		std::iota(parts[l].vertices.begin(), parts[l].vertices.end(), lines.offsets[l]);
		parts[l].family = lines.family[l];
		parts[l].closed = lines.closed[l];
		parts[l].ends   = lines.ends[l];
	}
	bool any = false;
	for (int round = 0; round < rounds; ++round) {
		const std::vector<Crossing> crossings = findCrossings(lines, parts);
		if (crossings.empty())
			break;
		any = true;
		std::vector<char> changed(parts.size(), 0); // places along a line hold until its first cut
		for (const auto& [a, b] : crossings) {
			if (changed[a.line] || changed[b.line])
				continue;
			if (a.line == b.line) {
				cutLoop(parts[a.line], a.at, b.at);
				changed[a.line] = 1;
				continue;
			}
			const bool first =
				costOfEnding(parts[a.line], a.at) <= costOfEnding(parts[b.line], b.at);
			const Segment cut = first ? a : b;
			endAt(parts[cut.line], cut.at);
			changed[cut.line] = 1;
		}
		for (Line& line : parts)
			if (!line.isLine())
				line.vertices.clear();
	}
	return any ? assembled(lines, parts) : lines;
}

} // namespace curvature_lines
