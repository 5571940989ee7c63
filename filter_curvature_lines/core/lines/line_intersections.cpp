// Crossings of lines of curvature (A09 section 5.2) with exact predicates on normal strips (CGAL).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "line_intersections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <vector>

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <Eigen/Geometry>

#include "crossing_order.h"
#include "line_crossing.h"
#include "line_network.h"
#include "point_cloud.h"
#include "progress.h"
#include "voronoi_cells.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point  = Kernel::Point_3;

// Half the height of a strip, in spacings of the cloud: lines on the same surface differ in height by the
// error of their projection, a fraction of the spacing. By experiment.
constexpr double stripHeight = 1.5;
// Two lines that cross and cross back within this many half heights only touch. By experiment.
constexpr double touchLength = 4.0;
// Below so many boxes CGAL scans instead of dividing them further; strips are flat and divide badly. CGAL's
// own default is 10; chosen for time on the clouds of benchmarks/table1.py. Changes no result.
constexpr std::ptrdiff_t scannedBoxes = 300;

struct Segment {
	Index line, index; // index: along the line
	Index from, to;    // line vertices
};

Segment segmentOf(const LineNetwork& lines, Index line, Index index)
{
	const Index first = lines.offsets[line], from = first + index;
	const Index to = from + 1 == lines.offsets[line + 1] ? first : from + 1;
	return {line, index, from, to};
}

// Half height of the strip at every line vertex.
std::vector<double>
stripHeights(const VoronoiCells& cells, const LineNetwork& lines, const Progress& progress)
{
	std::vector<double> heights(lines.vertices.cols(), 0.0);
	parallelFor(lines.lines(), progress, [&](Index line) {
		Index cell = 0;
		for (Index v = lines.offsets[line]; v < lines.offsets[line + 1]; ++v) {
			const Index next = cells.locate(lines.vertices.col(v), cell);
			const bool  same = next == cell && v > lines.offsets[line];
			heights[v]       = same ? heights[v - 1] : stripHeight * siteSpacing(cells, next);
			cell             = next;
		}
	});
	return heights;
}

class NormalStrips {
public:
	NormalStrips(const LineNetwork& lines, const std::vector<double>& heights) : m_lines(lines)
	{
		m_points.reserve(heights.size());
		m_rims.reserve(2 * heights.size());
		for (Index v = 0; v < static_cast<Index>(heights.size()); ++v) {
			const Vector3d p = lines.vertices.col(v), up = heights[v] * lines.normals.col(v);
			m_points.push_back(toPoint(p));
			m_rims.push_back(toPoint(p - up));
			m_rims.push_back(toPoint(p + up));
		}
	}

	CGAL::Bbox_3 boundingBox(const Segment& s) const { return rimBox(s.from) + rimBox(s.to); }

	// Appends where segment b passes through the strip of segment a.
	void pierce(const Segment& a, const Segment& b, std::vector<LineCrossing>& crossings) const
	{
		// Corners by the rims' numbering; both triangles face to the right of a.
		const Index low0 = 2 * a.from, low1 = 2 * a.to, high0 = low0 + 1, high1 = low1 + 1;
		for (const auto& triangle : {Corners{low0, low1, high1}, Corners{low0, high1, high0}}) {
			if (const int side = passes(triangle, b)) {
				const LineCrossing crossing = place(a, b, triangle, side);
				if (sameSheet(a, b, crossing))
					crossings.push_back(crossing);
			}
		}
	}

private:
	using Corners = std::array<Index, 3>;

	CGAL::Bbox_3 rimBox(Index v) const
	{
		const std::size_t low = 2 * static_cast<std::size_t>(v);
		return m_rims[low].bbox() + m_rims[low + 1].bbox();
	}
	static Point toPoint(const Vector3d& p) { return Point(p.x(), p.y(), p.z()); }
	Vector3d rim(Index corner) const
	{
		return {m_rims[corner].x(), m_rims[corner].y(), m_rims[corner].z()};
	}

	// Zero counts as positive everywhere, as if the points were shifted by an infinitesimal amount,
	// so that a line through a joint passes through exactly one of the two triangles that share it.
	static bool positive(const Point& p, const Point& q, const Point& r, const Point& s)
	{
		return CGAL::orientation(p, q, r, s) != CGAL::NEGATIVE;
	}
	bool rightOf(const Corners& t, const Point& p) const
	{
		return positive(m_rims[t[0]], m_rims[t[1]], m_rims[t[2]], p);
	}
	// Which side of the triangle's side c0 c1 the line of b passes; both triangles agree about it.
	bool turns(const Segment& b, Index c0, Index c1) const
	{
		const bool ordered = c0 < c1;
		const bool turn    = positive(
            m_points[b.from], m_points[b.to], m_rims[ordered ? c0 : c1], m_rims[ordered ? c1 : c0]);
		return turn == ordered;
	}

	// 0: b does not pass; +1: to the left of the strip, -1: to its right.
	int passes(const Corners& t, const Segment& b) const
	{
		const bool startsRight = rightOf(t, m_points[b.from]);
		if (startsRight == rightOf(t, m_points[b.to]))
			return 0;
		const bool turn = turns(b, t[0], t[1]);
		if (turn != turns(b, t[1], t[2]) || turn != turns(b, t[2], t[0]))
			return 0;
		return startsRight ? 1 : -1;
	}

