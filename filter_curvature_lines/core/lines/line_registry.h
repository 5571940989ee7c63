// Flow segments registered with the cloud points they pass, and the proximity queries of the tracing: a
// breadth-first search over the minimum neighbourhoods (A09 section 5.1), which stays on its own sheet.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "neighborhoods.h"
#include "point_cloud.h"

namespace curvature_lines {

// One piece of a line between two flow points, each in the Voronoi cell of a cloud point.
struct FlowSegment {
	Eigen::Vector3d from, to, normal;
	Index           fromCell, toCell;
	Index           line;
	double          arc; // arc length of its middle, measured from the seed of the line
};

// Is there a line within `radius`? Own segments count only where their arc lies in (ownFrom, ownTo), and
// within ownRadius.
struct ProximityQuery {
	Eigen::Vector3d position, normal;
	Index           cell; // of `position`
	double          radius;
	Index           line      = -1;
	double          ownRadius = 0.0, ownFrom = 0.0, ownTo = 0.0;
};

// The minimum neighbourhoods made symmetric: a search must be able to come back the way it went.
NeighborLists proximityGraph(const MinimumNeighborhoods& minimum);

// The segments of one family. All arguments must outlive it.
class LineRegistry {
public:
	LineRegistry(
		const PointCloud&           cloud,
		const MinimumNeighborhoods& minimum,
		const NeighborLists&        proximity); // proximityGraph(minimum)

	void add(const FlowSegment& segment);
	Index size() const { return static_cast<Index>(m_segments.size()); }
	void truncate(Index size); // takes back the segments added last

	// Distances are to segments, not samples; segments whose normal is more than 60 degrees off are on
	// another sheet or beyond a fold. Uses scratch of its own: one query at a time.
	bool occupied(const ProximityQuery& query);

	// Crossings with another family, counted segment by segment in the tangent plane of the cell they
	// share. An estimate: crossings where they share none are missed.
	Index countCrossings(const LineRegistry& other, const Eigen::Matrix3Xd& normals) const;

private:
	struct Entry {
		Index segment, next;
	};

	bool blocks(const FlowSegment& segment, const ProximityQuery& query) const;
	void enter(Index cell, Index segment);

	const Eigen::Matrix3Xd&    m_positions;
	const std::vector<double>& m_spacing;
	const NeighborLists&       m_neighbors;
	std::vector<FlowSegment>   m_segments;
	std::vector<Entry>         m_entries; // chained per cell, newest first
	std::vector<Index>         m_first;   // N: newest entry of a cell, -1 if none
	std::vector<std::uint32_t> m_visited; // N: the query that last came by
	std::uint32_t              m_query = 0;
	std::vector<Index>         m_queue;
};

} // namespace curvature_lines
