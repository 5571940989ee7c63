// Projection of free points and interpolation of normals and tensors, against exact surfaces.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "cloud_index.h"
#include "exact_field.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "surface_projection.h"

namespace curvature_lines::test {
namespace {

using Eigen::Vector3d;
using samples::AnalyticSurface;

constexpr ProjectionKind allKinds[] = {
	ProjectionKind::Mixed, ProjectionKind::LocallyOptimal, ProjectionKind::WeightedAverage};

ExactCloud cleanCloud(const std::string& surface, int points = 2000)
{
	samples::SampleRequest request;
	request.surface = surface;
	request.points  = points;
	request.seed    = 5;
	return exactCloud(request);
}

struct Errors {
	double distance = 0.0, normal = 0.0, direction = 0.0, k1 = 0.0, k2 = 0.0; // root mean squares
	double mean = 0.0; // signed: negative inside
};

// Of queries a fifth of a spacing off the surface, away from rims.
Errors errorsOf(const ExactCloud& exact, const AnalyticSurface& surface, ProjectionKind kind)
{
	samples::Random      random(7, 1);
	const NeighborSearch search(exact.cloud.positions);
	Errors               e;
	int                  count = 0;
	while (count < 2000) {
		const Vector3d query =
			surface.sample(random) + 0.2 * exact.minimum.medianSpacing * random.normal3();
		if (surface.rimDistance(surface.project(query)) < 4.0 * exact.minimum.medianSpacing)
			continue;
		const SurfaceSample s =
			projectToSurface(exact.cloud, exact.field, query, search.nearest(query, 1)[0], kind);
		const Vector3d foot  = surface.project(s.position);
		const auto     truth = surface.frame(foot);
		e.distance += (s.position - foot).squaredNorm();
		e.mean += (s.position - foot).dot(truth.normal);
		e.normal += std::pow(s.normal.cross(truth.normal).norm(), 2);
		e.direction += std::pow(lineAngle(s.d1, truth.d1), 2);
		e.k1 += std::pow(s.k1 - truth.k1, 2);
		e.k2 += std::pow(s.k2 - truth.k2, 2);
		++count;
	}
	for (double* sum : {&e.distance, &e.normal, &e.direction, &e.k1, &e.k2})
		*sum = std::sqrt(*sum / count);
	e.mean /= count;
	return e;
}

void expectFiniteFrame(const SurfaceSample& s)
{
	EXPECT_TRUE(s.position.allFinite());
	EXPECT_NEAR(s.normal.norm(), 1.0, 1e-12);
	EXPECT_NEAR(s.d1.norm(), 1.0, 1e-12);
	EXPECT_NEAR(s.d1.dot(s.normal), 0.0, 1e-9);
	EXPECT_NEAR((s.normal.cross(s.d1) - s.d2).norm(), 0.0, 1e-9);
	EXPECT_TRUE(std::isfinite(s.k1) && std::isfinite(s.k2));
	EXPECT_GE(s.k1, s.k2);
}

TEST(SurfaceProjection, MixedProjectionLiesOnTheTorus)
{
	const ExactCloud exact = cleanCloud("torus");
	const Errors     e     = errorsOf(exact, samples::surface("torus"), ProjectionKind::Mixed);
	EXPECT_LT(e.distance, 0.0015);
	EXPECT_LT(e.normal, 0.02);
	EXPECT_LT(e.direction, 0.025);
	EXPECT_LT(e.k1, 0.05);
	EXPECT_LT(e.k2, 0.10);
}

TEST(SurfaceProjection, MixedProjectionBeatsTheAverages)
{
	// Averages of points shrink convex parts by k s^2 / 2, which the Hermite mean cancels.
	for (const char* name : {"torus", "ellipsoid", "cylinder"}) {
		const ExactCloud exact   = cleanCloud(name);
		const auto&      surface = samples::surface(name);
		const Errors     mixed   = errorsOf(exact, surface, ProjectionKind::Mixed);
		const Errors     optimal = errorsOf(exact, surface, ProjectionKind::LocallyOptimal);
		const Errors     average = errorsOf(exact, surface, ProjectionKind::WeightedAverage);
		EXPECT_LT(mixed.distance, 0.4 * optimal.distance) << name;
		EXPECT_LT(mixed.distance, 0.4 * average.distance) << name;
		EXPECT_LT(average.mean, 0.0) << name;
		EXPECT_LT(average.distance, 0.1 * exact.minimum.medianSpacing) << name;
		EXPECT_LT(optimal.distance, 0.1 * exact.minimum.medianSpacing) << name;
	}
}

TEST(SurfaceProjection, BiasFallsWithTheSquareOfTheSpacing)
{
	const auto&  torus = samples::surface("torus");
	const double coarse =
		errorsOf(cleanCloud("torus", 1500), torus, ProjectionKind::Mixed).distance;
	const double fine = errorsOf(cleanCloud("torus", 6000), torus, ProjectionKind::Mixed).distance;
	EXPECT_GT(std::log2(coarse / fine), 1.8); // four times the points halve the spacing
}

TEST(SurfaceProjection, PlaneIsExactAndNothingSlides)
{
	const ExactCloud     exact = cleanCloud("plane", 800);
	const NeighborSearch search(exact.cloud.positions);
	const Vector3d       query(0.11, -0.07, 0.02);
	const Index          closest = search.nearest(query, 1)[0];
	for (const ProjectionKind kind : allKinds) {
		const SurfaceSample s = projectToSurface(exact.cloud, exact.field, query, closest, kind);
		expectFiniteFrame(s);
		EXPECT_NEAR((s.position - Vector3d(0.11, -0.07, 0.0)).norm(), 0.0, 1e-12);
		EXPECT_NEAR(s.k1, 0.0, 1e-12);
		// No curvature, but the field's directions still count.
		EXPECT_LT(lineAngle(s.d1, exact.field.d1.col(closest)), 1e-9);
	}
}

TEST(SurfaceProjection, ContinuousAcrossCells)
{
	const ExactCloud     exact = cleanCloud("torus");
	const auto&          torus = samples::surface("torus");
	const NeighborSearch search(exact.cloud.positions);
	const double         h     = exact.minimum.medianSpacing;
	const int            steps = 20000;
	SurfaceSample        previous;
	Index                cells       = 0;
	double               largestStep = 0.0, largestTurn = 0.0, largestChange = 0.0;
	for (int i = 0; i <= steps; ++i) {
		const double   a = 2.0 * EIGEN_PI * i / steps;
		const Vector3d query =
			torus.project(Vector3d(1.3 * std::cos(a), 1.3 * std::sin(a), 0.3 * std::sin(3.0 * a)));
		const SurfaceSample s = projectToSurface(
			exact.cloud, exact.field, query, search.nearest(query, 1)[0], ProjectionKind::Mixed);
		if (i > 0) {
			cells += s.closest != previous.closest;
			largestStep   = std::max(largestStep, (s.position - previous.position).norm());
			largestTurn   = std::max(largestTurn, lineAngle(s.d1, previous.d1));
			largestChange = std::max(largestChange, std::abs(s.k1 - previous.k1));
		}
		previous = s;
	}
	EXPECT_GT(cells, 50);
	EXPECT_LT(largestStep, 0.02 * h); // of which the query itself moves 0.005 h
	EXPECT_LT(largestTurn, 0.02);
	EXPECT_LT(largestChange, 0.02);
}

TEST(SurfaceProjection, FollowsRigidMotionAndScale)
{
	const ExactCloud      exact = cleanCloud("ellipsoid", 800);
	const double          scale = 3.0;
	const Eigen::Matrix3d rotation =
		Eigen::AngleAxisd(1.1, Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
	const Vector3d shift(0.3, -0.2, 0.7);
	ExactCloud     moved  = exact;
	moved.cloud.positions = (scale * rotation * exact.cloud.positions).colwise() + shift;
	moved.cloud.normals   = rotation * exact.cloud.normals;
	moved.field.d1        = rotation * exact.field.d1;
	moved.field.d2        = rotation * exact.field.d2;
	moved.field.k1 /= scale;
	moved.field.k2 /= scale;
	for (const ProjectionKind kind : allKinds)
		for (Index i = 0; i < exact.cloud.size(); i += 37) {
			const Vector3d      query  = exact.cloud.positions.col(i) + 0.01 * Vector3d::Ones();
			const Vector3d      query2 = scale * rotation * query + shift;
			const SurfaceSample a      = projectToSurface(exact.cloud, exact.field, query, i, kind);
			const SurfaceSample b = projectToSurface(moved.cloud, moved.field, query2, i, kind);
			EXPECT_NEAR((scale * rotation * a.position + shift - b.position).norm(), 0.0, 1e-12);
			EXPECT_NEAR((rotation * a.normal - b.normal).norm(), 0.0, 1e-12);
			EXPECT_NEAR(a.k1 / scale, b.k1, 1e-12);
			EXPECT_LT(lineAngle(rotation * a.d1, b.d1), 1e-7);
		}
}

TEST(SurfaceProjection, SignsOfDirectionsDoNotMatter)
{
	const ExactCloud exact   = cleanCloud("torus", 800);
	CurvatureField   flipped = exact.field;
	for (Index i = 0; i < flipped.size(); i += 2)
		flipped.d1.col(i) *= -1.0;
	for (Index i = 0; i < flipped.size(); i += 3)
		flipped.d2.col(i) *= -1.0;
	for (Index i = 0; i < flipped.size(); i += 29) {
		const Vector3d      query = exact.cloud.positions.col(i) + 0.01 * Vector3d::Ones();
		const SurfaceSample a =
			projectToSurface(exact.cloud, exact.field, query, i, ProjectionKind::Mixed);
		const SurfaceSample b =
			projectToSurface(exact.cloud, flipped, query, i, ProjectionKind::Mixed);
		EXPECT_NEAR((a.position - b.position).norm(), 0.0, 1e-14);
		EXPECT_LT(lineAngle(a.d1, b.d1), 1e-9);
		EXPECT_NEAR(a.k2, b.k2, 1e-12);
	}
}

TEST(SurfaceProjection, OppositeSheetTakesNoPart)
{
	// A plate thinner than the spacing, with weights that (wrongly) reach through it.
	ExactCloud  exact = cleanCloud("plane", 800);
	const Index n     = exact.cloud.size();
	PointCloud  plate;
	plate.positions.resize(3, 2 * n);
	plate.normals.resize(3, 2 * n);
	plate.positions << exact.cloud.positions, exact.cloud.positions;
	plate.positions.rightCols(n).row(2).array() -= 0.3 * exact.minimum.medianSpacing;
	plate.normals << exact.cloud.normals, -exact.cloud.normals;
	samples::GroundTruth truth;
	truth.k1 = truth.k2 = Eigen::VectorXd::Zero(2 * n);
	truth.d1.resize(3, 2 * n);
	truth.d1 << exact.field.d1, exact.field.d1;
	truth.d2 = truth.d1;
	const NeighborSearch            search(plate.positions);
	const MinimumNeighborhoods      minimum = minimumNeighborhoods(plate, search);
	CurvatureField                  field   = exactField(truth, plate, search, minimum);
	std::vector<std::vector<Index>> rows(2 * n);
	for (Index i = 0; i < 2 * n; ++i) {
		rows[i] = search.within(plate.positions.col(i), field.radius[i]);
		std::sort(rows[i].begin(), rows[i].end());
	}
	field.weights.neighbors = NeighborLists::fromRows(rows);
	field.weights.values.assign(field.weights.neighbors.indices.size(), 1.0);
	for (const ProjectionKind kind : allKinds)
		for (Index i = 0; i < n; i += 53) {
			const Vector3d query = plate.positions.col(i) + Vector3d(0.0, 0.0, 0.01);
			EXPECT_NEAR(projectToSurface(plate, field, query, i, kind).position.z(), 0.0, 1e-12);
		}
}

TEST(SurfaceProjection, EmptySupportFallsBackToTheTangentPlane)
{
	ExactCloud exact    = cleanCloud("sphere", 200);
	exact.field.weights = {};
	exact.field.weights.neighbors.offsets.assign(exact.cloud.size() + 1, 0);
	exact.field.status.assign(exact.cloud.size(), PointStatus::TooFewNeighbors);
	for (const ProjectionKind kind : allKinds) {
		const Vector3d      p = exact.cloud.positions.col(3), n = exact.cloud.normals.col(3);
		const SurfaceSample s = projectToSurface(exact.cloud, exact.field, 1.2 * p, 3, kind);
		expectFiniteFrame(s);
		EXPECT_NEAR(n.dot(s.position - p), 0.0, 1e-12);
		EXPECT_LT(lineAngle(s.d1, exact.field.d1.col(3)), 1e-9);
	}
}

TEST(SurfaceProjection, AlwaysFinite)
{
	const ExactCloud exact = cleanCloud("cube", 600);
	const double     nan   = std::numeric_limits<double>::quiet_NaN();
	const double     huge  = std::numeric_limits<double>::max();
	for (const ProjectionKind kind : allKinds)
		for (const Vector3d& query :
		     {Vector3d(nan, 0.0, 0.0),
		      Vector3d(huge, -huge, huge),
		      Vector3d(1e8, 1e8, 1e8),
		      Vector3d(0.0, 0.0, 0.0),
		      Vector3d(exact.cloud.positions.col(9)),
		      Vector3d(5.0, -7.0, 3.0)})
			expectFiniteFrame(projectToSurface(exact.cloud, exact.field, query, 9, kind));
}

// Two sheets a tenth of a spacing apart that look away from each other.
TEST(ClosestOnSide, IsTheNearestWhoseNormalAgrees)
{
	samples::Random random(3, 0);
	PointCloud      cloud;
	cloud.positions.resize(3, 400);
	cloud.normals.resize(3, 400);
	for (Index i = 0; i < 400; ++i) {
		const double side = i % 2 == 0 ? 1.0 : -1.0;
		cloud.positions.col(i) << random.uniform(), random.uniform(), 0.0025 * side;
		cloud.normals.col(i) << 0.0, 0.0, side;
	}
	const CloudIndex index(cloud);
	for (int k = 0; k < 200; ++k) {
		const Vector3d p(random.uniform(), random.uniform(), random.uniform(-0.02, 0.02));
		const Vector3d normal(0.1, 0.0, k % 2 == 0 ? 1.0 : -1.0);
		Index          expected = -1;
		for (Index i = 0; i < 400; ++i)
			if (cloud.normals.col(i).dot(normal) > 0.0 &&
			    (expected < 0 ||
			     (cloud.positions.col(i) - p).norm() < (cloud.positions.col(expected) - p).norm()))
				expected = i;
		EXPECT_EQ(closestOnSide(index, p, normal), expected);
		// No normal agrees: the nearest of all.
		EXPECT_EQ(closestOnSide(index, p, Vector3d::UnitX()), index.search().nearest(p, 1)[0]);
	}
}

} // namespace
} // namespace curvature_lines::test
