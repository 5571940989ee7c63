// Shortest paths through the dual mesh (Dijkstra 1959) from odd faces, the shortest of all applied first.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "quad_completion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "linked_faces.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygon_splitting.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;
using Loop = LinkedFaces::Loop;
using Path = std::vector<Index>; // sides, by which every face is left

constexpr double infinity = std::numeric_limits<double>::infinity();

// Lengths of paths. The unit is one edge that is as long as those around it.
constexpr double longestFactor = 2.0; // of edges that are shorter or longer than those around
constexpr double valenceCost = 1.0; // of every edge that a vertex gets away from the regular number
constexpr double featureCost = 3.0; // more, of a turn beside a feature
constexpr double ringsCost   = 4.0; // of two triangles that need a smaller quad in each
constexpr double rimCost     = 2.0; // so that two odd faces near a rim rather find each other
constexpr double flatCost =
	2.0; // more, of a triangle's side on a rim: its middle gets a flat corner
constexpr double cornerCost  = 2.0; // times 1 - the least sine of a corner
constexpr double concaveCost = 6.0; // times a sine below 0, more
// Odd faces look so far first, and twice as far when all closer pairs are joined: most searches stay short.
constexpr double firstReach = 4.0;

// In steps that sums keep exactly: equal costs do not differ by rounding, and ties go by number on every order of the points.
double inSteps(double cost)
{
	constexpr double steps = 1 << 20;
	return std::round(cost * steps) / steps;
}

double costOf(double leastSine)
{
	return inSteps(cornerCost * (1.0 - leastSine) + concaveCost * std::max(0.0, -leastSine));
}

// A face cut into quads, as names of points: its corners from the start of the side that a path enters or
// leaves it by, then the middles of the sides divided, then a centre.
struct Pattern {
	int                               count;
	std::array<std::array<int, 4>, 5> parts;
};
constexpr Pattern triangleEnd = {1, {{{0, 3, 1, 2}}}};
constexpr Pattern pentagonEnd = {2, {{{3, 4, 0, 5}, {3, 5, 1, 2}}}};
// Of quads, by the sides from the one entered to the one left: 1 to 3. The middle of the first is named 4.
constexpr std::array<Pattern, 3> passages = {
	Pattern{3, {{{4, 1, 5, 6}, {5, 2, 3, 6}, {3, 0, 4, 6}}}},
	Pattern{2, {{{0, 4, 5, 3}, {4, 1, 2, 5}}}},
	Pattern{3, {{{5, 0, 4, 6}, {4, 1, 2, 6}, {2, 3, 5, 6}}}},
};
// A smaller quad in a quad.
constexpr Pattern ring = {
	5, {{{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}}}};

double leastSine(const std::array<Vector3d, 4>& corners, const Vector3d& normal)
{
	double least = 1.0;
	for (std::size_t k = 0; k < 4; ++k) {
		const Vector3d ahead = corners[(k + 1) % 4] - corners[k];
		const Vector3d back  = corners[(k + 3) % 4] - corners[k];
		const double   sine  = ahead.cross(back).dot(normal);
		least                = std::min(least, sine / (ahead.norm() * back.norm() + 1e-300));
	}
	return least;
}

double
leastSine(const Pattern& pattern, const std::vector<Vector3d>& points, const Vector3d& normal)
{
	double least = 1.0;
	for (int p = 0; p < pattern.count; ++p) {
		const auto& part = pattern.parts[p];
		least            = std::min(
            least,
            leastSine(
                {points[part[0]], points[part[1]], points[part[2]], points[part[3]]}, normal));
	}
	return least;
}

void addParts(const Pattern& pattern, const Loop& points, std::vector<Loop>& parts)
{
	for (int p = 0; p < pattern.count; ++p) {
		const auto& part = pattern.parts[p];
		parts.push_back({points[part[0]], points[part[1]], points[part[2]], points[part[3]]});
	}
}

bool isOdd(const LinkedFaces& faces, Index face)
{
	return faces.size(face) > 2 && faces.size(face) % 2 == 1;
}

Vector3d normalOf(const LinkedFaces& faces, const Loop& loop)
{
	Vector3d sum = Vector3d::Zero();
	for (const Index v : loop)
		sum += faces.normal(v);
	return sum.normalized();
}

