// Empty digons and curls removed, and triangles of crossings put in an order that a surface allows.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "crossing_order.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "line_crossing.h"
#include "line_network.h"
#include "point_cloud.h"

namespace curvature_lines {

namespace {

constexpr int mostRounds = 50; // a safeguard: a few do

// Lengths along the lines, from one parameter to another.
class ArcLengths {
public:
	explicit ArcLengths(const LineNetwork& lines) : m_lines(lines), m_length(lines.vertices.cols())
	{
		for (Index line = 0; line < lines.lines(); ++line) {
			const Index first = lines.offsets[line], n = lines.offsets[line + 1] - first;
			double      length = 0.0;
			for (Index k = 0; k < n; ++k) {
				m_length[first + k] = length;
				length += (lines.vertices.col(first + (k + 1) % n) - lines.vertices.col(first + k))
				              .norm();
			}
			m_total.push_back(length);
		}
	}

	// Forward, through the end of a closed line where need be.
	double between(Index line, double from, double to) const
	{
		const double length = at(line, to) - at(line, from);
		return length < 0.0 ? length + m_total[line] : length;
	}

private:
	double at(Index line, double parameter) const
	{
		const Index  v   = m_lines.offsets[line] + static_cast<Index>(parameter);
		const double end = v + 1 == m_lines.offsets[line + 1] ? m_total[line] : m_length[v + 1];
		return m_length[v] + (parameter - static_cast<Index>(parameter)) * (end - m_length[v]);
	}

	const LineNetwork&  m_lines;
	std::vector<double> m_length; // at each vertex, from the line's start
	std::vector<double> m_total;  // all around
};

// An entry is 2 * crossing + slot: one line's passage through a crossing; entry ^ 1 is the other
// line's.
class Passages {
public:
	Passages(
		const LineNetwork&               lines,
		const ArcLengths&                arcs,
		const std::vector<double>&       reach,
		const std::vector<LineCrossing>& crossings) :
			m_lines(lines), m_arcs(arcs), m_reach(reach), m_crossings(crossings),
			m_along(sortAlongLines(lines, crossings)), m_place(2 * crossings.size())
	{
		for (const std::vector<Index>& entries : m_along)
			for (std::size_t k = 0; k < entries.size(); ++k)
				m_place[entries[k]] = static_cast<Index>(k);
	}

	Index size() const { return static_cast<Index>(m_place.size()); }
	Index line(Index entry) const { return m_crossings[entry >> 1].line[entry & 1]; }
	// +1: the other line goes over to the left of this one.
	int side(Index entry) const
	{
		return entry & 1 ? -m_crossings[entry >> 1].side : m_crossings[entry >> 1].side;
	}

	// The neighbour of an entry along its line in either direction, or -1 when there is none close
	// by.
	Index near(Index entry, bool forward) const
	{
		const std::vector<Index>& entries = m_along[line(entry)];
		const Index n = static_cast<Index>(entries.size()), k = m_place[entry] + (forward ? 1 : -1);
		if (n == 1 || ((k < 0 || k == n) && !isClosed(m_lines, line(entry))))
			return -1;
		const Index other = entries[(k + n) % n];
		return forward ? (isShort(entry, other) ? other : -1)
		               : (isShort(other, entry) ? other : -1);
	}

private:
	bool isShort(Index from, Index to) const
	{
		const double start = parameter(from);
		const Index  v     = m_lines.offsets[line(from)] + static_cast<Index>(start);
		return m_arcs.between(line(from), start, parameter(to)) < m_reach[v];
	}
	double parameter(Index entry) const { return m_crossings[entry >> 1].parameter[entry & 1]; }

