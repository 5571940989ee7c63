// Singular points that come in pairs go, the ones a surface must have stay, and creases part them.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "singular_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "closed_surfaces.h"
#include "cross_field.h"
#include "point_cloud.h"
#include "scaffold.h"
#include "transition_circuit.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

int signedSum(const CrossField& field)
{
	int sum = 0;
	for (const std::uint8_t index : field.index)
		sum += index == 3 ? -1 : index;
	return sum;
}

// The index of every triangle is the sum of its turns.
void expectConsistent(const TriangleMesh& mesh, const CrossField& field)
{
	const Eigen::VectorXcd none = Eigen::VectorXcd::Zero(mesh.edgeCount());
	for (Index t = 0; t < mesh.triangleCount(); ++t)
		ASSERT_EQ(field.index[t], circuitOf(mesh, field, none, t).index);
}

// A disc of directions that are a quarter of a turn and more off makes pairs of singular points.
DirectionGuide disturbed(const test::TriangulatedSurface& surface, double weight, double share)
{
	DirectionGuide  guide = test::guideOf(surface, weight);
	samples::Random random(7, 0);
	for (Index v = 0; v < surface.size(); ++v) {
		if (random.uniform() > share)
			continue;
		const double a = random.uniform(0.0, EIGEN_PI);
		guide.directions.col(v) =
			std::cos(a) * surface.truth.d1.col(v) + std::sin(a) * surface.truth.d2.col(v);
	}
	return guide;
}

// Index 1 is put into the triangle on the left of edge e, and 3 on its right.
void addPair(const TriangleMesh& mesh, Index e, CrossField& field)
{
	field.turns[e]          = static_cast<std::uint8_t>((field.turns[e] + 1) & 3);
	const auto& edge        = mesh.edges()[e];
	field.index[edge.left]  = static_cast<std::uint8_t>((field.index[edge.left] + 1) & 3);
	field.index[edge.right] = static_cast<std::uint8_t>((field.index[edge.right] + 3) & 3);
}

TEST(SingularPairs, PairsThatNoiseHasMadeVanish)
{
	for (const auto& surface :
	     {test::triangulatedTorus(48, 20), test::triangulatedCylinder(40, 40)}) {
		const Scaffold   scaffold = test::scaffoldOf(surface.mesh);
		DirectionGuide   guide    = disturbed(surface, 3.0, 0.45);
		const CrossField noisy    = smoothCrossField(surface.mesh, guide);
		ASSERT_GT(singularTriangles(noisy).size(), 6);
		CrossField calm = calmCrossField(scaffold, guide);
		expectConsistent(surface.mesh, calm);
		EXPECT_LT(2 * singularTriangles(calm).size(), singularTriangles(noisy).size());
		const std::size_t before = singularTriangles(calm).size();
		const Index       joined = joinSingularPairs(scaffold, calm);
		expectConsistent(surface.mesh, calm);
		EXPECT_EQ(singularTriangles(calm).size(), before - 2 * joined);
		if (surface.mesh.rims().empty()) {
			EXPECT_EQ(signedSum(calm) & 3, 0);
		}
	}
}

TEST(SingularPairs, CalmDoesNothingWhereThereAreNone)
{
	for (const auto& surface :
	     {test::triangulatedTorus(48, 20), test::triangulatedCylinder(40, 20)}) {
		const Scaffold        scaffold = test::scaffoldOf(surface.mesh);
		DirectionGuide        guide    = test::guideOf(surface, 1.0);
		const Eigen::VectorXd weights  = guide.weights;
		const CrossField      smooth   = smoothCrossField(surface.mesh, guide);
		CrossField            calm     = calmCrossField(scaffold, guide);
		EXPECT_EQ(guide.weights, weights);
		EXPECT_EQ(calm.d1, smooth.d1);
		EXPECT_EQ(calm.turns, smooth.turns);
		EXPECT_EQ(joinSingularPairs(scaffold, calm), 0);
		EXPECT_EQ(calm.turns, smooth.turns);
	}
}