std::vector<Vector3d> positionsOf(const LinkedFaces& faces, const Loop& loop)
{
	std::vector<Vector3d> positions;
	for (const Index v : loop)
		positions.push_back(faces.position(v));
	return positions;
}

Vector3d middleOf(const LinkedFaces& faces, Index side)
{
	return 0.5 * (faces.position(faces.from(side)) + faces.position(faces.to(side)));
}

// By how much a vertex gets away from four edges, or three on a rim.
double irregularity(const LinkedFaces& faces, Index vertex, Index change)
{
	const Index beyond = faces.valence(vertex) - (faces.isOnRim(vertex) ? 3 : 4);
	return valenceCost * (std::abs(beyond + change) - std::abs(beyond));
}

// Two faces with a common side, of four or six corners together, without that side.
class FacePair {
public:
	FacePair(const LinkedFaces& faces, Index side) :
			m_faces(faces), m_sides{side, faces.across(side)}
	{
		if (m_sides[1] < 0)
			return;
		// from the start of the side around the other face to its end, and back around its own
		const Index own   = faces.size(faces.faceOf(side)),
					other = faces.size(faces.faceOf(m_sides[1]));
		if (own + other != 6 && own + other != 8)
			return;
		for (Index k = 1; k < other; ++k)
			m_borderSides.push_back(faces.along(m_sides[1], k));
		for (Index k = 1; k < own; ++k)
			m_borderSides.push_back(faces.along(side, k));
		for (const Index s : m_borderSides)
			m_border.push_back(faces.from(s));
		m_far = other - 1;
	}

	struct Quads {
		std::vector<Loop> loops; // empty: there is no way
		double            cost = infinity;
	};
	// One or two that are convex, the cheapest. Every inner vertex keeps three edges, no two vertices get a
	// second edge, and features stay.
	Quads quads() const
	{
		Quads best;
		Loop  sorted = m_border;
		std::sort(sorted.begin(), sorted.end());
		if (m_border.empty() || m_faces.isFeature(m_sides[0]) ||
		    std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
			return best;
		const auto     at     = positionsOf(m_faces, m_border);
		const Vector3d normal = normalOf(m_faces, m_border);
		if (m_border.size() == 4) {
			const double sine = leastSine({at[0], at[1], at[2], at[3]}, normal);
			if (sine > 0.0 && canSpareSide(noDiagonal))
				best = {{m_border}, cost(sine, noDiagonal)};
			return best;
		}
		for (Index k = 0; k < 3; ++k) {
			const double sine = std::min(
				leastSine({at[k], at[k + 1], at[k + 2], at[k + 3]}, normal),
				leastSine({at[k + 3], at[(k + 4) % 6], at[(k + 5) % 6], at[k]}, normal));
			if (sine <= 0.0 || cost(sine, k) >= best.cost || !canSpareSide(k) || isEdge(k, k + 3))
				continue;
			const Loop& v = m_border;
			best.cost     = cost(sine, k);
			best.loops    = {
                {v[k], v[k + 1], v[k + 2], v[k + 3]},
                {v[k + 3], v[(k + 4) % 6], v[(k + 5) % 6], v[k]}};
		}
		return best;
	}

private:
	// Diagonals: number k leads from the border's vertex k to the one opposite.
	static constexpr Index noDiagonal = -1;

	// The change of a vertex's edges, given its place in the border.
	Index change(Index place, Index diagonal) const
	{
		const bool loses = place == 0 || place == m_far;
		const bool gains = diagonal != noDiagonal && place % 3 == diagonal;
		return Index(gains) - Index(loses);
	}

	double cost(double sine, Index diagonal) const
	{
		double sum = costOf(sine);
		for (Index k = 0; k < static_cast<Index>(m_border.size()); ++k)
			sum += irregularity(m_faces, m_border[k], change(k, diagonal));
		return sum;
	}

	bool canSpareSide(Index diagonal) const
	{
		for (const Index place : {Index(0), m_far}) {
			const Index v = m_border[place];
			if (!m_faces.isOnRim(v) && m_faces.valence(v) + change(place, diagonal) < 3)
				return false;
		}
		return true;
	}

	bool isEdge(Index i, Index j) const
	{
		const Index side = m_borderSides[i];
		Index       s    = side;
		do {
			if (m_faces.to(s) == m_border[j])
				return true;
			const Index there = m_faces.across(s);
			s                 = there < 0 ? there : m_faces.next(there);
		} while (s >= 0 && s != side);
		if (s == side)
			return false;
		for (s = m_faces.previous(side); s >= 0;) { // there is a rim: the other way round
			if (m_faces.from(s) == m_border[j])
				return true;
			const Index there = m_faces.across(s);
			s                 = there < 0 ? there : m_faces.previous(there);
		}
		return false;
	}

	const LinkedFaces&   m_faces;
	std::array<Index, 2> m_sides; // both of the common edge
	std::vector<Index>   m_borderSides;
	Loop                 m_border;
	Index                m_far = 0; // the place of the common edge's end in the border
};

bool joinsTriangles(const LinkedFaces& faces, Index side)
{
	return faces.across(side) >= 0 && faces.size(faces.faceOf(side)) == 3 &&
	       faces.size(faces.faceOf(faces.across(side))) == 3;
}

// The shortest path from an odd face, through quads, to another or to a rim.
class PathSearch {
public:
	explicit PathSearch(const LinkedFaces& faces) : m_faces(faces) {}

