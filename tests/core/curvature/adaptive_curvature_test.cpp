// Curvature at the scale found from the cloud: exact surfaces with and without noise, wrong normals, outliers,
// the invariances that follow from the geometry, and degenerate clouds.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "curvature_estimate.h"
#include "estimated_field.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "umbilics.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

samples::SampleRequest request(const std::string& surface, int points, double noise = 0.0)
{
	samples::SampleRequest result;
	result.surface = surface;
	result.points  = points;
	result.noise   = noise;
	result.seed    = 1;
	return result;
}

// Normals as of a scan: those of plane fits to 16 points, with the right sign.
EstimatedField estimateScan(const samples::SampleCloud& sample)
{
	return estimateAdaptiveField(sample.positions, planeFitNormals(sample, 16));
}

struct Errors {
	double mean      = 0.0; // RMS of H - H_true, relative to the RMS of H_true
	double direction = 0.0; // mean angle of d1, radians
	double pull      = 0.0; // RMS of the error of k1 - k2 in standard errors
};

// Over the points `counts` names, all by default.
template<class Predicate>
Errors
errorsOf(const EstimatedField& estimated, const samples::SampleCloud& sample, Predicate counts)
{
	Errors errors;
	double squares = 0.0, points = 0.0;
	for (Index i = 0; i < estimated.field.size(); ++i) {
		const Index s = estimated.prepared.source[i];
		if (!counts(s))
			continue;
		const double k1 = estimated.k1(i), k2 = estimated.k2(i);
		errors.mean += std::pow(k1 + k2 - sample.k1[s] - sample.k2[s], 2);
		squares += std::pow(sample.k1[s] + sample.k2[s], 2);
		errors.direction +=
			std::acos(std::min(1.0, std::abs(estimated.field.d1.col(i).dot(sample.d1.col(s)))));
		errors.pull += std::pow(
			(k1 - k2 - sample.k1[s] + sample.k2[s]) /
				(estimated.field.error[i] / estimated.prepared.diagonal + 1e-300),
			2);
		points += 1.0;
	}
	errors.mean = std::sqrt(errors.mean / squares);
	errors.direction /= points;
	errors.pull = std::sqrt(errors.pull / points);
	return errors;
}

Errors errorsOf(const EstimatedField& estimated, const samples::SampleCloud& sample)
{
	return errorsOf(estimated, sample, [](Index) { return true; });
}

double median(std::vector<double> values)
{
	std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
	return values[values.size() / 2];
}

double medianRadius(const EstimatedField& estimated)
{
	const Eigen::VectorXd& radius = estimated.field.radius;
	return median({radius.data(), radius.data() + radius.size()});
}

// What every field promises.
void expectSound(const CurvatureField& f)
{
	for (const Eigen::VectorXd* values :
	     {&f.k1, &f.k2, &f.error, &f.radius, &f.confidence, &f.feature})
		ASSERT_TRUE(values->allFinite() && values->size() == f.size());
	ASSERT_TRUE(f.d1.allFinite() && f.d2.allFinite() && f.correctedNormals.allFinite());
	if (f.size() == 0)
		return;
	EXPECT_GE((f.k1 - f.k2).minCoeff(), 0.0);
	for (const Eigen::VectorXd* values : {&f.error, &f.radius, &f.confidence, &f.feature})
		EXPECT_GE(values->minCoeff(), 0.0);
	EXPECT_LE(f.feature.maxCoeff(), 1.0);
	ASSERT_EQ(static_cast<Index>(f.status.size()), f.size());
	ASSERT_EQ(f.weights.neighbors.size(), f.size());
	ASSERT_EQ(f.weights.values.size(), f.weights.neighbors.indices.size());
	for (Index i = 0; i < f.size(); ++i) {
		EXPECT_NEAR(f.d1.col(i).norm(), 1.0, 1e-9);
		EXPECT_NEAR(f.d2.col(i).norm(), 1.0, 1e-9);
		EXPECT_NEAR(f.d1.col(i).dot(f.d2.col(i)), 0.0, 1e-9);
		EXPECT_NEAR(f.correctedNormals.col(i).norm(), 1.0, 1e-9);
		for (const Index j : f.weights.neighbors[i])
			EXPECT_TRUE(j != i && f.weights(i, j) > 0.0 && f.weights(i, j) <= 1.0);
	}
}

