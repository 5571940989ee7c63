// Noise removed on surfaces that are known, edges and rims kept, and what must not matter: order, threads,
// place and size of the cloud.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "robust_denoising.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// Normals of plane fits to 16 points: what a user without a scanner's normals has.
void estimateNormals(PointCloud& cloud)
{
	const NeighborSearch search(cloud.positions);
	for (Index i = 0; i < cloud.size(); ++i) {
		const std::vector<Index> near = search.nearest(cloud.positions.col(i), 16);
		Matrix3Xd                local(3, near.size());
		for (std::size_t k = 0; k < near.size(); ++k)
			local.col(k) = cloud.positions.col(near[k]);
		local.colwise() -= local.rowwise().mean().eval();
		const Vector3d n = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(local * local.transpose())
		                       .eigenvectors()
		                       .col(0);
		cloud.normals.col(i) = n.dot(cloud.normals.col(i)) < 0.0 ? Vector3d(-n) : n;
	}
}

double rmsMove(const PointCloud& cloud, const RobustDenoisingResult& result)
{
	return std::sqrt((result.positions - cloud.positions).squaredNorm() / cloud.size());
}

// In the unit frame: the surface's diagonal is the unit of length.
struct NoisyCloud {
	const samples::AnalyticSurface& surface;
	PointCloud                      cloud;

	NoisyCloud(const std::string& name, int points, double noise, std::uint64_t seed = 3) :
			surface(samples::surface(name))
	{
		samples::SampleRequest request;
		request.surface                   = name;
		request.points                    = points;
		request.noise                     = noise;
		request.seed                      = seed;
		const samples::SampleCloud sample = samples::generate(request);
		cloud                             = {sample.positions / surface.diagonal(), sample.normals};
		estimateNormals(cloud);
	}
	Vector3d foot(const Vector3d& p) const
	{
		return surface.project(p * surface.diagonal()) / surface.diagonal();
	}
	double height(const Vector3d& p) const
	{
		const Vector3d q = foot(p);
		return (p - q).dot(surface.frame(q * surface.diagonal()).normal);
	}
	double rmsDistance(const Matrix3Xd& positions, const std::vector<Index>& points) const
	{
		double sum = 0.0;
		for (const Index i : points)
			sum += (positions.col(i) - foot(positions.col(i))).squaredNorm();
		return std::sqrt(sum / double(points.size()));
	}
	// Root mean square distance to the surface, after over before.
	double remaining(const Matrix3Xd& positions, const std::vector<Index>& points) const
	{
		return rmsDistance(positions, points) / rmsDistance(cloud.positions, points);
	}
	std::vector<Index> all() const
	{
		std::vector<Index> points(cloud.size());
		std::iota(points.begin(), points.end(), 0);
		return points;
	}
	double featureDistance(Index i) const
	{
		return surface.featureDistance(
			surface.project(cloud.positions.col(i) * surface.diagonal()));
	}
	double rimDistance(Index i) const
	{
		return surface.rimDistance(surface.project(cloud.positions.col(i) * surface.diagonal()));
	}
};

double meanNormalError(const NoisyCloud& noisy, const RobustDenoisingResult& result)
{
	double sum = 0.0;
	for (Index i = 0; i < noisy.cloud.size(); ++i) {
		const Vector3d foot =
			noisy.surface.project(result.positions.col(i) * noisy.surface.diagonal());
		sum += std::acos(
			std::clamp(result.normals.col(i).dot(noisy.surface.frame(foot).normal), -1.0, 1.0));
	}
	return sum / noisy.cloud.size() * 180.0 / EIGEN_PI;
}

// Standard deviation over mean of the distances to the nearest neighbour: 0.52 for random points of a
// surface, more where points clump.
double clumping(const Matrix3Xd& positions)
{
	const NeighborSearch search(positions);
	Eigen::ArrayXd       distance(positions.cols());
	for (Eigen::Index i = 0; i < positions.cols(); ++i)
		distance[i] =
			(positions.col(search.nearest(positions.col(i), 2)[1]) - positions.col(i)).norm();
	return std::sqrt((distance - distance.mean()).square().mean()) / distance.mean();
}