	struct Found {
		Path   path; // empty: none
		double cost    = infinity;
		bool   endless = false; // there may be one beyond reach
	};

	Found nearest(Index start, double reach)
	{
		begin(start);
		for (Index k = 0; k < m_faces.size(start); ++k) {
			const Index side = m_faces.firstSide(start) + k;
			leave(side, endCost(side), LinkedFaces::rim);
		}
		Found found;
		while (!m_heap.empty()) {
			const auto [cost, entered] = m_heap.top();
			if (cost >= m_best.cost)
				break;
			if (cost > reach) {
				found.endless = true;
				break;
			}
			m_heap.pop();
			if (cost == m_reached[entered].cost)
				pass(entered);
		}
		if (m_best.cost == infinity || (found.endless && m_best.cost > reach))
			return found;
		found.cost = m_best.cost;
		found.path = path();
		return found;
	}

private:
	// How a side was entered: from the face that was entered by another one.
	struct Reached {
		double cost    = infinity;
		Index  entered = -1;
		Index  round   = 0;
	};
	using Entry = std::pair<double, Index>; // cost, side entered

	void begin(Index start)
	{
		m_start = start;
		m_heap  = {};
		m_best  = {};
		++m_round;
		m_reached.resize(m_faces.sideCount());
	}

	void pass(Index entered)
	{
		std::array<Index, 4>    sides;
		std::array<Vector3d, 4> at;
		Vector3d                normal  = Vector3d::Zero();
		bool                    feature = false;
		for (Index k = 0; k < 4; ++k) {
			sides[k]      = m_faces.along(entered, k);
			const Index v = m_faces.from(sides[k]);
			at[k]         = m_faces.position(v);
			normal += m_faces.normal(v);
			feature = feature || m_faces.isOnFeature(v);
		}
		const bool   isConvex = leastSine(at, normal) > 0.0;
		const double cost     = m_reached[entered].cost;
		for (Index k = 1; k < 4; ++k) {
			double whole = cost;
			if (k !=
			    2) // the centre has three edges, the corner opposite the one turned around gets one more
				whole += valenceCost +
				         irregularity(m_faces, m_faces.from(sides[k == 1 ? 3 : 2]), 1) +
				         (feature ? featureCost : 0.0);
			if (!isConvex) {
				std::vector<Vector3d> points(at.begin(), at.end());
				points.push_back(middleOf(m_faces, entered));
				points.push_back(middleOf(m_faces, sides[k]));
				points.push_back(0.25 * (at[0] + at[1] + at[2] + at[3]));
				const double sine = leastSine(passages[k - 1], points, normal.normalized());
				whole += inSteps(concaveCost * std::max(0.0, -sine));
			}
			leave(sides[k], whole, entered);
		}
	}