TEST(SingularPairs, WhatTheSurfaceNeedsStays)
{
	for (const auto& [surface, weight] :
	     {std::pair(test::triangulatedSphere(4), 0.0),
	      std::pair(test::triangulatedEllipsoid(4), 1.0)}) {
		const Scaffold scaffold = test::scaffoldOf(surface.mesh);
		DirectionGuide guide    = test::guideOf(surface, weight);
		CrossField     field    = calmCrossField(scaffold, guide);
		joinSingularPairs(scaffold, field);
		expectConsistent(surface.mesh, field);
		EXPECT_EQ(singularTriangles(field).size(), 8);
		EXPECT_EQ(std::abs(signedSum(field)), 8);
	}
}

TEST(SingularPairs, HeavyGuidesOfFeaturesAreNotFaded)
{
	const auto     surface = test::triangulatedTorus(48, 20);
	DirectionGuide guide   = disturbed(surface, 3.0, 0.45);
	for (Index v = 0; v < surface.size(); v += 9)
		guide.weights[v] = 1e3;
	const Eigen::VectorXd before = guide.weights;
	calmCrossField(test::scaffoldOf(surface.mesh), guide);
	for (Index v = 0; v < surface.size(); ++v) {
		if (v % 9 == 0)
			EXPECT_EQ(guide.weights[v], before[v]);
		else
			EXPECT_LE(guide.weights[v], before[v]);
	}
	EXPECT_LT(guide.weights.sum(), before.sum());
}

TEST(SingularPairs, NeighboursOfOppositeIndexAreJoined)
{
	const auto       torus    = test::triangulatedTorus(48, 20);
	const Scaffold   scaffold = test::scaffoldOf(torus.mesh);
	const CrossField smooth   = smoothCrossField(torus.mesh, test::guideOf(torus, 1.0));
	for (const Index e : {3, 100, 501, 1203}) {
		CrossField field = smooth;
		addPair(torus.mesh, e, field);
		expectConsistent(torus.mesh, field);
		ASSERT_EQ(singularTriangles(field).size(), 2);
		EXPECT_EQ(joinSingularPairs(scaffold, field), 1);
		expectConsistent(torus.mesh, field);
		EXPECT_TRUE(singularTriangles(field).empty());
		EXPECT_EQ(field.d1, smooth.d1);
		EXPECT_EQ(field.turns, smooth.turns); // the way back is the shortest
	}
}

// A ring of vertices of the torus is a crease, its edges the only ones between pairs across it.
TEST(SingularPairs, CreasesPartPairs)
{
	const int        around = 48, tube = 20;
	const auto       torus    = test::triangulatedTorus(around, tube);
	Scaffold         scaffold = test::scaffoldOf(torus.mesh);
	const CrossField smooth   = smoothCrossField(torus.mesh, test::guideOf(torus, 1.0));
	Index            one      = -1;
	for (Index i = 0; i < around; ++i) {
		one                      = torus.mesh.edgeBetween(i, (i + 1) % around);
		scaffold.creaseEdge[one] = 1;
	}
	CrossField field = smooth;
	addPair(torus.mesh, one, field);
	const CrossField before = field;
	EXPECT_EQ(joinSingularPairs(scaffold, field), 0);
	EXPECT_EQ(field.turns, before.turns);
	// The way around the tube is there, but it is long.
	SingularPairOptions options;
	options.joined = 100.0;
	EXPECT_EQ(joinSingularPairs(scaffold, field, options), 1);
	expectConsistent(torus.mesh, field);
	EXPECT_TRUE(singularTriangles(field).empty());
	for (Index i = 0; i < around; ++i) {
		const Index e = torus.mesh.edgeBetween(i, (i + 1) % around);
		EXPECT_EQ(field.turns[e], before.turns[e]);
	}
}

TEST(SingularPairs, OnlyWhatMakesUpForEachOtherIsJoined)
{
	const auto     sphere   = test::triangulatedSphere(3);
	const Scaffold scaffold = test::scaffoldOf(sphere.mesh);
	CrossField     field    = smoothCrossField(sphere.mesh, test::guideOf(sphere, 0.0));
	const auto     turns    = field.turns;
	ASSERT_EQ(singularTriangles(field).size(), 8);
	SingularPairOptions options;
	options.joined = 100.0;
	EXPECT_EQ(joinSingularPairs(scaffold, field, options), 0); // eight of the same index
	EXPECT_EQ(field.turns, turns);
}