	const LineNetwork&                    m_lines;
	const ArcLengths&                     m_arcs;
	const std::vector<double>&            m_reach;
	const std::vector<LineCrossing>&      m_crossings;
	const std::vector<std::vector<Index>> m_along;
	std::vector<Index>                    m_place; // of every entry on its line
};

bool removeTouches(const Passages& passages, std::vector<LineCrossing>& crossings)
{
	std::vector<char> removed(crossings.size(), 0);
	for (Index a = 0; a < passages.size(); ++a) {
		const Index b = passages.near(a, true);
		if (b < 0 || removed[a >> 1] || removed[b >> 1])
			continue;
		const bool digon =
			passages.near(a ^ 1, true) == (b ^ 1) || passages.near(a ^ 1, false) == (b ^ 1);
		if (digon && passages.side(a) != passages.side(b))
			removed[a >> 1] = removed[b >> 1] = 1;
	}
	std::size_t kept = 0;
	for (std::size_t c = 0; c < removed.size(); ++c)
		if (!removed[c])
			crossings[kept++] = crossings[c];
	crossings.resize(kept);
	return kept < removed.size();
}

// A line that crosses itself again at once does so by noise, whatever else passes through the loop.
void removeCurls(
	const LineNetwork&         lines,
	const ArcLengths&          arcs,
	const std::vector<double>& reach,
	std::vector<LineCrossing>& crossings)
{
	const auto isCurl = [&](const LineCrossing& c) {
		if (c.line[0] != c.line[1])
			return false;
		const Index  line = c.line[0];
		const double near = reach[lines.offsets[line] + static_cast<Index>(c.parameter[0])];
		return arcs.between(line, c.parameter[0], c.parameter[1]) < near ||
		       (isClosed(lines, line) && arcs.between(line, c.parameter[1], c.parameter[0]) < near);
	};
	crossings.erase(std::remove_if(crossings.begin(), crossings.end(), isCurl), crossings.end());
}

// The triangle with corners u and v on line L, u and w on M, v and w on N; v follows u on L.
struct Triangle {
	Index onL[2], onM[2], onN[2]; // entries: u, v; u, w; v, w
	bool  afterOnM, afterOnN;     // whether w follows u on M, v on N
};

// The entries to exchange, or false when the three orders fit together.
bool findWrongOrder(const Passages& passages, const Triangle& t, Index exchange[2])
{
	const auto left = [&](Index entry, bool after) { return (passages.side(entry) > 0) == after; };
	const bool l    = left(t.onL[0], t.afterOnM) == left(t.onL[1], t.afterOnN);
	const bool m    = left(t.onM[0], true) == left(t.onM[1], !t.afterOnN);
	const bool n    = left(t.onN[0], false) == left(t.onN[1], !t.afterOnM);
	if (l + m + n != 1)
		return false;
	const Index* wrong = l ? t.onL : m ? t.onM : t.onN;
	std::copy(wrong, wrong + 2, exchange);
	return true;
}

Index reorderTriangles(const Passages& passages, std::vector<LineCrossing>& crossings)
{
	std::vector<char> moved(crossings.size(), 0);
	Index             exchanges = 0;
	const auto        tryAt     = [&](const Triangle& t) {
        const Index corners[] = {t.onL[0] >> 1, t.onL[1] >> 1, t.onM[1] >> 1};
        Index       exchange[2];
        if (moved[corners[0]] || moved[corners[1]] || moved[corners[2]] ||
            !findWrongOrder(passages, t, exchange))
            return;
        std::swap(
            crossings[exchange[0] >> 1].parameter[exchange[0] & 1],
            crossings[exchange[1] >> 1].parameter[exchange[1] & 1]);
        for (const Index c : corners)
            moved[c] = 1;
        ++exchanges;
	};
	for (Index a = 0; a < passages.size(); ++a) {
		const Index b = passages.near(a, true);
		if (b < 0 || passages.line(a ^ 1) == passages.line(b ^ 1))
			continue;
		for (const bool afterOnM : {false, true}) {
			const Index w = passages.near(a ^ 1, afterOnM);
			for (const bool afterOnN : {false, true})
				if (w >= 0 && w >> 1 != b >> 1 && passages.near(b ^ 1, afterOnN) == (w ^ 1))
					tryAt({{a, b}, {a ^ 1, w}, {b ^ 1, w ^ 1}, afterOnM, afterOnN});
		}
	}
	return exchanges;
}

} // namespace

std::vector<std::vector<Index>>
sortAlongLines(const LineNetwork& lines, const std::vector<LineCrossing>& crossings)
{
	std::vector<std::vector<Index>> along(lines.lines());
	for (Index c = 0; c < static_cast<Index>(crossings.size()); ++c)
		for (const Index slot : {0, 1})
			along[crossings[c].line[slot]].push_back(2 * c + slot);
	const auto parameter = [&](Index entry) { return crossings[entry >> 1].parameter[entry & 1]; };
	for (std::vector<Index>& entries : along)
		std::sort(entries.begin(), entries.end(), [&](Index a, Index b) {
			return std::make_pair(parameter(a), a) < std::make_pair(parameter(b), b);
		});
	return along;
}

Index makeConsistent(
	const LineNetwork&         lines,
	const std::vector<double>& reach,
	std::vector<LineCrossing>& crossings)
{
	const ArcLengths arcs(lines);
	Index            exchanges = 0;
	removeCurls(lines, arcs, reach, crossings);
	for (int round = 0; round < mostRounds; ++round) {
		while (removeTouches(Passages(lines, arcs, reach, crossings), crossings)) {
		}
		const Index more = reorderTriangles(Passages(lines, arcs, reach, crossings), crossings);
		if (more == 0)
			break;
		exchanges += more;
	}
	return exchanges;
}

} // namespace curvature_lines
