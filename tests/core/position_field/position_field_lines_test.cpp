// Lines of whole phases as polylines: closed circles on a torus, from rim to rim on a cylinder, each along its family.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "closed_surfaces.h"
#include "constant_crosses.h"
#include "cross_field.h"
#include "curvature_field.h"
#include "exact_field.h"
#include "line_density.h"
#include "line_network.h"
#include "line_networks.h"
#include "neighborhoods.h"
#include "phase_pins.h"
#include "point_cloud.h"
#include "position_field.h"
#include "position_field_lines.h"
#include "singular_vertices.h"
#include "surface_curves.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

struct Lines {
	test::CrossedSurface crossed;
	PointCloud           cloud; // the vertices
	CurvatureField       field;
	SurfaceCurves        curves;
	LineNetwork          lines;

	// `perLength` lines of either family
	Lines(const test::TriangulatedSurface& surface, double perLength) :
			crossed(test::crossed(surface)), cloud{surface.mesh.vertices, surface.truth.normals}
	{
		const NeighborSearch search(cloud.positions);
		field = test::exactField(surface.truth, cloud, search, minimumNeighborhoods(cloud, search));
		const LineDensity density = LineDensity::Constant(2, surface.size(), perLength);
		curves                    = integerLines(
            surface.mesh,
            crossed.field,
            positionField(surface.mesh, crossed.field, density, PhasePins(surface.size())));
		lines = linesOf(curves, crossed.scaffold, crossed.field, cloud, field);
	}
	// Of the segments, those that run along the other family.
	int alongTheOther(const char* name) const
	{
		const samples::AnalyticSurface& surface = samples::surface(name);
		int                             wrong   = 0;
		for (Index l = 0; l < lines.lines(); ++l)
			for (Index v = lines.offsets[l]; v + 1 < lines.offsets[l + 1]; ++v) {
				const Vector3d a = lines.vertices.col(v), d = lines.vertices.col(v + 1) - a;
				const auto     frame = surface.frame(surface.project(a + 0.5 * d));
				wrong += (lines.family[l] == 1) !=
				         (std::abs(d.dot(frame.d1)) > std::abs(d.dot(frame.d2)));
			}
		return wrong;
	}
};

TEST(PositionFieldLines, OfACylinderRunFromRimToRimAndRoundIt)
{
	const Lines found(test::triangulatedCylinder(80, 50), 4.1);
	Index       round = 0, straight = 0;
	for (Index l = 0; l < found.lines.lines(); ++l) {
		const bool closed = found.lines.closed[l];
		// circles are of the first family, across the axis
		EXPECT_EQ(found.lines.family[l], closed ? 1 : 2);
		(closed ? round : straight) += 1;
		const Vector3d first = found.lines.vertices.col(found.lines.offsets[l]),
					   last  = found.lines.vertices.col(found.lines.offsets[l + 1] - 1);
		if (!closed) {
			EXPECT_NEAR(std::abs(first.z() - last.z()), 2.0, 0.1);
			EXPECT_LT((first - last).head<2>().norm(), 0.05);
		}
		else
			EXPECT_NEAR(first.z(), last.z(), 0.02);
	}
	EXPECT_NEAR(round, 2.0 * 4.1, 1.1);
	EXPECT_EQ(straight, std::lround(EIGEN_PI * 4.1));
	EXPECT_EQ(found.alongTheOther("cylinder"), 0);
	EXPECT_EQ(tests::crossingsWithinFamilies(found.lines), 0);
	for (Index v = 0; v < static_cast<Index>(found.lines.vertices.cols()); ++v)
		EXPECT_NEAR(found.lines.vertices.col(v).head<2>().norm(), 0.5, 0.01);
}

TEST(PositionFieldLines, OfATorusLieOnItAlongTheirFamilies)
{
	const Lines found(test::triangulatedTorus(90, 45), 4.0);
	EXPECT_GT(found.lines.lines(), 20);
	EXPECT_EQ(tests::crossingsWithinFamilies(found.lines), 0);
	EXPECT_LT(found.alongTheOther("torus"), 0.01 * found.lines.vertices.cols());
	for (Index v = 0; v < static_cast<Index>(found.lines.vertices.cols()); ++v) {
		const Vector3d p = found.lines.vertices.col(v);
		EXPECT_NEAR(std::hypot(p.head<2>().norm() - 1.0, p.z()), 0.4, 0.01);
		EXPECT_NEAR(found.lines.normals.col(v).norm(), 1.0, 1e-9);
	}
}

// Lines of whole phases end at singular points: three or five at each, and nowhere else.
TEST(PositionFieldLines, EndAtSingularPoints)
{
	const test::CrossedSurface crossed = test::crossed(test::triangulatedEllipsoid(4));
	const test::ClosedSurface  closed(
        crossed.scaffold, directionGuide(crossed.scaffold, crossed.curvature), 5.0);
	const SingularVertices on = splitSingularTriangles(
		closed.scaffold, closed.closed.field, closed.closed.positions, closed.alignment.features);
	const SurfaceCurves curves =
		integerLines(on.scaffold.mesh, on.field, on.positions, on.singular);
	ASSERT_EQ(curves.ends, 0);
	const PointCloud     cloud{crossed.surface.mesh.vertices, crossed.surface.truth.normals};
	const NeighborSearch search(cloud.positions);
	const CurvatureField field =
		test::exactField(crossed.surface.truth, cloud, search, minimumNeighborhoods(cloud, search));
	const LineNetwork lines = linesOf(curves, on.scaffold, on.field, cloud, field);
	EXPECT_GT(lines.lines(), 20);
	EXPECT_EQ(tests::crossingsWithinFamilies(lines), 0);
	std::vector<int> meeting(on.scaffold.mesh.vertexCount(), 0);
	for (Index l = 0; l < lines.lines(); ++l)
		for (int side = 0; side < 2; ++side) {
			if (lines.closed[l])
				continue;
			EXPECT_TRUE(
				lines.ends[l][side] == LineEnd::Umbilic || lines.ends[l][side] == LineEnd::Line);
			const Vector3d end =
				lines.vertices.col(side == 0 ? lines.offsets[l] : lines.offsets[l + 1] - 1);
			for (Index v = 0; v < on.scaffold.mesh.vertexCount(); ++v)
				if (on.singular[v] && (on.scaffold.mesh.vertices.col(v) - end).norm() < 0.01)
					++meeting[v];
		}
	for (Index v = 0; v < on.scaffold.mesh.vertexCount(); ++v)
		if (on.singular[v]) {
			EXPECT_GE(meeting[v], 3);
			EXPECT_LE(meeting[v], 5);
		}
	for (Index v = 0; v < static_cast<Index>(lines.vertices.cols()); ++v)
		EXPECT_LT(
			(samples::surface("ellipsoid").project(lines.vertices.col(v)) - lines.vertices.col(v))
				.norm(),
			5e-3);
}

TEST(PositionFieldLines, NoCurvesAreNoLines)
{
	const Lines   torus(test::triangulatedTorus(30, 15), 1.0);
	SurfaceCurves none;
	none.points.resize(torus.crossed.surface.mesh.edgeCount());
	EXPECT_EQ(
		linesOf(none, torus.crossed.scaffold, torus.crossed.field, torus.cloud, torus.field)
			.lines(),
		0);
}

} // namespace
} // namespace curvature_lines
