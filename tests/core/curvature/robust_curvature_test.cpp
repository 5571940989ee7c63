// Robust curvature: the M-estimator against its formulas, exact surfaces, noise, bad normals, creases,
// degenerate input, and the invariances that follow from the geometry.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "curvature_field.h"
#include "estimated_field.h"
#include "irls.h"
#include "neighborhoods.h"
#include "operating_region.h"
#include "point_cloud.h"
#include "robust_curvature.h"
#include "robust_kernel.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;

samples::SampleCloud
sampled(const std::string& surface, int points = 2000, double noise = 0.0, int seed = 1)
{
	samples::SampleRequest request;
	request.surface = surface;
	request.points  = points;
	request.noise   = noise;
	request.seed    = seed;
	return samples::generate(request);
}

VariationSamples randomSamples(const VariationModel& truth, Index count, double noise, int seed)
{
	samples::Random  random(seed, 0);
	VariationSamples samples;
	for (Index s = 0; s < count; ++s) {
		const Vector2d dp(random.uniform(-1, 1), random.uniform(-1, 1));
		const Vector3d dn = s % 5 == 0 ? random.normal3() : truth * dp + noise * random.normal3();
		samples.add(s, s + 1, dp, dn, random.uniform(0.1, 3.0));
	}
	return samples;
}

VariationModel someModel()
{
	VariationModel model;
	model << 0.8, -0.3, 0.1, 0.5, 0.02, -0.01;
	return model;
}

TEST(GemanMcClure, PublishedFormulas)
{
	for (const double t : {0.0, 0.3, 1.0, 1.9, 2.0, 7.0}) {
		EXPECT_NEAR(gemanMcClureCost(t), t * t / (1 + t * t), 1e-15);
		EXPECT_NEAR(gemanMcClureWeight(t), 2.0 / std::pow(1 + t * t, 2), 1e-15);
		// w(t) = rho'(t) / t
		const double h = 1e-5;
		if (t > 0.0) {
			const double slope = (gemanMcClureCost(t + h) - gemanMcClureCost(t - h)) / (2 * h);
			EXPECT_NEAR(gemanMcClureWeight(t), slope / t, 1e-8);
		}
	}
}

TEST(Irls, ScaleAndWeightsAreThoseOfTheFormulas)
{
	for (const Index count : {40, 41}) {
		const VariationSamples samples = randomSamples(someModel(), count, 0.05, 7);
		IrlsSolver             solver;
		const IrlsFit          fit = solver.fit(samples, VariationModel::Zero(), {});
		std::vector<double>    residuals, sorted;
		for (Index s = 0; s < count; ++s)
			residuals.push_back((fit.model * Vector2d(samples.pu[s], samples.pv[s]) -
			                     Vector3d(samples.nu[s], samples.nv[s], samples.nw[s]))
			                        .norm());
		sorted = residuals;
		std::sort(sorted.begin(), sorted.end());
		const double sigma = 1.4826 * 0.5 * (sorted[(count - 1) / 2] + sorted[count / 2]);
		EXPECT_NEAR(fit.sigma, sigma, 1e-12);
		Index cut = 0;
		for (Index s = 0; s < count; ++s) {
			const double t = residuals[s] / sigma;
			EXPECT_NEAR(fit.weights[s], t < 2.0 ? gemanMcClureWeight(t) : 0.0, 1e-12);
			cut += fit.weights[s] == 0.0;
		}
		EXPECT_GE(cut, 5); // the gross errors
	}
}

TEST(Irls, IsAFixedPointAndIgnoresGrossErrors)
{
	const VariationSamples samples = randomSamples(someModel(), 400, 0.01, 3);
	IrlsOptions            options;
	options.tolerance     = 1e-12;
	options.maxIterations = 300;
	IrlsSolver    solver;
	const IrlsFit fit = solver.fit(samples, VariationModel::Zero(), options);
	EXPECT_LT((fit.model - someModel()).norm(), 0.01);
	EXPECT_LT((weightedLeastSquares(samples, fit.weights) - fit.model).norm(), 1e-5);

	IrlsOptions plain;
	plain.robust          = false;
	const IrlsFit squares = IrlsSolver().fit(samples, VariationModel::Zero(), plain);
	EXPECT_EQ(squares.iterations, 1);
	EXPECT_GT((squares.model - someModel()).norm(), 4.0 * (fit.model - someModel()).norm());
}

