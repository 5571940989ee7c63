// Lines of whole phases as polylines: closed circles on a torus, from rim to rim on a cylinder, each along its family.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "constant_crosses.h"
#include "curvature_field.h"
#include "exact_field.h"
#include "line_density.h"
#include "line_network.h"
#include "line_networks.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "position_field.h"
#include "position_field_lines.h"
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
