// Both ways of denoising, and what each asks for.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <functional>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "denoising.h"
#include "energy_denoising.h"
#include "point_cloud.h"
#include "progress.h"
#include "robust_denoising.h"

namespace curvature_lines::test {
namespace {

PointCloud noisyTorus()
{
	samples::SampleRequest request;
	request.points                    = 800;
	request.noise                     = 0.005;
	request.seed                      = 3;
	const samples::SampleCloud sample = samples::generate(request);
	return prepareCloud(sample.positions, sample.normals).cloud;
}

void expectMoves(const PointCloud& cloud, const DenoisingResult& result)
{
	const Eigen::VectorXd moves = (result.positions - cloud.positions).colwise().norm();
	EXPECT_GT(result.rmsMove, 0.0);
	EXPECT_NEAR(result.rmsMove * result.rmsMove, moves.array().square().mean(), 1e-15);
	EXPECT_DOUBLE_EQ(result.maxMove, moves.maxCoeff());
}

TEST(Denoising, ProjectionIsTheRobustMethodAndMeasuresItsMoves)
{
	const PointCloud            cloud  = noisyTorus();
	const DenoisingResult       result = denoiseByProjection(cloud);
	const RobustDenoisingResult direct = denoiseRobustly(cloud);
	EXPECT_EQ(result.positions, direct.positions);
	EXPECT_EQ(result.normals, direct.normals);
	EXPECT_EQ(result.pointDeviation, direct.pointDeviation);
	EXPECT_EQ(result.radius, direct.radius);
	EXPECT_EQ(result.iterations, 0);
	expectMoves(cloud, result);
}

TEST(Denoising, PublishedMethodMovesByTheNormalsItIsGiven)
{
	const PointCloud       cloud = noisyTorus();
	EnergyDenoisingOptions options;
	options.iterations                 = 5;
	PointCloud wrong                   = cloud;
	wrong.normals                      = -wrong.normals;
	const CloudIndex            index  = CloudIndex(cloud).withNormals(wrong.normals);
	const DenoisingResult       result = denoiseAsPublished(index, cloud.normals, options);
	const CloudIndex            right(cloud);
	const EnergyDenoisingResult direct =
		denoiseByEnergy(cloud, right.search(), right.minimum(), options);
	EXPECT_EQ(result.positions, direct.positions);
	EXPECT_EQ(result.normals, cloud.normals);
	EXPECT_EQ(result.iterations, direct.iterations);
	EXPECT_LT(result.finalEnergy, result.initialEnergy);
	EXPECT_EQ(result.pointDeviation, 0.0);
	expectMoves(wrong, result);
}

TEST(Denoising, ProgressReachesTheEndWithEither)
{
	const PointCloud       cloud = noisyTorus();
	EnergyDenoisingOptions published;
	published.iterations                                 = 5;
	const std::function<void(const Progress&)> methods[] = {
		[&](const Progress& progress) { denoiseByProjection(cloud, {}, progress); },
		[&](const Progress& progress) {
			denoiseAsPublished(cloud, cloud.normals, published, progress);
		}};
	for (const auto& method : methods) {
		double last = 0.0;
		method(Progress([&](double fraction, const char*) {
			EXPECT_GE(fraction, last - 1e-12);
			last = fraction;
			return true;
		}));
		EXPECT_DOUBLE_EQ(last, 1.0);
		EXPECT_THROW(
			method(Progress([](double fraction, const char*) { return fraction < 0.6; })),
			Cancelled);
	}
}

TEST(Denoising, NoiseIsTakenToTheUnitFrame)
{
	PreparedCloud prepared;
	prepared.diagonal = 8.0;
	RobustDenoisingOptions options;
	options.noise     = 2.0;
	options.radius    = 3.0; // in spacings: the same in every frame
	const auto inUnit = inUnitFrame(options, prepared);
	EXPECT_EQ(inUnit.noise, 0.25);
	EXPECT_EQ(inUnit.radius, 3.0);
	EXPECT_EQ(inUnit.sharpness, options.sharpness);
	options.noise = 0.0; // automatic
	EXPECT_EQ(inUnitFrame(options, prepared).noise, 0.0);
}

TEST(Denoising, NoiseOfMoreThanHalfTheDiagonalIsRefused)
{
	PreparedCloud prepared;
	prepared.diagonal = 8.0;
	RobustDenoisingOptions options;
	options.noise = 4.0;
	EXPECT_EQ(inUnitFrame(options, prepared).noise, 0.5);
	options.noise = 4.001;
	try {
		inUnitFrame(options, prepared);
		FAIL();
	}
	catch (const InputError& error) {
		EXPECT_STREQ(error.what(), "parameter 'noise' is more than half the cloud's diagonal (8).");
	}
}

TEST(Denoising, NoPointsDoNotMove)
{
	const PointCloud none{Eigen::Matrix3Xd(3, 0), Eigen::Matrix3Xd(3, 0)};
	for (const DenoisingResult& result :
	     {denoiseByProjection(none), denoiseAsPublished(none, none.normals)}) {
		EXPECT_EQ(result.positions.cols(), 0);
		EXPECT_EQ(result.maxMove, 0.0);
	}
}

} // namespace
} // namespace curvature_lines::test