TEST(Irls, LeastSquaresSolvesTheNormalEquations)
{
	const VariationSamples    samples = randomSamples(someModel(), 30, 0.3, 9);
	const std::vector<double> ones(30, 1.0);
	const VariationModel      model    = weightedLeastSquares(samples, ones);
	VariationModel            gradient = VariationModel::Zero();
	for (Index s = 0; s < 30; ++s) {
		const Vector2d dp(samples.pu[s], samples.pv[s]);
		const Vector3d dn(samples.nu[s], samples.nv[s], samples.nw[s]);
		gradient += samples.geometric[s] * (model * dp - dn) * dp.transpose();
	}
	EXPECT_LT(gradient.norm(), 1e-9);
}

TEST(Irls, ExactAndEmptyAndFlatSamples)
{
	IrlsSolver solver;
	EXPECT_EQ(solver.fit(VariationSamples(), someModel(), {}).model, someModel());
	VariationSamples exact;
	samples::Random  random(1, 1);
	for (int s = 0; s < 20; ++s) {
		const Vector2d dp(random.uniform(-1, 1), random.uniform(-1, 1));
		exact.add(0, s, dp, someModel() * dp, 1.0);
	}
	EXPECT_LT((solver.fit(exact, VariationModel::Zero(), {}).model - someModel()).norm(), 1e-5);
	VariationSamples line;
	for (int s = 1; s < 20; ++s)
		line.add(0, s, Vector2d(s, 2 * s), Vector3d(s, 0, 0), 1.0);
	EXPECT_FALSE(line.spanPlane());
	EXPECT_TRUE(exact.spanPlane());
	EXPECT_TRUE(solver.fit(line, VariationModel::Zero(), {}).model.allFinite());
}

TEST(OperatingRegion, PairSubsampleIsFixedAndAboutAsLargeAsAsked)
{
	const auto           sample   = sampled("torus", 1000);
	const auto           prepared = prepareCloud(sample.positions, sample.normals);
	const NeighborSearch search(prepared.cloud.positions);
	OperatingRegion      region;
	region.collect(prepared.cloud, search, 5, prepared.cloud.normals.col(5), 0.1, 3.0, 0, 120);
	ASSERT_EQ(region.size(), 121);
	std::vector<Index> all(121);
	std::iota(all.begin(), all.end(), 0);
	VariationSamples pairs, again;
	collectPairs(region, all, 1000000, pairs);
	EXPECT_EQ(pairs.size(), 121 * 120 / 2);
	collectPairs(region, all, 2000, pairs);
	collectPairs(region, all, 2000, again);
	EXPECT_NEAR(pairs.size(), 2000, 200);
	EXPECT_EQ(pairs.first, again.first);
	EXPECT_EQ(pairs.second, again.second);
	// The weight is the inverse of the mean squared distance, in units of the radius.
	const double a =
		(prepared.cloud.positions.col(region.points[7]) - prepared.cloud.positions.col(5))
			.squaredNorm();
	const double b =
		(prepared.cloud.positions.col(region.points[90]) - prepared.cloud.positions.col(5))
			.squaredNorm();
	EXPECT_NEAR(region.geometricWeight(7, 90), region.radius * region.radius * 2.0 / (a + b), 1e-9);
	EXPECT_EQ(region.squaredDistances[0], 0.0);
	EXPECT_TRUE(std::isfinite(region.geometricWeight(0, 0)));
}

