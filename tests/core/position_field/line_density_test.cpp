// Densities of lines with a known count of vertices, their anisotropy, and the gradients of one triangle.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "constant_crosses.h"
#include "line_density.h"
#include "point_cloud.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;
using test::CrossedSurface;

TEST(LineDensity, CountsTheVerticesOfAGrid)
{
	// n x m cells on the unit square: inside n m, and along the rim twice n and m.
	const CrossedSurface plane = test::crossed(test::triangulatedPlane(12));
	LineDensity          density(2, plane.surface.size());
	density.row(0).setConstant(8.0);
	density.row(1).setConstant(5.0);
	EXPECT_NEAR(
		expectedVertices(plane.surface.mesh, plane.field, density), 8 * 5 + 2 * (8 + 5), 1e-9);
	// No rim: lines per area.
	const CrossedSurface torus = test::crossed(test::triangulatedTorus(60, 30));
	const double         area  = torus.surface.mesh.vertexAreas().sum();
	density.setConstant(2, torus.surface.size(), 6.0);
	EXPECT_NEAR(expectedVertices(torus.surface.mesh, torus.field, density), 36.0 * area, 1e-9);
}

TEST(LineDensity, MeetsTheTargetNumberOfVertices)
{
	for (const auto& surface :
	     {test::triangulatedPlane(15),
	      test::triangulatedTorus(60, 30),
	      test::triangulatedCylinder(40, 30)})
		for (const double target : {50.0, 400.0, 3000.0}) {
			const CrossedSurface crossed = test::crossed(surface);
			LineDensityOptions   options;
			options.targetVertices = target;
			const LineDensity density =
				lineDensity(crossed.scaffold, crossed.field, crossed.curvature, options);
			EXPECT_GT(density.minCoeff(), 0.0);
			EXPECT_NEAR(
				expectedVertices(surface.mesh, crossed.field, density), target, 1e-6 * target);
		}
}

TEST(LineDensity, IsEvenWhereNothingAsksForMore)
{
	const CrossedSurface plane = test::crossed(test::triangulatedPlane(15, 0.2));
	LineDensityOptions   options;
	options.targetVertices    = 300;
	const LineDensity density = lineDensity(plane.scaffold, plane.field, plane.curvature, options);
	EXPECT_LT(density.maxCoeff() / density.minCoeff(), 1.0 + 1e-6);
}

// Across the strong bend of a cylinder, along d1, lines are closer, by as much as is allowed.
TEST(LineDensity, IsHigherAcrossStrongBendsUpToTheAnisotropy)
{
	const CrossedSurface cylinder = test::crossed(test::triangulatedCylinder(40, 30));
	double               before   = 1.0;
	for (const double anisotropy : {1.0, 1.3, 1.6}) {
		LineDensityOptions options;
		options.anisotropy = anisotropy;
		const LineDensity density =
			lineDensity(cylinder.scaffold, cylinder.field, cylinder.curvature, options);
		double smallest = 1e300, largest = 0.0;
		for (Index v = 0; v < cylinder.surface.size(); ++v) {
			const bool straight =
				std::abs(cylinder.field.d1.col(v).dot(cylinder.surface.truth.d1.col(v))) > 0.7;
			const double ratio = density(straight ? 0 : 1, v) / density(straight ? 1 : 0, v);
			smallest           = std::min(smallest, ratio);
			largest            = std::max(largest, ratio);
		}
		EXPECT_NEAR(smallest, anisotropy, 0.02 * anisotropy);
		EXPECT_NEAR(largest, anisotropy, 0.02 * anisotropy);
		EXPECT_GE(largest, before - 1e-9);
		before = largest;
	}
}

TEST(LineDensity, ShrinksAsTheSurfaceGrows)
{
	const auto                small = test::triangulatedTorus(40, 20);
	test::TriangulatedSurface large = small;
	large.mesh.vertices *= 10.0;
	large.truth.k1 /= 10.0;
	large.truth.k2 /= 10.0;
	const CrossedSurface a = test::crossed(small), b = test::crossed(large);
	const LineDensity    fine = lineDensity(a.scaffold, a.field, a.curvature, {}),
					  coarse  = lineDensity(b.scaffold, b.field, b.curvature, {});
	EXPECT_LT((fine - 10.0 * coarse).cwiseAbs().maxCoeff(), 1e-6 * fine.maxCoeff());
}

