// Neighbour search against brute force, tangent frames, minimum neighbourhoods and boundary flags.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "neighborhoods.h"
#include "point_cloud.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

PointCloud sampled(const std::string& surface, int points, bool regular = false)
{
	samples::SampleRequest request;
	request.surface   = surface;
	request.points    = points;
	request.seed      = 2;
	request.regular   = regular;
	const auto sample = samples::generate(request);
	return prepareCloud(sample.positions, sample.normals).cloud;
}

std::vector<Index> sortedByDistance(const Matrix3Xd& positions, const Vector3d& query)
{
	std::vector<Index> order(positions.cols());
	std::iota(order.begin(), order.end(), 0);
	const auto distance = [&](Index i) {
		const Vector3d d = positions.col(i) - query;
		return d.x() * d.x() + d.y() * d.y() + d.z() * d.z();
	};
	std::stable_sort(
		order.begin(), order.end(), [&](Index a, Index b) { return distance(a) < distance(b); });
	return order;
}

// An integer lattice: almost every distance is a tie.
Matrix3Xd lattice(int side)
{
	Matrix3Xd positions(3, side * side * side);
	for (int i = 0; i < positions.cols(); ++i)
		positions.col(i) = Vector3d(i % side, (i / side) % side, i / (side * side));
	return positions;
}

TEST(NeighborSearch, AgreesWithBruteForceAlsoInTies)
{
	const Matrix3Xd      positions = lattice(8);
	const NeighborSearch search(positions);
	for (const Index i : {0, 37, 291, 511}) {
		const Vector3d           query = positions.col(i);
		const std::vector<Index> all   = sortedByDistance(positions, query);
		for (const Index k : {1, 2, 7, 10, 33, 512, 600}) {
			const std::vector<Index> expected(
				all.begin(), all.begin() + std::min<std::size_t>(k, all.size()));
			EXPECT_EQ(search.nearest(query, k), expected) << i << " " << k;
		}
		for (const double radius : {0.0, 1.0, 1.5, 2.0, 20.0}) {
			std::vector<Index> expected;
			for (const Index j : all)
				if ((positions.col(j) - query).squaredNorm() <= radius * radius)
					expected.push_back(j);
			EXPECT_EQ(search.within(query, radius), expected) << i << " " << radius;
		}
	}
}

TEST(NeighborSearch, EmptyCloudAndSenselessQueries)
{
	const Matrix3Xd none(3, 0), one = Matrix3Xd::Zero(3, 1);
	EXPECT_TRUE(NeighborSearch(none).nearest(Vector3d::Zero(), 3).empty());
	EXPECT_TRUE(NeighborSearch(none).within(Vector3d::Zero(), 1.0).empty());
	EXPECT_TRUE(NeighborSearch(one).nearest(Vector3d::Zero(), 0).empty());
	EXPECT_TRUE(NeighborSearch(one).within(Vector3d::Zero(), -1.0).empty());
	EXPECT_EQ(NeighborSearch(one).nearest(Vector3d::Ones(), 9).size(), 1u);
}

TEST(TangentFrame, OrthonormalEverywhereAndContinuousButForOnePole)
{
	samples::Random random(3, 0);
	for (int trial = 0; trial < 3000; ++trial) {
		Vector3d n = random.normal3().normalized();
		if (trial % 3 == 0) // close to the pole
			n = (Vector3d(0, 0, -1) + std::pow(10.0, -random.uniform(0, 12)) * n).normalized();
		const TangentFrame f(n);
		Eigen::Matrix3d    m;
		m << f.u, f.v, f.n;
		EXPECT_LT((m.transpose() * m - Eigen::Matrix3d::Identity()).norm(), 1e-12) << n.transpose();
		EXPECT_NEAR(m.determinant(), 1.0, 1e-12);
		const double turn = (TangentFrame((n + 1e-7 * f.u).normalized()).u - f.u).norm();
		EXPECT_LT(turn, n.z() > -0.9 ? 1e-5 : 4.0);
	}
	for (const double sign : {1.0, -1.0}) {
		const TangentFrame f(Vector3d(0, 0, sign));
		EXPECT_LT((f.u.cross(f.v) - f.n).norm(), 1e-15);
	}
}

TEST(TangentNear, IsTheTangentPartOrThatOfTheFrame)
{
	const Vector3d up(0, 0, 1);
	EXPECT_EQ(tangentNear({0, 4, 3}, up), Vector3d(0, 1, 0));
	EXPECT_EQ(tangentNear({0, 0, 3}, up), TangentFrame(up).u);
	EXPECT_EQ(tangentNear(Vector3d::Zero(), up), TangentFrame(up).u);
}

TEST(MinimumNeighborhoods, OnePerSixtyDegreesAndProjectedClosest)
{
	const PointCloud           cloud = sampled("ellipsoid", 1500);
	const NeighborSearch       search(cloud.positions);
	const MinimumNeighborhoods minimum = minimumNeighborhoods(cloud, search);
	for (Index i = 0; i < cloud.size(); ++i) {
		const auto          row = minimum.neighbors[i];
		const TangentFrame  frame(cloud.normals.col(i));
		std::vector<double> angles;
		double              sum = 0.0;
		for (const Index j : row) {
			const Vector3d        d = cloud.positions.col(j) - cloud.positions.col(i);
			const Eigen::Vector2d t = frame.toPlane(d);
			angles.push_back(std::atan2(t.y(), t.x()));
			sum += d.norm();
		}
		ASSERT_LE(row.size(), 6);
		EXPECT_NEAR(minimum.spacing[i], sum / row.size(), 1e-12);
		// Of two points in neighbouring slices either may be close to the border, not of three in a row.
		std::sort(angles.begin(), angles.end());
		for (std::size_t a = 0; a + 2 < angles.size(); ++a)
			EXPECT_GT(angles[a + 2] - angles[a], EIGEN_PI / 3.0 - 1e-9);
		// The projected-closest of all near points must be among them.
		Index  closest  = -1;
		double distance = 1e9;
		for (const Index j : search.nearest(cloud.positions.col(i), 20)) {
			const double t = frame.toPlane(cloud.positions.col(j) - cloud.positions.col(i)).norm();
			if (j != i && t < distance) {
				distance = t;
				closest  = j;
			}
		}
		EXPECT_NE(std::find(row.begin(), row.end(), closest), row.end());
	}
}