TEST(RobustCurvature, ExactOnSphereCylinderAndPlane)
{
	const auto sphereSample = sampled("sphere");
	const auto sphere       = estimateField(sphereSample.positions, sphereSample.normals);
	for (Index i = 0; i < sphere.field.size(); ++i) {
		EXPECT_NEAR(sphere.k1(i), 1.0, 0.03);
		EXPECT_NEAR(sphere.k2(i), 1.0, 0.03);
	}
	const auto planeSample = sampled("plane");
	const auto plane       = estimateField(planeSample.positions, planeSample.normals);
	EXPECT_LT(plane.field.k1.cwiseAbs().maxCoeff() + plane.field.k2.cwiseAbs().maxCoeff(), 1e-6);
	EXPECT_LT((plane.field.correctedNormals - plane.prepared.cloud.normals).norm(), 1e-6);

	const auto cylinderSample = sampled("cylinder");
	const auto cylinder       = estimateField(cylinderSample.positions, cylinderSample.normals);
	for (Index i = 0; i < cylinder.field.size(); ++i) {
		if (cylinder.field.status[i] != PointStatus::Ok)
			continue;
		EXPECT_NEAR(cylinder.k1(i), 2.0, 0.1);
		EXPECT_NEAR(cylinder.k2(i), 0.0, 0.05);
		EXPECT_GT(std::abs(cylinder.field.d2.col(i).z()), 0.999);
	}
}

TEST(RobustCurvature, FramesOrderErrorsAndConfidence)
{
	const auto      sample     = sampled("ellipsoid", 1500, 0.003);
	const auto      estimated  = estimateField(sample.positions, planeFitNormals(sample, 25));
	const auto&     f          = estimated.field;
	Eigen::VectorXd confidence = Eigen::VectorXd::Zero(f.size());
	for (Index i = 0; i < f.size(); ++i) {
		EXPECT_GE(f.k1[i], f.k2[i]);
		Eigen::Matrix3d frame;
		frame << f.d1.col(i), f.d2.col(i), estimated.prepared.cloud.normals.col(i);
		EXPECT_LT((frame.transpose() * frame - Eigen::Matrix3d::Identity()).norm(), 1e-9);
		EXPECT_NEAR(frame.determinant(), 1.0, 1e-9);
		EXPECT_NEAR(f.correctedNormals.col(i).norm(), 1.0, 1e-12);
		EXPECT_GT(f.error[i], 0.0);
		EXPECT_LE(f.radius[i], 6.0 * estimated.minimum.spacing[i] * (1.0 + 1e-12));
		const auto row = f.weights.neighbors[i];
		EXPECT_TRUE(std::is_sorted(row.begin(), row.end()));
		for (const Index j : row) {
			EXPECT_NE(j, i);
			EXPECT_GT(f.weights(i, j), 0.0);
			EXPECT_LE(f.weights(i, j), 1.0);
			confidence[j] += f.weights(i, j);
		}
		EXPECT_EQ(f.weights(i, i), 0.0);
	}
	EXPECT_LT((confidence - f.confidence).norm(), 1e-9);
	EXPECT_GT(f.iterations, 1);
	EXPECT_LE(f.iterations, 30);
}

TEST(RobustCurvature, TorusWithTrueNormals)
{
	const auto sample = sampled("torus");
	const auto gated  = curvatureErrors(estimateField(sample.positions, sample.normals), sample);
	EXPECT_LE(gated.k1, 0.06);
	EXPECT_LE(gated.k2, 0.09);
	EXPECT_LE(gated.direction, 0.02);
	RobustCurvatureOptions published;
	published.featureGate = false;
	const auto paper =
		curvatureErrors(estimateField(sample.positions, sample.normals, published), sample);
	EXPECT_LE(paper.k1, 0.06);
	EXPECT_LE(paper.k2, 0.09);
}

TEST(RobustCurvature, NoisyTorusWithPlaneFitNormals)
{
	CurvatureErrors mean;
	for (const int seed : {1, 2, 3}) {
		const auto sample = sampled("torus", 2000, 0.01, seed);
		const auto errors =
			curvatureErrors(estimateField(sample.positions, planeFitNormals(sample, 25)), sample);
		mean.k1 += errors.k1 / 3;
		mean.k2 += errors.k2 / 3;
		mean.direction += errors.direction / 3;
		EXPECT_LE(errors.normalAfter, 0.65 * errors.normalBefore);
	}
	EXPECT_LE(mean.k1, 0.30);
	EXPECT_LE(mean.k2, 0.27);
	EXPECT_LE(mean.direction, 0.13);
}