	// `entered`: the side that the face was entered by; rim: it is the first.
	void leave(Index side, double cost, Index entered)
	{
		const Index there = m_faces.across(side);
		if (there == LinkedFaces::tangled || (there >= 0 && m_faces.faceOf(there) == m_start))
			return;
		const double crossing = crossingCost(side);
		cost += crossing;
		if (there == LinkedFaces::rim || isOdd(m_faces, m_faces.faceOf(there))) {
			if (there >= 0)
				cost = entered < 0 ? crossing + joinCost(side) : cost + endCost(there);
			else
				cost += rimCost + (entered < 0 && m_faces.size(m_start) == 3 ? flatCost : 0.0);
			if (cost < m_best.cost) {
				m_best = {cost, entered, m_round};
				m_last = side;
			}
			return;
		}
		Reached& reached = m_reached[there];
		if (m_faces.size(m_faces.faceOf(there)) != 4 ||
		    (reached.round == m_round && reached.cost <= cost))
			return;
		reached = {cost, entered, m_round};
		m_heap.emplace(cost, there);
	}

	double crossingCost(Index side) const
	{
		double mean = m_faces.meanLength(m_faces.faceOf(side));
		if (const Index there = m_faces.across(side); there >= 0)
			mean = 0.5 * (mean + m_faces.meanLength(m_faces.faceOf(there)));
		return inSteps(
			std::clamp(mean / (m_faces.length(side) + 1e-300), 1.0 / longestFactor, longestFactor));
	}

	// Of a path that begins or ends at this side of an odd face.
	double endCost(Index side) const
	{
		if (m_faces.size(m_faces.faceOf(side)) != 5)
			return 0.0;
		const Loop            corners = m_faces.loopFrom(side);
		std::vector<Vector3d> points  = positionsOf(m_faces, corners);
		points.push_back(middleOf(m_faces, side));
		return costOf(leastSine(pentagonEnd, points, normalOf(m_faces, corners))) + valenceCost +
		       irregularity(m_faces, corners[3], 1);
	}

	// Of two odd faces with a common side.
	double joinCost(Index side) const
	{
		const FacePair::Quads quads = FacePair(m_faces, side).quads();
		if (!quads.loops.empty())
			return std::max(0.0, quads.cost);
		return joinsTriangles(m_faces, side) ? ringsCost
		                                     : endCost(side) + endCost(m_faces.across(side));
	}

	// Every face once: where the path comes back to one, the round trip goes.
	Path path() const
	{
		Path sides = {m_last};
		for (Index entered = m_best.entered; entered >= 0; entered = m_reached[entered].entered)
			sides.push_back(m_faces.across(entered));
		std::reverse(sides.begin(), sides.end());
		std::vector<std::pair<Index, std::size_t>> visits;
		visits.reserve(sides.size());
		for (std::size_t k = 0; k < sides.size(); ++k)
			visits.emplace_back(m_faces.faceOf(sides[k]), k);
		std::sort(visits.begin(), visits.end());
		Path simple;
		for (std::size_t k = 0; k < sides.size(); ++k) {
			const std::pair<Index, std::size_t> end = {m_faces.faceOf(sides[k]), sides.size()};
			k = std::prev(std::lower_bound(visits.begin(), visits.end(), end))->second;
			simple.push_back(sides[k]);
		}
		return simple;
	}

	const LinkedFaces&   m_faces;
	Index                m_start = -1, m_last = -1, m_round = 0;
	Reached              m_best;
	std::vector<Reached> m_reached; // by the side entered
	std::priority_queue<Entry, std::vector<Entry>, std::greater<>> m_heap;
};

class QuadCompleter {
public:
	QuadCompleter(
		const PolygonMesh&             mesh,
		const std::vector<char>&       onFeature,
		const std::vector<VertexPair>& featureEdges) : m_faces(mesh, onFeature, featureEdges)
	{
	}

	// Even faces that no diagonal could cut.
	void cutEvenFaces()
	{
		const Index count = m_faces.faceCount();
		for (Index f = 0; f < count; ++f)
			if (m_faces.size(f) > 4 && m_faces.size(f) % 2 == 0) {
				std::vector<Loop> parts;
				addBetterFan(m_faces.loopFrom(m_faces.firstSide(f)), parts);
				m_faces.replace({f}, {}, parts);
			}
	}