TEST(RobustDenoising, RemovesNoiseFromSmoothSurfacesWithoutShrinkingThem)
{
	const struct {
		const char* surface;
		int         points;
		double      noise, remaining, normals;
	} cases[] = {
		{"torus", 4000, 0.005, 0.18, 2.0},
		{"torus", 4000, 0.01, 0.18, 3.0},
		{"torus", 1600, 0.005, 0.28, 3.0}};
	for (const auto& c : cases) {
		SCOPED_TRACE(std::string(c.surface) + " " + std::to_string(c.noise));
		const NoisyCloud noisy(c.surface, c.points, c.noise);
		const auto       result = denoiseRobustly(noisy.cloud);
		EXPECT_LT(noisy.remaining(result.positions, noisy.all()), c.remaining);
		EXPECT_LT(meanNormalError(noisy, result), c.normals);
		EXPECT_NEAR(result.pointDeviation, c.noise, 0.12 * c.noise);
		double height = 0.0;
		for (Index i = 0; i < noisy.cloud.size(); ++i)
			height += noisy.height(result.positions.col(i)) / noisy.cloud.size();
		EXPECT_LT(std::abs(height), 0.04 * noisy.rmsDistance(noisy.cloud.positions, noisy.all()));
		EXPECT_LT(clumping(result.positions), 0.56);
	}
}

TEST(RobustDenoising, KeepsEdges)
{
	const NoisyCloud   noisy("cube", 6000, 0.005);
	const auto         result = denoiseRobustly(noisy.cloud);
	std::vector<Index> edge, face;
	for (const Index i : noisy.all())
		(noisy.featureDistance(i) < 0.05 ? edge : face).push_back(i);
	EXPECT_LT(noisy.remaining(result.positions, edge), 0.55);
	EXPECT_LT(noisy.remaining(result.positions, face), 0.2);
	EXPECT_LT(meanNormalError(noisy, result), 5.0);
}

TEST(RobustDenoising, KeepsTheRim)
{
	const NoisyCloud   noisy("helicoid", 3000, 0.005);
	const auto         result = denoiseRobustly(noisy.cloud);
	std::vector<Index> rim;
	double             before = 0.0, after = 0.0;
	for (const Index i : noisy.all())
		if (noisy.rimDistance(i) < 0.05) {
			rim.push_back(i);
			before += noisy.cloud.positions.col(i).head<2>().norm();
			after += result.positions.col(i).head<2>().norm();
		}
	EXPECT_LT(noisy.remaining(result.positions, noisy.all()), 0.26);
	EXPECT_LT(noisy.remaining(result.positions, rim), 0.6);
	EXPECT_NEAR(after / double(rim.size()), before / double(rim.size()), 1e-3);
}

// Half of the torus has a ninth of the points: radii have to follow.
TEST(RobustDenoising, FollowsTheDensity)
{
	NoisyCloud         noisy("torus", 9000, 0.004);
	std::vector<Index> kept;
	for (Index i = 0; i < noisy.cloud.size(); ++i)
		if (noisy.cloud.positions(0, i) < 0.0 || i % 9 == 0)
			kept.push_back(i);
	PointCloud uneven;
	uneven.positions.resize(3, kept.size());
	uneven.normals.resize(3, kept.size());
	std::vector<Index> dense, sparse;
	for (std::size_t k = 0; k < kept.size(); ++k) {
		uneven.positions.col(k) = noisy.cloud.positions.col(kept[k]);
		uneven.normals.col(k)   = noisy.cloud.normals.col(kept[k]);
		(uneven.positions(0, k) < 0.0 ? dense : sparse).push_back(static_cast<Index>(k));
	}
	noisy.cloud       = uneven;
	const auto result = denoiseRobustly(uneven);
	EXPECT_LT(noisy.remaining(result.positions, dense), 0.25);
	EXPECT_LT(noisy.remaining(result.positions, sparse), 0.45);
}

