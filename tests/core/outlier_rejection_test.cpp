// Outlier rejection: the published vote on hand-made fields, recall and precision of the height vote on
// clouds with far outliers, and that clean clouds, edges, corners and rims stay whole.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/outlier_rejection.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <omp.h>

#include "estimated_field.h"

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

struct Outcome {
	double recall = 0.0, falsePositives = 0.0, noise = 0.0; // noise relative to the true diagonal
	Index  rounds = 0;
};

Outcome reject(
	const std::string&    surface,
	int                   points,
	double                noise,
	double                farOutliers,
	Index                 planeFit,
	const OutlierOptions& options = {})
{
	samples::SampleRequest request;
	request.surface     = surface;
	request.points      = points;
	request.noise       = noise;
	request.farOutliers = farOutliers;
	request.seed        = 2;
	const auto      sample  = samples::generate(request);
	const Matrix3Xd normals = planeFit > 0 ? planeFitNormals(sample, planeFit) : sample.normals;
	const auto      prepared = prepareCloud(sample.positions, normals);
	const auto      result   = rejectOutliers(prepared.cloud, options);
	const double    unit     = samples::surface(surface).diagonal();
	Outcome         outcome;
	double          outliers = 0, found = 0, inliers = 0, lost = 0;
	for (Index i = 0; i < prepared.cloud.size(); ++i) {
		const Index  s        = prepared.source[i];
		const double distance = (sample.positions.col(s) - sample.footPoints.col(s)).norm();
		EXPECT_GE(result.score[i], 0.0);
		EXPECT_LE(result.score[i], 1.0);
		if (sample.label[s] == samples::Inlier) {
			++inliers;
			lost += result.outlier[i];
		}
		else if (distance > 3.0 * noise * unit) {
			++outliers;
			found += result.outlier[i];
		}
	}
	outcome.recall         = outliers > 0 ? found / outliers : 1.0;
	outcome.falsePositives = lost / inliers;
	outcome.noise          = result.noise * prepared.diagonal / unit;
	outcome.rounds         = result.roundsUsed;
	return outcome;
}

TEST(HeightVote, FindsFarOutliersOfATorus)
{
	const Outcome outcome = reject("torus", 1500, 0.0025, 0.05, 20);
	EXPECT_GE(outcome.recall, 0.85);
	EXPECT_LE(outcome.falsePositives, 0.01);
	EXPECT_NEAR(outcome.noise, 0.0025, 0.0012);
	EXPECT_GE(outcome.rounds, 2);
	EXPECT_LE(outcome.rounds, 3);
}

TEST(HeightVote, FindsFarOutliersOfAHelicoid)
{
	const Outcome outcome = reject("helicoid", 1730, 0.005, 0.05, 20);
	EXPECT_GE(outcome.recall, 0.85);
	EXPECT_LE(outcome.falsePositives, 0.01);
}

TEST(HeightVote, CleanCloudsStayWhole)
{
	EXPECT_LE(reject("torus", 2000, 0.0, 0.0, 0).falsePositives, 0.001);
	EXPECT_LE(reject("torus", 2000, 0.0, 0.0, 20).falsePositives, 0.001);
	EXPECT_LE(reject("torus", 2000, 0.0025, 0.0, 20).falsePositives, 0.001);
	EXPECT_LE(reject("helicoid", 1500, 0.0, 0.0, 0).falsePositives, 0.001);
	EXPECT_LE(reject("plane", 900, 0.0, 0.0, 0).falsePositives, 0.001);
	EXPECT_EQ(reject("torus", 500, 0.0, 0.0, 0).rounds, 1);
}

TEST(HeightVote, EdgesAndCornersStay)
{
	EXPECT_LE(reject("cube", 2000, 0.0, 0.0, 0).falsePositives, 0.002);
	EXPECT_LE(reject("cube", 2000, 0.0025, 0.0, 20).falsePositives, 0.006);
}

TEST(HeightVote, MoreSensitiveFindsNoLess)
{
	OutlierOptions lax, strict;
	lax.sensitivity    = 8.0;
	strict.sensitivity = 2.5;
	lax.rounds = strict.rounds = 1;
	EXPECT_LE(
		reject("torus", 1200, 0.0025, 0.05, 20, lax).recall,
		reject("torus", 1200, 0.0025, 0.05, 20, strict).recall);
}

TEST(PaperVote, OnACloudIsOneRoundAndWorseThanTheHeightVote)
{
	OutlierOptions paper;
	paper.mode            = OutlierOptions::Mode::Paper;
	const Outcome outcome = reject("torus", 1500, 0.0025, 0.05, 20, paper);
	EXPECT_EQ(outcome.rounds, 1);
	EXPECT_GE(outcome.recall, 0.5);
	EXPECT_LE(outcome.falsePositives, 0.10);
}

TEST(RejectOutliers, AnyNumberOfThreadsAndAnyOrderOfPoints)
{
	samples::SampleRequest request;
	request.points      = 600;
	request.noise       = 0.003;
	request.farOutliers = 0.05;
	const auto sample   = samples::generate(request);
	const PointCloud cloud = prepareCloud(sample.positions, planeFitNormals(sample, 20)).cloud;
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
	auto backwards     = rejectOutliers(reversed).outlier;
	std::reverse(backwards.begin(), backwards.end());
	EXPECT_EQ(one.outlier, backwards);
}

TEST(RejectOutliers, DegenerateClouds)
{
	for (const Index n : {0, 1, 3, 25}) {
		PointCloud cloud;
		cloud.positions.setZero(3, n);
		if (n > 0)
			cloud.positions.row(0).setLinSpaced(0.0, n > 1 ? 1.0 : 0.0);
		cloud.normals.setZero(3, n);
		cloud.normals.row(2).setOnes();
		const auto result = rejectOutliers(cloud);
		EXPECT_EQ(static_cast<Index>(result.outlier.size()), n);
		for (const double score : result.score)
			EXPECT_TRUE(score >= 0.0 && score <= 1.0);
	}
}

TEST(RejectOutliers, CanBeCancelled)
{
	samples::SampleRequest request;
	request.points         = 500;
	const auto     sample  = samples::generate(request);
	const auto     cloud   = prepareCloud(sample.positions, sample.normals).cloud;
	const Progress stopped([](double fraction, const char*) { return fraction < 0.1; });
	EXPECT_THROW(rejectOutliers(cloud, {}, stopped), Cancelled);
}

} // namespace
} // namespace curvature_lines::test
