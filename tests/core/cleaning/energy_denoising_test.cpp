// The denoising energy against its definition and finite differences, and the noise it removes.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "energy_denoising.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "robust_curvature.h"

namespace curvature_lines::test {
namespace {

using Eigen::Vector3d;
using Energy    = EnergyDenoisingOptions::Energy;
using Neighbors = EnergyDenoisingOptions::Neighbors;
using Optimizer = EnergyDenoisingOptions::Optimizer;

samples::SampleRequest requestOf(const std::string& surface, int points, double noise)
{
	samples::SampleRequest request;
	request.surface = surface;
	request.points  = points;
	request.noise   = noise;
	request.seed    = 3;
	return request;
}

PointCloud noisyCloud(const samples::SampleRequest& request)
{
	const samples::SampleCloud sample = samples::generate(request);
	return {sample.positions, sample.normals};
}

EnergyDenoisingResult denoised(const PointCloud& cloud, const EnergyDenoisingOptions& options = {})
{
	const NeighborSearch search(cloud.positions);
	return denoiseByEnergy(cloud, search, minimumNeighborhoods(cloud, search), options);
}

double rmsDistance(const std::string& surface, const Eigen::Matrix3Xd& positions)
{
	double sum = 0.0;
	for (Eigen::Index i = 0; i < positions.cols(); ++i)
		sum +=
			(positions.col(i) - samples::surface(surface).project(positions.col(i))).squaredNorm();
	return std::sqrt(sum / positions.cols());
}

double removedShare(
	const std::string& surface, const PointCloud& cloud, const EnergyDenoisingOptions& options = {})
{
	return 1.0 - rmsDistance(surface, denoised(cloud, options).positions) /
	                 rmsDistance(surface, cloud.positions);
}

// What a user without normals has: plane fits to 25 points, corrected by the robust estimate.
PointCloud withEstimatedNormals(PointCloud cloud)
{
	const NeighborSearch search(cloud.positions);
	for (Index i = 0; i < cloud.size(); ++i) {
		const std::vector<Index> near = search.nearest(cloud.positions.col(i), 25);
		Eigen::Matrix3Xd         local(3, near.size());
		for (std::size_t k = 0; k < near.size(); ++k)
			local.col(k) = cloud.positions.col(near[k]);
		local.colwise() -= local.rowwise().mean().eval();
		const Vector3d n = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(local * local.transpose())
		                       .eigenvectors()
		                       .col(0);
		cloud.normals.col(i) = n.dot(cloud.normals.col(i)) < 0.0 ? Vector3d(-n) : n;
	}
	cloud.normals = robustCurvature(cloud).correctedNormals;
	return cloud;
}

Eigen::VectorXd stacked(const Eigen::Matrix3Xd& positions)
{
	return Eigen::Map<const Eigen::VectorXd>(positions.data(), positions.size());
}

NeighborLists sixSectors(const PointCloud& cloud)
{
	return minimumNeighborhoods(cloud, NeighborSearch(cloud.positions)).neighbors;
}

TEST(DenoisingEnergy, IsTheSumOverTrianglesOfTheNeighbors)
{
	const PointCloud    cloud     = noisyCloud(requestOf("torus", 500, 0.005));
	const NeighborLists neighbors = sixSectors(cloud);
	for (const Energy kind : {Energy::SquareRoot, Energy::Squared}) {
		EnergyDenoisingOptions options;
		options.energy  = kind;
		double expected = 0.0;
		for (Index i = 0; i < cloud.size(); ++i)
			for (Index j = 0; j < neighbors[i].size(); ++j)
				for (Index k = j + 1; k < neighbors[i].size(); ++k) {
					const Vector3d p = cloud.positions.col(i), n = cloud.normals.col(i);
					const Vector3d a = cloud.positions.col(neighbors[i][j]) - p;
					const Vector3d b = cloud.positions.col(neighbors[i][k]) - p;
					const Vector3d c = a.cross(b);
					if (c.norm() <= 0.05 * a.norm() * b.norm())
						continue;
					const double e2 = std::min(
						(n - c.normalized()).squaredNorm(), (n + c.normalized()).squaredNorm());
					expected += kind == Energy::Squared ? e2 : std::pow(e2 + 0.01, 0.25);
				}
		DenoisingEnergy energy(cloud, neighbors, options);
		Eigen::VectorXd gradient;
		EXPECT_NEAR(energy(stacked(cloud.positions), gradient), expected, 1e-9 * expected);
	}
}

TEST(DenoisingEnergy, GradientMatchesFiniteDifferences)
{
	PointCloud          cloud     = noisyCloud(requestOf("ellipsoid", 200, 0.01));
	const NeighborLists neighbors = sixSectors(cloud);
	samples::Random     random(4, 1);
	for (const Energy kind : {Energy::SquareRoot, Energy::Squared})
		for (const double distance : {0.0, 0.05}) { // at the start and well away from it
			EnergyDenoisingOptions options;
			options.energy = kind;
			DenoisingEnergy energy(cloud, neighbors, options);
			Eigen::VectorXd x = stacked(cloud.positions), gradient, unused;
			for (double& value : x)
				value += distance * random.normal();
			energy(x, gradient);
			const double step = 1e-6;
			for (Eigen::Index i = 0; i < x.size(); i += 11) {
				Eigen::VectorXd shifted = x;
				shifted[i]              = x[i] + step;
				const double above      = energy(shifted, unused);
				shifted[i]              = x[i] - step;
				const double below      = energy(shifted, unused);
				EXPECT_NEAR(
					(above - below) / (2.0 * step),
					gradient[i],
					1e-6 * gradient.cwiseAbs().maxCoeff());
			}
		}
}

TEST(DenoisingEnergy, StaysFiniteWhereTrianglesCollapse)
{
	const PointCloud    cloud     = noisyCloud(requestOf("sphere", 100, 0.0));
	const NeighborLists neighbors = sixSectors(cloud);
	DenoisingEnergy     energy(cloud, neighbors, {});
	Eigen::VectorXd     x = stacked(cloud.positions), gradient;
	for (const Index j : neighbors[0])
		x.segment<3>(3 * j) = x.segment<3>(0);
	EXPECT_TRUE(std::isfinite(energy(x, gradient)));
	EXPECT_TRUE(gradient.allFinite());
	x.setZero();
	EXPECT_TRUE(std::isfinite(energy(x, gradient)));
	EXPECT_TRUE(gradient.allFinite());
}

TEST(DenoisingEnergy, HasNoUnitAndNoOrigin)
{
	PointCloud          cloud     = noisyCloud(requestOf("torus", 500, 0.01));
	const NeighborLists neighbors = sixSectors(cloud);
	Eigen::VectorXd     gradient, moved;
	const double energy = DenoisingEnergy(cloud, neighbors, {})(stacked(cloud.positions), gradient);
	const Eigen::Matrix3d rotation =
		Eigen::AngleAxisd(1.3, Vector3d(1.0, -1.0, 3.0).normalized()).toRotationMatrix();
	cloud.positions = (50.0 * rotation * cloud.positions).colwise() + Vector3d(3.0, 1.0, -7.0);
	cloud.normals   = rotation * cloud.normals;
	EXPECT_NEAR(
		DenoisingEnergy(cloud, neighbors, {})(stacked(cloud.positions), moved),
		energy,
		1e-8 * energy);
	EXPECT_NEAR(gradient.norm() / 50.0, moved.norm(), 1e-6 * moved.norm());
}

TEST(Denoising, RemovesThePublishedShareOnTheRegularTorus)
{
	samples::SampleRequest request = requestOf("torus", 1575, 0.01);
	request.regular                = true;
	const PointCloud cloud         = withEstimatedNormals(noisyCloud(request));
	for (const Neighbors neighbors : {Neighbors::SixSectors, Neighbors::Nearest}) {
		EnergyDenoisingOptions options;
		options.neighbors = neighbors;
		EXPECT_GT(removedShare("torus", cloud, options), 0.60);
	}
	EnergyDenoisingOptions squared;
	squared.energy = Energy::Squared;
	EXPECT_GT(removedShare("torus", cloud, squared), 0.65);
	EnergyDenoisingOptions conjugate;
	conjugate.optimizer = Optimizer::PolakRibiere;
	EXPECT_GT(removedShare("torus", cloud, conjugate), 0.50);
}

TEST(Denoising, RemovesNoiseFromIrregularSamples)
{
	for (const double noise : {0.005, 0.01}) {
		const PointCloud cloud = withEstimatedNormals(noisyCloud(requestOf("torus", 1600, noise)));
		EnergyDenoisingOptions squared;
		squared.energy = Energy::Squared;
		EXPECT_GT(removedShare("torus", cloud), 0.50) << noise;
		EXPECT_GT(removedShare("torus", cloud, squared), 0.60) << noise;
	}
}

TEST(Denoising, KeepsSharpEdgesGivenTheirNormals)
{
	const PointCloud cloud = noisyCloud(requestOf("cube", 1500, 0.005));
	const auto       after = denoised(cloud).positions;
	EXPECT_LT(rmsDistance("cube", after), 0.5 * rmsDistance("cube", cloud.positions));
	const auto& cube    = samples::surface("cube");
	double      before2 = 0.0, after2 = 0.0;
	for (Index i = 0; i < cloud.size(); ++i) {
		if (cube.featureDistance(cube.project(cloud.positions.col(i))) > 0.04) // about a spacing
			continue;
		before2 += (cloud.positions.col(i) - cube.project(cloud.positions.col(i))).squaredNorm();
		after2 += (after.col(i) - cube.project(after.col(i))).squaredNorm();
	}
	EXPECT_LT(std::sqrt(after2 / before2), 0.8);
}

TEST(Denoising, HardlyMovesACleanCloud)
{
	const PointCloud     cloud = noisyCloud(requestOf("torus", 2000, 0.0));
	const NeighborSearch search(cloud.positions);
	const double         h = minimumNeighborhoods(cloud, search).medianSpacing;
	EXPECT_LT(rmsDistance("torus", denoised(cloud).positions), 0.06 * h);
}

TEST(Denoising, LowersTheEnergyWithinTheTrustBox)
{
	const PointCloud     cloud = noisyCloud(requestOf("torus", 1000, 0.02));
	const NeighborSearch search(cloud.positions);
	const auto           minimum = minimumNeighborhoods(cloud, search);
	for (const Optimizer optimizer : {Optimizer::LBFGSB, Optimizer::PolakRibiere}) {
		EnergyDenoisingOptions options;
		options.optimizer   = optimizer;
		options.iterations  = 30;
		options.maxMove     = 0.2; // tight, so that it is reached
		const auto   result = denoiseByEnergy(cloud, search, minimum, options);
		const double move   = (result.positions - cloud.positions).cwiseAbs().maxCoeff();
		EXPECT_LE(move, 0.2 * minimum.medianSpacing * (1.0 + 1e-9));
		EXPECT_GE(move, 0.2 * minimum.medianSpacing * (1.0 - 1e-6));
		EXPECT_LT(result.finalEnergy, 0.9 * result.initialEnergy);
		EXPECT_LE(result.iterations, 30);
		EXPECT_GT(result.iterations, 5);
	}
}

TEST(Denoising, WithoutIterationsReturnsTheInput)
{
	const PointCloud cloud = noisyCloud(requestOf("torus", 500, 0.01));
	for (const Optimizer optimizer : {Optimizer::LBFGSB, Optimizer::PolakRibiere}) {
		EnergyDenoisingOptions options;
		options.optimizer  = optimizer;
		options.iterations = 0;
		const auto result  = denoised(cloud, options);
		EXPECT_LT((result.positions - cloud.positions).cwiseAbs().maxCoeff(), 1e-14);
		EXPECT_EQ(result.iterations, 0);
		EXPECT_EQ(result.finalEnergy, result.initialEnergy);
	}
}

TEST(Denoising, SameResultForAnyNumberOfThreads)
{
	const PointCloud cloud = noisyCloud(requestOf("torus", 10000, 0.003)); // enough to go parallel
	EnergyDenoisingOptions options;
	options.iterations = 10;
	const int threads  = omp_get_max_threads();
	omp_set_num_threads(1);
	const auto one = denoised(cloud, options);
	omp_set_num_threads(2);
	const auto two = denoised(cloud, options);
	omp_set_num_threads(threads);
	EXPECT_EQ(one.positions, two.positions);
	EXPECT_EQ(one.finalEnergy, two.finalEnergy);
}

TEST(Denoising, ReportsAndCanBeCancelled)
{
	const PointCloud     cloud = noisyCloud(requestOf("torus", 500, 0.01));
	const NeighborSearch search(cloud.positions);
	const auto           minimum = minimumNeighborhoods(cloud, search);
	for (const Optimizer optimizer : {Optimizer::LBFGSB, Optimizer::PolakRibiere}) {
		EnergyDenoisingOptions options;
		options.optimizer      = optimizer;
		options.iterations     = 30;
		double         last    = 0.0;
		int            reports = 0;
		const Progress watch([&](double fraction, const char*) {
			EXPECT_GE(fraction, last);
			EXPECT_LE(fraction, 1.0);
			last = fraction;
			++reports;
			return true;
		});
		denoiseByEnergy(cloud, search, minimum, options, watch);
		EXPECT_GT(reports, 20);
		const Progress cancel([](double fraction, const char*) { return fraction < 0.3; });
		EXPECT_THROW(denoiseByEnergy(cloud, search, minimum, options, cancel), Cancelled);
	}
}

TEST(Denoising, SurvivesDegenerateClouds)
{
	PointCloud line, plane, plate;
	line.positions = Eigen::Matrix3Xd::Zero(3, 20);
	line.positions.row(0).setLinSpaced(20, -0.5, 0.5);
	line.normals = Vector3d::UnitZ().replicate(1, 20);
	plane        = noisyCloud(requestOf("plane", 20, 0.0));
	plate.positions.resize(3, 400);
	plate.normals.resize(3, 400);
	const PointCloud side = noisyCloud(requestOf("plane", 200, 0.002));
	plate.positions << side.positions, side.positions.colwise() + Vector3d(0.0, 0.0, -0.001);
	plate.normals << side.normals, -side.normals;
	for (const PointCloud& cloud : {line, plane, plate})
		for (const Neighbors neighbors : {Neighbors::SixSectors, Neighbors::Nearest})
			for (const Optimizer optimizer : {Optimizer::LBFGSB, Optimizer::PolakRibiere}) {
				EnergyDenoisingOptions options;
				options.neighbors  = neighbors;
				options.optimizer  = optimizer;
				options.iterations = 20;
				const auto result  = denoised(cloud, options);
				EXPECT_TRUE(result.positions.allFinite());
				EXPECT_LE(result.finalEnergy, result.initialEnergy);
			}
}

} // namespace
} // namespace curvature_lines::test
