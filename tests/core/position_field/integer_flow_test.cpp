// Whole numbers that close: ends of lines made by hand on grids, whose way back is known, and random ones on closed
// surfaces and on some with rims.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "integer_flow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "cross_field.h"
#include "gauged_fields.h"
#include "line_density.h"
#include "point_cloud.h"
#include "transition_circuit.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

struct Case {
	TriangleMesh  mesh;
	test::Framed  framed;
	HeldIncreases held;

	explicit Case(TriangleMesh m, double perLength = 1.0) : mesh(std::move(m))
	{
		framed.field   = test::alongTheAxes(mesh);
		framed.density = LineDensity::Constant(2, mesh.vertexCount(), perLength);
		framed.translations.setZero(mesh.edgeCount());
		held.assign(mesh.edgeCount(), {0, 0});
	}
	IntegerFlow closed(const IntegerFlowOptions& options = {}) const
	{
		return closeTranslations(
			mesh, framed.field, framed.density, held, framed.translations, options);
	}
	Complex sumOf(Index t) const
	{
		return circuitOf(mesh, framed.field, framed.translations, t).sum;
	}
	void holdRims()
	{
		for (Index e = 0; e < mesh.edgeCount(); ++e)
			if (mesh.edges()[e].isRim())
				held[e] = {1, 1};
	}
	Vector3d centre(Index t) const
	{
		return mesh.vertices(Eigen::all, mesh.triangles()[t]).rowwise().mean();
	}
	Index triangleAt(const Vector3d& p) const
	{
		Index best = 0;
		for (Index t = 0; t < mesh.triangleCount(); ++t)
			if ((centre(t) - p).norm() < (centre(best) - p).norm())
				best = t;
		return best;
	}
	std::pair<std::vector<double>, double>
	costsFrom(Index start, int across, double perLength) const;
	// Frames of no turns: `unit` of lines ends in triangle a, as much begins in b. Walks from triangle to triangle.
	void addEnds(Index a, Index b, const Complex& unit)
	{
		for (Index t = a; t != b;) {
			Index  next = -1, over = -1;
			double nearest = std::numeric_limits<double>::infinity();
			for (int c = 0; c < 3; ++c) {
				const auto& edge  = mesh.edges()[mesh.edgeOf(t, c)];
				const Index other = edge.left == t ? edge.right : edge.left;
				if (other < 0 || (centre(other) - centre(b)).norm() >= nearest)
					continue;
				nearest = (centre(other) - centre(b)).norm();
				next    = other;
				over    = mesh.edgeOf(t, c);
			}
			framed.translations[over] += mesh.edges()[over].left == t ? unit : -unit;
			t = next;
		}
	}
};

Case planeCase(int cells, double jitter = 0.0, double perLength = 10.0)
{
	Case result(test::triangulatedPlane(cells, jitter).mesh, perLength);
	result.holdRims();
	return result;
}

// Of every triangle the length of the least way from `start`, by relaxing all steps until none is shorter, and the least of
// the ways out over a rim.
std::pair<std::vector<double>, double>
Case::costsFrom(Index start, int across, double perLength) const
{
	const double        never = std::numeric_limits<double>::infinity();
	std::vector<double> cost(mesh.triangleCount(), never);
	double              out  = never;
	const auto          half = [&](Index t, Index e) {
        Vector3d lines =
            perLength * (mesh.vertices.col(mesh.edges()[e].from) + 0.5 * mesh.along(e) - centre(t));
        lines[1 - across] /= 3.0;
        return lines.norm();
	};
	cost[start] = 0.0;
	for (bool changed = true; changed;) {
		changed = false;
		for (Index e = 0; e < mesh.edgeCount(); ++e) {
			const auto& edge = mesh.edges()[e];
			if (edge.isRim()) {
				const Index t = std::max(edge.left, edge.right);
				out           = std::min(out, cost[t] + half(t, e));
				continue;
			}
			const double step = half(edge.left, e) + half(edge.right, e);
			for (const auto& [t, next] :
			     {std::pair(edge.left, edge.right), std::pair(edge.right, edge.left)})
				if (cost[t] + step < cost[next] - 1e-12) {
					cost[next] = cost[t] + step;
					changed    = true;
				}
		}
	}
	return {cost, out};
}