TEST(RobustCurvature, WrongNormalsDoNotMatter)
{
	const auto sample = sampled("torus");
	for (const auto& [share, bound] : {std::pair(0.15, 0.25), std::pair(0.30, 0.40)}) {
		Matrix3Xd       normals = sample.normals;
		samples::Random random(5, 0);
		for (Eigen::Index i = 0; i < normals.cols(); ++i)
			if (random.uniform() < share)
				normals.col(i) = random.normal3().normalized();
		RobustCurvatureOptions squares;
		squares.robust    = false;
		const auto robust = curvatureErrors(estimateField(sample.positions, normals), sample);
		const auto plain =
			curvatureErrors(estimateField(sample.positions, normals, squares), sample);
		EXPECT_LE(robust.k1, bound);
		EXPECT_LE(robust.k1, 0.5 * plain.k1);
		EXPECT_LE(robust.normalAfter, 0.25 * robust.normalBefore);
	}
}

// Two half planes that meet at a right angle along y; normals disturbed by `noise` radians.
struct Edge {
	Matrix3Xd positions, normals, trueNormals;
};

Edge edge(double noise)
{
	constexpr int   n = 2000;
	samples::Random random(4, 0);
	Edge            e;
	e.positions.resize(3, n);
	e.normals.resize(3, n);
	e.trueNormals.resize(3, n);
	for (int i = 0; i < n; ++i) {
		const double y = random.uniform(-0.5, 0.5), t = random.uniform(0.0, 0.5);
		const bool   top     = i % 2 == 0;
		e.positions.col(i)   = top ? Vector3d(-t, y, 0) : Vector3d(0, y, -t);
		e.trueNormals.col(i) = top ? Vector3d::UnitZ() : Vector3d::UnitX();
		e.normals.col(i)     = (e.trueNormals.col(i) + noise * random.normal3()).normalized();
	}
	return e;
}

struct EdgeOutcome {
	double leak = 0.0, meanDegrees = 0.0, maxDegrees = 0.0, medianCurvature = 0.0;
};

EdgeOutcome besideTheEdge(const Edge& e, const RobustCurvatureOptions& options = {})
{
	const auto          estimated = estimateField(e.positions, e.normals, options);
	const auto&         f         = estimated.field;
	double              across = 0.0, all = 0.0;
	std::vector<double> curvatures;
	EdgeOutcome         outcome;
	for (Index i = 0; i < f.size(); ++i) {
		const Vector3d p = e.positions.col(i), n = e.trueNormals.col(i);
		if (std::abs(p.y()) > 0.4 ||
		    std::max(-p.x(), -p.z()) > f.radius[i] * estimated.prepared.diagonal)
			continue;
		for (const Index j : f.weights.neighbors[i]) {
			all += f.weights(i, j);
			across += e.trueNormals.col(j).dot(n) < 0.5 ? f.weights(i, j) : 0.0;
		}
		const double angle =
			std::acos(std::min(1.0, f.correctedNormals.col(i).dot(n))) * 180.0 / EIGEN_PI;
		outcome.meanDegrees += angle;
		outcome.maxDegrees = std::max(outcome.maxDegrees, angle);
		curvatures.push_back(std::max(std::abs(estimated.k1(i)), std::abs(estimated.k2(i))));
	}
	outcome.leak = across / all;
	outcome.meanDegrees /= double(curvatures.size());
	std::nth_element(
		curvatures.begin(), curvatures.begin() + curvatures.size() / 2, curvatures.end());
	outcome.medianCurvature = curvatures[curvatures.size() / 2];
	return outcome;
}

TEST(FeatureGate, NothingLeaksAcrossAnExactEdge)
{
	const EdgeOutcome gated = besideTheEdge(edge(0.0));
	EXPECT_LE(gated.leak, 0.02);
	EXPECT_LE(gated.maxDegrees, 0.2);
	EXPECT_LE(gated.medianCurvature, 1e-6);
	RobustCurvatureOptions published; // what the gate is for
	published.featureGate = false;
	EXPECT_GE(besideTheEdge(edge(0.0), published).leak, 0.1);
}

TEST(FeatureGate, EdgeWithNoisyNormals)
{
	const EdgeOutcome gated = besideTheEdge(edge(3.0 * EIGEN_PI / 180.0));
	EXPECT_LE(gated.leak, 0.02);
	EXPECT_LE(gated.meanDegrees, 2.0);
}

