// Values of raw points: units, duplicates on both sides of the surface, points dropped, scalars and ranges.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "raw_curvatures.h"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "point_cloud.h"

namespace curvature_lines {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// Raw points 0, 1, 2 stand for kept points 0, 0, 1 in a model of diagonal 2; point 3 is dropped. Point 1 is a duplicate
// of point 0 that looks the other way; the raw normal of point 2 is 10 degrees off.
class RawCurvaturesTest : public testing::Test {
protected:
	RawCurvaturesTest()
	{
		const double tilt = 10.0 * EIGEN_PI / 180.0, nan = std::numeric_limits<double>::quiet_NaN();
		rawNormals.resize(3, 4);
		rawNormals << 0, 0, std::sin(tilt), nan, 0, 0, 0, nan, 3, -1, std::cos(tilt), nan;
		prepared.diagonal       = 2.0;
		prepared.source         = {0, 2};
		prepared.representative = {0, 0, 1, -1};
		prepared.cloud.positions.setZero(3, 2);
		prepared.cloud.normals.resize(3, 2);
		prepared.cloud.normals.colwise() = Vector3d(0, 0, 1);
		field.k1                         = Eigen::Vector2d(6, 4);
		field.k2                         = Eigen::Vector2d(2, -4);
		field.error                      = Eigen::Vector2d(0.5, 1.0);
		field.radius                     = Eigen::Vector2d(0.1, 0.2);
		field.confidence                 = Eigen::Vector2d(7, 8);
		field.feature                    = Eigen::Vector2d(0, 1);
		field.status                     = {PointStatus::Ok, PointStatus::Boundary};
		field.d1.resize(3, 2);
		field.d2.resize(3, 2);
		field.d1.colwise() = Vector3d(1, 0, 0);
		field.d2.colwise() = Vector3d(0, 1, 0);
	}

	RawCurvatures values(const std::vector<char>& umbilic = {0, 0}) const
	{
		return rawCurvatures(rawNormals, prepared, field, umbilic);
	}

	Matrix3Xd      rawNormals;
	PreparedCloud  prepared;
	CurvatureField field;
};

TEST_F(RawCurvaturesTest, AreInModelUnits)
{
	const RawCurvatures v = values();
	EXPECT_EQ(v.k1[0], 3.0);
	EXPECT_EQ(v.k2[0], 1.0);
	EXPECT_EQ(v.error[0], 0.25);
	EXPECT_EQ(v.radius[0], 0.2);
	EXPECT_EQ(v.confidence[0], 7.0);
	EXPECT_EQ(v.feature[2], 1.0);
}

TEST_F(RawCurvaturesTest, OfADuplicateOnTheOtherSideChangeSignAndPlaces)
{
	const RawCurvatures v = values();
	EXPECT_EQ(v.k1[1], -1.0);
	EXPECT_EQ(v.k2[1], -3.0);
	EXPECT_EQ(Vector3d(v.d1.col(1)), Vector3d(0, 1, 0));
	EXPECT_EQ(Vector3d(v.d2.col(1)), Vector3d(1, 0, 0)); // right-handed about (0, 0, -1)
	EXPECT_EQ(normalForRaw({0, 0, 1}, rawNormals, prepared, 0), Vector3d(0, 0, 1));
	EXPECT_EQ(normalForRaw({0, 0, 1}, rawNormals, prepared, 1), Vector3d(0, 0, -1));
}

TEST_F(RawCurvaturesTest, DirectionsAreTangentToTheRawNormalWhereItAgrees)
{
	EXPECT_EQ(Vector3d(values().d1.col(2)), Vector3d(1, 0, 0)); // 10 degrees: to the estimate's
	const double tilt = 0.5 * EIGEN_PI / 180.0;
	rawNormals.col(2) = Vector3d(std::sin(tilt), 0, std::cos(tilt));
	const Vector3d along(std::cos(tilt), 0, -std::sin(tilt));
	EXPECT_LT((values().d1.col(2) - along).norm(), 1e-15);
}

TEST_F(RawCurvaturesTest, OfDroppedPointsAreZeroAndInvalid)
{
	const RawCurvatures v = values();
	EXPECT_EQ(v.status[3], PointStatus::Invalid);
	EXPECT_EQ(v.k1[3], 0.0);
	EXPECT_EQ(v.confidence[3], 0.0);
	EXPECT_NEAR(v.d1.col(3).norm(), 1.0, 1e-15);
	EXPECT_NEAR(v.d1.col(3).dot(v.d2.col(3)), 0.0, 1e-15);
}

TEST_F(RawCurvaturesTest, OnlyPointsThatAreOkBecomeUmbilic)
{
	const RawCurvatures v = values({1, 1});
	EXPECT_EQ(v.status[0], PointStatus::Umbilic);
	EXPECT_EQ(v.status[1], PointStatus::Umbilic);
	EXPECT_EQ(v.status[2], PointStatus::Boundary);
}

TEST_F(RawCurvaturesTest, Scalars)
{
	const RawCurvatures v = values(); // point 0: k1 = 3, k2 = 1; point 2: k1 = 2, k2 = -2
	const auto at = [&](CurvatureScalar scalar, Index i) { return scalarsOf(v, scalar)[i]; };
	EXPECT_EQ(at(CurvatureScalar::Mean, 0), 2.0);
	EXPECT_EQ(at(CurvatureScalar::Gaussian, 0), 3.0);
	EXPECT_EQ(at(CurvatureScalar::K1, 0), 3.0);
	EXPECT_EQ(at(CurvatureScalar::K2, 0), 1.0);
	EXPECT_EQ(at(CurvatureScalar::Curvedness, 2), 2.0);
	EXPECT_EQ(at(CurvatureScalar::ShapeIndex, 2), 0.0);
	EXPECT_EQ(at(CurvatureScalar::Confidence, 2), 8.0);
	EXPECT_EQ(scalarsOf(v, CurvatureScalar::Mean).size(), 4);
}

TEST(RampRange, IsFromTheTenthToTheNinetiethPercentileOfEstimates)
{
	Eigen::VectorXd          values(23);
	std::vector<PointStatus> status(23, PointStatus::Ok);
	for (int i = 0; i < 21; ++i)
		values[i] = (8 * i) % 21; // 0 .. 20 in some order
	values[21] = 1e9;
	status[21] = PointStatus::Invalid;
	values[22] = -1e9;
	status[22] = PointStatus::TooFewNeighbors;
	EXPECT_EQ(rampRange(values, status), std::make_pair(2.0, 18.0));
}

TEST(RampRange, OfNoEstimateIsZero)
{
	const std::vector<PointStatus> status(2, PointStatus::Invalid);
	EXPECT_EQ(rampRange(Eigen::Vector2d(1, 2), status), std::make_pair(0.0, 0.0));
}

} // namespace
} // namespace curvature_lines