// The same torus, with a vertex on one of its edges: one of four triangles is flat.
TEST(LineDensity, TrianglesWithoutAreaHaveNoSay)
{
	const test::TriangulatedSurface torus = test::triangulatedTorus(40, 20);
	for (const double away : {0.0, 1e-18, 1e-14}) {
		SCOPED_TRACE(away);
		// Triangle 0 becomes a flat one of two of its corners and the new vertex, and another that covers it.
		const auto [a, b, c]            = torus.mesh.triangles()[0];
		const Index           added     = torus.size();
		std::vector<Triangle> triangles = torus.mesh.triangles();
		triangles[0]                    = {a, b, added};
		triangles.push_back({b, c, added});
		triangles.push_back({c, a, added});
		Eigen::Matrix3Xd vertices(3, added + 1);
		const auto       corner = [&](Index v) { return torus.mesh.vertices.col(v); };
		vertices << torus.mesh.vertices,
			0.5 * (corner(a) + corner(b)) + away * (corner(c) - corner(a));
		const CrossedSurface crossed =
			test::crossed(test::withTruth("torus", TriangleMesh(vertices, triangles)));
		LineDensityOptions options;
		options.targetVertices = 400;
		const LineDensity density =
			lineDensity(crossed.scaffold, crossed.field, crossed.curvature, options);
		ASSERT_TRUE(density.allFinite());
		EXPECT_NEAR(
			expectedVertices(crossed.surface.mesh, crossed.field, density), 400, 1e-4 * 400);
		const TriangleField flat = triangleField(crossed.surface.mesh, crossed.field, density, 0);
		EXPECT_EQ(flat.gradient, Eigen::Matrix3d::Zero());
		EXPECT_TRUE(flat.normal.allFinite());
		// What is around does not notice.
		const CrossedSurface whole = test::crossed(torus);
		const LineDensity    without =
			lineDensity(whole.scaffold, whole.field, whole.curvature, options);
		EXPECT_LT(
			(density.leftCols(added) - without).cwiseAbs().maxCoeff(), 0.1 * without.maxCoeff());
	}
}

// Lines are as far apart as the sizes of the scaffold.
TEST(LineDensity, FollowsTheSizesOfTheScaffold)
{
	CrossedSurface plane = test::crossed(test::triangulatedPlane(24));
	for (Index v = 0; v < plane.surface.size(); ++v)
		plane.scaffold.size[v] = 0.1 * std::exp(0.5 * plane.surface.mesh.vertices(0, v));
	const Eigen::VectorXd areas = plane.surface.mesh.vertexAreas();
	LineDensityOptions    options;
	options.targetVertices    = (areas.array() / plane.scaffold.size.array().square()).sum();
	options.anisotropy        = 1.0;
	const LineDensity density = lineDensity(plane.scaffold, plane.field, plane.curvature, options);
	// The lines along the other direction have to be as far apart everywhere: half-way is what a mesh can do.
	double fine = 0.0, coarse = 0.0;
	for (Index v = 0; v < plane.surface.size(); ++v) {
		const double x = plane.surface.mesh.vertices(0, v);
		if (x < -0.45)
			fine = std::max(fine, density.col(v).prod());
		if (x > 0.45)
			coarse = std::max(coarse, density.col(v).prod());
	}
	EXPECT_GT(fine / coarse, 1.3);
	// Twice as large, half as dense, wherever the target says no more than that.
	CrossedSurface large = plane;
	large.scaffold.size *= 2.0;
	const LineDensity same = lineDensity(large.scaffold, large.field, large.curvature, options);
	EXPECT_LT((same - density).cwiseAbs().maxCoeff(), 1e-6 * density.maxCoeff());
	// No sizes: even.
	plane.scaffold.size.resize(0);
	const LineDensity even = lineDensity(plane.scaffold, plane.field, plane.curvature, options);
	EXPECT_LT(even.maxCoeff() / even.minCoeff(), 1.0 + 1e-6);
}

// Around the tube of a torus lines have to be as many inside as outside, and get farther apart outside; half of it is a limb.
TEST(LineDensity, LinesOnLimbsDoNotMoveApart)
{
	CrossedSurface     torus = test::crossed(test::triangulatedTorus(60, 30));
	LineDensityOptions options;
	options.targetVertices  = 600;
	options.anisotropy      = 1.0;
	const LineDensity free  = lineDensity(torus.scaffold, torus.field, torus.curvature, options);
	const Index       count = torus.surface.size();
	torus.scaffold.onLimb.assign(count, 0);
	EXPECT_EQ(lineDensity(torus.scaffold, torus.field, torus.curvature, options), free);
	torus.scaffold.onLimb.assign(count, 1);
	const LineDensity bound = lineDensity(torus.scaffold, torus.field, torus.curvature, options);
	EXPECT_GT(free.maxCoeff() / free.minCoeff(), 1.8);
	// The least is .87 of what the sizes ask for, which the most, twice that, may exceed.
	EXPECT_LT(bound.maxCoeff() / bound.minCoeff(), 2.0 * 1.15 + 1e-9);
	EXPECT_GT(bound.minCoeff() / bound.maxCoeff(), free.minCoeff() / free.maxCoeff() * 1.1);
	EXPECT_NEAR(expectedVertices(torus.surface.mesh, torus.field, bound), 600, 1e-3);
}

