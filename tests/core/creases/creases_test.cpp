// Creases of exact shapes with and without noise, smooth surfaces and rims that have none, creases that fade,
// thin plates, invariances and degenerate clouds.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "crease_curves.h"
#include "creases.h"
#include "estimated_field.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "robust_denoising.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

struct Found {
	PreparedCloud        prepared;
	MinimumNeighborhoods minimum;
	Creases              creases; // unit frame

	// Of all curves, in model units.
	Matrix3Xd vertices() const
	{
		std::vector<Vector3d> all;
		for (const CreaseCurve& curve : creases.curves)
			for (Index v = 0; v < curve.size(); ++v)
				all.push_back(prepared.toModel(curve.positions.col(v)));
		Matrix3Xd result(3, all.size());
		for (std::size_t k = 0; k < all.size(); ++k)
			result.col(k) = all[k];
		return result;
	}
	double spacing() const { return minimum.medianSpacing * prepared.diagonal; }
};

Found find(PreparedCloud prepared, const CreaseOptions& options = {})
{
	Found found;
	found.prepared = std::move(prepared);
	const NeighborSearch search(found.prepared.cloud.positions);
	found.minimum = minimumNeighborhoods(found.prepared.cloud, search);
	found.creases = findCreases(found.prepared.cloud, options);
	return found;
}

Found find(const Matrix3Xd& positions, const Matrix3Xd& normals, const CreaseOptions& options = {})
{
	return find(prepareCloud(positions, normals), options);
}

samples::SampleCloud sampled(const std::string& surface, int points, double noise = 0.0)
{
	samples::SampleRequest request;
	request.surface = surface;
	request.points  = points;
	request.noise   = noise;
	request.seed    = 1;
	return samples::generate(request);
}

// As a scan: normals of plane fits, denoised.
Found findInScan(const std::string& surface, int points, double noise)
{
	const auto    sample     = sampled(surface, points, noise);
	PreparedCloud prepared   = prepareCloud(sample.positions, planeFitNormals(sample, 16));
	const auto    denoised   = denoiseRobustly(prepared.cloud);
	prepared.cloud.positions = denoised.positions;
	prepared.cloud.normals   = denoised.normals;
	return find(std::move(prepared));
}

void expectSound(const Found& found)
{
	const Creases& creases = found.creases;
	for (Index k = 0; k < static_cast<Index>(creases.curves.size()); ++k) {
		const CreaseCurve& curve = creases.curves[k];
		ASSERT_GE(curve.size(), 2);
		for (const Matrix3Xd* m : {&curve.positions, &curve.tangents, &curve.left, &curve.right}) {
			ASSERT_TRUE(m->allFinite());
			ASSERT_EQ(m->cols(), curve.size());
		}
		ASSERT_TRUE(curve.angle.allFinite());
		const double even = curve.length() / (curve.size() - (curve.closed ? 0 : 1));
		for (Index v = 0; v < curve.size(); ++v) {
			for (const Matrix3Xd* m : {&curve.tangents, &curve.left, &curve.right})
				EXPECT_NEAR(m->col(v).norm(), 1.0, 1e-9);
			if (v + 1 < curve.size()) {
				const Vector3d step = curve.positions.col(v + 1) - curve.positions.col(v);
				EXPECT_GT(step.norm(), 0.4 * even);
				EXPECT_LT(step.norm(), 1.6 * even);
				EXPECT_GT(step.dot(curve.tangents.col(v)), 0.0);
			}
			const Vector3d left = curve.left.col(v), right = curve.right.col(v),
						   tangent = curve.tangents.col(v);
			EXPECT_GT(tangent.dot(left.cross(right)) * curve.angle[v], 0.0);
		}
		for (const auto& [corner, v] :
		     {std::pair(curve.start, Index(0)), std::pair(curve.end, curve.size() - 1)})
			if (corner >= 0) {
				EXPECT_FALSE(curve.closed);
				EXPECT_LT(
					(creases.corners[corner].position - curve.positions.col(v)).norm(), 1e-12);
				const auto& there = creases.corners[corner].curves;
				EXPECT_NE(std::find(there.begin(), there.end(), k), there.end());
			}
	}
}