bool allClosed(const Case& c, const IntegerFlow& flow)
{
	for (Index t = 0; t < c.mesh.triangleCount(); ++t)
		if (!circuitOf(c.mesh, c.framed.field, flow.translations, t).isClosed())
			return false;
	return true;
}

TEST(IntegerFlow, WhatClosesStaysAsItIs)
{
	samples::Random random(1, 0);
	Case            torus(test::triangulatedTorus(16, 8).mesh);
	torus.framed.phase.setZero(torus.mesh.vertexCount());
	// Any whole number added to the phases of a vertex closes.
	for (Index v = 0; v < torus.mesh.vertexCount(); ++v) {
		const Complex n(double(random.index(5)), -double(random.index(3)));
		for (Index e = 0; e < torus.mesh.edgeCount(); ++e) {
			torus.framed.translations[e] += double(torus.mesh.edges()[e].from == v) * n;
			torus.framed.translations[e] -= double(torus.mesh.edges()[e].to == v) * n;
		}
	}
	torus.framed =
		test::inTurnedFrames(torus.mesh, torus.framed, test::randomQuarters(torus.mesh, random));
	const IntegerFlow flow = torus.closed();
	EXPECT_EQ(flow.translations, torus.framed.translations);
	EXPECT_EQ(flow.paths, 0);
	EXPECT_EQ(flow.length, 0.0);
	EXPECT_EQ(flow.left, 0);
}

// A unit costs the lines that its way crosses, and a third of those it runs along. No way is shorter than the straight one,
// and the closest one over triangles is not much longer.
TEST(IntegerFlow, APairCostsItsDistanceInLines)
{
	for (const double jitter : {0.0, 0.3})
		for (const Complex& unit : {Complex(1, 0), Complex(0, 1), Complex(-1, 0)})
			for (const Vector3d& step :
			     {Vector3d(0.5, 0, 0), Vector3d(0, 0.5, 0), Vector3d(0.4, -0.3, 0)}) {
				Case        plane = planeCase(20, jitter);
				const Index a = plane.triangleAt(-0.5 * step), b = plane.triangleAt(0.5 * step);
				plane.addEnds(a, b, unit);
				ASSERT_EQ(plane.sumOf(a), unit);
				ASSERT_EQ(plane.sumOf(b), -unit);
				const IntegerFlow flow = plane.closed();
				EXPECT_EQ(flow.left, 0);
				EXPECT_EQ(flow.paths, 1);
				EXPECT_TRUE(allClosed(plane, flow));
				const int across = unit.real() != 0.0 ? 0 : 1;
				Vector3d  lines  = 10.0 * (plane.centre(b) - plane.centre(a));
				lines[1 - across] /= 3.0;
				EXPECT_GE(flow.length, lines.norm() - 1e-9);
				EXPECT_NEAR(flow.length, plane.costsFrom(a, across, 10.0).first[b], 1e-3);
			}
}

// Lines across are dearer than lines along, by the option.
TEST(IntegerFlow, TheCostAlongLinesIsTheOptions)
{
	Case        plane = planeCase(20);
	const Index a = plane.triangleAt({0, -0.25, 0}), b = plane.triangleAt({0, 0.25, 0});
	plane.addEnds(a, b, 1.0);
	IntegerFlowOptions options;
	double             before = 0.0;
	for (const double along : {0.1, 1.0 / 3.0, 1.0}) {
		options.along          = along;
		const IntegerFlow flow = plane.closed(options);
		EXPECT_GT(flow.length, before);
		EXPECT_GE(flow.length, along * 10.0 * 0.45);
		before = flow.length;
	}
}