// Five times the noise on one side: either side as clean as it would be alone.
TEST(RobustDenoising, FollowsTheNoise)
{
	NoisyCloud         noisy("torus", 6000, 0.0), louder("torus", 6000, 0.01);
	const NoisyCloud   quiet("torus", 6000, 0.002);
	std::vector<Index> little, much;
	for (Index i = 0; i < noisy.cloud.size(); ++i) {
		// The same random numbers: the clouds differ in the noise only.
		const bool left              = noisy.cloud.positions(0, i) < 0.0;
		noisy.cloud.positions.col(i) = (left ? quiet : louder).cloud.positions.col(i);
		if (std::abs(noisy.cloud.positions(0, i)) > 0.05) // the step itself is nobody's scan
			(left ? little : much).push_back(i);
	}
	estimateNormals(noisy.cloud);
	const auto whole = denoiseRobustly(noisy.cloud);
	EXPECT_LT(
		noisy.rmsDistance(whole.positions, little),
		1.3 * quiet.rmsDistance(denoiseRobustly(quiet.cloud).positions, little));
	EXPECT_LT(
		noisy.rmsDistance(whole.positions, much),
		1.3 * louder.rmsDistance(denoiseRobustly(louder.cloud).positions, much));
}

// The cloud and `copies` of its first points, with an error of `jitter` (a length) in each coordinate.
PointCloud repeated(const PointCloud& cloud, Index copied, int copies, double jitter)
{
	samples::Random random(11, 4);
	PointCloud      all;
	all.positions.resize(3, cloud.size() + copies * copied);
	all.normals.resize(3, all.positions.cols());
	for (Index k = 0; k < all.positions.cols(); ++k) {
		const bool  original = k < cloud.size();
		const Index i        = original ? k : (k - cloud.size()) % copied;
		all.positions.col(k) = cloud.positions.col(i);
		if (!original)
			all.positions.col(k) += jitter * random.normal3();
		all.normals.col(k) = cloud.normals.col(i);
	}
	return all;
}

// A copy has the noise of its point and tells nothing new: as much noise is left as without it.
TEST(RobustDenoising, CountsCopiesOfAPointAsOne)
{
	const NoisyCloud single("torus", 3000, 0.002);
	const Index      n       = single.cloud.size();
	const double     spacing = std::sqrt(1.9 / 3000.0);
	const auto       alone   = denoiseRobustly(single.cloud);
	const struct {
		Index  copied;
		int    copies;
		double jitter, over; // spacings; noise left over that of the single points
	} cases[] = {
		{n, 1, 1e-8, 1.02},
		{n, 1, 1e-4, 1.02},
		{n, 1, 0.01, 1.1},
		{n, 1, 0.04, 1.15},
		{n, 2, 0.01, 1.1},
		{n / 3, 1, 1e-3, 1.05}};
	for (const auto& c : cases) {
		SCOPED_TRACE(
			std::to_string(c.copied) + " points, copies of each: " + std::to_string(c.copies) +
			", error in spacings: " + std::to_string(c.jitter));
		NoisyCloud twice  = single;
		twice.cloud       = repeated(single.cloud, c.copied, c.copies, c.jitter * spacing);
		const auto result = denoiseRobustly(twice.cloud);
		EXPECT_LT(
			twice.rmsDistance(result.positions, twice.all()),
			c.over * single.rmsDistance(alone.positions, single.all()));
		EXPECT_NEAR(result.pointDeviation, alone.pointDeviation, 0.15 * alone.pointDeviation);
		EXPECT_NEAR(result.radius, alone.radius, 0.25 * alone.radius);
	}
}

