// Preparation of raw clouds: what is dropped, merged and scaled, and what is refused.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "point_cloud.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

samples::SampleCloud torus(int points = 300)
{
	samples::SampleRequest request;
	request.points = points;
	request.seed   = 1;
	return samples::generate(request);
}

std::string refusal(const Matrix3Xd& positions, const Matrix3Xd& normals)
{
	try {
		prepareCloud(positions, normals);
	}
	catch (const InputError& error) {
		return error.what();
	}
	return {};
}

TEST(PrepareCloud, UnitFrameAndBack)
{
	const auto  sample   = torus();
	const auto  prepared = prepareCloud(sample.positions, 7.0 * sample.normals);
	const auto& p        = prepared.cloud.positions;
	EXPECT_NEAR((p.rowwise().maxCoeff() - p.rowwise().minCoeff()).norm(), 1.0, 1e-12);
	EXPECT_LT((p.rowwise().maxCoeff() + p.rowwise().minCoeff()).norm(), 1e-12);
	for (Index i = 0; i < prepared.cloud.size(); ++i) {
		EXPECT_EQ(prepared.source[i], i);
		EXPECT_EQ(prepared.representative[i], i);
		EXPECT_LT((prepared.toModel(p.col(i)) - sample.positions.col(i)).norm(), 1e-12);
		EXPECT_LT((prepared.cloud.normals.col(i) - sample.normals.col(i)).norm(), 1e-12);
	}
}

TEST(PrepareCloud, DropsAndMerges)
{
	const auto   sample    = torus();
	const Index  n         = 300;
	Matrix3Xd    positions = sample.positions, normals = sample.normals;
	const double nan = std::numeric_limits<double>::quiet_NaN();
	const double inf = std::numeric_limits<double>::infinity();
	positions(1, 3)  = nan;
	positions(0, 4)  = -inf;
	normals.col(5).setZero();
	normals(2, 6)     = nan;
	positions.col(20) = positions.col(10); // tilted duplicates: the mean of the unit normals
	normals.col(10)   = 5.0 * Vector3d(1, 0, 0);
	normals.col(20)   = Vector3d(0, 1, 0);
	positions.col(21) = positions.col(11); // opposite duplicates: the first one's
	normals.col(11)   = Vector3d(0, 0, 2);
	normals.col(21)   = Vector3d(0, 0, -2);

	const auto prepared = prepareCloud(positions, normals);
	EXPECT_EQ(prepared.nonFinite, 2);
	EXPECT_EQ(prepared.zeroNormals, 2);
	EXPECT_EQ(prepared.duplicates, 2);
	EXPECT_EQ(prepared.cloud.size(), n - 6);
	for (const Index dropped : {3, 4, 5, 6})
		EXPECT_EQ(prepared.representative[dropped], -1);
	EXPECT_EQ(prepared.representative[20], prepared.representative[10]);
	EXPECT_EQ(prepared.source[prepared.representative[20]], 10);
	EXPECT_LT(
		(prepared.cloud.normals.col(prepared.representative[10]) - Vector3d(1, 1, 0).normalized())
			.norm(),
		1e-12);
	EXPECT_EQ(prepared.cloud.normals.col(prepared.representative[21]), Vector3d::UnitZ());
	for (Index k = 1; k < prepared.cloud.size(); ++k)
		EXPECT_LT(prepared.source[k - 1], prepared.source[k]);
}

TEST(PrepareCloud, FarFromTheOriginNoTwoPointsCoincide)
{
	const auto sample = torus();
	for (const double size : {1e-3, 1e-8}) { // the second leaves some 50 different coordinates
		const Matrix3Xd far      = (size * sample.positions).colwise() + Vector3d(1e6, -2e6, 3e6);
		const auto      prepared = prepareCloud(far, sample.normals);
		EXPECT_EQ(prepared.cloud.size() + prepared.duplicates, 300);
		for (Index i = 0; i < prepared.cloud.size(); ++i)
			for (Index j = 0; j < i; ++j)
				EXPECT_NE(prepared.cloud.positions.col(i), prepared.cloud.positions.col(j));
	}
}

TEST(PrepareCloud, RefusesWithACause)
{
	const auto sample = torus(40);
	EXPECT_NE(refusal(sample.positions, Matrix3Xd(3, 0)).find("no normals"), std::string::npos);
	EXPECT_NE(
		refusal(Matrix3Xd(3, 0), Matrix3Xd(3, 0)).find("no usable points"), std::string::npos);
	EXPECT_NE(
		refusal(sample.positions.leftCols(19), sample.normals.leftCols(19)).find("at least 20"),
		std::string::npos);
	EXPECT_NE(
		refusal(sample.positions, Matrix3Xd::Zero(3, 40)).find("no normal"), std::string::npos);
	EXPECT_NE(
		refusal(Matrix3Xd::Constant(3, 40, 2.0), sample.normals).find("same place"),
		std::string::npos);
	Matrix3Xd line(3, 40);
	for (int i = 0; i < 40; ++i)
		line.col(i) = Vector3d(1, 2, 3) + 0.1 * i * Vector3d(-3, 1, 2);
	EXPECT_NE(refusal(line, sample.normals).find("one line"), std::string::npos);
	EXPECT_NE(
		refusal(1e308 * sample.positions, sample.normals).find("too large"), std::string::npos);
	EXPECT_EQ(refusal(sample.positions, sample.normals), "");
}

TEST(NeighborLists, RowsKeepTheirOrder)
{
	const auto lists = NeighborLists::fromRows({{3, 1}, {}, {2}});
	ASSERT_EQ(lists.size(), 3);
	EXPECT_EQ(lists[0].size(), 2);
	EXPECT_EQ(lists[0][0], 3);
	EXPECT_EQ(lists[0][1], 1);
	EXPECT_EQ(lists[1].size(), 0);
	EXPECT_EQ(lists[2][0], 2);
	EXPECT_EQ(NeighborLists::fromRows({}).size(), 0);
}

} // namespace
} // namespace curvature_lines::test