// Edges as segments, by column: from, to.
struct Edges {
	Matrix3Xd from, to;
};

double distanceTo(const Edges& edges, const Vector3d& p)
{
	double nearest = 1e9;
	for (Eigen::Index e = 0; e < edges.from.cols(); ++e) {
		const Vector3d a = edges.from.col(e), d = edges.to.col(e) - a;
		const double   t = std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
		nearest          = std::min(nearest, (a + t * d - p).norm());
	}
	return nearest;
}

struct Errors {
	double rms = 0.0, max = 0.0; // of the vertices, share of the diagonal
	double gap = 0.0;            // largest distance of a true edge from a vertex, in spacings
};

Errors errorsOf(const Found& found, const Edges& edges, double diagonal)
{
	Errors          errors;
	const Matrix3Xd vertices = found.vertices();
	for (Eigen::Index v = 0; v < vertices.cols(); ++v) {
		const double d = distanceTo(edges, vertices.col(v)) / diagonal;
		errors.rms += d * d / double(vertices.cols());
		errors.max = std::max(errors.max, d);
	}
	errors.rms = std::sqrt(errors.rms);
	for (Eigen::Index e = 0; e < edges.from.cols(); ++e)
		for (double t = 0.0; t <= 1.0; t += 0.01) {
			const Vector3d p = (1.0 - t) * edges.from.col(e) + t * edges.to.col(e);
			errors.gap       = std::max(
                errors.gap, (vertices.colwise() - p).colwise().norm().minCoeff() / found.spacing());
		}
	return errors;
}

Edges boxEdges(const Vector3d& half)
{
	Edges edges{Matrix3Xd(3, 12), Matrix3Xd(3, 12)};
	for (int e = 0; e < 12; ++e) {
		const int axis = e / 4;
		Vector3d  corner;
		corner[(axis + 1) % 3] = e & 1 ? half[(axis + 1) % 3] : -half[(axis + 1) % 3];
		corner[(axis + 2) % 3] = e & 2 ? half[(axis + 2) % 3] : -half[(axis + 2) % 3];
		corner[axis]           = -half[axis];
		edges.from.col(e)      = corner;
		corner[axis]           = half[axis];
		edges.to.col(e)        = corner;
	}
	return edges;
}

Edges cubeEdges()
{
	return boxEdges({0.5, 0.5, 0.5});
}

void expectCube(const Found& found, double rms, double max)
{
	expectSound(found);
	EXPECT_EQ(found.creases.curves.size(), 12u);
	EXPECT_EQ(found.creases.corners.size(), 8u);
	for (const CreaseCorner& corner : found.creases.corners)
		EXPECT_EQ(corner.curves.size(), 3u);
	const Errors errors = errorsOf(found, cubeEdges(), std::sqrt(3.0));
	EXPECT_LT(errors.rms, rms);
	EXPECT_LT(errors.max, max);
	EXPECT_LT(errors.gap, 1.0);
}

TEST(Creases, CleanCube)
{
	const auto  cube  = sampled("cube", 6000);
	const Found found = find(cube.positions, cube.normals);
	expectCube(found, 1e-5, 1e-4);
	for (const CreaseCurve& curve : found.creases.curves) {
		EXPECT_NEAR(curve.angle.mean(), EIGEN_PI / 2.0, 0.01);
		EXPECT_NEAR(curve.length() / (curve.size() - 1) / found.minimum.medianSpacing, 0.7, 0.05);
	}
}

TEST(Creases, NoisyCube)
{
	expectCube(findInScan("cube", 6000, 0.0025), 0.0025, 0.008);
}

TEST(Creases, SmallCube)
{
	const auto cube = sampled("cube", 600);
	expectCube(find(cube.positions, cube.normals), 1e-5, 1e-4);
	expectCube(findInScan("cube", 600, 0.0), 5e-4, 2e-3);
}

