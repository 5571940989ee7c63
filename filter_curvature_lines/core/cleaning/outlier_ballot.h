// The votes about one point and their result (in place of counting votes in A09 section 4.1).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "outlier_voter.h"
#include "point_cloud.h"

namespace curvature_lines {

// A displacement to a voter's surface: unlike heights, displacements need no agreement about the sign of
// normals.
struct Vote {
	double          distance, weight;
	Eigen::Vector3d toSurface;
};

struct Ballot {
	std::vector<Vote> votes, rim;
	double            weight = 0.0, rimWeight = 0.0;
	bool proper = false; // one of the voters has the point inside and is not over an edge
	// Sums over the votes by nearness: OutlierVoter::heightError() and spacing.
	double heightError = 0.0, spacing = 0.0, nearness = 0.0;

	void clear()
	{
		votes.clear();
		rim.clear();
		weight = rimWeight = heightError = spacing = nearness = 0.0;
		proper                                                = false;
	}
};

// What the votes say about one point.
struct Verdict {
	Eigen::Vector3d toSurface   = Eigen::Vector3d::Zero();
	double          deviation   = 0.0;                // distance from the surface over heightError
	double          against     = 0.0;                // share of the votes
	double          heightError = 0.0, spacing = 0.0; // lengths
	Index           votes  = 0;
	bool            lonely = false;
};

// Adds the vote of a voter about point `p`, unless `p` is outside of its support.
void addVote(
	Ballot&                ballot,
	const OutlierVoter&    voter,
	const Eigen::Vector3d& centre,
	const Eigen::Vector3d& p);

// `crowding`: distance of the point to its neighbour number crowdSize. Sorts the votes.
Verdict countVotes(Ballot& ballot, double crowding, double sensitivity);

} // namespace curvature_lines
