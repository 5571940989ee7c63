// Sizes where a mesh leaves the surface out: half of a plane, whose distances are known, and the growth of sizes around.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "size_feedback.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "closed_surfaces.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "scaffold.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

// The unit square around the origin, of this size.
Scaffold squareOf(double size)
{
	Scaffold scaffold = test::scaffoldOf(test::triangulatedPlane(24, 0.2).mesh);
	scaffold.size.setConstant(scaffold.mesh.vertexCount(), size);
	return scaffold;
}

// The part of the square up to x, one face.
PolygonMesh meshUpTo(double x)
{
	PolygonMesh mesh;
	mesh.vertices.resize(3, 4);
	mesh.vertices << -0.5, x, x, -0.5, -0.5, -0.5, 0.5, 0.5, 0.0, 0.0, 0.0, 0.0;
	mesh.normals = Vector3d::UnitZ().replicate(1, 4);
	mesh.faces   = NeighborLists::fromRows(std::vector<std::vector<Index>>{{0, 1, 2, 3}});
	return mesh;
}

// The least of all sizes and the growth on the way from there, by relaxing all edges until nothing changes.
Eigen::VectorXd graded(const TriangleMesh& mesh, double gradation, Eigen::VectorXd size)
{
	for (bool changed = true; changed;) {
		changed = false;
		for (Index e = 0; e < mesh.edgeCount(); ++e) {
			const auto&  edge  = mesh.edges()[e];
			const double grown = gradation * mesh.along(e).norm();
			for (const auto& [a, b] :
			     {std::pair(edge.from, edge.to), std::pair(edge.to, edge.from)})
				if (size[a] + grown < size[b] - 1e-14) {
					size[b] = size[a] + grown;
					changed = true;
				}
		}
	}
	return size;
}

TEST(SizeFeedback, AMeshThatCoversEverythingChangesNothing)
{
	Scaffold              scaffold = squareOf(0.1);
	const Eigen::VectorXd before   = scaffold.size;
	EXPECT_EQ(shrinkSizesWhereFar(meshUpTo(0.5), scaffold).vertices, 0);
	EXPECT_EQ(scaffold.size, before);
	// A fifth of the size is accepted.
	EXPECT_EQ(shrinkSizesWhereFar(meshUpTo(0.5 - 0.019), scaffold).vertices, 0);
	EXPECT_EQ(scaffold.size, before);
}

TEST(SizeFeedback, SizesShrinkByTheDistance)
{
	for (const double end : {0.4, 0.2, -0.3}) {
		Scaffold            scaffold = squareOf(0.1);
		SizeFeedbackOptions options;
		options.mostGrowth     = INFINITY;
		Eigen::VectorXd wanted = scaffold.size;
		Index           far    = 0;
		for (Index v = 0; v < scaffold.mesh.vertexCount(); ++v) {
			const double distance = scaffold.mesh.vertices(0, v) - end;
			if (!(distance > options.accepted * 0.1))
				continue;
			++far;
			wanted[v] *= std::max(options.leastFactor, options.accepted * 0.1 / distance);
		}
		ASSERT_GT(far, 20);
		EXPECT_EQ(shrinkSizesWhereFar(meshUpTo(end), scaffold, options).vertices, far);
		const Eigen::VectorXd expected = graded(scaffold.mesh, options.gradation, wanted);
		EXPECT_LT((scaffold.size - expected).cwiseAbs().maxCoeff(), 1e-12);
		EXPECT_GE(scaffold.size.minCoeff(), options.leastFactor * 0.1 - 1e-12);
		// Beside what is left out sizes shrink as well, far away they do not.
		if (end > 0.0) {
			EXPECT_EQ(scaffold.size.maxCoeff(), 0.1);
		}
	}
}

TEST(SizeFeedback, OptionsSayWhatIsAcceptedAndHowMuchSizesShrink)
{
	SizeFeedbackOptions options;
	options.accepted  = 1.5;
	Scaffold scaffold = squareOf(0.1);
	EXPECT_EQ(shrinkSizesWhereFar(meshUpTo(0.36), scaffold, options).vertices, 0);
	options             = {};
	options.leastFactor = 0.7;
	EXPECT_GT(shrinkSizesWhereFar(meshUpTo(0.0), scaffold, options).vertices, 0);
	EXPECT_NEAR(scaffold.size.minCoeff(), 0.07, 1e-12);
}

// Where much is left out the sizes do not ask for many more vertices than before: more distance is accepted.
TEST(SizeFeedback, TheNumberOfVerticesGrowsByNoMoreThanItMay)
{
	const auto vertices = [](const Scaffold& scaffold) {
		return (scaffold.mesh.vertexAreas().array() / scaffold.size.array().square()).sum();
	};
	const Scaffold before   = squareOf(0.1);
	Index          farOfAll = 0;
	for (const double growth : {1.1, 1.6, 3.0, 1e9}) {
		Scaffold            scaffold = before;
		SizeFeedbackOptions options;
		options.mostGrowth = growth;
		const Index far    = shrinkSizesWhereFar(meshUpTo(-0.3), scaffold, options).vertices;
		EXPECT_LE(vertices(scaffold), growth * vertices(before) * (1.0 + 1e-12));
		EXPECT_GE(far, farOfAll); // the more may grow, the more is far
		farOfAll = far;
		if (far == 0) {
			EXPECT_EQ(scaffold.size, before.size);
		}
		for (Index v = 0; v < scaffold.mesh.vertexCount(); ++v)
			EXPECT_LE(scaffold.size[v], before.size[v]);
	}
	EXPECT_GT(farOfAll, before.mesh.vertexCount() / 2);
}

// Lengths alone count.
TEST(SizeFeedback, MovesAndGrowsWithTheSurface)
{
	Scaffold                scaffold = squareOf(0.1), moved = scaffold;
	PolygonMesh             mesh = meshUpTo(0.1), other = mesh;
	const test::RigidMotion motion;
	moved.mesh.vertices = 5.0 * motion.ofPoints(scaffold.mesh.vertices);
	moved.size *= 5.0;
	other.vertices = 5.0 * motion.ofPoints(mesh.vertices);
	other.normals  = motion.ofVectors(mesh.normals);
	EXPECT_EQ(
		shrinkSizesWhereFar(mesh, scaffold).vertices, shrinkSizesWhereFar(other, moved).vertices);
	EXPECT_LT((5.0 * scaffold.size - moved.size).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(SizeFeedback, NothingToCompareWith)
{
	Scaffold scaffold = squareOf(0.1);
	EXPECT_EQ(shrinkSizesWhereFar(PolygonMesh(), scaffold).vertices, 0);
	scaffold.size.resize(0);
	EXPECT_EQ(shrinkSizesWhereFar(meshUpTo(0.0), scaffold).vertices, 0);
	EXPECT_EQ(scaffold.size.size(), 0);
}

} // namespace
} // namespace curvature_lines
