// Creases on made-up limbs: what runs along a thin one is cut off, all the rest stays.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_creases.h"

#include <cmath>
#include <functional>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "cloud_index.h"
#include "point_cloud.h"
#include "scaffold_sites.h"
#include "sizing_field.h"

namespace curvature_lines::test {
namespace {

using Eigen::Vector3d;

constexpr double spacing = 0.05;

// A grid over the square from -1 to 1 whose points are on a limb of radius(x), in spacings.
struct Plate {
	CloudIndex  index;
	SizingField sizing;

	explicit Plate(const std::function<double(const Vector3d&)>& radius)
	{
		const Index side = 41;
		PointCloud  cloud;
		cloud.positions.setZero(3, side * side);
		cloud.normals = Vector3d::UnitZ().replicate(1, side * side);
		sizing.limb.resize(side * side);
		sizing.spacing.setConstant(side * side, spacing);
		for (Index i = 0; i < side * side; ++i) {
			cloud.positions.col(i).head<2>() << -1.0 + spacing * (i % side),
				-1.0 + spacing * (i / side);
			sizing.limb[i] = spacing * radius(cloud.positions.col(i));
		}
		index = CloudIndex(cloud);
	}
};

FeatureLine segment(double from, double to, int vertices = 39)
{
	FeatureLine line;
	line.points.setZero(3, vertices);
	line.points.row(0).setLinSpaced(vertices, from, to);
	return line;
}

FeatureLine circle(double start = 0.0, int vertices = 60)
{
	FeatureLine line;
	line.points.setZero(3, vertices);
	for (int k = 0; k < vertices; ++k) {
		const double angle = start + 2.0 * EIGEN_PI * k / vertices;
		line.points.col(k) << 0.8 * std::cos(angle), 0.8 * std::sin(angle), 0.0;
	}
	line.closed = true;
	return line;
}

double lengthOf(const FeatureLine& line)
{
	double length = 0.0;
	for (Eigen::Index k = 1; k < line.points.cols(); ++k)
		length += (line.points.col(k) - line.points.col(k - 1)).norm();
	return length;
}

double noLimb(const Vector3d&)
{
	return INFINITY;
}

double thinToTheRight(const Vector3d& p)
{
	return p.x() > 0.0 ? 1.0 : double(INFINITY);
}

TEST(ThinCreases, WhereThereIsNoLimbAllStay)
{
	const Plate plate(noLimb);
	const auto  kept = withoutThinLimbs(
        {segment(-0.9, 0.9), circle(), segment(0, 0.1, 2)}, plate.index, plate.sizing);
	ASSERT_EQ(kept.size(), 3u); // short ones too
	EXPECT_EQ(kept[0].points, segment(-0.9, 0.9).points);
	EXPECT_FALSE(kept[0].closed);
	EXPECT_EQ(kept[1].points, circle().points);
	EXPECT_TRUE(kept[1].closed);
	EXPECT_EQ(kept[2].points, segment(0, 0.1, 2).points);
	EXPECT_TRUE(withoutThinLimbs({}, plate.index, plate.sizing).empty());
}

TEST(ThinCreases, AreCutWhereTheLimbBegins)
{
	const Plate plate(thinToTheRight);
	const auto  kept = withoutThinLimbs({segment(-0.9, 0.9)}, plate.index, plate.sizing);
	ASSERT_EQ(kept.size(), 1u);
	EXPECT_FALSE(kept[0].closed);
	const Index count = static_cast<Index>(kept[0].points.cols());
	EXPECT_EQ(kept[0].points, segment(-0.9, 0.9).points.leftCols(count));
	EXPECT_NEAR(kept[0].points(0, count - 1), 0.0, 1.5 * spacing);
	// All on the limb: nothing is left.
	EXPECT_TRUE(withoutThinLimbs({segment(0.2, 0.9)}, plate.index, plate.sizing).empty());
}

TEST(ThinCreases, LimbsThePointsCanTellFromACreaseKeepThem)
{
	for (const double radius : {0.5, 1.0, 2.4, 2.6, 10.0}) {
		const Plate plate([radius](const Vector3d&) { return radius; });
		const auto  kept = withoutThinLimbs({segment(-0.9, 0.9)}, plate.index, plate.sizing);
		EXPECT_EQ(kept.size(), radius > 2.5 ? 1u : 0u) << radius;
	}
}

// One point in nine: the estimate is wrong now and then.
TEST(ThinCreases, SinglePointsDoNotCut)
{
	const Plate plate([](const Vector3d& p) {
		const auto x = std::lround(p.x() / spacing), y = std::lround(p.y() / spacing);
		return x % 3 == 0 && y % 3 == 0 ? 1.0 : double(INFINITY);
	});
	const auto  kept = withoutThinLimbs({segment(-0.9, 0.9)}, plate.index, plate.sizing);
	ASSERT_EQ(kept.size(), 1u);
	EXPECT_EQ(kept[0].points, segment(-0.9, 0.9).points);
}

TEST(ThinCreases, ALimbInTheMiddleLeavesBothEnds)
{
	const Plate plate(
		[](const Vector3d& p) { return std::abs(p.x()) < 0.3 ? 1.0 : double(INFINITY); });
	const auto kept = withoutThinLimbs({segment(-0.9, 0.9)}, plate.index, plate.sizing);
	ASSERT_EQ(kept.size(), 2u);
	for (const FeatureLine& part : kept) {
		EXPECT_GT(part.points.row(0).cwiseAbs().minCoeff(), 0.3 - 1.5 * spacing);
		EXPECT_NEAR(lengthOf(part), 0.6, 2.0 * spacing);
	}
	EXPECT_LT(kept[0].points.row(0).maxCoeff(), 0.0);
	EXPECT_GT(kept[1].points.row(0).minCoeff(), 0.0);
	// Parts of two vertices are none.
	EXPECT_TRUE(withoutThinLimbs({segment(-0.36, 0.2, 8)}, plate.index, plate.sizing).empty());
}

// Wherever its first vertex is: half a circle is left, in one piece.
TEST(ThinCreases, AClosedCreaseIsCutOpenOnce)
{
	const Plate plate(thinToTheRight);
	for (int k = 0; k < 8; ++k) {
		const auto kept =
			withoutThinLimbs({circle(0.1 + k * EIGEN_PI / 4.0)}, plate.index, plate.sizing);
		ASSERT_EQ(kept.size(), 1u) << k;
		EXPECT_FALSE(kept[0].closed);
		EXPECT_NEAR(lengthOf(kept[0]), 0.8 * EIGEN_PI, 4.0 * spacing);
		EXPECT_LT(kept[0].points.row(0).maxCoeff(), 1.5 * spacing);
	}
}

} // namespace
} // namespace curvature_lines::test
