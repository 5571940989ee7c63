// Odd faces joined pair by pair, the shortest path of all first, and what lies on a path cut into quads.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "quad_completion.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "face_joining.h"
#include "face_paths.h"
#include "linked_faces.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygon_splitting.h"
#include "quad_patterns.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;
using Loop = LinkedFaces::Loop;
using Path = std::vector<Index>; // sides, by which every face is left

// Odd faces look so far first, and twice as far when all closer pairs are joined: most searches stay short.
constexpr double firstReach = 4.0;

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
			if (isOddFace(m_faces, f))
				heap.emplace(0.0, f);
		FacePathSearch search(m_faces);
		while (!heap.empty()) {
			const auto [cost, face] = heap.top();
			heap.pop();
			if (!isOddFace(m_faces, face))
				continue;
			if (isStillThere(paths[face])) {
				apply(paths[face]);
				continue;
			}
			const double reach = std::max(firstReach, 2.0 * cost);
			FacePath     found = search.nearest(face, reach);
			if (!found.sides.empty())
				heap.emplace(found.cost, face);
			else if (found.endless)
				heap.emplace(reach, face);
			paths[face] = std::move(found.sides);
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
		return end == LinkedFaces::rim || isOddFace(m_faces, m_faces.faceOf(end));
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
		addParts(quadPassages[sides - 1], points, parts);
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
		const auto     at     = m_faces.positionsOf(border);
		const Vector3d normal = m_faces.normalOf(border);
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
		const Index              there  = m_faces.across(side);
		const std::vector<Index> faces  = {m_faces.faceOf(side), m_faces.faceOf(there)};
		const JoinedFaces        joined = joinedFaces(m_faces, side);
		if (!joined.quads.empty()) {
			m_faces.replace(faces, {}, joined.quads);
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
		addParts(quadRing, border, parts);
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
