// Creases of scaffolds made by hand: which are too short for the cells of the mesh, and which lines cannot follow.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "crease_selection.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "closed_surfaces.h"
#include "point_cloud.h"
#include "scaffold.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

constexpr int columns = 16;

// Edges of length 1; a cell of the mesh is two of them wide.
Scaffold grid(double slope = 0.0)
{
	Scaffold scaffold = test::scaffoldOf(
		test::triangulatedGrid(columns, columns, false, false, [&](double u, double v) {
			const double x = columns * (u - 0.5);
			return Vector3d(x, columns * v, slope * std::abs(x));
		}));
	scaffold.size.setConstant(scaffold.mesh.vertexCount(), 2.0);
	scaffold.spacing.setConstant(scaffold.mesh.vertexCount(), 1.0);
	return scaffold;
}

using Place = std::pair<int, int>; // column, row

Index at(const Place& p)
{
	return p.first + (columns + 1) * p.second;
}

Index edgeBetween(const Scaffold& scaffold, const Place& a, const Place& b)
{
	return scaffold.mesh.edgeBetween(at(a), at(b));
}

// Along rows and columns from place to place.
void addCrease(Scaffold& scaffold, const std::vector<Place>& places)
{
	for (std::size_t k = 0; k + 1 < places.size(); ++k) {
		Place       p  = places[k];
		const Place to = places[k + 1];
		while (p != to) {
			const Place next = {
				p.first + (to.first > p.first) - (to.first < p.first),
				p.second + (to.second > p.second) - (to.second < p.second)};
			scaffold.creaseEdge[edgeBetween(scaffold, p, next)] = 1;
			p                                                   = next;
		}
	}
}

Index creaseEdges(const Scaffold& scaffold)
{
	return static_cast<Index>(
		std::count(scaffold.creaseEdge.begin(), scaffold.creaseEdge.end(), 1));
}

// Returns how many edges are left.
Index leftAfterDropping(Scaffold& scaffold)
{
	const Index before = creaseEdges(scaffold), dropped = dropShortCreases(scaffold),
				left = creaseEdges(scaffold);
	EXPECT_EQ(dropped, before - left);
	EXPECT_EQ(dropShortCreases(scaffold), 0); // once is enough
	EXPECT_EQ(creaseEdges(scaffold), left);
	return left;
}

TEST(CreaseSelection, PiecesShorterThanACellGo)
{
	Scaffold shorter = grid(), longer = grid();
	addCrease(shorter, {{4, 4}, {5, 4}});
	EXPECT_EQ(leftAfterDropping(shorter), 0);
	addCrease(longer, {{4, 4}, {7, 4}});
	EXPECT_EQ(leftAfterDropping(longer), 3);
	// In larger cells it is short, too; in the spacing where there are no sizes it is long.
	longer.size *= 2.0;
	Scaffold bySpacing = longer;
	EXPECT_EQ(leftAfterDropping(longer), 0);
	bySpacing.size.resize(0);
	EXPECT_EQ(leftAfterDropping(bySpacing), 3);
}

TEST(CreaseSelection, SmallLoopsGo)
{
	Scaffold small = grid(), large = grid();
	addCrease(small, {{4, 4}, {5, 4}, {5, 5}, {4, 5}, {4, 4}});
	EXPECT_EQ(leftAfterDropping(small), 0);
	addCrease(large, {{4, 4}, {7, 4}, {7, 7}, {4, 7}, {4, 4}});
	EXPECT_EQ(leftAfterDropping(large), 12);
}

TEST(CreaseSelection, SpursGoAndWhatTheyMeetStays)
{
	Scaffold scaffold = grid();
	addCrease(scaffold, {{2, 8}, {14, 8}});
	addCrease(scaffold, {{8, 8}, {8, 9}}); // a spur
	EXPECT_EQ(leftAfterDropping(scaffold), 12);
	EXPECT_EQ(scaffold.creaseEdge[edgeBetween(scaffold, {8, 8}, {8, 9})], 0);
}