	void joinOddFaces()
	{
		using Candidate = std::pair<double, Index>; // cost of its path or of none found yet, face
		std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> heap;
		const Index       count = m_faces.faceCount();
		std::vector<Path> paths(count);
		for (Index f = 0; f < count; ++f)
			if (isOdd(m_faces, f))
				heap.emplace(0.0, f);
		PathSearch search(m_faces);
		while (!heap.empty()) {
			const auto [cost, face] = heap.top();
			heap.pop();
			if (!isOdd(m_faces, face))
				continue;
			if (isStillThere(paths[face])) {
				apply(paths[face]);
				continue;
			}
			const double      reach = std::max(firstReach, 2.0 * cost);
			PathSearch::Found found = search.nearest(face, reach);
			if (!found.path.empty())
				heap.emplace(found.cost, face);
			else if (found.endless)
				heap.emplace(reach, face);
			paths[face] = std::move(found.path);
		}
	}

	QuadCompletion result(std::vector<char>& onFeature) const
	{
		QuadCompletion result;
		result.mesh         = m_faces.mesh();
		result.featureEdges = m_faces.featureEdges();
		result.paths        = m_paths;
		result.rimPaths     = m_rimPaths;
		for (Index f = 0; f < m_faces.faceCount(); ++f)
			result.left += !m_faces.isReplaced(f) && m_faces.size(f) != 4;
		onFeature = m_faces.onFeature();
		return result;
	}

private:
	bool isStillThere(const Path& path) const
	{
		const auto isGone = [&](Index side) { return m_faces.isReplaced(m_faces.faceOf(side)); };
		if (path.empty() || std::any_of(path.begin(), path.end(), isGone))
			return false;
		const Index end = m_faces.across(path.back());
		return end == LinkedFaces::rim || isOdd(m_faces, m_faces.faceOf(end));
	}

	void apply(const Path& path)
	{
		const Index end = m_faces.across(path.back());
		++(end >= 0 ? m_paths : m_rimPaths);
		if (path.size() == 1 && end >= 0 && joinNeighbors(path.front()))
			return;
		std::vector<Index>              faces;
		std::vector<Loop>               parts;
		std::vector<LinkedFaces::Split> splits;
		Index                           before = -1;
		for (std::size_t k = 0; k < path.size(); ++k) {
			const Index middle = addSplit(path[k], splits);
			if (k == 0)
				cutEnd(path[k], middle, parts);
			else
				cutQuad(m_faces.across(path[k - 1]), before, path[k], middle, parts);
			faces.push_back(m_faces.faceOf(path[k]));
			before = middle;
		}
		if (end >= 0) {
			// Two pentagons with a common side may have the corner opposite it in common too.
			const bool sameCorner = path.size() == 1 && isPentagon(path.front()) &&
			                        isPentagon(end) && oppositeOf(path.front()) == oppositeOf(end);
			cutEnd(end, before, parts, sameCorner);
			faces.push_back(m_faces.faceOf(end));
		}
		m_faces.replace(faces, std::move(splits), parts);
	}

	Index addSplit(Index side, std::vector<LinkedFaces::Split>& splits)
	{
		const Index middle = m_faces.addMiddle(side);
		splits.push_back({side, middle});
		if (m_faces.across(side) >= 0)
			splits.push_back({m_faces.across(side), middle});
		return middle;
	}

	bool isPentagon(Index side) const { return m_faces.size(m_faces.faceOf(side)) == 5; }
	// The corner opposite a side of a pentagon.
	Index oppositeOf(Index side) const { return m_faces.from(m_faces.along(side, 3)); }

	void cutEnd(Index side, Index middle, std::vector<Loop>& parts, bool alwaysFan = false)
	{
		Loop points = m_faces.loopFrom(side);
		if (points.size() <= 5 && !alwaysFan) {
			points.push_back(middle);
			addParts(points.size() == 4 ? triangleEnd : pentagonEnd, points, parts);
			return;
		}
		// An edge of the fan ends at the middle: else it would have two edges if a triangle is across.
		points.insert(points.begin() + 1, middle);
		std::rotate(points.begin(), points.begin() + 1, points.end());
		addFan(points, parts);
	}