TEST(AdaptiveCurvature, CleanTorus)
{
	const auto   sample    = samples::generate(request("torus", 5000));
	const auto   estimated = estimateScan(sample);
	const Errors errors    = errorsOf(estimated, sample);
	expectSound(estimated.field);
	EXPECT_LT(errors.mean, 0.005);
	EXPECT_LT(errors.direction, 0.005);
}

TEST(AdaptiveCurvature, NoisyTorus)
{
	const auto   sample    = samples::generate(request("torus", 5000, 0.005));
	const auto   estimated = estimateScan(sample);
	const Errors errors    = errorsOf(estimated, sample);
	expectSound(estimated.field);
	EXPECT_LT(errors.mean, 0.07);
	EXPECT_LT(errors.direction, 0.03);
	EXPECT_GT(errors.pull, 0.3); // the standard error tells the size of the error
	EXPECT_LT(errors.pull, 3.0);
	// The surface is where the truth is, not where the noise is.
	const CurvatureErrors angles = curvatureErrors(estimated, sample);
	EXPECT_LT(angles.normalAfter, 3.0);
	EXPECT_LT(angles.normalAfter, 0.3 * angles.normalBefore);
	const UmbilicRegions umbilics =
		findUmbilics(estimated.prepared.cloud, estimated.field, estimated.minimum);
	EXPECT_EQ(std::count(umbilics.umbilic.begin(), umbilics.umbilic.end(), 1), 0);
}

TEST(AdaptiveCurvature, NoisySphereIsUmbilic)
{
	const auto sample    = samples::generate(request("sphere", 3000, 0.005));
	const auto estimated = estimateScan(sample);
	EXPECT_LT(errorsOf(estimated, sample).mean, 0.03);
	const UmbilicRegions umbilics =
		findUmbilics(estimated.prepared.cloud, estimated.field, estimated.minimum);
	EXPECT_GT(std::count(umbilics.umbilic.begin(), umbilics.umbilic.end(), 1), 2990);
}

TEST(AdaptiveCurvature, CylinderAwayFromItsRims)
{
	const auto  sample    = samples::generate(request("cylinder", 3000, 0.0025));
	const auto& surface   = samples::surface("cylinder");
	const auto  estimated = estimateScan(sample);
	const auto inner = [&](Index s) { return surface.rimDistance(sample.footPoints.col(s)) > 0.2; };
	const Errors errors = errorsOf(estimated, sample, inner);
	expectSound(estimated.field);
	EXPECT_LT(errors.mean, 0.04);
	EXPECT_LT(errors.direction, 0.02);
}

TEST(AdaptiveCurvature, SaddleHasCurvaturesOfBothSigns)
{
	samples::Random random(2, 0);
	Matrix3Xd       positions(3, 2000), normals(3, 2000);
	const double    a = 0.4; // z = a (x^2 - y^2): -2 a along x, +2 a along y at the origin
	for (int i = 0; i < 2000; ++i) {
		const double x = random.uniform(-1.0, 1.0), y = random.uniform(-1.0, 1.0);
		positions.col(i) = Vector3d(x, y, a * (x * x - y * y));
		normals.col(i)   = Vector3d(-2 * a * x, 2 * a * y, 1.0).normalized();
	}
	const auto estimated = estimateAdaptiveField(positions, normals);
	Index      seen      = 0;
	for (Index i = 0; i < estimated.field.size(); ++i) {
		if (positions.col(i).norm() > 0.15)
			continue;
		++seen;
		EXPECT_NEAR(estimated.k1(i), 2.0 * a, 0.06);
		EXPECT_NEAR(estimated.k2(i), -2.0 * a, 0.06);
		EXPECT_GT(std::abs(estimated.field.d1.col(i).y()), 0.99);
	}
	EXPECT_GT(seen, 20);
}

TEST(AdaptiveCurvature, PlaneIsFlat)
{
	const auto sample    = samples::generate(request("plane", 1000));
	const auto estimated = estimateAdaptiveField(sample.positions, sample.normals);
	expectSound(estimated.field);
	EXPECT_LT(estimated.field.k1.cwiseAbs().maxCoeff(), 1e-6);
	EXPECT_LT(estimated.field.k2.cwiseAbs().maxCoeff(), 1e-6);
}