// Ways do not get in each other's way, so that a pairing costs the sum of its pairs. The closest first are not always the
// best ones, but for three never more than twice as dear.
TEST(IntegerFlow, PairsOfSeveralEndsAreNearTheBestOnes)
{
	samples::Random random(2, 0);
	for (int trial = 0; trial < 6; ++trial) {
		const Case           empty = planeCase(14, 0.25);
		std::array<Index, 6> ends;
		for (Index& end : ends)
			do
				end =
					empty.triangleAt({random.uniform(-0.45, 0.45), random.uniform(-0.45, 0.45), 0});
			while (std::count(ends.begin(), ends.end(), end) > 1);
		std::array<std::array<double, 3>, 3> cost;
		for (int i = 0; i < 3; ++i)
			for (int j = 0; j < 3; ++j) {
				Case one = empty;
				one.addEnds(ends[i], ends[3 + j], 1.0);
				cost[i][j] = one.closed().length;
			}
		double             best  = std::numeric_limits<double>::infinity();
		std::array<int, 3> order = {0, 1, 2};
		do
			best = std::min(best, cost[0][order[0]] + cost[1][order[1]] + cost[2][order[2]]);
		while (std::next_permutation(order.begin(), order.end()));
		Case all = empty;
		for (int i = 0; i < 3; ++i)
			all.addEnds(ends[i], ends[3 + i], 1.0);
		const IntegerFlow flow = all.closed();
		EXPECT_EQ(flow.left, 0);
		EXPECT_EQ(flow.paths, 3);
		EXPECT_GE(flow.length, best - 1e-9);
		EXPECT_LE(flow.length, 2.0 * best);
	}
}

// On a torus without singular points; frames are arbitrary, and so are the numbers of triangles and their first corners.
TEST(IntegerFlow, FramesAndNumbersOfTrianglesDoNotMatter)
{
	samples::Random    random(4, 0);
	const TriangleMesh grid =
		test::triangulatedGrid(14, 7, true, true, [&](double u, double v) { // no two ways alike
			const double a = 2.0 * EIGEN_PI * u, b = 2.0 * EIGEN_PI * v,
						 rho = 1.0 + 0.4 * std::cos(b);
			return Vector3d(
				rho * std::cos(a) + random.uniform(0.0, 0.05),
				rho * std::sin(a) + random.uniform(0.0, 0.05),
				0.4 * std::sin(b));
		});
	Case torus(grid, 3.0);
	for (int k = 0; k < 12; ++k) {
		const auto  some = [&] { return static_cast<Index>(random.index(grid.triangleCount())); };
		const Index a = some(), b = some();
		torus.addEnds(a, b, turned(1.0, static_cast<int>(random.index(4))));
	}
	const IntegerFlow flow = torus.closed();
	EXPECT_EQ(flow.left, 0);
	EXPECT_TRUE(allClosed(torus, flow));
	EXPECT_GT(flow.paths, 5);
	const IntegerFlow again = torus.closed();
	EXPECT_EQ(again.translations, flow.translations);
	EXPECT_EQ(again.length, flow.length);

	Case       framed      = torus;
	const auto quarters    = test::randomQuarters(torus.mesh, random);
	framed.framed          = test::inTurnedFrames(torus.mesh, torus.framed, quarters);
	const IntegerFlow seen = framed.closed();
	EXPECT_EQ(seen.left, 0);
	EXPECT_NEAR(seen.length, flow.length, 1e-9);

	std::vector<Triangle> triangles = grid.triangles();
	for (std::size_t k = triangles.size(); k > 1; --k) {
		std::swap(triangles[k - 1], triangles[random.index(k)]);
		std::rotate(
			triangles[k - 1].begin(),
			triangles[k - 1].begin() + std::ptrdiff_t(random.index(3)),
			triangles[k - 1].end());
	}
	Case shuffled                = torus;
	shuffled.mesh                = TriangleMesh(grid.vertices, triangles);
	const IntegerFlow renumbered = shuffled.closed();
	EXPECT_EQ(renumbered.left, 0);
	EXPECT_NEAR(renumbered.length, flow.length, 1e-9);
	EXPECT_LT((renumbered.translations - flow.translations).cwiseAbs().maxCoeff(), 0.5);
}

// Whatever the turns and the whole numbers are.
TEST(IntegerFlow, EverythingClosesOnClosedSurfaces)
{
	samples::Random random(5, 0);
	for (int trial = 0; trial < 40; ++trial) {
		Case closed(
			trial % 2 == 0 ? test::triangulatedSphere(2).mesh : test::triangulatedTorus(12, 8).mesh,
			2.0);
		for (auto& turns : closed.framed.field.turns)
			turns = static_cast<std::uint8_t>(
				random.index(4) * (random.index(4) < std::size_t(trial % 5)));
		test::setIndices(closed.mesh, closed.framed.field);
		closed.framed.translations = test::randomWholes(closed.mesh, 1 + trial % 3, random);
		const IntegerFlow flow     = closed.closed();
		EXPECT_EQ(flow.left, 0) << trial;
		EXPECT_EQ(allClosed(closed, flow), flow.left == 0);
		for (Index e = 0; e < closed.mesh.edgeCount(); ++e) {
			EXPECT_EQ(flow.translations[e].real(), std::round(flow.translations[e].real()));
			EXPECT_EQ(flow.translations[e].imag(), std::round(flow.translations[e].imag()));
		}
	}
}

