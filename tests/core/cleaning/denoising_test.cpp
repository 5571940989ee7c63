// The choice between the two ways of denoising, and what each asks for.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "denoising.h"

namespace curvature_lines::test {
namespace {

using Method = DenoisingOptions::Method;

PointCloud noisyTorus()
{
	samples::SampleRequest request;
	request.points                    = 800;
	request.noise                     = 0.005;
	request.seed                      = 3;
	const samples::SampleCloud sample = samples::generate(request);
	return prepareCloud(sample.positions, sample.normals).cloud;
}

struct Correction {
	const PointCloud           cloud;
	const NeighborSearch       search{cloud.positions};
	const MinimumNeighborhoods minimum = minimumNeighborhoods(cloud, search);
	int                        calls   = 0;

	explicit Correction(const PointCloud& cloud) : cloud(cloud) {}
	NormalCorrection counted()
	{
		return [this](const Progress&) {
			++calls;
			return CorrectedNormals{cloud.normals, search, minimum};
		};
	}
};

void expectMoves(const PointCloud& cloud, const DenoisingResult& result)
{
	const Eigen::VectorXd moves = (result.positions - cloud.positions).colwise().norm();
	EXPECT_GT(result.rmsMove, 0.0);
	EXPECT_NEAR(result.rmsMove * result.rmsMove, moves.array().square().mean(), 1e-15);
	EXPECT_DOUBLE_EQ(result.maxMove, moves.maxCoeff());
}

TEST(Denoising, RobustNeedsNoCurvature)
{
	Correction            correction(noisyTorus());
	const DenoisingResult result = denoise(correction.cloud, correction.counted());
	EXPECT_EQ(correction.calls, 0);
	const RobustDenoisingResult direct = denoiseRobustly(correction.cloud);
	EXPECT_EQ(result.positions, direct.positions);
	EXPECT_EQ(result.normals, direct.normals);
	EXPECT_EQ(result.pointDeviation, direct.pointDeviation);
	EXPECT_EQ(result.radius, direct.radius);
	EXPECT_EQ(result.iterations, 0);
	expectMoves(correction.cloud, result);
}

TEST(Denoising, PaperMovesByCorrectedNormals)
{
	Correction       correction(noisyTorus());
	DenoisingOptions options;
	options.method               = Method::Paper;
	options.paper.iterations     = 5;
	PointCloud wrong             = correction.cloud;
	wrong.normals                = -wrong.normals;
	const DenoisingResult result = denoise(wrong, correction.counted(), options);
	EXPECT_EQ(correction.calls, 1);
	const EnergyDenoisingResult direct =
		denoiseByEnergy(correction.cloud, correction.search, correction.minimum, options.paper);
	EXPECT_EQ(result.positions, direct.positions);
	EXPECT_EQ(result.normals, correction.cloud.normals);
	EXPECT_EQ(result.iterations, direct.iterations);
	EXPECT_LT(result.finalEnergy, result.initialEnergy);
	EXPECT_EQ(result.pointDeviation, 0.0);
	expectMoves(wrong, result);
}

TEST(Denoising, ProgressReachesTheEndWithEither)
{
	for (const Method method : {Method::Robust, Method::Paper}) {
		Correction       correction(noisyTorus());
		DenoisingOptions options;
		options.method           = method;
		options.paper.iterations = 5;
		double last              = 0.0;
		denoise(
			correction.cloud,
			correction.counted(),
			options,
			Progress([&](double fraction, const char*) {
				EXPECT_GE(fraction, last - 1e-12);
				last = fraction;
				return true;
			}));
		EXPECT_DOUBLE_EQ(last, 1.0);
		EXPECT_THROW(
			denoise(
				correction.cloud,
				correction.counted(),
				options,
				Progress([](double fraction, const char*) { return fraction < 0.6; })),
			Cancelled);
	}
}

TEST(Denoising, NoPointsDoNotMove)
{
	const DenoisingResult result =
		denoise({Eigen::Matrix3Xd(3, 0), Eigen::Matrix3Xd(3, 0)}, NormalCorrection());
	EXPECT_EQ(result.positions.cols(), 0);
	EXPECT_EQ(result.maxMove, 0.0);
}

} // namespace
} // namespace curvature_lines::test