// z = 1.2 sin(w x) cos(w y) over 24 x 24, w = 2 pi / 15, on lines along x that are `ratio` times as far apart as their
// points; noise along z.
struct ScannedWave {
	static constexpr double side = 24.0;
	PointCloud              cloud; // in the unit frame
	double                  diagonal = std::sqrt(2.0) * side;

	static double height(double x, double y)
	{
		constexpr double w = 2.0 * EIGEN_PI / 15.0;
		return 1.2 * std::sin(w * x) * std::cos(w * y);
	}
	ScannedWave(double step, double ratio, double noise)
	{
		samples::Random       random(9, 3);
		std::vector<Vector3d> points;
		for (double y = 0.0; y < side; y += step * ratio) {
			const double begin = random.uniform(0.0, step);
			for (double x = begin; x < side; x += step)
				points.emplace_back(x, y, height(x, y) + noise * random.normal3().x());
		}
		cloud.positions.resize(3, points.size());
		for (std::size_t i = 0; i < points.size(); ++i)
			cloud.positions.col(i) = points[i] / diagonal;
		cloud.normals = Vector3d::UnitZ().replicate(1, points.size());
	}
	// Root mean square of the heights over the surface.
	double rms(const Matrix3Xd& positions) const
	{
		double sum = 0.0;
		for (Eigen::Index i = 0; i < positions.cols(); ++i) {
			const Vector3d p = positions.col(i) * diagonal;
			const double   e = p.z() - height(p.x(), p.y());
			sum += e * e;
		}
		return std::sqrt(sum / double(positions.cols()));
	}
};

TEST(RobustDenoising, SeesFromScanLineToScanLine)
{
	const struct {
		double step, ratio, remaining, error; // error: made where there is no noise
	} cases[] = {{0.2, 5.0, 0.3, 0.0005}, {0.1, 12.0, 0.3, 0.0005}};
	for (const auto& c : cases) {
		SCOPED_TRACE(c.ratio);
		constexpr double  noise = 0.02;
		const ScannedWave noisy(c.step, c.ratio, noise), exact(c.step, c.ratio, 0.0);
		const auto        result = denoiseRobustly(noisy.cloud);
		EXPECT_LT(noisy.rms(result.positions), c.remaining * noise);
		EXPECT_NEAR(result.pointDeviation * noisy.diagonal, noise, 0.12 * noise);
		EXPECT_LT(exact.rms(denoiseRobustly(exact.cloud).positions), c.error);
	}
}

TEST(RobustDenoising, ScanLinesInAnyOrderAndOnAnyNumberOfThreads)
{
	const ScannedWave  noisy(0.2, 8.0, 0.02);
	std::vector<Index> order(noisy.cloud.size());
	std::iota(order.begin(), order.end(), 0);
	std::shuffle(order.begin(), order.end(), std::mt19937(1));
	const int threads = omp_get_max_threads();
	omp_set_num_threads(1);
	const auto result = denoiseRobustly(noisy.cloud);
	omp_set_num_threads(3);
	const auto other = denoiseRobustly(columnsOf(noisy.cloud, order));
	omp_set_num_threads(threads);
	for (Index i = 0; i < noisy.cloud.size(); ++i)
		ASSERT_EQ(other.positions.col(i), result.positions.col(order[i]));
}

TEST(RobustDenoising, NeedsNoMoreOfNormalsThanMostOfTheirSides)
{
	std::mt19937                     random(5);
	std::normal_distribution<double> normal;
	for (const double noise : {0.0, 0.005}) {
		NoisyCloud noisy("torus", 1600, noise);
		for (Index i = 0; i < noisy.cloud.size(); ++i)
			if (random() % 100 < 15)
				noisy.cloud.normals.col(i) =
					Vector3d(normal(random), normal(random), normal(random)).normalized();
		const auto result = denoiseRobustly(noisy.cloud);
		for (Index i = 0; i < noisy.cloud.size(); ++i) {
			const Vector3d foot =
				noisy.surface.project(result.positions.col(i) * noisy.surface.diagonal());
			EXPECT_GT(result.normals.col(i).dot(noisy.surface.frame(foot).normal), 0.5);
		}
	}
}