	void cutQuad(Index entered, Index before, Index left, Index after, std::vector<Loop>& parts)
	{
		const Index sides   = (left - entered + 4) % 4;
		Loop        points  = m_faces.loopFrom(entered);
		const Loop  corners = points;
		points.push_back(before);
		points.push_back(after);
		if (sides != 2)
			points.push_back(m_faces.addCenter(corners));
		addParts(passages[sides - 1], points, parts);
	}

	// Around a new centre, with edges to every second vertex from the first.
	void addFan(const Loop& border, std::vector<Loop>& parts)
	{
		const Index center = m_faces.addCenter(border);
		for (std::size_t k = 0; k < border.size(); k += 2)
			parts.push_back({center, border[k], border[k + 1], border[(k + 2) % border.size()]});
	}

	void addBetterFan(Loop border, std::vector<Loop>& parts)
	{
		const auto     at     = positionsOf(m_faces, border);
		const Vector3d normal = normalOf(m_faces, border);
		Vector3d       center = Vector3d::Zero();
		for (const Vector3d& p : at)
			center += p / double(at.size());
		std::array<double, 2> least = {1.0, 1.0};
		for (std::size_t k = 0; k < at.size(); ++k)
			least[k % 2] = std::min(
				least[k % 2],
				leastSine(
					{center, at[k], at[(k + 1) % at.size()], at[(k + 2) % at.size()]}, normal));
		if (least[1] > least[0])
			std::rotate(border.begin(), border.begin() + 1, border.end());
		addFan(border, parts);
	}

	// Two odd faces with a common side, unless a path of that side alone serves them as it serves others.
	bool joinNeighbors(Index side)
	{
		const Index              there = m_faces.across(side);
		const std::vector<Index> faces = {m_faces.faceOf(side), m_faces.faceOf(there)};
		const FacePair::Quads    quads = FacePair(m_faces, side).quads();
		if (!quads.loops.empty()) {
			m_faces.replace(faces, {}, quads.loops);
			return true;
		}
		if (!joinsTriangles(m_faces, side))
			return false;
		// The middle of their common edge would have two edges only: a smaller quad goes into either.
		std::vector<LinkedFaces::Split> splits;
		std::vector<Loop>               parts;
		const Index                     middle = addSplit(side, splits);
		for (const Index s : {side, there}) {
			Loop border = m_faces.loopFrom(s);
			border.insert(border.begin() + 1, middle);
			addRing(border, parts);
		}
		m_faces.replace(faces, std::move(splits), parts);
		return true;
	}

	void addRing(Loop border, std::vector<Loop>& parts)
	{
		const Loop corners = border;
		for (const Index v : corners) { // half-way to the mean
			Loop weighted = corners;
			weighted.insert(weighted.end(), 4, v);
			border.push_back(m_faces.addCenter(weighted));
		}
		addParts(ring, border, parts);
	}

	LinkedFaces m_faces;
	Index       m_paths = 0, m_rimPaths = 0;
};

bool hasLargeFaces(const PolygonMesh& mesh)
{
	for (Index f = 0; f < mesh.faceCount(); ++f)
		if (mesh.faces[f].size() > 5)
			return true;
	return false;
}

PolygonMesh withSmallFaces(const PolygonMesh& mesh)
{
	PolygonSplitter splitter(mesh);
	splitter.cutLargeFaces();
	return splitter.mesh();
}

} // namespace

QuadCompletion completeQuads(
	const PolygonMesh&             mesh,
	std::vector<char>&             onFeature,
	const std::vector<VertexPair>& featureEdges)
{
	QuadCompleter completer(
		hasLargeFaces(mesh) ? withSmallFaces(mesh) : mesh, onFeature, featureEdges);
	completer.cutEvenFaces();
	completer.joinOddFaces();
	return completer.result(onFeature);
}

QuadCompletion completeQuads(const PolygonMesh& mesh, std::vector<char>& onFeature)
{
	return completeQuads(mesh, onFeature, edgesBetween(mesh, onFeature));
}

} // namespace curvature_lines