TEST(MinimumNeighborhoods, IndependentOfAxesAndSignOfNormals)
{
	const PointCloud         cloud = sampled("torus", 800);
	PointCloud               moved = cloud, flipped = cloud;
	const Eigen::Quaterniond turn(0.3, -0.5, 0.7, 0.4);
	moved.positions = turn.normalized().toRotationMatrix() * cloud.positions;
	moved.normals   = turn.normalized().toRotationMatrix() * cloud.normals;
	flipped.normals *= -1.0;
	const auto rowsOf = [](const PointCloud& c) {
		const auto minimum = minimumNeighborhoods(c, NeighborSearch(c.positions));
		std::vector<std::vector<Index>> rows;
		for (Index i = 0; i < c.size(); ++i) {
			rows.emplace_back(minimum.neighbors[i].begin(), minimum.neighbors[i].end());
			std::sort(rows.back().begin(), rows.back().end());
		}
		return rows;
	};
	const auto rows = rowsOf(cloud);
	EXPECT_EQ(rowsOf(moved), rows);
	EXPECT_EQ(rowsOf(flipped), rows);
}

TEST(MinimumNeighborhoods, BoundaryIsTheRimAndNothingElse)
{
	const auto flagged = [](const PointCloud& cloud) {
		const auto        minimum = minimumNeighborhoods(cloud, NeighborSearch(cloud.positions));
		std::vector<char> flags;
		for (const PointStatus s : minimum.status)
			flags.push_back(s != PointStatus::Ok);
		return flags;
	};
	const auto closed = flagged(sampled("torus", 3000));
	// .001: random gaps of a random sampling
	EXPECT_LE(std::count(closed.begin(), closed.end(), 1), 3);

	const PointCloud plane = sampled("plane", 2500, true);
	const auto       flags = flagged(plane);
	const double     edge  = plane.positions.row(0).maxCoeff();
	for (Index i = 0; i < plane.size(); ++i) {
		const double toRim = edge - plane.positions.col(i).head<2>().cwiseAbs().maxCoeff();
		EXPECT_EQ(bool(flags[i]), toRim < 1e-9) << plane.positions.col(i).transpose();
	}
}

TEST(MinimumNeighborhoods, SparsePartIsNotABoundary)
{
	// Two unit squares side by side, the second ten times coarser.
	std::vector<Vector3d> points;
	for (int i = 0; i < 60; ++i)
		for (int j = 0; j < 60; ++j)
			points.emplace_back(i / 60.0, j / 60.0, 1e-4 * (i % 3));
	for (int i = 0; i < 10; ++i)
		for (int j = 0; j < 10; ++j)
			points.emplace_back(1.05 + i / 10.0, j / 10.0, 1e-4 * (j % 3));
	PointCloud cloud;
	cloud.positions.resize(3, points.size());
	for (std::size_t i = 0; i < points.size(); ++i)
		cloud.positions.col(i) = points[i];
	cloud.normals.setZero(3, points.size());
	cloud.normals.row(2).setOnes();
	const auto minimum = minimumNeighborhoods(cloud, NeighborSearch(cloud.positions));
	for (Index i = 3600; i < cloud.size(); ++i) {
		const auto p      = cloud.positions.col(i);
		const bool inside = p.x() > 1.25 && p.x() < 1.85 && p.y() > 0.15 && p.y() < 0.85;
		EXPECT_TRUE(!inside || minimum.status[i] == PointStatus::Ok) << p.transpose();
	}
}

TEST(MinimumNeighborhoods, OtherSheetAndStrayPoints)
{
	PointCloud  sheet = sampled("plane", 900, true);
	PointCloud  cloud;
	const Index n = sheet.size();
	cloud.positions.resize(3, 2 * n + 1);
	cloud.normals.resize(3, 2 * n + 1);
	cloud.positions << sheet.positions, sheet.positions.colwise() - Vector3d(0.001, 0.002, 0.004),
		Vector3d(0, 0, 5);
	cloud.normals << sheet.normals, -sheet.normals, Vector3d::UnitX();
	const auto minimum = minimumNeighborhoods(cloud, NeighborSearch(cloud.positions));
	for (Index i = 0; i < n; ++i)
		for (const Index j : minimum.neighbors[i])
			EXPECT_LT(j, n) << "a point of the other sheet";
	EXPECT_EQ(minimum.status[2 * n], PointStatus::Isolated);
	EXPECT_EQ(minimum.neighbors[2 * n].size(), 0);
}

TEST(MinimumNeighborhoods, DegenerateCloudsGivePositiveSpacing)
{
	for (const Index n : {1, 2, 3, 5}) {
		PointCloud cloud;
		cloud.positions.setZero(3, n);
		cloud.positions.row(0).setLinSpaced(0.0, 1.0);
		cloud.normals.setZero(3, n);
		cloud.normals.row(2).setOnes();
		const auto minimum = minimumNeighborhoods(cloud, NeighborSearch(cloud.positions));
		for (const double h : minimum.spacing) {
			EXPECT_GT(h, 0.0);
			EXPECT_TRUE(std::isfinite(h));
		}
	}
}

} // namespace
} // namespace curvature_lines::test