// Index 1 is put into one triangle, 3 into another one, by a walk between both.
void addPair(const TriangleMesh& mesh, Index from, Index to, CrossField& field)
{
	const auto centre = [&](Index t) {
		return Vector3d(mesh.vertices(Eigen::all, mesh.triangles()[t]).rowwise().mean());
	};
	for (Index t = from; t != to;) {
		Index over = -1, next = t;
		for (int c = 0; c < 3; ++c) {
			const Index e = mesh.edgeOf(t, c);
			const Index other =
				mesh.edges()[e].left == t ? mesh.edges()[e].right : mesh.edges()[e].left;
			if ((centre(other) - centre(to)).norm() < (centre(next) - centre(to)).norm()) {
				next = other;
				over = e;
			}
		}
		ASSERT_GE(over, 0);
		field.turns[over] = static_cast<std::uint8_t>(
			(field.turns[over] + (mesh.edges()[over].left == t ? 1 : 3)) & 3);
		t = next;
	}
	field.index[from] = static_cast<std::uint8_t>((field.index[from] + 1) & 3);
	field.index[to]   = static_cast<std::uint8_t>((field.index[to] + 3) & 3);
}

// Four in a row, of alternating index: the two in the middle are closest, and the others are too far apart then.
TEST(SingularPairs, TheClosestAreJoinedFirst)
{
	const auto     torus    = test::triangulatedTorus(96, 40);
	const Scaffold scaffold = test::scaffoldOf(torus.mesh);
	CrossField     field    = smoothCrossField(torus.mesh, test::guideOf(torus, 1.0));
	const double   cell     = scaffold.size[0];
	const auto     at       = [&](double cells) {
        const double   angle = 0.7 + cells * cell / 1.4; // along the outer circle
        const Vector3d p(1.4 * std::cos(angle), 1.4 * std::sin(angle), 0.01);
        Index          best     = 0;
        const auto     distance = [&](Index t) {
            return (torus.mesh.vertices(Eigen::all, torus.mesh.triangles()[t]).rowwise().mean() - p)
                .norm();
        };
        for (Index t = 0; t < torus.mesh.triangleCount(); ++t)
            if (distance(t) < distance(best))
                best = t;
        return best;
	};
	const std::array<Index, 4> row = {at(0.0), at(1.5), at(2.3), at(3.8)};
	addPair(torus.mesh, row[0], row[1], field);
	addPair(torus.mesh, row[2], row[3], field);
	expectConsistent(torus.mesh, field);
	ASSERT_EQ(singularTriangles(field).size(), 4);
	EXPECT_EQ(joinSingularPairs(scaffold, field), 1);
	expectConsistent(torus.mesh, field);
	std::vector<Index> left = {row[0], row[3]};
	std::sort(left.begin(), left.end());
	EXPECT_EQ(singularTriangles(field), left);
	SingularPairOptions options;
	options.joined = 8.0;
	EXPECT_EQ(joinSingularPairs(scaffold, field, options), 1);
	EXPECT_TRUE(singularTriangles(field).empty());
}

// Which way round either goes is not known: two at a tip would become a whole turn around a triangle that is not singular.
TEST(SingularPairs, HalfTurnsAreNotJoined)
{
	const auto          torus    = test::triangulatedTorus(48, 20);
	const Scaffold      scaffold = test::scaffoldOf(torus.mesh);
	CrossField          field    = smoothCrossField(torus.mesh, test::guideOf(torus, 1.0));
	SingularPairOptions options;
	options.joined = 100.0;
	addPair(torus.mesh, 100, field);
	addPair(torus.mesh, 100, field);
	const auto before = field.turns;
	ASSERT_EQ(singularTriangles(field).size(), 2);
	EXPECT_EQ(joinSingularPairs(scaffold, field, options), 0);
	EXPECT_EQ(field.turns, before);
}

// Two of index 1, this many cells apart, on a torus; what makes up for them is on its other side.
struct NearPoints {
	test::TriangulatedSurface torus    = test::triangulatedTorus(96, 40);
	Scaffold                  scaffold = test::scaffoldOf(torus.mesh);
	CrossField                field    = smoothCrossField(torus.mesh, test::guideOf(torus, 1.0));

