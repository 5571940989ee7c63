// Dijkstra's search over the sides that faces are entered by.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "face_paths.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "face_joining.h"
#include "linked_faces.h"
#include "point_cloud.h"
#include "quad_patterns.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;
using Loop = LinkedFaces::Loop;

constexpr double infinity = std::numeric_limits<double>::infinity();

// Lengths of paths. The unit is one edge that is as long as those around it.
constexpr double longestFactor = 2.0; // of edges that are shorter or longer than those around
constexpr double featureCost   = 3.0; // more, of a turn beside a feature
constexpr double ringsCost     = 4.0; // of two triangles that need a smaller quad in each
constexpr double rimCost       = 2.0; // so that two odd faces near a rim rather find each other
constexpr double flatCost =
	2.0; // more, of a triangle's side on a rim: its middle gets a flat corner

} // namespace

bool isOddFace(const LinkedFaces& faces, Index face)
{
	return faces.size(face) > 2 && faces.size(face) % 2 == 1;
}

bool joinsTriangles(const LinkedFaces& faces, Index side)
{
	return faces.across(side) >= 0 && faces.size(faces.faceOf(side)) == 3 &&
	       faces.size(faces.faceOf(faces.across(side))) == 3;
}

FacePath FacePathSearch::nearest(Index start, double reach)
{
	m_start    = start;
	m_bestCost = infinity;
	m_paths.start(m_faces.sideCount());
	for (Index k = 0; k < m_faces.size(start); ++k) {
		const Index side = m_faces.firstSide(start) + k;
		leave(side, endCost(side), LinkedFaces::rim);
	}
	FacePath found;
	while (m_paths.isOpen()) {
		const auto [cost, entered] = m_paths.nearest();
		if (cost >= m_bestCost)
			break;
		if (cost > reach) {
			found.endless = true;
			break;
		}
		if (m_paths.take())
			pass(entered);
	}
	if (m_bestCost == infinity || (found.endless && m_bestCost > reach))
		return found;
	found.cost  = m_bestCost;
	found.sides = sidesOfBest();
	return found;
}

void FacePathSearch::pass(Index entered)
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
	const double cost     = m_paths.cost(entered);
	for (Index k = 1; k < 4; ++k) {
		double whole = cost;
		if (k !=
		    2) // the centre has three edges, the corner opposite the one turned around gets one more
			whole += valenceCost +
			         irregularityCost(m_faces, m_faces.from(sides[k == 1 ? 3 : 2]), 1) +
			         (feature ? featureCost : 0.0);
		if (!isConvex) {
			std::vector<Vector3d> points(at.begin(), at.end());
			points.push_back(m_faces.middleOf(entered));
			points.push_back(m_faces.middleOf(sides[k]));
			points.push_back(0.25 * (at[0] + at[1] + at[2] + at[3]));
			const double sine = leastSine(quadPassages[k - 1], points, normal.normalized());
			whole += concaveCost(sine);
		}
		leave(sides[k], whole, entered);
	}
}

void FacePathSearch::leave(Index side, double cost, Index entered)
{
	const Index there = m_faces.across(side);
	if (there == LinkedFaces::tangled || (there >= 0 && m_faces.faceOf(there) == m_start))
		return;
	const double crossing = crossingCost(side);
	cost += crossing;
	if (there == LinkedFaces::rim || isOddFace(m_faces, m_faces.faceOf(there))) {
		if (there >= 0)
			cost = entered < 0 ? crossing + joinCost(side) : cost + endCost(there);
		else
			cost += rimCost + (entered < 0 && m_faces.size(m_start) == 3 ? flatCost : 0.0);
		if (cost < m_bestCost) {
			m_bestCost    = cost;
			m_bestEntered = entered;
			m_last        = side;
		}
		return;
	}
	if (m_faces.size(m_faces.faceOf(there)) == 4)
		m_paths.reach(there, cost, entered);
}

double FacePathSearch::crossingCost(Index side) const
{
	double mean = m_faces.meanLength(m_faces.faceOf(side));
	if (const Index there = m_faces.across(side); there >= 0)
		mean = 0.5 * (mean + m_faces.meanLength(m_faces.faceOf(there)));
	return inSteps(
		std::clamp(mean / (m_faces.length(side) + 1e-300), 1.0 / longestFactor, longestFactor));
}

double FacePathSearch::endCost(Index side) const
{
	if (m_faces.size(m_faces.faceOf(side)) != 5)
		return 0.0;
	const Loop            corners = m_faces.loopFrom(side);
	std::vector<Vector3d> points  = m_faces.positionsOf(corners);
	points.push_back(m_faces.middleOf(side));
	return cornerCost(leastSine(pentagonEnd, points, m_faces.normalOf(corners))) + valenceCost +
	       irregularityCost(m_faces, corners[3], 1);
}

double FacePathSearch::joinCost(Index side) const
{
	const JoinedFaces joined = joinedFaces(m_faces, side);
	if (!joined.quads.empty())
		return std::max(0.0, joined.cost);
	return joinsTriangles(m_faces, side) ? ringsCost
	                                     : endCost(side) + endCost(m_faces.across(side));
}

std::vector<Index> FacePathSearch::sidesOfBest() const
{
	std::vector<Index> sides = {m_last};
	for (Index entered = m_bestEntered; entered >= 0; entered = m_paths.before(entered))
		sides.push_back(m_faces.across(entered));
	std::reverse(sides.begin(), sides.end());
	std::vector<std::pair<Index, std::size_t>> visits;
	visits.reserve(sides.size());
	for (std::size_t k = 0; k < sides.size(); ++k)
		visits.emplace_back(m_faces.faceOf(sides[k]), k);
	std::sort(visits.begin(), visits.end());
	std::vector<Index> simple;
	for (std::size_t k = 0; k < sides.size(); ++k) {
		const std::pair<Index, std::size_t> end = {m_faces.faceOf(sides[k]), sides.size()};
		k = std::prev(std::lower_bound(visits.begin(), visits.end(), end))->second;
		simple.push_back(sides[k]);
	}
	return simple;
}

} // namespace curvature_lines