TEST(ExpectedRise, IsTheNumberOfLinesAnEdgeCrosses)
{
	const CrossedSurface plane = test::crossed(test::triangulatedPlane(10, 0.3));
	LineDensity          density(2, plane.surface.size());
	density.row(0).setConstant(8.0);
	density.row(1).setConstant(5.0);
	const Eigen::VectorXcd rise = expectedRise(plane.surface.mesh, plane.field, density);
	for (Index e = 0; e < plane.surface.mesh.edgeCount(); ++e) {
		const Index    v     = plane.surface.mesh.edges()[e].from;
		const Vector3d along = plane.surface.mesh.along(e);
		EXPECT_NEAR(rise[e].real(), 8.0 * along.dot(plane.field.d1.col(v)), 1e-9);
		EXPECT_NEAR(rise[e].imag(), 5.0 * along.dot(plane.field.d2.col(v)), 1e-9);
	}
	// Once around the tube of a torus, as many lines as its length holds.
	const CrossedSurface torus = test::crossed(test::triangulatedTorus(40, 100));
	density.setConstant(2, torus.surface.size(), 6.0);
	const Eigen::VectorXcd around = expectedRise(torus.surface.mesh, torus.field, density);
	double                 lines  = 0.0;
	for (Index j = 0; j < 100; ++j) {
		const Index e = torus.surface.mesh.edgeBetween(40 * j, 40 * ((j + 1) % 100));
		lines += std::abs(around[e]);
	}
	EXPECT_NEAR(lines, 6.0 * 2.0 * EIGEN_PI * 0.4, 0.05);
}

// On an edge that leaves a crease only the vertex beside it counts.
TEST(ExpectedRise, TakesTheEndThatIsNotOnACrease)
{
	CrossedSurface plane = test::crossed(test::triangulatedPlane(4));
	LineDensity    density(2, plane.surface.size());
	for (Index v = 0; v < plane.surface.size(); ++v)
		density.col(v) << 1.0 + v, 2.0 + v;
	const auto& mesh = plane.surface.mesh;
	const Index e    = mesh.edgeBetween(12, 13);
	const auto  at   = [&](Index v) {
        return Complex(
            density(0, v) * mesh.along(e).dot(plane.field.d1.col(v)),
            density(1, v) * mesh.along(e).dot(plane.field.d2.col(v)));
	};
	const auto rise = [&] { return expectedRise(mesh, plane.field, density)[e]; };
	EXPECT_LT(std::abs(rise() - 0.5 * (at(12) + at(13))), 1e-12);
	plane.field.onCrease[12] = 1;
	EXPECT_LT(std::abs(rise() - at(13)), 1e-12);
	plane.field.onCrease[13] = 1;
	EXPECT_LT(std::abs(rise() - 0.5 * (at(12) + at(13))), 1e-12);
	plane.field.onCrease[12] = 0;
	EXPECT_LT(std::abs(rise() - at(12)), 1e-12);
}

TEST(TriangleField, GradientsAreThoseOfLinearFunctions)
{
	const CrossedSurface torus   = test::crossed(test::triangulatedTorus(40, 20));
	const LineDensity    density = LineDensity::Constant(2, torus.surface.size(), 5.0);
	const Vector3d       slope(0.3, -1.2, 2.5);
	const TriangleMesh&  mesh = torus.surface.mesh;
	for (Index t = 0; t < mesh.triangleCount(); ++t) {
		const TriangleField field    = triangleField(mesh, torus.field, density, t);
		Vector3d            gradient = Vector3d::Zero();
		for (int c = 0; c < 3; ++c)
			gradient +=
				field.gradient.col(c) * slope.dot(mesh.vertices.col(mesh.triangles()[t][c]));
		const Vector3d expected = slope - slope.dot(field.normal) * field.normal;
		EXPECT_LT((gradient - expected).norm(), 1e-9);
		EXPECT_NEAR(field.area, mesh.areaVector(t).norm(), 1e-12);
		for (int f = 0; f < 2; ++f) {
			EXPECT_NEAR(field.target[f].dot(field.normal), 0.0, 1e-9);
			EXPECT_NEAR(field.target[f].norm(), 5.0, 0.2); // arms at its corners differ a little
		}
		EXPECT_NEAR(field.target[0].dot(field.target[1]), 0.0, 0.5);
	}
}

} // namespace
} // namespace curvature_lines
