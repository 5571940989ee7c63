// Votes about a point that are made up by hand, and what they come to.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "outlier_ballot.h"
#include "outlier_voter.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

// A voter on the plane z = 0 that knows the disc of its radius.
OutlierVoter planeVoter(double radius = 1.0, double noise = 0.01)
{
	OutlierVoter voter;
	voter.neighbors       = 60;
	voter.surface         = SurfacePatch(Vector3d::Zero(), Vector3d::UnitZ(), radius);
	voter.surface.scale   = noise;
	voter.surface.valid   = true;
	voter.spacing         = 0.1;
	voter.heightDeviation = noise;
	voter.supportShape    = 4.0 * Eigen::Matrix2d::Identity(); // of an even disc of radius 1
	return voter;
}

Ballot votesAbout(const Vector3d& p, int count, const OutlierVoter& voter)
{
	Ballot ballot;
	for (int k = 0; k < count; ++k)
		addVote(ballot, voter, Vector3d::Zero(), p);
	return ballot;
}

TEST(OutlierBallot, APointOnTheSurfaceHasNoVoteAgainstIt)
{
	Ballot        ballot  = votesAbout({0.2, 0.1, 0.005}, 8, planeVoter());
	const Verdict verdict = countVotes(ballot, 0.1, 3.5);
	EXPECT_EQ(verdict.votes, 8);
	EXPECT_EQ(verdict.against, 0.0);
	EXPECT_FALSE(verdict.lonely);
	EXPECT_LT(verdict.deviation, 1.0);
	EXPECT_NEAR(verdict.toSurface.z(), -0.005, 1e-9);
	EXPECT_NEAR(verdict.spacing, 0.1, 1e-12);
	EXPECT_NEAR(verdict.heightError, planeVoter().heightError(), 1e-12);
}

TEST(OutlierBallot, APointAboveTheSurfaceHasAllVotesAgainstIt)
{
	for (const double height : {0.1, -0.1}) {
		Ballot        ballot  = votesAbout({0.2, 0.1, height}, 8, planeVoter());
		const Verdict verdict = countVotes(ballot, 0.1, 3.5);
		EXPECT_EQ(verdict.against, 1.0);
		EXPECT_NEAR(verdict.deviation, std::abs(height) / planeVoter().heightError(), 1e-6);
		EXPECT_NEAR(verdict.toSurface.z(), -height, 1e-9);
	}
}

TEST(OutlierBallot, SensitivityIsInNoiseUnits)
{
	const double error = planeVoter().heightError();
	for (const double units : {2.0, 3.4, 3.6, 8.0}) {
		Ballot ballot = votesAbout({0.0, 0.0, units * error}, 5, planeVoter());
		EXPECT_EQ(countVotes(ballot, 0.1, 3.5).against, units > 3.5 ? 1.0 : 0.0);
	}
}

// A few voters that know the face a point lies on are enough, whatever the others think.
TEST(OutlierBallot, AMinorityThatAgreesAcceptsThePoint)
{
	const Vector3d p(0.0, 0.0, 0.0);
	OutlierVoter   other     = planeVoter();
	other.surface.origin.z() = 0.5; // another surface
	Ballot ballot            = votesAbout(p, 2, planeVoter());
	for (int k = 0; k < 18; ++k)
		addVote(ballot, other, Vector3d::Zero(), p);
	const Verdict verdict = countVotes(ballot, 0.1, 3.5);
	EXPECT_LT(verdict.deviation, 0.1);
	EXPECT_NEAR(verdict.against, 0.9, 0.02);
}

TEST(OutlierBallot, VotersSpeakOnlyOfPlacesTheyKnow)
{
	EXPECT_TRUE(votesAbout({0.2, 0.0, 0.0}, 1, planeVoter()).proper);
	const Ballot rim = votesAbout({1.2, 0.0, 0.0}, 1, planeVoter()); // 1.2^2 * 4 = 5.8 is beside
	EXPECT_TRUE(rim.votes.empty());
	EXPECT_EQ(rim.rim.size(), 1u);
	EXPECT_FALSE(rim.proper);
	Ballot nothing = votesAbout({3.0, 0.0, 0.0}, 4, planeVoter());
	EXPECT_TRUE(nothing.votes.empty() && nothing.rim.empty());
	EXPECT_EQ(countVotes(nothing, 0.1, 3.5).votes, 0);
}

TEST(OutlierBallot, ALonelyPointNeedsAProperVoter)
{
	Ballot known = votesAbout({0.2, 0.0, 0.0}, 4, planeVoter());
	EXPECT_TRUE(countVotes(known, 1.0, 3.5).lonely);
	Ballot beside = votesAbout({1.2, 0.0, 0.0}, 4, planeVoter());
	EXPECT_EQ(countVotes(beside, 1.0, 3.5).votes, 0);
	Ballot       bent;
	OutlierVoter edge = planeVoter();
	edge.overEdge     = true;
	addVote(bent, edge, Vector3d::Zero(), {0.2, 0.0, 0.0});
	EXPECT_FALSE(bent.proper);
	EXPECT_LT(bent.weight, 0.01 * known.weight);
}

TEST(OutlierBallot, AClearedBallotIsEmpty)
{
	Ballot ballot = votesAbout({0.2, 0.0, 0.0}, 4, planeVoter());
	ballot.clear();
	EXPECT_TRUE(ballot.votes.empty() && ballot.rim.empty() && !ballot.proper);
	EXPECT_EQ(
		ballot.weight + ballot.rimWeight + ballot.heightError + ballot.spacing + ballot.nearness,
		0.0);
}

} // namespace
} // namespace curvature_lines
