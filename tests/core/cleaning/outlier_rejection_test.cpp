// Outlier rejection: the published vote on hand-made fields; of the robust vote, recall and precision with
// far and clustered outliers, and that clean clouds, edges, corners, rims and thin sheets stay whole.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "outlier_rejection.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "curvature_field.h"
#include "outlier_result.h"
#include "point_cloud.h"
#include "progress.h"
#include "robust_outliers.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

CurvatureField fieldOf(const std::vector<std::vector<Index>>& rows)
{
	CurvatureField field;
	field.k1.setZero(rows.size());
	field.weights.neighbors = NeighborLists::fromRows(rows);
	field.weights.values.assign(field.weights.neighbors.indices.size(), 1.0);
	field.status.assign(rows.size(), PointStatus::Ok);
	return field;
}

TEST(PaperVote, OneSidedWeightsAreVotesAgainst)
{
	// 0 leans on 1, 2, 3; only 1 leans back: 2 of 3 votes against 0. Nobody is against 1, 2, 3.
	CurvatureField field = fieldOf({{1, 2, 3}, {0, 2, 3}, {1, 3}, {1, 2}});
	OutlierResult  vote  = voteOutliers(field, 0.5);
	EXPECT_EQ(vote.outlier, std::vector<char>({1, 0, 0, 0}));
	EXPECT_NEAR(vote.score[0], 2.0 / 3.0, 1e-15);
	EXPECT_EQ(vote.score[1], 0.0);
	EXPECT_EQ(vote.isolated, 0);
	EXPECT_EQ(voteOutliers(field, 0.7).outlier, std::vector<char>({0, 0, 0, 0}));

	// Exactly half is not over half.
	EXPECT_EQ(voteOutliers(fieldOf({{1, 2}, {0, 2}, {1}}), 0.5).outlier[0], 0);
}

TEST(PaperVote, NoVotesOrIsolated)
{
	CurvatureField field = fieldOf({{1}, {0}, {}});
	field.status[1]      = PointStatus::Isolated;
	const auto vote      = voteOutliers(field, 0.5);
	EXPECT_EQ(vote.outlier, std::vector<char>({0, 1, 1}));
	EXPECT_EQ(vote.isolated, 2);
	EXPECT_EQ(vote.score[2], 1.0);
}

samples::SampleCloud
sampled(const std::string& surface, int points, double noise, double far, double near)
{
	samples::SampleRequest request;
	request.surface      = surface;
	request.points       = points;
	request.noise        = noise;
	request.farOutliers  = far;
	request.nearOutliers = near;
	request.seed         = 2;
	return samples::generate(request);
}

struct Outcome {
	double recall = 1.0, precision = 1.0, falsePositives = 0.0;
	double noise  = 0.0; // relative to the true diagonal
	Index  rounds = 0;
};

// Far outliers that happen to lie within the noise are in no count: no method can tell them.
Outcome reject(
	const std::string&    surface,
	int                   points,
	double                noise,
	double                far,
	double                near    = 0.0,
	const OutlierOptions& options = {})
{
	const auto   sample   = sampled(surface, points, noise, far, near);
	const auto   prepared = prepareCloud(sample.positions, sample.normals);
	const auto   result   = rejectOutliers(prepared.cloud, options);
	const double diagonal = samples::surface(surface).diagonal();
	double       outliers = 0, found = 0, inliers = 0, lost = 0;
	for (Index i = 0; i < prepared.cloud.size(); ++i) {
		const Index  s        = prepared.source[i];
		const double distance = (sample.positions.col(s) - sample.footPoints.col(s)).norm();
		EXPECT_GE(result.score[i], 0.0);
		EXPECT_LE(result.score[i], 1.0);
		if (sample.label[s] == samples::Inlier) {
			++inliers;
			lost += result.outlier[i];
		}
		else if (
			sample.label[s] == samples::NearOutlier ||
			distance > 3.0 * std::max(noise, 0.0025) * diagonal) {
			++outliers;
			found += result.outlier[i];
		}
	}
	Outcome outcome;
	if (outliers > 0)
		outcome.recall = found / outliers;
	if (found + lost > 0)
		outcome.precision = found / (found + lost);
	outcome.falsePositives = lost / inliers;
	outcome.noise          = result.heightDeviation * prepared.diagonal / diagonal;
	outcome.rounds         = result.roundsUsed;
	return outcome;
}