TEST(FeatureGate, CostsNothingOnASmoothSurface)
{
	const auto             sample  = sampled("torus", 2000, 0.005);
	const Matrix3Xd        normals = planeFitNormals(sample, 25);
	RobustCurvatureOptions published;
	published.featureGate = false;
	const auto gated      = curvatureErrors(estimateField(sample.positions, normals), sample);
	const auto paper = curvatureErrors(estimateField(sample.positions, normals, published), sample);
	EXPECT_LE(gated.k1, 1.08 * paper.k1);
	EXPECT_LE(gated.k2, 1.08 * paper.k2);
}

class Invariance : public ::testing::Test {
protected:
	samples::SampleCloud sample  = sampled("torus", 700, 0.004);
	Matrix3Xd            normals = planeFitNormals(sample, 20);
	EstimatedField       base    = estimateField(sample.positions, normals);
	// Rounding moves residuals across cuts; what is left is a small share of the points.
	void expectEqual(const Eigen::VectorXd& a, const Eigen::VectorXd& b, double tolerance)
	{
		Index off = 0;
		for (Eigen::Index i = 0; i < a.size(); ++i)
			off += std::abs(a[i] - b[i]) > tolerance * (1.0 + std::abs(a[i]));
		EXPECT_LE(off, a.size() / 100);
	}
};

TEST_F(Invariance, Scaling)
{
	const auto      scaled = estimateField(1000.0 * sample.positions, normals);
	Eigen::VectorXd k1(base.field.size()), k2(base.field.size());
	for (Index i = 0; i < base.field.size(); ++i) {
		k1[i] = 1000.0 * scaled.k1(i) * base.prepared.diagonal;
		k2[i] = 1000.0 * scaled.k2(i) * base.prepared.diagonal;
	}
	expectEqual(base.field.k1, k1, 1e-6);
	expectEqual(base.field.k2, k2, 1e-6);
}

TEST_F(Invariance, RigidMotion)
{
	const Eigen::Matrix3d turn =
		Eigen::AngleAxisd(1.1, Vector3d(0.4, -0.8, 0.3).normalized()).toRotationMatrix();
	const Matrix3Xd moved     = (turn * sample.positions).colwise() + Vector3d(3, -5, 8);
	const auto      estimated = estimateField(moved, turn * normals);
	const double    scale     = base.prepared.diagonal / estimated.prepared.diagonal;
	expectEqual(base.field.k1, scale * estimated.field.k1, 1e-3);
	expectEqual(base.field.k2, scale * estimated.field.k2, 1e-3);
	Index off = 0;
	for (Index i = 0; i < base.field.size(); ++i)
		off += std::abs((turn * base.field.d1.col(i)).dot(estimated.field.d1.col(i))) < 0.999;
	EXPECT_LE(off, base.field.size() / 100);
}

TEST_F(Invariance, FlippedNormals)
{
	const auto flipped = estimateField(sample.positions, -normals);
	expectEqual(base.field.k1, -flipped.field.k2, 1e-3);
	expectEqual(base.field.k2, -flipped.field.k1, 1e-3);
	Index off = 0;
	for (Index i = 0; i < base.field.size(); ++i)
		off += std::abs(base.field.d1.col(i).dot(flipped.field.d2.col(i))) < 0.999;
	EXPECT_LE(off, base.field.size() / 100);
}

TEST_F(Invariance, OrderOfPoints)
{
	const Index        n = base.field.size();
	std::vector<Index> order(n);
	for (Index i = 0; i < n; ++i)
		order[i] = (i * 367 + 11) % n; // 367 and 700 have no common factor
	Matrix3Xd positions(3, n), turned(3, n);
	for (Index i = 0; i < n; ++i) {
		positions.col(i) = sample.positions.col(order[i]);
		turned.col(i)    = normals.col(order[i]);
	}
	const auto      permuted = estimateField(positions, turned);
	Eigen::VectorXd k1(n);
	for (Index i = 0; i < n; ++i)
		k1[order[i]] = permuted.field.k1[i];
	EXPECT_LT((base.field.k1 - k1).cwiseAbs().maxCoeff(), 1e-9);
}

