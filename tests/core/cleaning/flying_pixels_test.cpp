// Scenes of a depth camera and of a terrestrial scanner: pixels between two surfaces are found, sparse ground stays.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "flying_pixels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "neighborhoods.h"
#include "outlier_voter.h"
#include "point_cloud.h"
#include "rejected_points.h"
#include "shuffled_order.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

struct Scene {
	Matrix3Xd         positions;
	std::vector<char> mixed;

	void add(const std::vector<Vector3d>& points)
	{
		positions.resize(3, points.size());
		for (std::size_t i = 0; i < points.size(); ++i)
			positions.col(i) = points[i];
	}
};

// A sphere before a wall; of the pixels at its silhouette 70 % are anywhere between both.
Scene sphereBeforeWall(double pixelsPerUnit, double radius, int seed)
{
	const double    front = 0.8, wall = 1.3, side = 0.2;
	samples::Random random(seed, 0);
	const int       half  = static_cast<int>(side * pixelsPerUnit);
	const auto      depth = [&](int x, int y) {
        const Vector3d ray(x / pixelsPerUnit, y / pixelsPerUnit, 1.0);
        const double   a = ray.squaredNorm(), b = -2.0 * front * ray.z();
        const double   discriminant = b * b - 4.0 * a * (front * front - radius * radius);
        return discriminant > 0.0 ? (-b - std::sqrt(discriminant)) / (2.0 * a) : wall;
	};
	Scene                 scene;
	std::vector<Vector3d> points;
	for (int y = -half; y < half; ++y)
		for (int x = -half; x < half; ++x) {
			double     z     = depth(x, y);
			const bool edge  = z < wall && (depth(x + 1, y) == wall || depth(x - 1, y) == wall ||
                                           depth(x, y + 1) == wall || depth(x, y - 1) == wall);
			const bool mixed = edge && random.uniform(0.0, 1.0) < 0.7;
			if (mixed)
				z = random.uniform(front + 0.06, wall - 0.04);
			z += 0.0014 * z * z * random.normal();
			points.emplace_back(x / pixelsPerUnit * z, y / pixelsPerUnit * z, z);
			scene.mixed.push_back(mixed);
		}
	scene.add(points);
	return scene;
}

// Flat ground seen from 1.7 up to 40 away; with posts, pixels at whose sides are anywhere between them and the ground.
Scene groundWithPosts(bool posts, int seed)
{
	const double          height = 1.7, step = 0.25 * EIGEN_PI / 180.0;
	const double          distances[] = {5.0, 7.0, 9.0, 12.0};
	const double          azimuths[]  = {-0.5, -0.2, 0.1, 0.4};
	samples::Random       random(seed, 0);
	Scene                 scene;
	std::vector<Vector3d> points;
	for (int row = -240; row < 0; ++row)
		for (int column = -180; column < 180; ++column) {
			const double up = row * step, around = column * step;
			double       range = -height / std::sin(up);
			if (range > 40.0)
				continue;
			bool mixed = false;
			for (int k = 0; posts && k < 4; ++k) {
				const double across = std::abs(around - azimuths[k]) * distances[k];
				const double atPost = distances[k] / std::cos(up);
				if (across > 0.15 || atPost >= range)
					continue;
				mixed = across > 0.15 - distances[k] * step && range > atPost + 0.5 &&
				        random.uniform(0.0, 1.0) < 0.7;
				range = mixed ? random.uniform(atPost + 0.2, range - 0.2) : atPost;
			}
			range += 0.003 * random.normal();
			points.emplace_back(
				range * std::cos(up) * std::cos(around),
				range * std::cos(up) * std::sin(around),
				range * std::sin(up));
			scene.mixed.push_back(mixed);
		}
	scene.add(points);
	return scene;
}

struct Counts {
	double found = 0.0, taken = 0.0; // shares of the mixed pixels and of the other points
};

Counts countsOf(const Scene& scene, const std::vector<char>& flagged)
{
	double found = 0.0, mixed = 0.0, taken = 0.0;
	for (std::size_t i = 0; i < flagged.size(); ++i) {
		mixed += scene.mixed[i];
		found += scene.mixed[i] && flagged[i];
		taken += !scene.mixed[i] && flagged[i];
	}
	return {found / std::max(1.0, mixed), taken / (double(flagged.size()) - mixed)};
}