TEST(Creases, ConcaveEdge)
{
	for (const double noise : {0.0, 0.0025}) {
		const Found found = findInScan("l_block", 4000, noise);
		expectSound(found);
		EXPECT_EQ(found.creases.curves.size(), 18u);
		EXPECT_EQ(found.creases.corners.size(), 12u);
		int concave = 0;
		for (const CreaseCurve& curve : found.creases.curves) {
			concave += curve.angle.maxCoeff() < 0.0;
			EXPECT_GT(curve.angle.maxCoeff() * curve.angle.minCoeff(), 0.0);
		}
		EXPECT_EQ(concave, 1);
		const Matrix3Xd                 vertices = found.vertices();
		double                          sum      = 0.0;
		const samples::AnalyticSurface& shape    = samples::surface("l_block");
		for (Eigen::Index v = 0; v < vertices.cols(); ++v) {
			const Vector3d foot = shape.project(vertices.col(v));
			sum +=
				(foot - vertices.col(v)).squaredNorm() + std::pow(shape.featureDistance(foot), 2);
		}
		EXPECT_LT(
			std::sqrt(sum / vertices.cols()) / shape.diagonal(), noise > 0.0 ? 0.0025 : 0.0005);
	}
}

TEST(Creases, ClosedCircles)
{
	for (const double noise : {0.0, 0.0025}) {
		const Found found = findInScan("capped_cylinder", 4000, noise);
		expectSound(found);
		ASSERT_EQ(found.creases.curves.size(), 2u);
		EXPECT_TRUE(found.creases.corners.empty());
		const Matrix3Xd vertices = found.vertices();
		double          sum      = 0.0;
		for (Eigen::Index v = 0; v < vertices.cols(); ++v)
			sum += std::pow(vertices.col(v).head<2>().norm() - 0.5, 2) +
			       std::pow(std::abs(vertices(2, v)) - 0.5, 2);
		EXPECT_LT(std::sqrt(sum / vertices.cols()) / std::sqrt(3.0), noise > 0.0 ? 0.003 : 0.001);
		for (const CreaseCurve& curve : found.creases.curves) {
			EXPECT_TRUE(curve.closed);
			EXPECT_NEAR(curve.length() * found.prepared.diagonal, EIGEN_PI, 0.05);
		}
	}
}

class SmoothSurface : public testing::TestWithParam<const char*> {};

TEST_P(SmoothSurface, HasNone)
{
	for (const double noise : {0.0, 0.005, 0.02})
		EXPECT_TRUE(findInScan(GetParam(), 1600, noise).creases.curves.empty()) << noise;
}

// Also open ones: a rim is no crease.
INSTANTIATE_TEST_SUITE_P(
	Creases,
	SmoothSurface,
	testing::Values(
		"torus", "sphere", "ellipsoid", "helicoid", "capsule", "cylinder", "bent_sheet", "plane"),
	[](const auto& info) { return std::string(info.param); });

// A roof whose angle `degrees(y)` between the slopes' normals varies along its ridge, the y axis.
template<class Degrees>
Found findOnRoof(Degrees degrees, const CreaseOptions& options = {})
{
	std::mt19937 engine(3);
	const auto   uniform = [&] { return engine() / 4294967296.0; };
	const int    n       = 4000;
	Matrix3Xd    positions(3, n), normals(3, n);
	for (int i = 0; i < n; ++i) {
		const double x = 2.0 * uniform() - 1.0, y = 3.0 * uniform();
		const auto   slope = [&](double at) {
            return std::tan(0.5 * degrees(at) * EIGEN_PI / 180.0);
		};
		const double h = 1e-4, bend = (slope(y + h) - slope(y - h)) / (2.0 * h);
		positions.col(i) = Vector3d(x, y, -std::abs(x) * slope(y));
		normals.col(i) = Vector3d(std::copysign(slope(y), x), std::abs(x) * bend, 1.0).normalized();
	}
	return find(positions, normals, options);
}

TEST(Creases, SmallestAngle)
{
	const auto constant = [](double) { return 50.0; };
	const auto found    = findOnRoof(constant);
	expectSound(found);
	ASSERT_EQ(found.creases.curves.size(), 1u);
	EXPECT_NEAR(found.creases.curves[0].angle.mean() * 180.0 / EIGEN_PI, 50.0, 0.5);
	EXPECT_EQ(found.creases.curves[0].start, -1);
	EXPECT_EQ(found.creases.curves[0].end, -1);
	EXPECT_NEAR(found.creases.curves[0].length() * found.prepared.diagonal, 3.0, 0.15);
	CreaseOptions options;
	options.minAngle = 60.0;
	EXPECT_TRUE(findOnRoof(constant, options).creases.curves.empty());
	options.minAngle = 25.0;
	EXPECT_EQ(findOnRoof([](double) { return 28.0; }, options).creases.curves.size(), 1u);
}