TEST(RobustDenoising, HardlyMovesACleanCloud)
{
	for (const char* name : {"torus", "cube"}) {
		SCOPED_TRACE(name);
		const NoisyCloud clean(name, 3000, 0.0);
		const auto       result  = denoiseRobustly(clean.cloud);
		const double     spacing = std::sqrt(0.9 / 3000.0); // the area is below 1.9
		EXPECT_LT(rmsMove(clean.cloud, result), 0.05 * spacing);
	}
}

// Two faces at a right angle, joined by a fillet of this radius. With a thickness (less than the radius), a wall: the same
// again from inside. All lengths in spacings; noise along the normals.
struct FilletedWall {
	static constexpr double width = 16.0, depth = 24.0;
	PointCloud              cloud; // in the unit frame
	double                  radius, thickness, scale;

	FilletedWall(double radius, double thickness, double noise) :
			radius(radius), thickness(thickness), scale(1.0 / (2.0 * width))
	{
		samples::Random       random(21, 5);
		const double          arc = 0.5 * EIGEN_PI * radius, length = 2.0 * width + arc;
		const auto            n = static_cast<Index>(length * depth);
		std::vector<Vector3d> points, normals;
		for (const double side : {1.0, -1.0}) {
			if (side < 0.0 && thickness <= 0.0)
				break;
			for (Index i = 0; i < n; ++i) {
				const double s = random.uniform(0.0, length) - width;
				Vector3d     p(0.0, random.uniform(0.0, depth), 0.0), normal(0.0, 0.0, 1.0);
				if (s <= 0.0) {
					p.x() = s;
				}
				else if (s < arc) {
					const double turn = s / radius;
					normal            = Vector3d(std::sin(turn), 0.0, std::cos(turn));
					p.x()             = radius * normal.x();
					p.z()             = radius * (normal.z() - 1.0);
				}
				else {
					normal = Vector3d::UnitX();
					p.x()  = radius;
					p.z()  = arc - radius - s;
				}
				if (side < 0.0)
					p -= thickness * normal;
				points.emplace_back(p + noise * random.normal3().x() * normal);
				normals.emplace_back(side * normal);
			}
		}
		cloud.positions.resize(3, points.size());
		cloud.normals.resize(3, points.size());
		for (std::size_t i = 0; i < points.size(); ++i) {
			cloud.positions.col(i) = scale * points[i];
			cloud.normals.col(i)   = normals[i];
		}
	}
	// Of the points from their side of the wall, in spacings.
	Eigen::VectorXd errors(const Matrix3Xd& positions) const
	{
		Eigen::VectorXd result(positions.cols());
		for (Index i = 0; i < positions.cols(); ++i) {
			const Vector3d        p = positions.col(i) / scale;
			const Eigen::Vector2d d(p.x(), p.z() + radius); // from the axis of the fillet
			const double          outside = std::hypot(std::max(d.x(), 0.0), std::max(d.y(), 0.0)) +
			                       std::min(std::max(d.x(), d.y()), 0.0) - radius;
			const bool inner = thickness > 0.0 && i >= positions.cols() / 2;
			result[i]        = inner ? outside + thickness : outside;
		}
		return result;
	}
};

double rms(const Eigen::VectorXd& values)
{
	return std::sqrt(values.squaredNorm() / double(values.size()));
}

// A fillet is narrower than the smallest patch. Before moves were bound to the noise it was flattened by up to .05
// spacings.
TEST(RobustDenoising, MovesNothingWhereThereIsNoNoise)
{
	for (const double radius : {0.5, 1.0, 2.0, 4.0}) {
		SCOPED_TRACE(radius);
		const FilletedWall wall(radius, 0.0, 0.0);
		const auto         errors = wall.errors(denoiseRobustly(wall.cloud).positions);
		EXPECT_LT(rms(errors), 1e-3);
		EXPECT_LT(errors.cwiseAbs().maxCoeff(), 0.03);
	}
}