struct Prepared {
	explicit Prepared(const Matrix3Xd& p) : positions(p), search(positions), rank(p.cols())
	{
		const std::vector<Index> shuffled = shuffledOrder(positions);
		for (std::size_t k = 0; k < shuffled.size(); ++k)
			rank[shuffled[k]] = static_cast<Index>(k);
		for (const auto point : positions.colwise())
			crowding.push_back(
				(positions.col(search.nearest(point, crowdSize + 1).back()) - point).norm());
	}
	VoterCloud cloud() const { return {positions, crowding, rank, search, none, search}; }

	Matrix3Xd           positions;
	NeighborSearch      search;
	std::vector<Index>  rank, none;
	std::vector<double> crowding;
};

// Without this unit none of them is found.
TEST(FlyingPixels, ThoseOfADepthCameraAreFound)
{
	for (const int seed : {1, 2, 3})
		for (const double pixels : {260.0, 365.0}) {
			SCOPED_TRACE(seed);
			SCOPED_TRACE(pixels);
			const Scene    scene = sphereBeforeWall(pixels, seed == 3 ? 0.08 : 0.12, seed);
			const Prepared prepared(scene.positions);
			const Counts   counts = countsOf(scene, findFlyingPixels(prepared.cloud()));
			EXPECT_GE(counts.found, 0.93);
			EXPECT_LE(counts.taken, 0.001);
		}
}

TEST(FlyingPixels, StayRejectedThroughTheVotes)
{
	const Scene  scene  = sphereBeforeWall(300.0, 0.12, 4);
	const Counts counts = countsOf(scene, rejectedOf(scene.positions));
	EXPECT_GE(counts.found, 0.95);
	EXPECT_LE(counts.taken, 0.0015); // most of them by the noise, as without flying pixels
}

TEST(FlyingPixels, GroundWhoseDensityFallsWithTheDistanceStays)
{
	const Scene    scene = groundWithPosts(false, 1);
	const Prepared prepared(scene.positions);
	EXPECT_EQ(countsOf(scene, findFlyingPixels(prepared.cloud())).taken, 0.0);
	const Counts counts = countsOf(scene, rejectedOf(scene.positions));
	EXPECT_LE(counts.taken, 0.0005);
}

TEST(FlyingPixels, PixelsBesidePostsAreFoundOneByOne)
{
	const Scene       scene = groundWithPosts(true, 2);
	const Prepared    prepared(scene.positions);
	std::vector<char> all(scene.mixed.size(), 1);
	const Counts      counts = countsOf(scene, findLoneMixedPixels(prepared.cloud(), all, 5.0));
	EXPECT_GE(counts.found, 0.3);
	EXPECT_LE(counts.taken, 0.0002);
	const Counts rejected = countsOf(scene, rejectedOf(scene.positions));
	EXPECT_GE(rejected.found, 0.85);
	EXPECT_LE(rejected.taken, 0.001);
}

TEST(FlyingPixels, DoNotDependOnTheOrderOfThePoints)
{
	const Scene scene = sphereBeforeWall(200.0, 0.12, 5);
	Scene       turned;
	turned.positions = scene.positions.rowwise().reverse();
	const Prepared    prepared(scene.positions), other(turned.positions);
	std::vector<char> flags = findFlyingPixels(other.cloud());
	std::reverse(flags.begin(), flags.end());
	EXPECT_EQ(flags, findFlyingPixels(prepared.cloud()));
	EXPECT_GT(std::count(flags.begin(), flags.end(), char(1)), 20);
}

// Dense clusters of outliers on both sides of a surface make no sparse sheet of it.
TEST(FlyingPixels, ASurfaceBetweenDenseClustersHasNone)
{
	samples::SampleRequest request;
	request.surface                = "torus";
	request.points                 = 1000;
	request.farOutliers            = 0.05;
	request.nearOutliers           = 0.05;
	request.seed                   = 2;
	const auto              sample = samples::generate(request);
	const Prepared          prepared(sample.positions);
	const std::vector<char> flagged = findFlyingPixels(prepared.cloud());
	EXPECT_LE(std::count(flagged.begin(), flagged.end(), char(1)), 50); // the far outliers
}

TEST(FlyingPixels, TinyAndDegenerateCloudsHaveNone)
{
	for (const Index size : {1, 7, 30, 300}) {
		const Prepared          prepared(Matrix3Xd::Zero(3, size));
		const std::vector<char> all(size, 1), none(size, 0);
		EXPECT_EQ(findFlyingPixels(prepared.cloud()), none);
		EXPECT_EQ(findLoneMixedPixels(prepared.cloud(), all, 5.0), none);
	}
}

} // namespace
} // namespace curvature_lines::test
