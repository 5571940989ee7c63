// Moves of known size against a known noise.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "move_limit.h"

#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "neighborhoods.h"
#include "point_cloud.h"

namespace curvature_lines {
namespace {

constexpr double noise = 0.01;

// A grid whose points move up by a hundredth of the noise, but for some.
struct Moves {
	Eigen::Matrix3Xd before = Eigen::Matrix3Xd::Zero(3, 400), after;

	Moves()
	{
		for (Index i = 0; i < 400; ++i)
			before.col(i) << i % 20, i / 20, 0.0;
		after = before;
		after.row(2).setConstant(0.01 * noise);
	}
	void limit()
	{
		const NeighborSearch search(before);
		limitMoves(before, search, std::vector<double>(400, noise), after);
	}
};

TEST(MoveLimit, FarMovesAreTakenBack)
{
	Moves moves;
	moves.after(2, 50)  = 3.9 * noise;
	moves.after(2, 150) = 5.0 * noise;
	moves.after(2, 250) = 6.1 * noise;
	moves.after(2, 350) = -100.0 * noise;
	moves.limit();
	EXPECT_EQ(moves.after(2, 50), 3.9 * noise);
	EXPECT_NEAR(moves.after(2, 150), 2.5 * noise, 1e-12);
	EXPECT_EQ(moves.after(2, 250), 0.0);
	EXPECT_EQ(moves.after(2, 350), 0.0);
	EXPECT_EQ(moves.after(2, 0), 0.01 * noise);
}

// Where half of the moves are far, so is the noise: but no more than two and a half times as far as was estimated.
TEST(MoveLimit, TheMovesAroundTellTheNoiseToo)
{
	for (const double far : {2.0, 20.0}) {
		Moves moves;
		moves.after.row(2).setConstant(far * noise);
		moves.after(2, 210) = 8.0 * noise;
		moves.limit();
		EXPECT_EQ(moves.after(2, 210), 8.0 * noise) << far;
		EXPECT_EQ(moves.after(2, 100), far == 2.0 ? far * noise : 0.0);
	}
}

// No noise, no moves.
TEST(MoveLimit, WithoutNoiseEveryPointStays)
{
	Moves                moves;
	const NeighborSearch search(moves.before);
	limitMoves(moves.before, search, std::vector<double>(400, 0.0), moves.after);
	EXPECT_EQ(moves.after, moves.before);
}

} // namespace
} // namespace curvature_lines