TEST(Creases, FadingCreaseEndsFreely)
{
	const auto found = findOnRoof([](double y) { return 80.0 * std::max(0.0, 1.0 - 0.5 * y); });
	expectSound(found);
	ASSERT_EQ(found.creases.curves.size(), 1u);
	const Matrix3Xd vertices = found.vertices();
	EXPECT_LT(vertices.row(0).cwiseAbs().maxCoeff(), 0.01);
	EXPECT_LT(vertices.row(1).minCoeff(), 0.1);
	// 30 degrees are left at y = 1.25, 18 at y = 1.55.
	EXPECT_GT(vertices.row(1).maxCoeff(), 1.25);
	EXPECT_LT(vertices.row(1).maxCoeff(), 1.7);
}

TEST(Creases, ThinPlate)
{
	std::mt19937   engine(3);
	const auto     uniform = [&](double half) { return half * (engine() / 2147483648.0 - 1.0); };
	const Vector3d half(0.5, 0.5, 0.06);
	const int      n = 9000;
	Matrix3Xd      positions(3, n), normals(3, n);
	for (int i = 0; i < n; ++i) {
		// By area: two large faces, four narrow ones.
		const double share = engine() / 4294967296.0 * (2.0 + 4.0 * 0.12);
		const int    axis  = share < 2.0 ? 2 : share < 2.24 ? 0 : 1;
		const double side  = engine() % 2 ? 1.0 : -1.0;
		positions.col(i)   = Vector3d(uniform(half.x()), uniform(half.y()), uniform(half.z()));
		positions(axis, i) = side * half[axis];
		normals.col(i)     = side * Vector3d::Unit(axis);
	}
	const Found found = find(positions, normals);
	expectSound(found);
	EXPECT_EQ(found.creases.curves.size(), 12u);
	EXPECT_EQ(found.creases.corners.size(), 8u);
	const Errors errors = errorsOf(found, boxEdges(half), 1.0);
	EXPECT_LT(errors.max, 1e-3);
	EXPECT_LT(errors.gap, 1.0);
}

TEST(Creases, TipOfAConeIsNone)
{
	std::mt19937 engine(3);
	const int    n = 3000;
	Matrix3Xd    positions(3, n), normals(3, n);
	for (int i = 0; i < n; ++i) {
		const double r     = std::sqrt(engine() / 4294967296.0),
					 angle = 2.0 * EIGEN_PI * engine() / 4294967296.0;
		const Vector3d radial(std::cos(angle), std::sin(angle), 0.0);
		positions.col(i) = r * radial - r * Vector3d::UnitZ();
		normals.col(i)   = (radial + Vector3d::UnitZ()).normalized();
	}
	EXPECT_TRUE(find(positions, normals).creases.curves.empty());
}

TEST(Creases, AnyOrderOfThePoints)
{
	const auto          cube     = sampled("cube", 3000);
	const PreparedCloud prepared = prepareCloud(cube.positions, cube.normals);
	PreparedCloud       permuted = prepared;
	std::vector<Index>  order(prepared.cloud.size());
	std::iota(order.begin(), order.end(), 0);
	std::shuffle(order.begin(), order.end(), std::mt19937(4));
	for (Index i = 0; i < prepared.cloud.size(); ++i) {
		permuted.cloud.positions.col(i) = prepared.cloud.positions.col(order[i]);
		permuted.cloud.normals.col(i)   = prepared.cloud.normals.col(order[i]);
	}
	const Matrix3Xd a = find(prepared).vertices(), b = find(permuted).vertices();
	ASSERT_EQ(a.cols(), b.cols());
	EXPECT_EQ(a, b);
}