	explicit NearPoints(double cells)
	{
		const double step = cells * scaffold.size[0] / 1.4;
		addPair(torus.mesh, at(0.7), at(3.0), field);
		addPair(torus.mesh, at(0.7 + step), at(3.8), field);
	}
	Vector3d centre(Index t) const
	{
		return torus.mesh.vertices(Eigen::all, torus.mesh.triangles()[t]).rowwise().mean();
	}
	Index at(double angle) const // on the outer circle
	{
		const Vector3d p(1.4 * std::cos(angle), 1.4 * std::sin(angle), 0.01);
		Index          best = 0;
		for (Index t = 0; t < torus.mesh.triangleCount(); ++t)
			if ((centre(t) - p).norm() < (centre(best) - p).norm())
				best = t;
		return best;
	}
	// Of the singular points, in cells.
	double leastDistance() const
	{
		const std::vector<Index> points = singularTriangles(field);
		double                   least  = 1e9;
		for (std::size_t a = 0; a < points.size(); ++a)
			for (std::size_t b = 0; b < a; ++b)
				least = std::min(least, (centre(points[a]) - centre(points[b])).norm());
		return least / scaffold.size[0];
	}
};

TEST(SingularPairs, PointsThatAreTooNearMoveApart)
{
	for (const double cells : {0.25, 0.5, 0.7}) {
		NearPoints       near(cells);
		const CrossField before = near.field;
		const double     apart  = near.leastDistance();
		ASSERT_EQ(singularTriangles(near.field).size(), 4);
		EXPECT_GE(spreadSingularPoints(near.scaffold, near.field), 1);
		expectConsistent(near.torus.mesh, near.field);
		EXPECT_GT(near.leastDistance(), apart + 0.1);
		EXPECT_GT(near.leastDistance(), 0.75);
		EXPECT_EQ(near.field.d1, before.d1); // the crosses stay
		// As many of each index, and those that were apart where they were.
		for (int index = 0; index < 4; ++index)
			EXPECT_EQ(
				std::count(near.field.index.begin(), near.field.index.end(), index),
				std::count(before.index.begin(), before.index.end(), index));
		for (Index t = 0; t < near.torus.mesh.triangleCount(); ++t)
			if (before.index[t] == 3) {
				EXPECT_EQ(near.field.index[t], 3);
			}
	}
}

TEST(SingularPairs, PointsWithRoomStayWhereTheyAre)
{
	NearPoints far(2.5);
	const auto turns = far.field.turns;
	EXPECT_EQ(spreadSingularPoints(far.scaffold, far.field), 0);
	EXPECT_EQ(far.field.turns, turns);
	const auto     sphere   = test::triangulatedSphere(4);
	const Scaffold scaffold = test::scaffoldOf(sphere.mesh);
	CrossField     field    = smoothCrossField(sphere.mesh, test::guideOf(sphere, 0.0));
	EXPECT_EQ(spreadSingularPoints(scaffold, field), 0);
}

// All edges across the way around the tube are creases, so that there is no room but along them.
TEST(SingularPairs, PointsDoNotMoveOverCreases)
{
	NearPoints near(0.4);
	const auto before = near.field.turns;
	for (Index e = 0; e < near.torus.mesh.edgeCount(); ++e) {
		const auto&    edge         = near.torus.mesh.edges()[e];
		const Vector3d p            = near.torus.mesh.vertices.col(edge.from),
					   q            = near.torus.mesh.vertices.col(edge.to);
		near.scaffold.creaseEdge[e] = std::abs(p.z() - q.z()) < 1e-9;
	}
	spreadSingularPoints(near.scaffold, near.field);
	expectConsistent(near.torus.mesh, near.field);
	for (Index e = 0; e < near.torus.mesh.edgeCount(); ++e)
		if (near.scaffold.creaseEdge[e]) {
			EXPECT_EQ(near.field.turns[e], before[e]);
		}
	EXPECT_EQ(singularTriangles(near.field).size(), 4);
}

} // namespace
} // namespace curvature_lines
