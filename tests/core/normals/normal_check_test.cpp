// Right normals pass; equal, random, long and torn ones are found.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "normal_check.h"

#include <cmath>
#include <random>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"

using namespace curvature_lines;

namespace {

samples::SampleCloud sample(const char* surface)
{
	samples::SampleRequest request;
	request.surface = surface;
	request.points  = 2000;
	request.seed    = 3;
	return samples::generate(request);
}

} // namespace

TEST(NormalCheck, RightNormalsPassInsideOutToo)
{
	for (const char* name : {"torus", "sphere", "ellipsoid"}) {
		const auto        cloud = sample(name);
		const NormalCheck right = checkNormals(cloud.positions, cloud.normals);
		EXPECT_FALSE(right.allEqual);
		EXPECT_EQ(right.notUnit + right.disagreeing + right.torn, 0.0) << name;
		EXPECT_EQ(checkNormals(cloud.positions, -cloud.normals).torn, 0.0);
	}
}

TEST(NormalCheck, WrongOnesAreFound)
{
	const auto       cloud = sample("torus");
	Eigen::Matrix3Xd equal = Eigen::Matrix3Xd::Zero(3, cloud.positions.cols());
	equal.row(2).setOnes();
	EXPECT_TRUE(checkNormals(cloud.positions, equal).allEqual);
	EXPECT_EQ(checkNormals(cloud.positions, 3.0 * cloud.normals).notUnit, 1.0);
	std::mt19937                     random(4);
	std::normal_distribution<double> component;
	Eigen::Matrix3Xd                 any = equal, turned = cloud.normals;
	for (Eigen::Index i = 0; i < any.cols(); ++i) {
		any.col(i) =
			Eigen::Vector3d(component(random), component(random), component(random)).normalized();
		if (i % 10 == 0)
			turned.col(i) *= -1.0;
	}
	EXPECT_GT(checkNormals(cloud.positions, any).disagreeing, 0.3);
	EXPECT_GT(checkNormals(cloud.positions, turned).torn, 0.1);
}

TEST(NormalCheck, FlatCloudsMayHaveOneNormal)
{
	Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Random(3, 500), up = Eigen::Matrix3Xd::Zero(3, 500);
	points.row(2).setZero();
	up.row(2).setOnes();
	EXPECT_FALSE(checkNormals(points, up).allEqual);
	EXPECT_EQ(checkNormals(points.leftCols(5), up.leftCols(5)).disagreeing, 0.0);
}