TEST_F(Invariance, NumberOfThreads)
{
	const int threads = omp_get_max_threads();
	omp_set_num_threads(1);
	const auto one = estimateField(sample.positions, normals);
	omp_set_num_threads(3);
	const auto three = estimateField(sample.positions, normals);
	omp_set_num_threads(threads);
	EXPECT_EQ(one.field.k1, three.field.k1);
	EXPECT_EQ(one.field.d1, three.field.d1);
	EXPECT_EQ(one.field.confidence, three.field.confidence);
	EXPECT_EQ(one.field.correctedNormals, three.field.correctedNormals);
	EXPECT_EQ(one.field.weights.neighbors.indices, three.field.weights.neighbors.indices);
	EXPECT_EQ(one.field.weights.values, three.field.weights.values);
}

void expectSound(const PointCloud& cloud)
{
	const NeighborSearch       search(cloud.positions);
	const MinimumNeighborhoods minimum = minimumNeighborhoods(cloud, search);
	for (const bool gate : {true, false}) {
		RobustCurvatureOptions options;
		options.featureGate    = gate;
		const CurvatureField f = robustCurvature(cloud, options);
		EXPECT_TRUE(f.k1.allFinite() && f.k2.allFinite() && f.error.allFinite());
		EXPECT_TRUE(f.d1.allFinite() && f.d2.allFinite() && f.correctedNormals.allFinite());
		EXPECT_TRUE(f.radius.allFinite() && f.confidence.allFinite());
		for (Index i = 0; i < f.size(); ++i) {
			EXPECT_NEAR(f.d1.col(i).norm(), 1.0, 1e-9);
			EXPECT_NEAR(f.d2.col(i).norm(), 1.0, 1e-9);
		}
	}
}

TEST(RobustCurvature, DegenerateCloudsGiveFiniteFrames)
{
	PointCloud cloud; // one point, two, and a line
	for (const Index n : {0, 1, 2, 30}) {
		cloud.positions.setZero(3, n);
		if (n > 0)
			cloud.positions.row(0).setLinSpaced(0.0, n > 1 ? 1.0 : 0.0);
		cloud.normals.setZero(3, n);
		cloud.normals.row(2).setConstant(-1.0);
		expectSound(cloud);
	}
	cloud.positions.row(1) =
		1e-7 * Eigen::VectorXd::LinSpaced(30, -1.0, 1.0).array().sin().matrix();
	expectSound(cloud);             // almost a line
	cloud.positions.setZero(3, 60); // duplicates that preparation would have merged
	cloud.normals.setZero(3, 60);
	cloud.normals.row(0).setOnes();
	expectSound(cloud);

	// twenty coplanar points, then with normals in the plane
	const auto sheet = sampled("plane", 20);
	cloud            = prepareCloud(sheet.positions, sheet.normals).cloud;
	expectSound(cloud);
	cloud.normals.setZero();
	cloud.normals.row(1).setOnes();
	expectSound(cloud);

	const auto two = sampled("plane", 400); // two sheets that touch
	cloud.positions.resize(3, 800);
	cloud.normals.resize(3, 800);
	cloud.positions << two.positions, two.positions.colwise() + Vector3d(1e-9, 0, 0);
	cloud.normals << two.normals, -two.normals;
	expectSound(cloud);

	cloud = prepareCloud(two.positions, two.normals).cloud; // one point far from all others
	cloud.positions.col(0) = Vector3d(0, 0, 3);
	expectSound(cloud);
	const NeighborSearch       search(cloud.positions);
	const MinimumNeighborhoods minimum = minimumNeighborhoods(cloud, search);
	EXPECT_EQ(robustCurvature(cloud).status[0], PointStatus::Isolated);
}

TEST(Scalars, ShapeIndexAndCurvedness)
{
	EXPECT_NEAR(shapeIndex(2.0, 2.0), 1.0, 1e-15);
	EXPECT_NEAR(shapeIndex(-2.0, -2.0), -1.0, 1e-15);
	EXPECT_NEAR(shapeIndex(1.0, 0.0), 0.5, 1e-15);
	EXPECT_NEAR(shapeIndex(1.0, -1.0), 0.0, 1e-15);
	EXPECT_EQ(shapeIndex(0.0, 0.0), 0.0);
	EXPECT_NEAR(curvedness(3.0, 4.0), 5.0 / std::sqrt(2.0), 1e-15);
	EXPECT_EQ(curvedness(0.0, 0.0), 0.0);
}

} // namespace
} // namespace curvature_lines::test
