// Diagonals of the polygon that is left without the common edge.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "face_joining.h"

#include <algorithm>
#include <array>
#include <vector>

#include <Eigen/Core>

#include "linked_faces.h"
#include "point_cloud.h"
#include "quad_patterns.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;
using Loop = LinkedFaces::Loop;

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

	JoinedFaces quads() const
	{
		JoinedFaces best;
		Loop        sorted = m_border;
		std::sort(sorted.begin(), sorted.end());
		if (m_border.empty() || m_faces.isFeature(m_sides[0]) ||
		    std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
			return best;
		const auto     at     = m_faces.positionsOf(m_border);
		const Vector3d normal = m_faces.normalOf(m_border);
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
			best.quads    = {
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
		double sum = cornerCost(sine);
		for (Index k = 0; k < static_cast<Index>(m_border.size()); ++k)
			sum += irregularityCost(m_faces, m_border[k], change(k, diagonal));
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

} // namespace

JoinedFaces joinedFaces(const LinkedFaces& faces, Index side)
{
	return FacePair(faces, side).quads();
}

} // namespace curvature_lines