TEST(RobustVote, FarOutliers)
{
	// Beyond an edge of the cube its faces' planes go on.
	for (const auto& [surface, recall] :
	     std::map<std::string, double>{{"torus", 0.95}, {"helicoid", 0.95}, {"cube", 0.94}}) {
		SCOPED_TRACE(surface);
		const Outcome outcome = reject(surface, 4000, 0.0025, 0.05);
		EXPECT_GE(outcome.recall, recall);
		EXPECT_GE(outcome.precision, 0.96);
		EXPECT_LE(outcome.falsePositives, 0.002);
	}
	const Outcome many = reject("torus", 4000, 0.0025, 0.10);
	EXPECT_GE(many.recall, 0.95);
	EXPECT_GE(many.precision, 0.98);
	EXPECT_GE(many.rounds, 2);
	EXPECT_LE(many.rounds, 3);
}

TEST(RobustVote, NoiseIsMeasured)
{
	EXPECT_NEAR(reject("sphere", 4000, 0.0025, 0.05).noise, 0.0025, 0.0002);
	EXPECT_NEAR(reject("plane", 2000, 0.004, 0.0).noise, 0.004, 0.0003);
}

TEST(RobustVote, ClustersNearTheSurface)
{
	const Outcome exact = reject("torus", 5000, 0.0, 0.0, 0.05);
	EXPECT_GE(exact.recall, 0.99);
	EXPECT_GE(exact.precision, 0.99);
	const Outcome noisy = reject("torus", 5000, 0.0025, 0.0, 0.05);
	EXPECT_GE(noisy.recall, 0.85);
	EXPECT_GE(noisy.precision, 0.97);
}

TEST(RobustVote, CleanCloudsStayWhole)
{
	EXPECT_LE(reject("torus", 2000, 0.0, 0.0).falsePositives, 0.001);
	EXPECT_LE(reject("torus", 2000, 0.0025, 0.0).falsePositives, 0.001);
	EXPECT_LE(reject("helicoid", 1500, 0.0, 0.0).falsePositives, 0.001);
	EXPECT_LE(reject("plane", 900, 0.0, 0.0).falsePositives, 0.001);
	EXPECT_EQ(reject("torus", 500, 0.0, 0.0).rounds, 1);
}

TEST(RobustVote, EdgesAndCornersStay)
{
	EXPECT_LE(reject("cube", 600, 0.0, 0.0).falsePositives, 0.005);
	EXPECT_LE(reject("cube", 4000, 0.0, 0.0).falsePositives, 0.001);
	EXPECT_LE(reject("cube", 4000, 0.0025, 0.0).falsePositives, 0.002);
}

Matrix3Xd twoSheets(int points, double gap, double noise)
{
	samples::Random random(4, 0);
	Matrix3Xd       positions(3, points);
	for (int i = 0; i < points; ++i)
		positions.col(i) = Vector3d(
			random.uniform(-0.35, 0.35),
			random.uniform(-0.35, 0.35),
			(i % 2 ? 0.5 : -0.5) * gap + noise * random.normal());
	return positions;
}

// The distance between the sheets is two spacings; a voter spans seven.
TEST(RobustVote, ThinSheetsStay)
{
	const OutlierResult result =
		rejectByRobustVotes(PointCloud{twoSheets(4000, 0.03, 0.001), {}}, 3.5, 3);
	EXPECT_LE(std::count(result.outlier.begin(), result.outlier.end(), char(1)), 16);
	EXPECT_NEAR(result.heightDeviation, 0.001, 0.0001);
}