TEST(AdaptiveCurvature, WrongNormalsDoNotMatter)
{
	const auto      sample  = samples::generate(request("torus", 2000));
	Matrix3Xd       normals = sample.normals;
	samples::Random random(5, 0);
	for (Eigen::Index i = 0; i < normals.cols(); ++i)
		if (random.uniform() < 0.3)
			normals.col(i) = random.normal3().normalized();
	const auto estimated = estimateAdaptiveField(sample.positions, normals);
	const auto errors    = curvatureErrors(estimated, sample);
	EXPECT_LT(errors.k1, 0.05);
	EXPECT_GT(errors.normalBefore, 40.0);
	EXPECT_LT(errors.normalAfter, 1.0);
}

TEST(AdaptiveCurvature, FarOutliersDoNotReachTheInliers)
{
	auto dirty           = request("torus", 3000, 0.0025);
	dirty.farOutliers    = 0.05;
	const auto sample    = samples::generate(dirty);
	const auto estimated = estimateScan(sample);
	expectSound(estimated.field);
	const auto inlier = [&](Index s) { return sample.label[s] == samples::Inlier; };
	EXPECT_LT(errorsOf(estimated, sample, inlier).mean, 0.06);
}

// Two tori of size 1 and 1/5 beside each other, as many points and the same noise on both: neither is
// estimated at the scale of the other.
TEST(AdaptiveCurvature, PartsOfDifferentSizeHaveTheirOwnScale)
{
	const int       points = 2500;
	const auto      large  = samples::generate(request("torus", points));
	const double    size   = 0.2;
	samples::Random random(1, 0);
	Matrix3Xd       positions(3, 2 * points), normals(3, 2 * points);
	positions << large.positions, (size * large.positions).colwise() + Vector3d(2, 0, 0);
	normals << large.normals, large.normals;
	for (Eigen::Index i = 0; i < positions.cols(); ++i)
		positions.col(i) += 0.005 * random.normal3();
	const auto estimated = estimateAdaptiveField(positions, normals);
	double     errors[2] = {}, squares[2] = {};
	for (Index i = 0; i < estimated.field.size(); ++i) {
		const Index  s    = estimated.prepared.source[i];
		const int    part = s < points ? 0 : 1;
		const double truth =
			(large.k1[s % points] + large.k2[s % points]) / (part == 0 ? 1.0 : size);
		errors[part] += std::pow(estimated.k1(i) + estimated.k2(i) - truth, 2);
		squares[part] += truth * truth;
	}
	EXPECT_LT(std::sqrt(errors[0] / squares[0]), 0.08);
	EXPECT_LT(std::sqrt(errors[1] / squares[1]), 0.12);
}

TEST(AdaptiveCurvature, RegionsGrowWithTheNoise)
{
	const auto clean = estimateScan(samples::generate(request("torus", 2000, 0.0)));
	const auto noisy = estimateScan(samples::generate(request("torus", 2000, 0.01)));
	EXPECT_GT(medianRadius(noisy), 1.3 * medianRadius(clean));
}

// Directions are tangent to the given normal where it is right, and to the surface where it is not.
TEST(AdaptiveCurvature, DirectionsAreTangentToTheSurface)
{
	const auto sample  = samples::generate(request("torus", 1500));
	Matrix3Xd  normals = sample.normals;
	for (Eigen::Index i = 0; i < normals.cols(); i += 2)
		normals.col(i) = (normals.col(i) + 0.3 * sample.d1.col(i)).normalized();
	const auto            estimated = estimateAdaptiveField(sample.positions, normals);
	const CurvatureField& f         = estimated.field;
	const Matrix3Xd       tangentTo = surfaceNormals(f);
	Index                 right     = 0;
	for (Index i = 0; i < f.size(); ++i) {
		const Vector3d given  = estimated.prepared.cloud.normals.col(i),
					   fitted = f.correctedNormals.col(i);
		const bool same       = given.dot(fitted) > std::cos(0.9 * EIGEN_PI / 180.0);
		if (i % 2 == 0 || same) {
			EXPECT_LT((tangentTo.col(i) - (i % 2 == 0 ? fitted : given)).norm(), 1e-9);
		}
		right += same;
	}
	EXPECT_GT(right, 0.45 * f.size());
	CurvatureField tilted = f;
	makeTangent(f.correctedNormals, tilted);
	EXPECT_LT((surfaceNormals(tilted) - f.correctedNormals).norm(), 1e-9);
}