// Between two others it ends nowhere: without it they would end freely.
TEST(CreaseSelection, ShortPiecesBetweenOthersStay)
{
	Scaffold scaffold = grid();
	addCrease(scaffold, {{2, 8}, {14, 8}});
	addCrease(scaffold, {{2, 9}, {14, 9}});
	addCrease(scaffold, {{8, 8}, {8, 9}});
	EXPECT_EQ(leftAfterDropping(scaffold), 25);
}

// A small tree: with its leaves gone the stem is short.
TEST(CreaseSelection, WhatIsLeftAfterSpursIsLookedAtAgain)
{
	Scaffold scaffold = grid();
	addCrease(scaffold, {{5, 5}, {5, 6}});
	addCrease(scaffold, {{4, 6}, {6, 6}});
	EXPECT_EQ(leftAfterDropping(scaffold), 0);
}

TEST(CreaseSelection, CreasesOfACubeStay)
{
	Scaffold cube = test::CreasedCube(6).scaffold;
	EXPECT_EQ(leftAfterDropping(cube), 12 * 6);
}

// The middle column, between faces that meet at this angle.
Scaffold folded(double degrees)
{
	Scaffold scaffold = grid(std::tan(0.5 * degrees * EIGEN_PI / 180.0));
	addCrease(scaffold, {{columns / 2, 0}, {columns / 2, columns}});
	return scaffold;
}

Index triangleNear(const Scaffold& scaffold, const Vector3d& p)
{
	Index      best     = 0;
	const auto distance = [&](Index t) {
		return (scaffold.mesh.vertices(Eigen::all, scaffold.mesh.triangles()[t]).rowwise().mean() -
		        p)
		    .norm();
	};
	for (Index t = 0; t < scaffold.mesh.triangleCount(); ++t)
		if (distance(t) < distance(best))
			best = t;
	return best;
}

TEST(CreaseSelection, CreasesNearTheTrianglesGo)
{
	for (const double degrees : {20.0, 55.0}) {
		Scaffold       scaffold = folded(degrees);
		const Vector3d middle(0.3, 8.0, 0.0);
		const Index    t = triangleNear(scaffold, middle), dropped = dropCreasesAt({t}, scaffold);
		EXPECT_GT(dropped, 0);
		EXPECT_EQ(creaseEdges(scaffold), columns - dropped);
		for (int k = 0; k < columns; ++k) {
			const bool left =
				scaffold
					.creaseEdge[edgeBetween(scaffold, {columns / 2, k}, {columns / 2, k + 1})] != 0;
			const double away = std::abs(k + 0.5 - middle.y());
			// A corner of the triangle is up to an edge and a half away from its middle.
			if (away > 2.0 + 1.5) {
				EXPECT_TRUE(left) << k;
			}
			if (away < 2.0 - 1.5) {
				EXPECT_FALSE(left) << k;
			}
		}
	}
}

TEST(CreaseSelection, SharpCreasesStay)
{
	Scaffold           sharp = folded(70.0);
	std::vector<Index> all(sharp.mesh.triangleCount());
	for (Index t = 0; t < sharp.mesh.triangleCount(); ++t)
		all[t] = t;
	EXPECT_EQ(dropCreasesAt(all, sharp), 0);
	Scaffold blunt = folded(50.0);
	EXPECT_EQ(dropCreasesAt(all, blunt), columns);
}

TEST(CreaseSelection, FarTrianglesAndNoneChangeNothing)
{
	Scaffold scaffold = folded(20.0);
	EXPECT_EQ(dropCreasesAt({}, scaffold), 0);
	EXPECT_EQ(dropCreasesAt({triangleNear(scaffold, {6.0, 8.0, 1.0})}, scaffold), 0);
	Scaffold none = grid();
	EXPECT_EQ(dropShortCreases(none), 0);
	Scaffold empty;
	EXPECT_EQ(dropShortCreases(empty), 0);
	EXPECT_EQ(dropCreasesAt({}, empty), 0);
}

} // namespace
} // namespace curvature_lines