// Three clusters of a hundred points each, more than half of what a voter sees.
TEST(RobustVote, DenseClustersDoNotOutvoteTheSurface)
{
	samples::Random random(5, 0);
	const auto      sample = sampled("torus", 4000, 0.001, 0.0, 0.0);
	const double    unit   = 1.0 / samples::surface("torus").diagonal();
	Matrix3Xd       positions(3, 4300);
	positions.leftCols(4000) = sample.positions * unit;
	for (int c = 0; c < 3; ++c) {
		const Vector3d middle = unit * (sample.footPoints.col(c) + 0.05 * sample.normals.col(c));
		for (int k = 0; k < 100; ++k)
			positions.col(4000 + 100 * c + k) = middle + 0.0015 * random.normal3();
	}
	const OutlierResult result = rejectByRobustVotes(PointCloud{positions, {}}, 3.5, 3);
	EXPECT_GE(std::count(result.outlier.begin() + 4000, result.outlier.end(), char(1)), 290);
	EXPECT_LE(std::count(result.outlier.begin(), result.outlier.begin() + 4000, char(1)), 12);
}

// A thorn on a sheet, four spacings wide at half its height: too narrow for voters of 150 points.
TEST(RobustVote, NarrowTipsStay)
{
	const double    spacing = 0.01, width = 2.5 * spacing, height = 12.0 * spacing;
	samples::Random random(7, 0);
	const auto      thorn = [&](double r) { return height * std::exp(-r * r / (width * width)); };
	Matrix3Xd       positions(3, 12000);
	Index           tip = 0;
	for (Index i = 0; i < positions.cols();) {
		const double x = random.uniform(-0.5, 0.5), y = random.uniform(-0.5, 0.5),
					 r     = std::hypot(x, y);
		const double slope = 2.0 * r / (width * width) * thorn(r);
		if (random.uniform(0.0, 4.5) > std::sqrt(1.0 + slope * slope)) // even on the surface
			continue;
		tip += thorn(r) > 0.2 * height;
		positions.col(i++) = Vector3d(x, y, thorn(r));
	}
	ASSERT_GT(tip, 60);
	const OutlierResult result = rejectByRobustVotes(PointCloud{positions, {}}, 3.5, 3);
	EXPECT_LE(std::count(result.outlier.begin(), result.outlier.end(), char(1)), 25);
}

// A wall before a depth camera: one point per unit, noise of .7, depth rounded to steps. Without looking for the steps a fifth
// to a third of the points were lost, all that are not on the fullest layer.
TEST(RobustVote, RoundedDepthIsNoOutlier)
{
	for (const double step : {0.7, 1.4, 2.1})
		for (const double slope : {0.0, 0.09}) {
			SCOPED_TRACE(step);
			samples::Random random(11, 0);
			Matrix3Xd       positions(3, 4900);
			for (Index i = 0; i < positions.cols(); ++i) {
				const double x = i % 70 + random.uniform(-0.15, 0.15);
				const double z = slope * x + 0.7 * random.normal();
				positions.col(i) << x, i / 70 + random.uniform(-0.15, 0.15),
					step * std::round(z / step);
			}
			const OutlierResult result =
				rejectByRobustVotes(PointCloud{positions / 100.0, {}}, 3.5, 3);
			EXPECT_LE(std::count(result.outlier.begin(), result.outlier.end(), char(1)), 24);
			EXPECT_GE(result.heightDeviation, 0.0065);
			EXPECT_LE(result.heightDeviation, 0.0105);
		}
}

TEST(RobustVote, MoreSensitiveFindsNoLess)
{
	OutlierOptions lax, strict;
	lax.sensitivity    = 8.0;
	strict.sensitivity = 2.5;
	lax.rounds = strict.rounds = 1;
	EXPECT_LE(
		reject("torus", 1200, 0.0025, 0.05, 0.0, lax).recall,
		reject("torus", 1200, 0.0025, 0.05, 0.0, strict).recall);
}

TEST(PaperVote, OnACloudIsOneRoundAndKnowsTheNoise)
{
	OutlierOptions paper;
	paper.mode            = OutlierOptions::Mode::Paper;
	const Outcome outcome = reject("torus", 1500, 0.0025, 0.05, 0.0, paper);
	EXPECT_EQ(outcome.rounds, 1);
	EXPECT_GE(outcome.recall, 0.5);
	EXPECT_LE(outcome.falsePositives, 0.10);
	EXPECT_NEAR(outcome.noise, 0.0025, 0.001);
}