TEST(RobustDenoising, SidesOfAThinWallStayApart)
{
	const struct {
		double thickness, noise;
	} cases[] = {{1.0, 0.1}, {1.5, 0.2}, {3.0, 0.3}};
	for (const auto& c : cases) {
		SCOPED_TRACE(std::to_string(c.thickness) + " " + std::to_string(c.noise));
		const FilletedWall wall(4.0, c.thickness, c.noise);
		const auto         errors = wall.errors(denoiseRobustly(wall.cloud).positions);
		EXPECT_LT(rms(errors), 0.5 * c.noise);
		EXPECT_LT((errors.array().abs() > 0.5 * c.thickness).count(), 3);
	}
}

// Beyond a few deviations nothing is noise, whatever the surface around says.
TEST(RobustDenoising, LeavesPointsFarFromTheSurfaceWhereTheyAre)
{
	NoisyCloud         noisy("torus", 4000, 0.002);
	std::vector<Index> far;
	for (Index i = 0; i < noisy.cloud.size(); i += 400) {
		noisy.cloud.positions.col(i) += 0.03 * noisy.cloud.normals.col(i);
		far.push_back(i);
	}
	const auto result = denoiseRobustly(noisy.cloud);
	for (const Index i : far)
		EXPECT_EQ(result.positions.col(i), noisy.cloud.positions.col(i));
}

TEST(RobustDenoising, TakesNoiseAndRadiusAsGiven)
{
	const NoisyCloud       noisy("torus", 3000, 0.005);
	RobustDenoisingOptions options;
	options.noise     = 0.006;
	options.radius    = 6.0;
	const auto result = denoiseRobustly(noisy.cloud, options);
	EXPECT_EQ(result.pointDeviation, 0.006);
	EXPECT_EQ(result.radius, 6.0);
	EXPECT_LT(noisy.remaining(result.positions, noisy.all()), 0.3);
}

TEST(RobustDenoising, SameResultForAnyOrderOfThePoints)
{
	const NoisyCloud   noisy("cube", 2000, 0.005);
	std::vector<Index> order = noisy.all();
	std::shuffle(order.begin(), order.end(), std::mt19937(1));
	PointCloud shuffled = noisy.cloud;
	for (Index i = 0; i < shuffled.size(); ++i) {
		shuffled.positions.col(i) = noisy.cloud.positions.col(order[i]);
		shuffled.normals.col(i)   = noisy.cloud.normals.col(order[i]);
	}
	const auto result = denoiseRobustly(noisy.cloud), other = denoiseRobustly(shuffled);
	for (Index i = 0; i < shuffled.size(); ++i) {
		ASSERT_EQ(other.positions.col(i), result.positions.col(order[i]));
		ASSERT_EQ(other.normals.col(i), result.normals.col(order[i]));
	}
	EXPECT_EQ(other.pointDeviation, result.pointDeviation);
	EXPECT_EQ(other.radius, result.radius);
}

TEST(RobustDenoising, SameResultForAnyNumberOfThreads)
{
	const NoisyCloud noisy("cube", 1500, 0.005);
	const int        threads = omp_get_max_threads();
	omp_set_num_threads(1);
	const auto one = denoiseRobustly(noisy.cloud);
	omp_set_num_threads(3);
	const auto three = denoiseRobustly(noisy.cloud);
	omp_set_num_threads(threads);
	EXPECT_EQ(one.positions, three.positions);
	EXPECT_EQ(one.normals, three.normals);
}