// Two units in one triangle and nothing else open: one goes around a singular point and comes back as the opposite one.
TEST(IntegerFlow, ATriangleMayMakeUpForItself)
{
	for (const Complex& units : {Complex(2, 0), Complex(0, -2), Complex(1, 1), Complex(-1, 1)}) {
		// Over one side of the cone the frames turn, all the way to the rim.
		Case disc = planeCase(8);
		for (Index e = 0; e < disc.mesh.edgeCount(); ++e) {
			const auto&    edge = disc.mesh.edges()[e];
			const Vector3d p    = disc.mesh.vertices.col(edge.from),
						   q    = disc.mesh.vertices.col(edge.to);
			const double cut    = 0.05; // just above the middle row of vertices, left of the middle
			if (std::max(p.x(), q.x()) < 0.2 && std::min(p.y(), q.y()) < cut &&
			    std::max(p.y(), q.y()) > cut)
				disc.framed.field.turns[e] = p.y() < q.y() ? 1 : 3;
		}
		test::setIndices(disc.mesh, disc.framed.field);
		ASSERT_EQ(singularTriangles(disc.framed.field).size(), 1);
		const Index open = disc.triangleAt({0.3, -0.3, 0});
		const Index e    = disc.mesh.edgeOf(open, 0);
		disc.framed.translations[e] += disc.mesh.isForward(open, 0) ? units : -units;
		const auto& edge = disc.mesh.edges()[e];
		const Index next = edge.left == open ? edge.right : edge.left;
		const Index cone = singularTriangles(disc.framed.field)[0];
		// What the neighbour has is moved into the singular point, where an even number makes no difference.
		Case moved = disc;
		moved.addEnds(next, cone, units);
		ASSERT_TRUE(
			circuitOf(moved.mesh, moved.framed.field, moved.framed.translations, next).isClosed());
		ASSERT_TRUE(
			circuitOf(moved.mesh, moved.framed.field, moved.framed.translations, cone).isClosed());
		const IntegerFlow flow = moved.closed();
		EXPECT_EQ(flow.left, 0) << units;
		EXPECT_EQ(flow.paths, 1);
	}
}

TEST(IntegerFlow, HeldIncreasesStay)
{
	samples::Random random(6, 0);
	for (int trial = 0; trial < 8; ++trial) {
		Case some(
			trial % 2 == 0 ? test::triangulatedSphere(2).mesh
						   : test::triangulatedCylinder(16, 8).mesh,
			2.0);
		for (Index e = 0; e < some.mesh.edgeCount(); ++e) {
			some.framed.field.turns[e] = static_cast<std::uint8_t>(random.index(4));
			some.held[e]               = {char(random.index(3) == 0), char(random.index(3) == 0)};
		}
		test::setIndices(some.mesh, some.framed.field);
		some.framed.translations = test::randomWholes(some.mesh, 2, random);
		const IntegerFlow flow   = some.closed();
		Index             left   = 0;
		for (Index t = 0; t < some.mesh.triangleCount(); ++t)
			left += !circuitOf(some.mesh, some.framed.field, flow.translations, t).isClosed();
		EXPECT_EQ(flow.left, left);
		for (Index e = 0; e < some.mesh.edgeCount(); ++e) {
			if (some.held[e][0]) {
				EXPECT_EQ(flow.translations[e].real(), some.framed.translations[e].real());
			}
			if (some.held[e][1]) {
				EXPECT_EQ(flow.translations[e].imag(), some.framed.translations[e].imag());
			}
		}
	}
}