class AdaptiveInvariance : public ::testing::Test {
protected:
	static const samples::SampleCloud& sample()
	{
		static const auto result = samples::generate(request("torus", 1000, 0.004));
		return result;
	}
	static const Matrix3Xd& normals()
	{
		static const Matrix3Xd result = planeFitNormals(sample(), 16);
		return result;
	}
	static const EstimatedField& base()
	{
		static const EstimatedField result = estimateAdaptiveField(sample().positions, normals());
		return result;
	}
	static void expectNear(const Eigen::VectorXd& a, const Eigen::VectorXd& b, double tolerance)
	{
		EXPECT_LE((a - b).cwiseAbs().maxCoeff(), tolerance * a.cwiseAbs().maxCoeff());
	}
};

TEST_F(AdaptiveInvariance, Scaling)
{
	// Both are in the unit frame: curvatures in model units go with 1 / factor. A power of two changes no
	// bit; another factor rounds, which may tip whether a sample counts as an outlier of its fit.
	for (const auto& [factor, tolerance] : {std::pair(1024.0, 0.0), std::pair(1000.0, 1e-4)}) {
		const auto scaled = estimateAdaptiveField(factor * sample().positions, normals());
		EXPECT_NEAR(scaled.prepared.diagonal, factor * base().prepared.diagonal, 1e-6);
		expectNear(base().field.k1, scaled.field.k1, tolerance);
		expectNear(base().field.k2, scaled.field.k2, tolerance);
		expectNear(base().field.error, scaled.field.error, tolerance);
		expectNear(base().field.radius, scaled.field.radius, tolerance);
	}
}

TEST_F(AdaptiveInvariance, RigidMotion)
{
	const Eigen::Matrix3d turn =
		Eigen::AngleAxisd(1.1, Vector3d(0.4, -0.8, 0.3).normalized()).toRotationMatrix();
	const Matrix3Xd moved     = (turn * sample().positions).colwise() + Vector3d(3, -5, 8);
	const auto      estimated = estimateAdaptiveField(moved, turn * normals());
	// The unit frame is that of the bounding box, and so is the largest scale considered.
	const Errors here       = errorsOf(base(), sample());
	double       difference = 0.0, angle = 0.0;
	for (Index i = 0; i < base().field.size(); ++i) {
		difference += std::pow(base().k1(i) + base().k2(i) - estimated.k1(i) - estimated.k2(i), 2);
		angle += std::acos(
			std::min(
				1.0, std::abs((turn * base().field.d1.col(i)).dot(estimated.field.d1.col(i)))));
	}
	const double size = (sample().k1 + sample().k2).norm();
	EXPECT_LT(std::sqrt(difference) / size, 0.5 * here.mean);
	EXPECT_LT(angle / base().field.size(), 0.5 * here.direction);
}

TEST_F(AdaptiveInvariance, FlippedNormals)
{
	const auto flipped = estimateAdaptiveField(sample().positions, -normals());
	// Iterations start from other frames, so they agree to what iterations do, not to rounding.
	expectNear(base().field.k1, -flipped.field.k2, 2e-3);
	expectNear(base().field.k2, -flipped.field.k1, 2e-3);
	expectNear(base().field.error, flipped.field.error, 5e-3);
	EXPECT_LT(
		(base().field.correctedNormals + flipped.field.correctedNormals).cwiseAbs().maxCoeff(),
		2e-3);
}

TEST_F(AdaptiveInvariance, OrderOfPoints)
{
	const Index        n = base().field.size();
	std::vector<Index> order(n);
	std::iota(order.begin(), order.end(), 0);
	std::shuffle(order.begin(), order.end(), std::mt19937(3));
	Matrix3Xd positions(3, n), turned(3, n);
	for (Index k = 0; k < n; ++k) {
		positions.col(k) = sample().positions.col(order[k]);
		turned.col(k)    = normals().col(order[k]);
	}
	const auto permuted = estimateAdaptiveField(positions, turned);
	for (Index k = 0; k < n; ++k) {
		const Index i = order[k];
		EXPECT_EQ(base().field.k1[i], permuted.field.k1[k]);
		EXPECT_EQ(base().field.k2[i], permuted.field.k2[k]);
		EXPECT_EQ(base().field.d1.col(i), permuted.field.d1.col(k));
		EXPECT_EQ(base().field.error[i], permuted.field.error[k]);
		EXPECT_EQ(base().field.radius[i], permuted.field.radius[k]);
		EXPECT_EQ(base().field.feature[i], permuted.field.feature[k]);
		EXPECT_NEAR(base().field.confidence[i], permuted.field.confidence[k], 1e-9);
	}
}