PointCloud preparedTorus()
{
	const auto sample = sampled("torus", 1000, 0.003, 0.05, 0.05);
	return prepareCloud(sample.positions, sample.normals).cloud;
}

TEST(RejectOutliers, AnyNumberOfThreadsAndAnyOrderOfPoints)
{
	const PointCloud cloud   = preparedTorus();
	const int        threads = omp_get_max_threads();
	omp_set_num_threads(1);
	const auto one = rejectOutliers(cloud);
	omp_set_num_threads(3);
	const auto three = rejectOutliers(cloud);
	omp_set_num_threads(threads);
	EXPECT_EQ(one.outlier, three.outlier);
	EXPECT_EQ(one.score, three.score);

	PointCloud reversed;
	reversed.positions = cloud.positions.rowwise().reverse();
	reversed.normals   = cloud.normals.rowwise().reverse();
	auto backwards     = rejectOutliers(reversed);
	std::reverse(backwards.outlier.begin(), backwards.outlier.end());
	std::reverse(backwards.score.begin(), backwards.score.end());
	EXPECT_EQ(one.outlier, backwards.outlier);
	EXPECT_EQ(one.score, backwards.score);
}

TEST(RejectOutliers, RigidMotionScalingAndNormalsDoNotMatter)
{
	const PointCloud cloud = preparedTorus();
	const auto       here  = rejectOutliers(cloud).outlier;
	PointCloud       moved = cloud;
	moved.normals *= -1.0;
	moved.positions = (Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix() *
	                   cloud.positions)
	                      .colwise() +
	                  Vector3d(0.01, -0.02, 0.03);
	EXPECT_EQ(here, rejectOutliers(moved).outlier);
	moved = cloud;
	moved.positions *= 0.5;
	EXPECT_EQ(here, rejectOutliers(moved).outlier);
}

TEST(RejectOutliers, DegenerateClouds)
{
	samples::Random random(6, 0);
	for (const bool flat : {false, true})
		for (const Index n : {0, 1, 3, 20, 60}) {
			PointCloud cloud;
			cloud.positions.setZero(3, n);
			for (Index i = 0; i < n; ++i) {
				cloud.positions(0, i) = random.uniform(-0.5, 0.5);
				cloud.positions(1, i) = flat ? random.uniform(-0.5, 0.5) : 0.0;
			}
			cloud.normals.setZero(3, n);
			cloud.normals.row(2).setOnes();
			for (const auto mode : {OutlierOptions::Mode::Robust, OutlierOptions::Mode::Paper}) {
				OutlierOptions options;
				options.mode      = mode;
				const auto result = rejectOutliers(cloud, options);
				EXPECT_EQ(static_cast<Index>(result.outlier.size()), n);
				EXPECT_TRUE(std::isfinite(result.heightDeviation));
				for (const double score : result.score)
					EXPECT_TRUE(score >= 0.0 && score <= 1.0);
			}
		}
}

// From 0 to 1 and never back, through the vote and all that restores points after it.
TEST(RejectOutliers, ProgressGoesForward)
{
	const samples::SampleCloud sample = sampled("cube", 3000, 0.0025, 0.1, 0.1);
	double                     last   = 0.0;
	rejectOutliers(
		prepareCloud(sample.positions, sample.normals).cloud,
		{},
		Progress([&](double fraction, const char* what) {
			EXPECT_GE(fraction, last - 1e-12) << what;
			last = fraction;
			return true;
		}));
	EXPECT_EQ(last, 1.0);
}

TEST(RejectOutliers, CanBeCancelled)
{
	samples::SampleRequest request;
	request.points        = 500;
	const auto     sample = samples::generate(request);
	const auto     cloud  = prepareCloud(sample.positions, sample.normals).cloud;
	const Progress stopped([](double fraction, const char*) { return fraction < 0.1; });
	EXPECT_THROW(rejectOutliers(cloud, {}, stopped), Cancelled);
}

} // namespace
} // namespace curvature_lines::test