// A wall of held edges between both ends, with a gap far away.
TEST(IntegerFlow, WaysGoAroundWhatIsHeld)
{
	Case        plane = planeCase(16);
	const Index a = plane.triangleAt({-0.2, 0.3, 0}), b = plane.triangleAt({0.2, 0.3, 0});
	plane.addEnds(a, b, 1.0);
	const double free = plane.closed().length;
	const auto   wall = [&](double gapBelow) {
        for (Index e = 0; e < plane.mesh.edgeCount(); ++e) {
            const auto&    edge = plane.mesh.edges()[e];
            const Vector3d p    = plane.mesh.vertices.col(edge.from),
                           q    = plane.mesh.vertices.col(edge.to);
            if (std::abs(p.x()) < 1e-9 && std::abs(q.x()) < 1e-9 &&
                std::min(p.y(), q.y()) > gapBelow)
                plane.held[e][0] = 1;
        }
	};
	wall(-0.3);
	const IntegerFlow around = plane.closed();
	EXPECT_EQ(around.left, 0);
	// Twice 0.6 up and down, a third of ten lines each, and 0.4 across.
	EXPECT_GT(around.length, free + 0.8);
	// Lines of the other family are not held.
	Case other = plane;
	other.framed.translations.setZero();
	other.addEnds(a, b, Complex(0, 1));
	EXPECT_EQ(other.closed().left, 0);
	EXPECT_LT(other.closed().length, free);
	wall(-1.0);
	EXPECT_EQ(plane.closed().left, 2);
	EXPECT_EQ(plane.closed().translations, plane.framed.translations);
}

TEST(IntegerFlow, OneEndLeavesOverTheNearestRim)
{
	Case        plane(test::triangulatedPlane(16).mesh, 10.0);
	const Index a = plane.triangleAt({0.35, 0.1, 0}), rim = plane.triangleAt({0.49, 0.1, 0});
	plane.addEnds(a, rim, 1.0);
	for (int c = 0; c < 3; ++c) // the other one is taken out of the surface
		if (plane.mesh.edges()[plane.mesh.edgeOf(rim, c)].isRim()) {
			const Index e = plane.mesh.edgeOf(rim, c);
			plane.framed.translations[e] += plane.mesh.isForward(rim, c) ? 1.0 : -1.0;
		}
	ASSERT_EQ(plane.sumOf(a), 1.0);
	ASSERT_EQ(plane.sumOf(rim), 0.0);
	const IntegerFlow flow = plane.closed();
	EXPECT_EQ(flow.left, 0);
	EXPECT_EQ(flow.paths, 1);
	// 1.5 lines across to the right; along the lines 4 to the upper rim, which count a third
	EXPECT_NEAR(flow.length, plane.costsFrom(a, 0, 10.0).second, 1e-3);
	plane.holdRims();
	EXPECT_EQ(plane.closed().left, 1);
}

TEST(IntegerFlow, LimbsAreLeftAloneWhereThereIsAWayRound)
{
	Case        plane = planeCase(20);
	const Index a = plane.triangleAt({-0.3, 0, 0}), b = plane.triangleAt({0.3, 0, 0});
	plane.addEnds(a, b, 1.0);
	IntegerFlowOptions options;
	options.onLimb.assign(plane.mesh.vertexCount(), 0);
	for (Index v = 0; v < plane.mesh.vertexCount(); ++v)
		options.onLimb[v] = plane.mesh.vertices.col(v).cwiseAbs().maxCoeff() < 0.13;
	const auto onLimb = [&](const IntegerFlow& flow) {
		Index count = 0;
		for (Index e = 0; e < plane.mesh.edgeCount(); ++e)
			count += flow.translations[e] != plane.framed.translations[e] &&
			         options.onLimb[plane.mesh.edges()[e].from] &&
			         options.onLimb[plane.mesh.edges()[e].to];
		return count;
	};
	const IntegerFlow straight = plane.closed(), round = plane.closed(options);
	EXPECT_GT(onLimb(straight), 0);
	EXPECT_EQ(onLimb(round), 0);
	EXPECT_EQ(round.left, 0);
	EXPECT_GT(round.length, straight.length);
}

TEST(IntegerFlow, EmptyMesh)
{
	const Case empty((TriangleMesh()));
	EXPECT_EQ(empty.closed().paths, 0);
	EXPECT_EQ(empty.closed().left, 0);
}

} // namespace
} // namespace curvature_lines