TEST_F(AdaptiveInvariance, NumberOfThreads)
{
	const int threads = omp_get_max_threads();
	omp_set_num_threads(1);
	const auto one = estimateAdaptiveField(sample().positions, normals());
	omp_set_num_threads(2);
	const auto two = estimateAdaptiveField(sample().positions, normals());
	omp_set_num_threads(threads);
	EXPECT_EQ(one.field.k1, two.field.k1);
	EXPECT_EQ(one.field.k2, two.field.k2);
	EXPECT_EQ(one.field.d1, two.field.d1);
	EXPECT_EQ(one.field.error, two.field.error);
	EXPECT_EQ(one.field.feature, two.field.feature);
	EXPECT_EQ(one.field.confidence, two.field.confidence);
	EXPECT_EQ(one.field.correctedNormals, two.field.correctedNormals);
	EXPECT_EQ(one.field.weights.values, two.field.weights.values);
}

void expectSoundOn(const PointCloud& cloud)
{
	const NeighborSearch       search(cloud.positions);
	const MinimumNeighborhoods minimum = minimumNeighborhoods(cloud, search);
	expectSound(estimateCurvature(cloud));
}

TEST(AdaptiveCurvature, DegenerateClouds)
{
	PointCloud cloud; // nothing, one point, two, and a line
	for (const Index n : {0, 1, 2, 30}) {
		SCOPED_TRACE(n);
		cloud.positions.setZero(3, n);
		if (n > 0)
			cloud.positions.row(0).setLinSpaced(0.0, n > 1 ? 1.0 : 0.0);
		cloud.normals.setZero(3, n);
		cloud.normals.row(2).setConstant(-1.0);
		expectSoundOn(cloud);
	}
	cloud.positions.row(1) =
		1e-7 * Eigen::VectorXd::LinSpaced(30, -1.0, 1.0).array().sin().matrix();
	expectSoundOn(cloud);           // almost a line
	cloud.positions.setZero(3, 60); // duplicates that preparation would have merged
	cloud.normals.setZero(3, 60);
	cloud.normals.row(0).setOnes();
	expectSoundOn(cloud);

	// coplanar, then with normals in the plane
	const auto sheet = samples::generate(request("plane", 20));
	cloud            = prepareCloud(sheet.positions, sheet.normals).cloud;
	expectSoundOn(cloud);
	cloud.normals.setZero();
	cloud.normals.row(1).setOnes();
	expectSoundOn(cloud);

	const auto two = samples::generate(request("plane", 300)); // two sheets that touch
	cloud.positions.resize(3, 600);
	cloud.normals.resize(3, 600);
	cloud.positions << two.positions, two.positions.colwise() + Vector3d(1e-9, 0, 0);
	cloud.normals << two.normals, -two.normals;
	expectSoundOn(cloud);

	cloud = prepareCloud(two.positions, two.normals).cloud; // one point far from all others
	cloud.positions.col(0) = Vector3d(0, 0, 3);
	expectSoundOn(cloud);
}

TEST(AdaptiveCurvature, TinyClouds)
{
	for (const char* name : {"sphere", "torus", "cube"})
		for (const int points : {20, 21, 30, 45, 60}) {
			SCOPED_TRACE(name + std::to_string(points));
			const auto sample = samples::generate(request(name, points, 0.01));
			expectSoundOn(prepareCloud(sample.positions, sample.normals).cloud);
		}
}

TEST(AdaptiveCurvature, CanBeCancelled)
{
	const auto                 sample = samples::generate(request("torus", 1000));
	const PointCloud           cloud  = prepareCloud(sample.positions, sample.normals).cloud;
	const NeighborSearch       search(cloud.positions);
	const MinimumNeighborhoods minimum = minimumNeighborhoods(cloud, search);
	double                     last    = 0.0;
	const Progress             watch([&](double fraction, const char*) {
        EXPECT_GE(fraction, last - 1e-12);
        last = fraction;
        return true;
    });
	estimateCurvature(cloud, {}, watch);
	EXPECT_DOUBLE_EQ(last, 1.0);
	const Progress cancel([](double fraction, const char*) { return fraction < 0.4; });
	EXPECT_THROW(estimateCurvature(cloud, {}, cancel), Cancelled);
}

} // namespace
} // namespace curvature_lines::test
