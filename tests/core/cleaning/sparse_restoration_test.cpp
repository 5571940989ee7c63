// Sparse parts of a surface come back; strays and patches beside a surface do not.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_restoration.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "neighborhoods.h"
#include "outlier_result.h"
#include "outlier_voter.h"
#include "point_cloud.h"
#include "robust_outliers.h"

namespace curvature_lines {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

struct Points {
	std::vector<Vector3d> positions, normals;
	void add(const Vector3d& p, const Vector3d& n)
	{
		positions.push_back(p);
		normals.push_back(n.normalized());
	}
	Index size() const { return static_cast<Index>(positions.size()); }
};

Matrix3Xd columns(const std::vector<Vector3d>& points)
{
	Matrix3Xd matrix(3, points.size());
	for (std::size_t i = 0; i < points.size(); ++i)
		matrix.col(i) = points[i];
	return matrix;
}

// A grid in the plane z = 0 with spacing 1, a little uneven, but for a hole around the origin.
Points planeWithHole(double radius, samples::Random& random)
{
	Points points;
	for (int x = -20; x <= 20; ++x)
		for (int y = -20; y <= 20; ++y) {
			const Vector3d p(x + random.uniform(-0.3, 0.3), y + random.uniform(-0.3, 0.3), 0.0);
			if (p.norm() > radius)
				points.add(p, Vector3d::UnitZ());
		}
	return points;
}

// Of points all of which from `first` on are rejected, those that stay so.
Index leftOf(const Points& points, Index first, bool excluded = false)
{
	const Matrix3Xd      positions = columns(points.positions);
	const NeighborSearch search(positions);
	std::vector<double>  crowding(points.size());
	std::vector<Index>   rank(points.size());
	std::iota(rank.begin(), rank.end(), 0);
	for (Index i = 0; i < points.size(); ++i) {
		const Vector3d p = positions.col(i);
		crowding[i]      = (positions.col(search.nearest(p, crowdSize + 1).back()) - p).norm();
	}
	std::vector<char> rejected(points.size(), 0);
	std::fill(rejected.begin() + first, rejected.end(), char(1));
	restoreSparseSurfaces(
		{positions, crowding, rank, search, {}, search},
		columns(points.normals),
		std::vector<char>(points.size(), excluded),
		rejected);
	EXPECT_EQ(std::count(rejected.begin(), rejected.begin() + first, char(1)), 0);
	return static_cast<Index>(std::count(rejected.begin() + first, rejected.end(), char(1)));
}

TEST(SparseRestoration, PointsInAGapOfTheSurfaceComeBack)
{
	samples::Random random(1, 0);
	Points          points = planeWithHole(5.0, random);
	const Index     first  = points.size();
	points.add({0.0, 0.0, 0.1}, Vector3d::UnitZ());
	points.add({2.0, 1.5, -0.1}, {0.1, 0.1, 1.0});
	EXPECT_EQ(leftOf(points, first), 0);
	EXPECT_EQ(leftOf(points, first, true), 2);
}

// Wider than a point sees: those in its middle know only others that are rejected.
TEST(SparseRestoration, APartThatIsSparseThroughoutComesBack)
{
	samples::Random random(2, 0);
	Points          points = planeWithHole(15.0, random);
	const Index     first  = points.size();
	for (int x = -4; x <= 4; ++x)
		for (int y = -4; y <= 4; ++y)
			if (std::hypot(x, y) < 4.3)
				points.add({3.3 * x, 3.3 * y, random.uniform(-0.1, 0.1)}, Vector3d::UnitZ());
	EXPECT_EQ(leftOf(points, first), 0);
}

TEST(SparseRestoration, WhatIsNoPartOfTheSurfaceStaysRejected)
{
	samples::Random random(3, 0);
	const Points    holed = planeWithHole(5.0, random);
	const Points    whole = planeWithHole(0.0, random);
	{ // above the hole; in it, but with another normal; on the other side of the surface
		for (const auto& [p, n] :
		     {std::make_pair(Vector3d(0.0, 0.0, 2.5), Vector3d(0.0, 0.0, 1.0)),
		      std::make_pair(Vector3d(0.0, 0.0, 0.0), Vector3d(1.0, 0.0, 0.2)),
		      std::make_pair(Vector3d(0.0, 0.0, 0.0), Vector3d(0.0, 0.0, -1.0))}) {
			Points points = holed;
			points.add(p, n);
			EXPECT_EQ(leftOf(points, holed.size()), 1) << p.transpose();
		}
	}
	{ // a patch over the surface, as dense as a cluster of outliers and sparser
		for (const double step : {0.5, 1.0, 2.0}) {
			Points points = whole;
			for (int x = -2; x <= 2; ++x)
				for (int y = -2; y <= 2; ++y)
					points.add({step * x, step * y, 1.5}, Vector3d::UnitZ());
			EXPECT_EQ(leftOf(points, whole.size()), 25) << step;
		}
	}
	{ // a stray in the hole of a torus: the ring around it slants away
		samples::SampleRequest request;
		request.surface                  = "torus";
		request.points                   = 2000;
		request.seed                     = 4;
		const samples::SampleCloud torus = samples::generate(request);
		for (const double z : {-0.13, 0.0, 0.1}) {
			Points points;
			for (Eigen::Index i = 0; i < torus.positions.cols(); ++i)
				points.add(torus.positions.col(i), torus.normals.col(i));
			const Index first = points.size();
			points.add({0.05, -0.13, z}, {0.0, 0.0, z > 0.0 ? 1.0 : -1.0});
			EXPECT_EQ(leftOf(points, first), 1) << z;
		}
	}
	{ // points of no surface at all
		Points points = whole;
		for (int i = 0; i < 2000; ++i)
			points.add(
				{random.uniform(-20.0, 20.0),
			     random.uniform(-20.0, 20.0),
			     random.uniform(1.0, 40.0)},
				{random.normal(), random.normal(), random.normal()});
		EXPECT_GE(leftOf(points, whole.size()), 1990);
	}
}

// A round foot: 12 spacings across, with a third to a twentieth of the points per area on its sole. `solid`: with a sole.
Points foot(double step, bool solid, samples::Random& random)
{
	constexpr double radius = 6.0, height = 30.0, turn = 2.0 * EIGEN_PI;
	constexpr int    around = 38;
	Points           points;
	for (double z = 0.0; z < height; ++z)
		for (int k = 0; k < around; ++k) {
			const double   t = turn * (k + random.uniform(-0.3, 0.3)) / around;
			const Vector3d n(std::cos(t), std::sin(t), 0.0);
			const double   up = z > 0.0 ? random.uniform(-0.3, 0.3) : 0.0;
			points.add(
				radius * n + Vector3d(0.0, 0.0, z + up),
				n - (z > 0.0 ? 0.0 : 1.0) * Vector3d::UnitZ());
		}
	for (double x = -2.0 * step; solid && x < radius; x += step)
		for (double y = -2.0 * step; y < radius; y += step)
			if (std::hypot(x, y) < radius - 1.0)
				points.add({x, y, random.uniform(-0.05, 0.05)}, -Vector3d::UnitZ());
	return points;
}

TEST(SparseRestoration, ASoleStaysAndAnOpenEndStaysOpen)
{
	for (const double step : {2.5, 3.5, 5.0}) {
		SCOPED_TRACE(step);
		samples::Random random(4, 0);
		const Points    closed = foot(step, true, random);
		Points          open   = foot(step, false, random);
		const Index     wall   = open.size();
		for (int i = 0; i < 5; ++i) // strays in the end of a tube
			open.add(
				{random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0)},
				{random.normal(), random.normal(), 0.0});
		const auto rejected = [](const Points& points) {
			return rejectByRobustVotes(
				prepareCloud(columns(points.positions), columns(points.normals)).cloud, 3.5, 3);
		};
		const std::vector<char> ofClosed = rejected(closed).outlier;
		EXPECT_EQ(std::count(ofClosed.begin(), ofClosed.end(), char(1)), 0);
		const std::vector<char> ofOpen = rejected(open).outlier;
		EXPECT_EQ(std::count(ofOpen.begin() + wall, ofOpen.end(), char(1)), 5);
	}
}

} // namespace
} // namespace curvature_lines
