// Matching of curve points on the sides of a triangle; lines of whole phases, and where they end.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "closed_surfaces.h"
#include "cross_field.h"
#include "gauged_fields.h"
#include "point_cloud.h"
#include "position_field.h"
#include "singular_vertices.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

// Counter-clockwise place of a side point on the border.
int rank(const std::array<int, 3>& counts, const SidePoint& p)
{
	int rank = p.index;
	for (int c = 0; c < p.side; ++c)
		rank += counts[c];
	return rank;
}

TEST(MatchSides, AllCountsGiveDisjointChordsBetweenDifferentSides)
{
	for (int code = 0; code < 5 * 5 * 5; ++code) {
		const std::array<int, 3>         counts = {code % 5, code / 5 % 5, code / 25};
		const auto                       arcs   = matchSides(counts);
		std::set<int>                    used;
		std::vector<std::pair<int, int>> chords;
		for (const auto& [p, q] : arcs) {
			EXPECT_NE(p.side, q.side);
			for (const SidePoint& point : {p, q}) {
				EXPECT_GE(point.index, 0);
				EXPECT_LT(point.index, counts[point.side]);
				EXPECT_TRUE(used.insert(rank(counts, point)).second) << code;
			}
			chords.push_back(std::minmax(rank(counts, p), rank(counts, q)));
		}
		for (const auto& [a, b] : chords)
			for (const auto& [c, d] : chords)
				EXPECT_FALSE(a < c && c < b && b < d) << code;
		// What is left lies on one side, and is as little as parity and the longest side allow.
		const int sum   = counts[0] + counts[1] + counts[2];
		const int most  = *std::max_element(counts.begin(), counts.end());
		const int least = std::max(sum % 2, 2 * most - sum);
		EXPECT_EQ(sum - 2 * static_cast<int>(arcs.size()), least) << code;
	}
}

// The phases grow evenly over a plane, by `slope` and turned by `angle`; the one at `whole` is zero.
struct Slope {
	TriangleMesh  mesh;
	CrossField    field;
	PositionField positions;

	Slope(TriangleMesh m, double slope, double angle, Index whole) :
			mesh(std::move(m)), field(test::alongTheAxes(mesh))
	{
		positions.phase.resize(mesh.vertexCount());
		for (Index v = 0; v < mesh.vertexCount(); ++v) {
			const Eigen::Vector3d d = mesh.vertices.col(v) - mesh.vertices.col(whole);
			positions.phase[v]      = slope * std::polar(1.0, angle) * Complex(d.x(), d.y());
		}
		positions.translations.setZero(mesh.edgeCount());
		finishPositions(mesh, field, positions);
	}
};

int chordsAt(const SurfaceCurves& curves, Index v)
{
	return static_cast<int>(
		std::count_if(curves.chords.begin(), curves.chords.end(), [&](const auto& chord) {
			return chord.b.edge < 0 && chord.b.point == v;
		}));
}

// Every point of an edge is in one chord of each of its triangles, a chord that ends at a vertex comes from the edge across.
void expectSound(const TriangleMesh& mesh, const SurfaceCurves& curves)
{
	EXPECT_EQ(curves.ends, 0);
	std::set<std::tuple<Index, Index, Index>> seen; // triangle, edge, point
	for (const SurfaceCurves::Chord& chord : curves.chords) {
		ASSERT_GE(chord.a.edge, 0);
		for (const SurfaceCurves::End& end : {chord.a, chord.b}) {
			if (end.edge < 0)
				continue;
			const auto& edge = mesh.edges()[end.edge];
			EXPECT_TRUE(edge.left == chord.triangle || edge.right == chord.triangle);
			EXPECT_TRUE(seen.emplace(chord.triangle, end.edge, end.point).second);
		}
		if (chord.b.edge >= 0)
			continue;
		const Triangle& corners = mesh.triangles()[chord.triangle];
		EXPECT_EQ(std::count(corners.begin(), corners.end(), chord.b.point), 1);
		EXPECT_NE(mesh.edges()[chord.a.edge].from, chord.b.point);
		EXPECT_NE(mesh.edges()[chord.a.edge].to, chord.b.point);
	}
	for (Index e = 0; e < mesh.edgeCount(); ++e)
		for (Index p = 0; p < static_cast<Index>(curves.points[e].size()); ++p)
			for (const Index t : {mesh.edges()[e].left, mesh.edges()[e].right})
				EXPECT_EQ(seen.count({t, e, p}), t < 0 ? 0 : 1);
}

TEST(IntegerLines, AllGoFromRimToRim)
{
	const Slope         plane(test::triangulatedPlane(9, 0.3).mesh, 5.3, 0.4, 44);
	const SurfaceCurves curves = integerLines(plane.mesh, plane.field, plane.positions);
	expectSound(plane.mesh, curves);
	for (Index e = 0; e < plane.mesh.edgeCount(); ++e)
		for (const EdgePoint& p : curves.points[e]) {
			const auto&   edge = plane.mesh.edges()[e];
			const Complex w    = (1.0 - p.t) * plane.positions.phase[edge.from] +
			                  p.t * plane.positions.phase[edge.to];
			const double x = p.family == 0 ? w.real() : w.imag();
			EXPECT_NEAR(x, std::round(x), 1e-9);
		}
}

// At a vertex where both phases are whole four pieces of lines come together.
TEST(IntegerLines, EndAtVerticesWithWholePhases)
{
	for (const double angle : {0.2, 0.5, 1.1, 2.6})
		for (const Index inner : {44, 33, 55}) {
			const Slope         plane(test::triangulatedPlane(9, 0.3).mesh, 5.3, angle, inner);
			const SurfaceCurves curves = integerLines(plane.mesh, plane.field, plane.positions);
			expectSound(plane.mesh, curves);
			EXPECT_EQ(chordsAt(curves, inner), 4);
			for (Index v = 0; v < plane.mesh.vertexCount(); ++v)
				if (v != inner) {
					EXPECT_EQ(chordsAt(curves, v), 0);
				}
		}
}

// The vertices put into singular points have no phase of their own.
TEST(IntegerLines, EndAtTheVerticesThatAreCrossings)
{
	const test::ClosedSurface sphere(test::triangulatedSphere(3), 0.0, 3.2);
	SingularVertices          on = splitSingularTriangles(
        sphere.scaffold, sphere.closed.field, sphere.closed.positions, sphere.alignment.features);
	const TriangleMesh& mesh = on.scaffold.mesh;
	for (Index v = 0; v < mesh.vertexCount(); ++v)
		if (on.singular[v])
			on.positions.phase[v] = {0.4, 0.3};
	const SurfaceCurves curves = integerLines(mesh, on.field, on.positions, on.singular);
	expectSound(mesh, curves);
	for (Index v = 0; v < mesh.vertexCount(); ++v)
		EXPECT_EQ(chordsAt(curves, v), on.singular[v] ? 3 : 0);
	// Whoever does not know of them has ends.
	EXPECT_GT(integerLines(mesh, on.field, on.positions).ends, 0);
}

} // namespace
} // namespace curvature_lines
