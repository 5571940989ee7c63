// The direction energy against finite differences and its definition, and what smoothing does to noisy fields.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "direction_smoothing.h"
#include "exact_field.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines::test {
namespace {

using Eigen::Vector3d;

constexpr double degree = EIGEN_PI / 180.0;

// Exact curvatures, directions turned by normal noise.
ExactCloud noisyDirections(const std::string& surface, double degrees, int points = 2000)
{
	samples::SampleRequest request;
	request.surface       = surface;
	request.points        = points;
	request.seed          = 5;
	ExactCloud      exact = exactCloud(request);
	samples::Random random(11, 1);
	for (Index i = 0; i < exact.cloud.size(); ++i) {
		const double   a = degrees * degree * random.normal();
		const Vector3d d1 =
			std::cos(a) * exact.sample.d1.col(i) + std::sin(a) * exact.sample.d2.col(i);
		exact.field.d1.col(i) = d1;
		exact.field.d2.col(i) = exact.cloud.normals.col(i).cross(d1);
	}
	return exact;
}

DirectionSmoothingResult smoothed(const ExactCloud& exact, double alpha)
{
	DirectionSmoothingOptions options;
	options.alpha = alpha;
	return smoothDirections(exact.cloud, exact.field, options);
}

double rmsAngle(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b)
{
	double sum = 0.0;
	for (Eigen::Index i = 0; i < a.cols(); ++i)
		sum += std::pow(lineAngle(a.col(i), b.col(i)), 2);
	return std::sqrt(sum / a.cols());
}

double largestAngle(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b)
{
	double largest = 0.0;
	for (Eigen::Index i = 0; i < a.cols(); ++i)
		largest = std::max(largest, lineAngle(a.col(i), b.col(i)));
	return largest;
}

TEST(DirectionEnergy, GradientMatchesFiniteDifferences)
{
	const ExactCloud exact = noisyDirections("ellipsoid", 20.0, 300);
	for (const double alpha : {0.0, 0.3, 0.7, 1.0}) {
		const DirectionEnergy energy(exact.cloud, exact.field, alpha);
		samples::Random       random(2, 1);
		Eigen::VectorXd       theta = energy.initialAngles();
		for (double& t : theta)
			t += 0.5 * random.normal();
		Eigen::VectorXd gradient, unused;
		energy(theta, gradient);
		const double step = 1e-5;
		for (Index i = 0; i < exact.cloud.size(); i += 7) {
			Eigen::VectorXd shifted = theta;
			shifted[i]              = theta[i] + step;
			const double above      = energy(shifted, unused);
			shifted[i]              = theta[i] - step;
			const double below      = energy(shifted, unused);
			EXPECT_NEAR(
				(above - below) / (2.0 * step), gradient[i], 1e-6 * gradient.cwiseAbs().maxCoeff());
		}
	}
}

// A09's formula, written out: with the angle of the projected chord in each plane instead of the
// transport.
TEST(DirectionEnergy, AgreesWithThePublishedChordAngles)
{
	const ExactCloud exact = noisyDirections("sphere", 0.0, 4000);
	Eigen::VectorXd  theta(exact.cloud.size()), unused;
	samples::Random  random(4, 1);
	for (double& t : theta)
		t = random.uniform(0.0, EIGEN_PI);
	std::vector<std::vector<Index>> near(exact.cloud.size());
	CurvatureField                  field = exact.field;
	for (Index i = 0; i < exact.cloud.size(); ++i)
		near[i].assign(exact.minimum.neighbors[i].begin(), exact.minimum.neighbors[i].end());
	for (Index i = 0; i < exact.cloud.size(); ++i)
		for (const Index j : exact.minimum.neighbors[i])
			near[j].push_back(i);
	for (auto& row : near) {
		std::sort(row.begin(), row.end());
		row.erase(std::unique(row.begin(), row.end()), row.end());
	}
	field.weights.neighbors = NeighborLists::fromRows(near);
	field.weights.values.assign(field.weights.neighbors.indices.size(), 1.0);

	double expected = 0.0, pairs = 0.0;
	for (Index i = 0; i < exact.cloud.size(); ++i)
		for (const Index j : near[i]) {
			if (i > j)
				continue;
			const Vector3d chord = exact.cloud.positions.col(i) - exact.cloud.positions.col(j);
			const auto     a     = TangentFrame(exact.cloud.normals.col(i)).toPlane(chord);
			const auto     b     = TangentFrame(exact.cloud.normals.col(j)).toPlane(chord);
			const double   psi =
				theta[i] - std::atan2(a.y(), a.x()) - theta[j] + std::atan2(b.y(), b.x());
			const double w = 1.0 / near[i].size() + 1.0 / near[j].size();
			expected -= w * std::pow(std::cos(psi), 2);
			pairs += w;
		}
	// On a sphere chords are geodesics, so the two agree exactly, not only to first order.
	EXPECT_NEAR(DirectionEnergy(exact.cloud, field, 1.0)(theta, unused), expected, 1e-9 * pairs);
}

TEST(DirectionSmoothing, WithoutSmoothingReturnsTheInput)
{
	const ExactCloud exact  = noisyDirections("torus", 10.0, 600);
	const auto       result = smoothed(exact, 0.0);
	EXPECT_LT(largestAngle(result.d1, exact.field.d1), 1e-7);
	EXPECT_NEAR(result.meanTurn, 0.0, 1e-7);
}

TEST(DirectionSmoothing, RemovesMostOfTheNoise)
{
	for (const char* surface : {"torus", "cylinder"})
		for (const double degrees : {5.0, 10.0}) {
			const ExactCloud exact  = noisyDirections(surface, degrees);
			const double     before = rmsAngle(exact.field.d1, exact.sample.d1);
			const auto       half   = smoothed(exact, 0.5);
			const auto       more   = smoothed(exact, 0.8);
			EXPECT_LT(rmsAngle(half.d1, exact.sample.d1), 0.5 * before) << surface;
			EXPECT_LT(rmsAngle(more.d1, exact.sample.d1), 0.3 * before) << surface;
			EXPECT_LE(half.finalEnergy, half.initialEnergy);
			EXPECT_GT(half.meanTurn, 0.3 * degrees * degree);
		}
}

// Directions known to be right stay, those known to be doubtful follow, whatever the curvatures are.
TEST(DirectionSmoothing, StandardErrorDecidesWhoFollows)
{
	ExactCloud exact = noisyDirections("torus", 0.0);
	exact.field.error.setConstant(1e-4);
	std::vector<Index> turned;
	for (Index i = 0; i < exact.cloud.size(); i += 10) {
		turned.push_back(i);
		exact.field.d1.col(i) =
			(exact.sample.d1.col(i) + 0.6 * exact.sample.d2.col(i)).normalized();
	}
	const auto sure = smoothed(exact, 0.5);
	for (const Index i : turned)
		exact.field.error[i] = exact.field.k1[i] - exact.field.k2[i];
	const auto doubtful = smoothed(exact, 0.5);
	for (const Index i : turned) { // by 31 degrees; some of them are neighbors
		EXPECT_GT(lineAngle(sure.d1.col(i), exact.sample.d1.col(i)), 10.0 * degree);
		EXPECT_LT(lineAngle(doubtful.d1.col(i), exact.sample.d1.col(i)), 9.0 * degree);
	}
}

TEST(DirectionSmoothing, LeavesAnExactFieldAlone)
{
	const ExactCloud exact = noisyDirections("torus", 0.0);
	EXPECT_LT(rmsAngle(smoothed(exact, 0.5).d1, exact.sample.d1), 1.0 * degree);
}

TEST(DirectionSmoothing, RepairsGrossErrors)
{
	ExactCloud exact = noisyDirections("cylinder", 0.0);
	for (Index i = 0; i < exact.cloud.size(); i += 10) // families swapped
		exact.field.d1.col(i) = exact.sample.d2.col(i);
	EXPECT_LT(largestAngle(smoothed(exact, 0.8).d1, exact.sample.d1), 10.0 * degree);
}

TEST(DirectionSmoothing, FramesStayOrthonormal)
{
	const ExactCloud exact  = noisyDirections("helicoid", 10.0);
	const auto       result = smoothed(exact, 0.6);
	for (Index i = 0; i < exact.cloud.size(); ++i) {
		const Vector3d n = exact.cloud.normals.col(i);
		EXPECT_NEAR(result.d1.col(i).norm(), 1.0, 1e-12);
		EXPECT_NEAR(result.d1.col(i).dot(n), 0.0, 1e-12);
		EXPECT_NEAR((n.cross(result.d1.col(i)) - result.d2.col(i)).norm(), 0.0, 1e-12);
	}
}

TEST(DirectionSmoothing, SignsOfTheInputDoNotMatter)
{
	const ExactCloud exact   = noisyDirections("torus", 8.0, 800);
	ExactCloud       flipped = exact;
	for (Index i = 0; i < exact.cloud.size(); i += 3)
		flipped.field.d1.col(i) *= -1.0;
	EXPECT_LT(largestAngle(smoothed(exact, 0.5).d1, smoothed(flipped, 0.5).d1), 1e-3);
}

TEST(DirectionSmoothing, FollowsRigidMotionAndOrderOfPoints)
{
	const ExactCloud      exact = noisyDirections("torus", 8.0, 800);
	const Index           n     = exact.cloud.size();
	const Eigen::Matrix3d rotation =
		Eigen::AngleAxisd(2.1, Vector3d(-1.0, 2.0, 0.5).normalized()).toRotationMatrix();
	std::vector<Index> order(n), place(n);
	std::iota(order.begin(), order.end(), 0);
	std::shuffle(order.begin(), order.end(), std::mt19937(7));
	ExactCloud                      moved = exact;
	std::vector<std::vector<Index>> rows(n);
	for (Index k = 0; k < n; ++k)
		place[order[k]] = k;
	for (Index k = 0; k < n; ++k) {
		const Index i                = order[k];
		moved.cloud.positions.col(k) = rotation * exact.cloud.positions.col(i);
		moved.cloud.normals.col(k)   = rotation * exact.cloud.normals.col(i);
		moved.field.d1.col(k)        = rotation * exact.field.d1.col(i);
		moved.field.k1[k]            = exact.field.k1[i];
		moved.field.k2[k]            = exact.field.k2[i];
		moved.field.radius[k]        = exact.field.radius[i];
	}
	// Regions of up to 32 points, so that no choice by index is made.
	std::vector<std::vector<Index>> small(n);
	for (Index i = 0; i < n; ++i)
		for (const Index j : exact.minimum.neighbors[i]) {
			small[i].push_back(j);
			rows[place[i]].push_back(place[j]);
		}
	for (auto* lists : {&small, &rows})
		for (auto& row : *lists)
			std::sort(row.begin(), row.end());
	ExactCloud reduced              = exact;
	reduced.field.weights.neighbors = NeighborLists::fromRows(small);
	moved.field.weights.neighbors   = NeighborLists::fromRows(rows);
	for (auto* field : {&reduced.field, &moved.field})
		field->weights.values.assign(field->weights.neighbors.indices.size(), 1.0);

	const auto a = smoothed(reduced, 0.5), b = smoothed(moved, 0.5);
	for (Index i = 0; i < n; ++i)
		EXPECT_LT(lineAngle(rotation * a.d1.col(i), b.d1.col(place[i])), 2e-3);
}

TEST(DirectionSmoothing, NothingCrossesAnEdge)
{
	// Two faces of a cube with contradicting fields, in weights that (wrongly) reach across the
	// edge.
	ExactCloud exact = noisyDirections("cube", 0.0, 1500);
	exact.field.k1.setConstant(1.0);
	for (Index i = 0; i < exact.cloud.size(); ++i) {
		const Vector3d n      = exact.cloud.normals.col(i);
		const Vector3d d      = std::abs(n.z()) > 0.5 ? Vector3d(1.0, 1.0, 0.0) : Vector3d::UnitZ();
		exact.field.d1.col(i) = d.normalized();
	}
	const NeighborSearch            search(exact.cloud.positions);
	std::vector<std::vector<Index>> rows(exact.cloud.size());
	for (Index i = 0; i < exact.cloud.size(); ++i) {
		rows[i] = search.within(exact.cloud.positions.col(i), exact.field.radius[i]);
		std::sort(rows[i].begin(), rows[i].end());
	}
	exact.field.weights.neighbors = NeighborLists::fromRows(rows);
	exact.field.weights.values.assign(exact.field.weights.neighbors.indices.size(), 1.0);
	EXPECT_LT(largestAngle(smoothed(exact, 0.9).d1, exact.field.d1), 1e-3);
}

TEST(DirectionSmoothing, PlaneWithoutCurvatureBecomesParallel)
{
	const ExactCloud       exact  = noisyDirections("plane", 20.0, 800); // no data term at all
	const auto             result = smoothed(exact, 0.5);
	const Eigen::Matrix3Xd same   = result.d1.col(0).replicate(1, exact.cloud.size());
	EXPECT_LT(largestAngle(result.d1, same), 3.0 * degree);
	EXPECT_LT(lineAngle(result.d1.col(0), exact.sample.d1.col(0)), 10.0 * degree);
}

TEST(DirectionSmoothing, SameResultForAnyNumberOfThreads)
{
	const ExactCloud exact   = noisyDirections("torus", 8.0, 3000);
	const int        threads = omp_get_max_threads();
	omp_set_num_threads(1);
	const auto one = smoothed(exact, 0.5);
	omp_set_num_threads(2);
	const auto two = smoothed(exact, 0.5);
	omp_set_num_threads(threads);
	EXPECT_EQ(one.d1, two.d1);
	EXPECT_EQ(one.finalEnergy, two.finalEnergy);
}

TEST(DirectionSmoothing, SurvivesPointsWithoutPartners)
{
	ExactCloud exact    = noisyDirections("sphere", 0.0, 50);
	exact.field.weights = {};
	exact.field.weights.neighbors.offsets.assign(51, 0);
	exact.field.status.assign(50, PointStatus::TooFewNeighbors);
	for (const double alpha : {0.0, 0.5, 1.0})
		EXPECT_LT(largestAngle(smoothed(exact, alpha).d1, exact.field.d1), 1e-6);
}

TEST(DirectionSmoothing, CanBeCancelled)
{
	const ExactCloud          exact = noisyDirections("torus", 10.0, 600);
	const Progress            cancel([](double fraction, const char*) { return fraction < 0.4; });
	DirectionSmoothingOptions options;
	options.alpha = 0.5;
	EXPECT_THROW(smoothDirections(exact.cloud, exact.field, options, cancel), Cancelled);
}

} // namespace
} // namespace curvature_lines::test
