// Vertices at singular points: the surface and what is known of it stay, no triangle is singular, and all lines go through.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "singular_vertices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "closed_surfaces.h"
#include "cross_field.h"
#include "point_cloud.h"
#include "position_field.h"
#include "scaffold.h"
#include "surface_curves.h"
#include "transition_circuit.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;
using test::ClosedSurface;

SingularVertices split(const ClosedSurface& surface)
{
	return splitSingularTriangles(
		surface.scaffold,
		surface.closed.field,
		surface.closed.positions,
		surface.alignment.features);
}

// Every column and flag differs from vertex to vertex, so that none can be taken for another.
ClosedSurface markedSphere()
{
	ClosedSurface sphere(test::triangulatedSphere(3), 0.0, 3.1);
	const Index   n = sphere.scaffold.mesh.vertexCount();
	sphere.scaffold.onLimb.resize(n);
	for (Index v = 0; v < n; ++v) {
		sphere.scaffold.spacing[v] = 1.0 + 0.01 * v;
		sphere.scaffold.size[v]    = 3.0 + 0.01 * v;
		sphere.scaffold.place[v]   = 7 * v;
		sphere.scaffold.onLimb[v]  = v % 3 == 0;
	}
	for (Index e = 0; e < sphere.scaffold.mesh.edgeCount(); ++e) {
		sphere.scaffold.creaseEdge[e]     = e % 5 == 0;
		sphere.alignment.features.edge[e] = e % 7 == 0;
	}
	for (Index v = 0; v < n; ++v)
		sphere.alignment.features.corner[v] = v % 11 == 0;
	return sphere;
}

TEST(SingularVertices, WithoutSingularTrianglesNothingChanges)
{
	const ClosedSurface    torus(test::triangulatedTorus(30, 14), 1.0, 3.0);
	const SingularVertices result = split(torus);
	EXPECT_EQ(result.scaffold.mesh.vertices, torus.scaffold.mesh.vertices);
	EXPECT_EQ(result.scaffold.mesh.triangles(), torus.scaffold.mesh.triangles());
	EXPECT_EQ(result.positions.end, torus.closed.positions.end);
	EXPECT_EQ(result.field.turns, torus.closed.field.turns);
	EXPECT_EQ(std::count(result.singular.begin(), result.singular.end(), 0), 30 * 14);
}

TEST(SingularVertices, TheSurfaceAndWhatIsKnownOfItStay)
{
	const ClosedSurface      sphere = markedSphere();
	const SingularVertices   result = split(sphere);
	const TriangleMesh &     before = sphere.scaffold.mesh, &after = result.scaffold.mesh;
	const std::vector<Index> singular = singularTriangles(sphere.closed.field);
	const Index              n = before.vertexCount(), added = static_cast<Index>(singular.size());
	ASSERT_EQ(added, 8);
	ASSERT_EQ(after.vertexCount(), n + added);
	EXPECT_EQ(after.triangleCount(), before.triangleCount() + 2 * added);
	EXPECT_EQ(after.eulerCharacteristic(), before.eulerCharacteristic());
	EXPECT_TRUE(after.rims().empty());
	EXPECT_NEAR(after.vertexAreas().sum(), before.vertexAreas().sum(), 1e-12);
	EXPECT_EQ(after.vertices.leftCols(n), before.vertices);
	EXPECT_TRUE(singularTriangles(result.field).empty());
	EXPECT_EQ(static_cast<Index>(result.field.index.size()), after.triangleCount());

	ASSERT_EQ(static_cast<Index>(result.singular.size()), n + added);
	for (Index v = 0; v < n + added; ++v)
		EXPECT_EQ(result.singular[v] != 0, v >= n);
	for (Index v = 0; v < n; ++v) {
		EXPECT_EQ(result.scaffold.source[v], sphere.scaffold.source[v]);
		EXPECT_EQ(result.scaffold.place[v], sphere.scaffold.place[v]);
		EXPECT_EQ(result.scaffold.onLimb[v], sphere.scaffold.onLimb[v]);
		EXPECT_EQ(result.scaffold.spacing[v], sphere.scaffold.spacing[v]);
		EXPECT_EQ(result.scaffold.size[v], sphere.scaffold.size[v]);
		EXPECT_EQ(result.features.corner[v], sphere.alignment.features.corner[v]);
		EXPECT_EQ(result.field.d1.col(v), sphere.closed.field.d1.col(v));
		EXPECT_EQ(result.positions.phase[v], sphere.closed.positions.phase[v]);
	}
	for (Index k = 0; k < added; ++k) {
		const Triangle& corners = before.triangles()[singular[k]];
		EXPECT_EQ(result.scaffold.source[n + k], -1);
		EXPECT_EQ(result.features.corner[n + k], 0);
		EXPECT_NEAR(result.field.normals.col(n + k).norm(), 1.0, 1e-12);
		// what it takes over is that of a corner around it
		EXPECT_TRUE(std::any_of(corners.begin(), corners.end(), [&](Index v) {
			return result.scaffold.spacing[n + k] == sphere.scaffold.spacing[v] &&
			       result.scaffold.size[n + k] == sphere.scaffold.size[v] &&
			       result.scaffold.place[n + k] == sphere.scaffold.place[v] &&
			       result.scaffold.onLimb[n + k] == sphere.scaffold.onLimb[v];
		}));
		for (const Index v : corners)
			EXPECT_GE(after.edgeBetween(v, n + k), 0);
	}
	Index creases = 0, features = 0;
	for (Index e = 0; e < before.edgeCount(); ++e) {
		const Index same = after.edgeBetween(before.edges()[e].from, before.edges()[e].to);
		ASSERT_GE(same, 0);
		EXPECT_EQ(result.scaffold.creaseEdge[same], sphere.scaffold.creaseEdge[e]);
		EXPECT_EQ(result.features.edge[same], sphere.alignment.features.edge[e]);
		EXPECT_EQ(result.field.turns[same], sphere.closed.field.turns[e]);
		EXPECT_EQ(result.positions.end[same], sphere.closed.positions.end[e]);
		creases += sphere.scaffold.creaseEdge[e] != 0;
		features += sphere.alignment.features.edge[e] != 0;
	}
	const auto marked = [](const std::vector<char>& flags) {
		return std::count_if(flags.begin(), flags.end(), [](char flag) { return flag != 0; });
	};
	EXPECT_EQ(marked(result.scaffold.creaseEdge), creases);
	EXPECT_EQ(marked(result.features.edge), features);
}