TEST(RobustDenoising, MovesAndScalesWithTheCloud)
{
	const NoisyCloud         noisy("cube", 2000, 0.005);
	const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.7, Vector3d(1.0, 2.0, -1.0).normalized()));
	const Eigen::Matrix3d    rotation = turn.toRotationMatrix();
	const Vector3d           shift(0.03, -0.01, 0.02);
	constexpr double         scale = 0.7;
	PointCloud               moved;
	moved.positions        = (scale * rotation * noisy.cloud.positions).colwise() + shift;
	moved.normals          = rotation * noisy.cloud.normals;
	const auto      result = denoiseRobustly(noisy.cloud), other = denoiseRobustly(moved);
	const Matrix3Xd expected = (scale * rotation * result.positions).colwise() + shift;
	EXPECT_LT((other.positions - expected).colwise().norm().maxCoeff(), 1e-6);
	EXPECT_LT((other.normals - rotation * result.normals).colwise().norm().maxCoeff(), 1e-4);
	EXPECT_NEAR(other.pointDeviation, scale * result.pointDeviation, 1e-9);
}

TEST(RobustDenoising, ReportsAndCanBeCancelled)
{
	const NoisyCloud noisy("cube", 1000, 0.005);
	double           last    = 0.0;
	int              reports = 0;
	const Progress   watch([&](double fraction, const char* what) {
        EXPECT_GE(fraction, last - 1e-12);
        EXPECT_LE(fraction, 1.0);
        EXPECT_NE(std::string(what), "");
        last = fraction;
        ++reports;
        return true;
    });
	denoiseRobustly(noisy.cloud, {}, watch);
	EXPECT_GT(reports, 20);
	const Progress cancel([](double fraction, const char*) { return fraction < 0.3; });
	EXPECT_THROW(denoiseRobustly(noisy.cloud, {}, cancel), Cancelled);
}

TEST(RobustDenoising, SurvivesDegenerateClouds)
{
	samples::Random random(5, 1);
	const auto      filled = [](Index n, const auto& position) {
        PointCloud cloud;
        cloud.positions.resize(3, n);
        for (Index i = 0; i < n; ++i)
            cloud.positions.col(i) = position(i);
        cloud.normals = Vector3d::UnitZ().replicate(1, n);
        return cloud;
	};
	const auto inPlane = [&](Index) {
		return Vector3d(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 0.0);
	};
	PointCloud plates = filled(400, [&](Index i) -> Vector3d {
		return inPlane(i) + Vector3d(0.0, 0.0, i % 2 == 0 ? 0.001 : -0.001);
	});
	for (Index i = 1; i < plates.size(); i += 2)
		plates.normals.col(i) *= -1.0;
	PointCloud far = filled(100, inPlane);
	far.positions.col(7) << 0.0, 0.0, 40.0;
	const PointCloud clouds[] = {
		filled(0, inPlane),
		filled(1, inPlane),
		filled(3, inPlane),
		filled(20, inPlane),
		filled(20, [](Index i) { return Vector3d(0.05 * i - 0.5, 0.0, 0.0); }),
		filled(100, [](Index i) { return Vector3d(0.01 * i - 0.5, 0.0, 0.0); }),
		filled(400, [](Index i) { return Vector3d(0.05 * (i % 20), 0.05 * (i / 20), 0.0); }),
		filled(300, [&](Index) -> Vector3d { return random.normal3() * 0.2; }),
		plates,
		far};
	for (const PointCloud& cloud : clouds) {
		SCOPED_TRACE(&cloud - clouds);
		const auto result = denoiseRobustly(cloud);
		ASSERT_EQ(result.positions.cols(), cloud.positions.cols());
		EXPECT_TRUE(result.positions.allFinite());
		EXPECT_TRUE(result.normals.allFinite());
		if (cloud.size() == 0)
			continue;
		EXPECT_LT(rmsMove(cloud, result), 0.2);
		if (cloud.positions.row(2).isZero()) {
			EXPECT_LT(rmsMove(cloud, result), 1e-6);
		}
	}
}

} // namespace
} // namespace curvature_lines::test