TEST(Creases, RigidMotion)
{
	const auto            cube = sampled("cube", 3000);
	const Eigen::Matrix3d turn =
		Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
	const Found found = find(
		(1000.0 * turn * cube.positions).colwise() + Vector3d(5e3, -1e4, 2e3), turn * cube.normals);
	expectSound(found);
	EXPECT_EQ(found.creases.curves.size(), 12u);
	EXPECT_EQ(found.creases.corners.size(), 8u);
	Edges edges         = cubeEdges();
	edges.from          = (1000.0 * turn * edges.from).colwise() + Vector3d(5e3, -1e4, 2e3);
	edges.to            = (1000.0 * turn * edges.to).colwise() + Vector3d(5e3, -1e4, 2e3);
	const Errors errors = errorsOf(found, edges, 1000.0 * std::sqrt(3.0));
	EXPECT_LT(errors.max, 1e-4);
	EXPECT_LT(errors.gap, 1.0);
}

TEST(Creases, AnyNumberOfThreads)
{
	const auto cube    = sampled("cube", 3000, 0.001);
	const int  threads = omp_get_max_threads();
	omp_set_num_threads(1);
	const Matrix3Xd a = find(cube.positions, cube.normals).vertices();
	omp_set_num_threads(4);
	const Matrix3Xd b = find(cube.positions, cube.normals).vertices();
	omp_set_num_threads(threads);
	EXPECT_EQ(a, b);
}

TEST(Creases, SpacingAsAsked)
{
	const auto    cube = sampled("cube", 3000);
	CreaseOptions options;
	options.spacing   = 0.02;
	const Found found = find(cube.positions, cube.normals, options);
	EXPECT_EQ(found.creases.curves.size(), 12u);
	for (const CreaseCurve& curve : found.creases.curves)
		EXPECT_NEAR(curve.length() / (curve.size() - 1), 0.02, 0.001);
	options.spacing = 10.0;
	for (const CreaseCurve& curve : find(cube.positions, cube.normals, options).creases.curves)
		EXPECT_EQ(curve.size(), 2);
	options.spacing = 1e-12; // no finer than sensible
	for (const CreaseCurve& curve : find(cube.positions, cube.normals, options).creases.curves)
		EXPECT_LT(curve.size(), 2000);
}

TEST(Creases, OutliersLeftOver)
{
	const auto cube = sampled("cube", 6000);
	Matrix3Xd  positions(3, 6100), normals(3, 6100);
	positions.leftCols(6000) = cube.positions;
	normals.leftCols(6000)   = cube.normals;
	samples::Random random(1, 9);
	for (int i = 6000; i < 6100; ++i) {
		for (int c = 0; c < 3; ++c)
			positions(c, i) = random.uniform(-0.6, 0.6);
		normals.col(i) = random.normal3().normalized();
	}
	const Found found = find(positions, normals);
	expectSound(found);
	EXPECT_EQ(found.creases.curves.size(), 12u);
	EXPECT_EQ(found.creases.corners.size(), 8u);
}

TEST(Creases, DegenerateClouds)
{
	const auto none = [](const Matrix3Xd& positions, const Matrix3Xd& normals) {
		const PointCloud     cloud{positions, normals};
		const NeighborSearch search(cloud.positions);
		const auto           minimum = minimumNeighborhoods(cloud, search);
		return findCreases(cloud).curves.empty();
	};
	EXPECT_TRUE(none(Matrix3Xd(3, 0), Matrix3Xd(3, 0)));
	const Matrix3Xd up = Vector3d::UnitZ().replicate(1, 100);
	EXPECT_TRUE(none(Vector3d::Zero(), Vector3d::UnitZ()));
	EXPECT_TRUE(none(Matrix3Xd::Zero(3, 100), up));
	EXPECT_TRUE(none(Vector3d(1, 0, 0) * Eigen::RowVectorXd::LinSpaced(100, 0.0, 1.0), up));
	samples::Random random(1, 0);
	Matrix3Xd       blob(3, 500), anywhere(3, 500);
	for (int i = 0; i < 500; ++i) {
		blob.col(i)     = 0.2 * random.normal3();
		anywhere.col(i) = random.normal3().normalized();
	}
	const PreparedCloud prepared = prepareCloud(blob, anywhere);
	expectSound(find(prepared)); // whatever it finds
	CreaseOptions options;
	options.minAngle = 1.0;
	expectSound(find(prepared, options));
}

} // namespace
} // namespace curvature_lines::test
