// Gate normals tell the side of exact surfaces, whatever noise the given normals have.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "gate_normals.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

PointCloud cloudOf(const char* surface, int points)
{
	samples::SampleRequest request;
	request.surface   = surface;
	request.points    = points;
	request.seed      = 4;
	const auto sample = samples::generate(request);
	return {sample.positions, sample.normals};
}

Eigen::Matrix3Xd gateOf(const PointCloud& cloud)
{
	return gateNormals(cloud, NeighborSearch(cloud.positions));
}

TEST(GateNormals, AreTheMeanOfNoisyOnes)
{
	const PointCloud exact = cloudOf("torus", 4000);
	PointCloud       noisy = exact;
	samples::Random  random(1, 0);
	double           before = 0.0, after = 0.0;
	for (Index i = 0; i < noisy.size(); ++i)
		noisy.normals.col(i) = (noisy.normals.col(i) + 0.25 * random.normal3()).normalized();
	const Eigen::Matrix3Xd gate = gateOf(noisy);
	for (Index i = 0; i < noisy.size(); ++i) {
		EXPECT_NEAR(gate.col(i).norm(), 1.0, 1e-9);
		before += (noisy.normals.col(i) - exact.normals.col(i)).norm();
		after += (gate.col(i) - exact.normals.col(i)).norm();
	}
	EXPECT_LT(after, 0.4 * before);
}

// One in twenty looks the wrong way: nearly all around oppose it.
TEST(GateNormals, SetSingleWrongNormalsRight)
{
	const PointCloud exact   = cloudOf("sphere", 3000);
	PointCloud       flipped = exact;
	for (Index i = 0; i < flipped.size(); i += 20)
		flipped.normals.col(i) *= -1.0;
	const Eigen::Matrix3Xd gate = gateOf(flipped);
	for (Index i = 0; i < flipped.size(); ++i)
		EXPECT_GT(gate.col(i).dot(exact.normals.col(i)), 0.9);
}

TEST(GateNormals, KeepTheSidesOfAThinPlateApart)
{
	const PointCloud front = cloudOf("plane", 2000);
	PointCloud       plate;
	plate.positions.resize(3, 4000);
	plate.normals.resize(3, 4000);
	plate.positions << front.positions, front.positions.colwise() - Vector3d(0, 0, 0.002);
	plate.normals << front.normals, -front.normals;
	EXPECT_LT((gateOf(plate) - plate.normals).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(GateNormals, TurnWithTheCloudAndWithItsSide)
{
	const PointCloud        cloud = cloudOf("ellipsoid", 1500);
	const test::RigidMotion motion;
	const Eigen::Matrix3Xd  gate = gateOf(cloud);
	const PointCloud moved   = {motion.ofPoints(cloud.positions), motion.ofVectors(cloud.normals)},
					 flipped = {cloud.positions, -cloud.normals};
	EXPECT_LT((gateOf(moved) - motion.ofVectors(gate)).cwiseAbs().maxCoeff(), 1e-6);
	EXPECT_LT((gateOf(flipped) + gate).cwiseAbs().maxCoeff(), 1e-12);
}

} // namespace
} // namespace curvature_lines