	LineCrossing place(const Segment& a, const Segment& b, const Corners& t, int side) const
	{
		const auto&    vertices = m_lines.vertices;
		const Vector3d q0 = vertices.col(b.from), q1 = vertices.col(b.to);
		const Vector3d c0 = rim(t[0]), e1 = rim(t[1]) - c0, e2 = rim(t[2]) - c0;
		const Vector3d normal = e1.cross(e2);
		const double   d0 = normal.dot(q0 - c0), d1 = normal.dot(q1 - c0);
		const double   onB  = d0 == d1 ? 0.5 : belowOne(d0 / (d0 - d1));
		const Vector3d x    = q0 + onB * (q1 - q0) - c0;
		const double   area = normal.squaredNorm();
		const double   w1 = normal.dot(x.cross(e2)) / area, w2 = normal.dot(e1.cross(x)) / area;
		// Along a, corner 0 is at 0, corner 1 at 1, and corner 2 at 1 in the lower triangle only.
		const bool   lower = t[2] >> 1 == a.to;
		const double onA   = belowOne(area > 0.0 ? w1 + (lower ? w2 : 0.0) : 0.5);

		const Vector3d p0 = vertices.col(a.from), p1 = vertices.col(a.to);
		LineCrossing   crossing;
		crossing.position     = 0.5 * (p0 + onA * (p1 - p0) + q0 + onB * (q1 - q0));
		crossing.normal       = (normalOn(a, onA) + normalOn(b, onB)).normalized();
		crossing.line[0]      = a.line;
		crossing.line[1]      = b.line;
		crossing.parameter[0] = a.index + onA;
		crossing.parameter[1] = b.index + onB;
		crossing.tangent[0]   = (p1 - p0).normalized();
		crossing.tangent[1]   = (q1 - q0).normalized();
		crossing.side         = side;
		// The tangents sort the edges around the vertex: they have to give the same side as the
		// predicates.
		const Vector3d left  = crossing.normal.cross(crossing.tangent[0]).normalized();
		const double   aside = crossing.tangent[1].dot(left);
		if (aside * side < 0.0)
			crossing.tangent[1] -= 2.0 * aside * left;
		return crossing;
	}

	bool sameSheet(const Segment& a, const Segment& b, const LineCrossing& crossing) const
	{
		const double onA = crossing.parameter[0] - a.index, onB = crossing.parameter[1] - b.index;
		return normalOn(a, onA).dot(normalOn(b, onB)) > 0.0;
	}

	Vector3d normalOn(const Segment& s, double t) const
	{
		return (1.0 - t) * m_lines.normals.col(s.from) + t * m_lines.normals.col(s.to);
	}
	static double belowOne(double t) { return std::clamp(t, 0.0, 1.0 - 1e-12); }

	const LineNetwork& m_lines;
	std::vector<Point> m_points, m_rims; // of every line vertex; below and above it
};

// Neighbours along a line share a vertex; they do not cross.
bool adjoin(const LineNetwork& lines, const Segment& a, const Segment& b)
{
	if (a.line != b.line)
		return false;
	const Index apart = std::abs(a.index - b.index);
	return apart < 2 || (isClosed(lines, a.line) && apart == segmentCount(lines, a.line) - 1);
}

std::vector<LineCrossing> findCrossings(
	const LineNetwork& lines, const std::vector<double>& heights, const Progress& progress)
{
	using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, Segment>;
	const NormalStrips strips(lines, heights);
	std::vector<Box>   boxes;
	for (Index line = 0; line < lines.lines(); ++line) {
		for (Index k = 0; k < segmentCount(lines, line); ++k) {
			const Segment s = segmentOf(lines, line, k);
			boxes.emplace_back(strips.boundingBox(s), s);
		}
	}

	std::vector<LineCrossing> crossings;
	std::size_t               tested = 0;
	const auto                test   = [&](const Box& boxA, const Box& boxB) {
        const Segment &a = boxA.info(), &b = boxB.info();
        if (++tested % (1 << 18) == 0)
            progress.report(0.5);
        if (adjoin(lines, a, b))
            return;
        // Of a pair of lines always the same one carries the strip: its crossings are then
        // consistent.
        if (std::tie(a.line, a.index) < std::tie(b.line, b.index))
            strips.pierce(a, b, crossings);
        else
            strips.pierce(b, a, crossings);
	};
	CGAL::box_self_intersection_d(
		boxes.begin(),
		boxes.end(),
		test,
		CGAL::Box_intersection_d::Box_traits_d<Box>(),
		scannedBoxes);
	std::sort(crossings.begin(), crossings.end(), [](const LineCrossing& a, const LineCrossing& b) {
		return std::tie(a.line[0], a.line[1], a.parameter[0], a.parameter[1]) <
		       std::tie(b.line[0], b.line[1], b.parameter[0], b.parameter[1]);
	});
	return crossings;
}

} // namespace

LineIntersections
intersectLines(const VoronoiCells& cells, const LineNetwork& lines, const Progress& progress)
{
	LineIntersections         result;
	const std::vector<double> heights =
		stripHeights(cells, lines, progress.sub(0.0, 0.3, "Finding crossings"));
	result.crossings = findCrossings(lines, heights, progress.sub(0.3, 0.9, "Finding crossings"));
	const std::size_t   found = result.crossings.size();
	std::vector<double> reach;
	reach.reserve(heights.size());
	for (double height : heights)
		reach.push_back(touchLength * height);
	result.reordered = makeConsistent(lines, reach, result.crossings);
	result.cancelled = static_cast<Index>(found - result.crossings.size());
	result.alongLine = sortAlongLines(lines, result.crossings);
	for (Index line = 0; line < lines.lines(); ++line) {
		const bool crossed = !result.alongLine[line].empty();
		result.dangling += crossed ? (isClosed(lines, line) ? 0 : 2) : 1;
	}
	progress.report(1.0);
	return result;
}

} // namespace curvature_lines