// Seen from every corner a crossing of lines, and the same point from all of them.
TEST(SingularVertices, NewEdgesEndAtTheFixedPoint)
{
	const ClosedSurface      sphere(test::triangulatedSphere(4), 0.0, 4.0);
	const SingularVertices   result   = split(sphere);
	const TriangleMesh&      before   = sphere.scaffold.mesh;
	const std::vector<Index> singular = singularTriangles(sphere.closed.field);
	for (std::size_t k = 0; k < singular.size(); ++k) {
		const Index             centre  = before.vertexCount() + static_cast<Index>(k);
		const TransitionCircuit circuit = circuitOf(
			before, sphere.closed.field, sphere.closed.positions.translations, singular[k]);
		std::array<Complex, 3> end;
		for (int c = 0; c < 3; ++c) {
			const Index corner = before.triangles()[singular[k]][c];
			const Index e      = result.scaffold.mesh.edgeBetween(corner, centre);
			ASSERT_EQ(result.scaffold.mesh.edges()[e].from, corner);
			EXPECT_EQ(result.field.turns[e], 0);
			end[c] = result.positions.end[e];
			EXPECT_EQ(end[c].real(), std::round(end[c].real()));
			EXPECT_EQ(end[c].imag(), std::round(end[c].imag()));
		}
		for (int c = 0; c < 3; ++c)
			EXPECT_EQ(turned(end[(c + 1) % 3], -circuit.turns[c]) + circuit.translation[c], end[c]);
	}
}

TEST(SingularVertices, NoLineEndsLoose)
{
	for (const double perLength : {1.7, 3.1}) {
		std::vector<ClosedSurface> surfaces;
		surfaces.emplace_back(test::triangulatedSphere(3), 0.0, perLength);
		surfaces.emplace_back(test::triangulatedEllipsoid(4), 1.0, perLength);
		surfaces.emplace_back(test::triangulatedTorus(40, 18), 1.0, perLength);
		surfaces.emplace_back(test::triangulatedCylinder(40, 20), 1.0, perLength);
		const test::CreasedCube cube(10);
		surfaces.emplace_back(cube.scaffold, cube.guide, perLength);
		for (std::size_t k = 0; k < surfaces.size(); ++k) {
			SCOPED_TRACE(testing::Message() << perLength << " " << k);
			if (!surfaces[k].closed.turnedOver.empty())
				continue;
			const SingularVertices on = split(surfaces[k]);
			const SurfaceCurves    curves =
				integerLines(on.scaffold.mesh, on.field, on.positions, on.singular);
			EXPECT_EQ(curves.ends, 0);
			if (k == 4) // where its creases meet there are no lines but these
				continue;
			// Three or five lines come together at every singular point.
			std::vector<int> meeting(on.scaffold.mesh.vertexCount(), 0);
			for (const auto& chord : curves.chords)
				if (chord.b.edge < 0)
					++meeting[chord.b.point];
			for (Index v = 0; v < on.scaffold.mesh.vertexCount(); ++v)
				if (on.singular[v]) {
					EXPECT_TRUE(meeting[v] == 3 || meeting[v] == 5) << meeting[v];
				}
		}
	}
}

} // namespace
} // namespace curvature_lines
