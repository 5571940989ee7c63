// Traced lines against the exact surfaces: direction, distance to the surface, distance to each other, ends.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "line_tracing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "exact_field.h"
#include "line_intersections.h"
#include "line_network.h"
#include "line_spacing.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "umbilics.h"
#include "voronoi_cells.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;
using samples::AnalyticSurface;

constexpr double degree = 3.14159265358979323846 / 180.0;

struct Traced : test::ExactCloud {
	UmbilicRegions umbilics;
	LineNetwork    lines;
};

samples::SampleRequest request(const char* surface, int points, std::uint64_t seed = 1)
{
	samples::SampleRequest result;
	result.surface = surface;
	result.points  = points;
	result.seed    = seed;
	return result;
}

LineNetwork trace(const test::ExactCloud& exact, const LineTracingOptions& options = {})
{
	const UmbilicRegions umbilics = findUmbilics(exact.cloud, exact.field, exact.minimum);
	const VoronoiCells   cells(exact.cloud.positions);
	return traceLines(exact.cloud, exact.field, exact.minimum, umbilics, cells, options);
}

// Directions turned by Gaussian noise: lines of such a field do not close.
void disturb(test::ExactCloud& exact, double angle)
{
	samples::Random random(17, 1);
	for (Index i = 0; i < exact.cloud.size(); ++i) {
		const double   t  = angle * random.normal();
		const Vector3d d1 = exact.field.d1.col(i), d2 = exact.field.d2.col(i);
		exact.field.d1.col(i) = std::cos(t) * d1 + std::sin(t) * d2;
		exact.field.d2.col(i) = std::cos(t) * d2 - std::sin(t) * d1;
	}
}

// visit(line, from, to) for every segment, the closing one included.
template<class Visit>
void forEachSegment(const LineNetwork& lines, const Visit& visit)
{
	for (Index l = 0; l < lines.lines(); ++l) {
		const Index first = lines.offsets[l], last = lines.offsets[l + 1];
		for (Index i = first; i + 1 < last; ++i)
			visit(l, i, i + 1);
		if (lines.closed[l])
			visit(l, last - 1, first);
	}
}

std::vector<double> lengths(const LineNetwork& lines)
{
	std::vector<double> result(lines.lines(), 0.0);
	forEachSegment(lines, [&](Index l, Index a, Index b) {
		result[l] += (lines.vertices.col(b) - lines.vertices.col(a)).norm();
	});
	return result;
}

double familyLength(const LineNetwork& lines, int family)
{
	const std::vector<double> all = lengths(lines);
	double                    sum = 0.0;
	for (Index l = 0; l < lines.lines(); ++l)
		sum += lines.family[l] == family ? all[l] : 0.0;
	return sum;
}

double rmsDistance(const LineNetwork& lines, const AnalyticSurface& surface)
{
	double sum = 0.0;
	for (Index i = 0; i < lines.vertices.cols(); ++i)
		sum += (lines.vertices.col(i) - surface.project(lines.vertices.col(i))).squaredNorm();
	return std::sqrt(sum / lines.vertices.cols());
}

// Angles of the segments to the true direction of their family, sorted, weighted by nothing.
std::vector<double> directionErrors(const LineNetwork& lines, const AnalyticSurface& surface)
{
	std::vector<double> errors;
	forEachSegment(lines, [&](Index l, Index a, Index b) {
		const Vector3d middle = 0.5 * (lines.vertices.col(a) + lines.vertices.col(b));
		const auto     frame  = surface.frame(surface.project(middle));
		errors.push_back(
			test::lineAngle(
				lines.vertices.col(b) - lines.vertices.col(a),
				lines.family[l] == 1 ? frame.d1 : frame.d2));
	});
	std::sort(errors.begin(), errors.end());
	return errors;
}

double quantile(const std::vector<double>& sorted, double q)
{
	return sorted[static_cast<std::size_t>(q * (sorted.size() - 1))];
}

double distanceToSegment(const Vector3d& x, const Vector3d& a, const Vector3d& b)
{
	const double t = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
	return (a + t * (b - a) - x).norm();
}

// For every vertex, the distance to the nearest other line of its family that was traced before.
std::vector<double> distancesToEarlierLines(const LineNetwork& lines)
{
	std::vector<double> result(lines.vertices.cols(), HUGE_VAL);
	for (Index later = 0; later < lines.lines(); ++later)
		for (Index v = lines.offsets[later]; v < lines.offsets[later + 1]; ++v)
			forEachSegment(lines, [&](Index l, Index a, Index b) {
				if (l < later && lines.family[l] == lines.family[later])
					result[v] = std::min(
						result[v],
						distanceToSegment(
							lines.vertices.col(v), lines.vertices.col(a), lines.vertices.col(b)));
			});
	return result;
}

void expectSane(const LineNetwork& lines)
{
	ASSERT_EQ(lines.offsets.size(), lines.family.size() + 1);
	ASSERT_EQ(lines.closed.size(), lines.family.size());
	EXPECT_EQ(lines.offsets.back(), lines.vertices.cols());
	EXPECT_EQ(lines.normals.cols(), lines.vertices.cols());
	EXPECT_EQ(lines.curvature.size(), lines.vertices.cols());
	EXPECT_TRUE(
		lines.vertices.allFinite() && lines.normals.allFinite() && lines.curvature.allFinite());
	for (Index l = 0; l < lines.lines(); ++l) {
		EXPECT_GE(lines.offsets[l + 1] - lines.offsets[l], 2);
		EXPECT_TRUE(lines.family[l] == 1 || lines.family[l] == 2);
	}
}

TEST(LineSpacing, IsTheChordWhoseSagittaIsEpsilon)
{
	for (const double radius : {0.1, 1.0, 7.0})
		for (const double eps : {1e-5, 1e-3, 0.05}) {
			const double d = lineSpacing(1.0 / radius, eps, 0.0, 100.0);
			EXPECT_NEAR(radius - std::sqrt(radius * radius - 0.25 * d * d), eps, 1e-10);
			EXPECT_EQ(d, lineSpacing(-1.0 / radius, eps, 0.0, 100.0));
		}
}

TEST(LineSpacing, StaysInItsBounds)
{
	EXPECT_EQ(lineSpacing(0.0, 1e-5, 0.01, 0.1), 0.1);
	EXPECT_EQ(lineSpacing(1e9, 1e-5, 0.01, 0.1), 0.01);
	EXPECT_DOUBLE_EQ(lineSpacing(4.0, 3.0, 0.0, 10.0), 0.5); // no chord is longer than the diameter
}

TEST(LineTracing, FollowsMeridiansAndParallelsOfTheTorus)
{
	const test::ExactCloud exact = test::exactCloud(request("torus", 2000));
	const LineNetwork      lines = trace(exact);
	expectSane(lines);
	const auto errors = directionErrors(lines, samples::surface("torus"));
	EXPECT_LT(quantile(errors, 0.5), 1.5 * degree);
	EXPECT_LT(quantile(errors, 0.99), 7.0 * degree);
	EXPECT_LT(rmsDistance(lines, samples::surface("torus")), 0.0015);
	for (Index i = 0; i < lines.vertices.cols(); ++i)
		EXPECT_NEAR(lines.normals.col(i).norm(), 1.0, 1e-9);
}

TEST(LineTracing, FollowsCirclesAndRulingsOfTheCylinder)
{
	const test::ExactCloud exact = test::exactCloud(request("cylinder", 3000));
	const LineNetwork      lines = trace(exact);
	expectSane(lines);
	EXPECT_LT(quantile(directionErrors(lines, samples::surface("cylinder")), 0.99), 6.0 * degree);
	for (Index l = 0; l < lines.lines(); ++l)
		for (Index i = lines.offsets[l]; i < lines.offsets[l + 1]; ++i)
			EXPECT_NEAR(lines.curvature[i], lines.family[l] == 1 ? 2.0 : 0.0, 0.05);
}

TEST(LineTracing, ClosesTheCirclesOfTheTorus)
{
	const test::ExactCloud exact = test::exactCloud(request("torus", 3000));
	LineTracingOptions     options;
	options.stopFactor                  = meshStopFactor;
	options.gradation                   = meshGradation;
	const LineNetwork         lines     = trace(exact, options);
	double                    closed[2] = {0, 0}, all[2] = {0, 0};
	const std::vector<double> length = lengths(lines);
	for (Index l = 0; l < lines.lines(); ++l) {
		all[lines.family[l] - 1] += length[l];
		if (!lines.closed[l])
			continue;
		closed[lines.family[l] - 1] += length[l];
		const Vector3d first = lines.vertices.col(lines.offsets[l]);
		const Vector3d last  = lines.vertices.col(lines.offsets[l + 1] - 1);
		EXPECT_LT((first - last).norm(), 1.1 * exact.minimum.medianSpacing);
		// A meridian has one length; a parallel goes once around the axis.
		double turn = 0.0;
		for (Index i = lines.offsets[l]; i < lines.offsets[l + 1]; ++i) {
			const Index    j = i + 1 < lines.offsets[l + 1] ? i + 1 : lines.offsets[l];
			const Vector3d a = lines.vertices.col(i), b = lines.vertices.col(j);
			turn += std::atan2(a.x() * b.y() - a.y() * b.x(), a.x() * b.x() + a.y() * b.y());
		}
		EXPECT_NEAR(std::abs(turn), lines.family[l] == 1 ? 0.0 : 360.0 * degree, 1e-9);
		if (lines.family[l] == 1) {
			EXPECT_NEAR(length[l], 360.0 * degree * 0.4, 0.03);
		}
	}
	EXPECT_GT(closed[0], 0.75 * all[0]);
	EXPECT_GT(closed[1], 0.90 * all[1]);
}

TEST(LineTracing, KeepsItsDistance)
{
	const test::ExactCloud exact = test::exactCloud(request("helicoid", 2500));
	for (const double stop : {1.0, 0.5}) {
		LineTracingOptions options;
		options.stopFactor = stop;
		options.minSpacing = options.maxSpacing = 5.0 * exact.minimum.medianSpacing;
		const LineNetwork lines                 = trace(exact, options);
		EXPECT_GT(lines.lines(), 10);
		for (const double d : distancesToEarlierLines(lines))
			EXPECT_GE(d, stop * options.minSpacing);
	}
}

TEST(LineTracing, ClosingALineDoesNotPushItIntoAnother)
{
	test::ExactCloud exact = test::exactCloud(request("torus", 2500));
	disturb(exact, 4.0 * degree);
	LineTracingOptions options;
	options.minSpacing = options.maxSpacing = 5.0 * exact.minimum.medianSpacing;
	const LineNetwork lines                 = trace(exact, options);
	EXPECT_GT(std::accumulate(lines.closed.begin(), lines.closed.end(), 0), 2);
	std::vector<double> d = distancesToEarlierLines(lines);
	std::sort(d.begin(), d.end());
	EXPECT_GT(d.front(), 0.05 * options.minSpacing);
	EXPECT_GT(quantile(d, 0.05), 0.45 * options.minSpacing);
}

TEST(LineTracing, LeavesNoGapsWhereALineCouldStart)
{
	const test::ExactCloud exact = test::exactCloud(request("torus", 2000));
	LineTracingOptions     options;
	options.minSpacing = options.maxSpacing = 4.0 * exact.minimum.medianSpacing;
	const LineNetwork lines                 = trace(exact, options);
	for (const int family : {1, 2})
		for (Index i = 0; i < exact.cloud.size(); ++i) {
			double nearest = HUGE_VAL;
			forEachSegment(lines, [&](Index l, Index a, Index b) {
				if (lines.family[l] == family)
					nearest = std::min(
						nearest,
						distanceToSegment(
							exact.cloud.positions.col(i),
							lines.vertices.col(a),
							lines.vertices.col(b)));
			});
			// Closing moves lines a little after the seeds beside them were skipped.
			EXPECT_LT(nearest, 1.5 * options.minSpacing);
		}
}

TEST(LineTracing, SpiralsDoNotRunNextToThemselves)
{
	test::ExactCloud exact = test::exactCloud(request("torus", 2500));
	// A constant turn makes every line of the torus a helix that never closes.
	for (Index i = 0; i < exact.cloud.size(); ++i) {
		const Vector3d d1 = exact.field.d1.col(i), d2 = exact.field.d2.col(i);
		exact.field.d1.col(i) = std::cos(0.1) * d1 + std::sin(0.1) * d2;
		exact.field.d2.col(i) = std::cos(0.1) * d2 - std::sin(0.1) * d1;
	}
	LineTracingOptions options;
	options.minSpacing = options.maxSpacing = 4.0 * exact.minimum.medianSpacing;
	const LineNetwork lines                 = trace(exact, options);
	const double      area                  = 4.0 * 180.0 * degree * 180.0 * degree * 0.4;
	for (const int family : {1, 2}) {
		EXPECT_GT(familyLength(lines, family), 0.5 * area / options.minSpacing);
		EXPECT_LT(familyLength(lines, family), 2.3 * area / options.minSpacing);
	}
	for (const double length : lengths(lines))
		EXPECT_LE(length, 20.0 * samples::surface("torus").diagonal()); // both halves
}

TEST(LineTracing, DoesNotLeaveAnOpenSurface)
{
	for (const char* name : {"helicoid", "cylinder", "plane"}) {
		const test::ExactCloud exact = test::exactCloud(request(name, 2500));
		const LineNetwork      lines = trace(exact);
		EXPECT_GT(lines.lines(), 5) << name;
		const AnalyticSurface& surface = samples::surface(name);
		Index                  off     = 0;
		for (Index i = 0; i < lines.vertices.cols(); ++i) {
			const double d =
				(lines.vertices.col(i) - surface.project(lines.vertices.col(i))).norm();
			EXPECT_LT(d, 1.5 * exact.minimum.medianSpacing) << name;
			off += d > 0.3 * exact.minimum.medianSpacing;
		}
		EXPECT_LT(off, 0.01 * lines.vertices.cols()) << name;
	}
}

TEST(LineTracing, SphereTerminatesAndPlaneIsCovered)
{
	const LineNetwork sphere = trace(test::exactCloud(request("sphere", 2000)));
	expectSane(sphere);
	EXPECT_GT(sphere.lines(), 0);
	EXPECT_LT(rmsDistance(sphere, samples::surface("sphere")), 0.005);

	LineTracingOptions options;
	options.minSpacing = options.maxSpacing = 0.1;
	const LineNetwork plane = trace(test::exactCloud(request("plane", 2000)), options);
	expectSane(plane);
	for (const int family : {1, 2}) {
		EXPECT_GT(familyLength(plane, family), 0.6 / 0.1);
		EXPECT_LT(familyLength(plane, family), 1.5 / 0.1);
	}
}

TEST(LineTracing, LinesGoOnWhereAFlatPartBends)
{
	const test::ExactCloud exact    = test::exactCloud(request("bent_sheet", 4000));
	const UmbilicRegions   umbilics = findUmbilics(exact.cloud, exact.field, exact.minimum);
	ASSERT_GE(umbilics.regions, 1);
	const VoronoiCells cells(exact.cloud.positions);
	const LineNetwork  lines = traceLines(exact.cloud, exact.field, exact.minimum, umbilics, cells);
	Index              bridges = 0;
	for (Index l = 0; l < lines.lines(); ++l) {
		bool flat = false, bent = false;
		for (Index i = lines.offsets[l]; i < lines.offsets[l + 1]; ++i) {
			const Index cell                       = cells.locate(lines.vertices.col(i), 0);
			(umbilics.umbilic[cell] ? flat : bent) = true;
		}
		bridges += flat && bent;
	}
	EXPECT_GE(bridges, 5);
}

TEST(LineTracing, EpsilonControlsTheDensity)
{
	const test::ExactCloud exact = test::exactCloud(request("ellipsoid", 4000));
	double                 last  = HUGE_VAL;
	for (const double epsilon : {5e-4, 1.5e-3, 4.5e-3}) {
		LineTracingOptions options;
		options.epsilon         = epsilon;
		options.maxSpacing      = 0.5 * samples::surface("ellipsoid").diagonal();
		const LineNetwork lines = trace(exact, options);
		EXPECT_NEAR(lines.epsilon, epsilon, 1e-12);
		// d grows with the square root of epsilon, which is tripled; the lower bound holds some of it back.
		const double length = familyLength(lines, 1) + familyLength(lines, 2);
		EXPECT_LT(length, 0.75 * last);
		last = length;
	}
}

TEST(LineTracing, MeetsItsTarget)
{
	for (const char* name : {"torus", "ellipsoid", "cylinder"}) {
		const test::ExactCloud exact = test::exactCloud(request(name, 4000));
		LineTracingOptions     options;
		options.targetVertices   = 500;
		const LineNetwork  lines = trace(exact, options);
		const VoronoiCells cells(exact.cloud.positions);
		const auto         found = intersectLines(cells, lines).crossings.size();
		EXPECT_NEAR(double(found), 500.0, 75.0) << name;
		EXPECT_GT(lines.epsilon, 0.0);
	}
}

TEST(LineTracing, AnyNumberOfThreadsAgreesToTheBit)
{
	const test::ExactCloud exact   = test::exactCloud(request("ellipsoid", 2000));
	const int              threads = omp_get_max_threads();
	omp_set_num_threads(1);
	const LineNetwork a = trace(exact);
	omp_set_num_threads(4);
	const LineNetwork b = trace(exact);
	omp_set_num_threads(threads);
	EXPECT_EQ(a.vertices, b.vertices);
	EXPECT_EQ(a.offsets, b.offsets);
	EXPECT_EQ(a.family, b.family);
}

TEST(LineTracing, OrderOfPointsAndRigidMotionChangeLittle)
{
	const samples::SampleRequest wanted = request("torus", 2500);
	const test::ExactCloud       exact  = test::exactCloud(wanted);
	const LineNetwork            lines  = trace(exact);

	const Eigen::Matrix3d turn =
		Eigen::AngleAxisd(0.7, Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
	test::ExactCloud moved = exact;
	const Index      n     = exact.cloud.size();
	const auto       place = [&](const Eigen::Matrix3Xd& from, Eigen::Matrix3Xd& to) {
        for (Index i = 0; i < n; ++i)
            to.col(n - 1 - i) = turn * from.col(i);
	};
	place(exact.cloud.positions, moved.cloud.positions);
	place(exact.cloud.normals, moved.cloud.normals);
	place(exact.sample.d1, moved.sample.d1);
	place(exact.sample.d2, moved.sample.d2);
	moved.sample.k1 = exact.sample.k1.reverse();
	moved.sample.k2 = exact.sample.k2.reverse();
	const NeighborSearch search(moved.cloud.positions);
	moved.minimum           = minimumNeighborhoods(moved.cloud, search);
	moved.field             = test::exactField(moved.sample, moved.cloud, search, moved.minimum);
	const LineNetwork other = trace(moved);
	for (const int family : {1, 2})
		EXPECT_NEAR(
			familyLength(other, family),
			familyLength(lines, family),
			0.15 * familyLength(lines, family));
}

TEST(LineTracing, SurvivesSmallAndDegenerateClouds)
{
	samples::SampleRequest tiny = request("plane", 20);
	expectSane(trace(test::exactCloud(tiny)));
	tiny.regular = true;
	expectSane(trace(test::exactCloud(tiny)));

	test::ExactCloud nowhere = test::exactCloud(request("torus", 200));
	nowhere.field.status.assign(nowhere.cloud.size(), PointStatus::TooFewNeighbors);
	EXPECT_EQ(trace(nowhere).lines(), 0);

	// No support at all: every projection falls back to the closest point's tangent plane.
	test::ExactCloud alone = test::exactCloud(request("torus", 300));
	alone.field.weights.neighbors.offsets.assign(alone.cloud.size() + 1, 0);
	alone.field.weights.neighbors.indices.clear();
	alone.field.weights.values.clear();
	expectSane(trace(alone));
}

TEST(LineTracing, EndsOnTheRimAndNotBeyond)
{
	const test::ExactCloud exact = test::exactCloud(request("helicoid", 4000));
	LineTracingOptions     options;
	options.minSpacing = options.maxSpacing = 0.05;
	options.stopFactor                      = meshStopFactor;
	const LineNetwork lines                 = trace(exact, options);
	const double      h                     = exact.minimum.medianSpacing;
	Index             rims = 0, others = 0;
	for (const auto& both : lines.ends)
		for (const LineEnd end : both)
			++(end == LineEnd::Rim ? rims : others);
	EXPECT_GT(rims, 5 * others);
	// Lines reach the rim from all sides: the cloud's box is the surface's.
	for (int axis = 0; axis < 3; ++axis) {
		const auto line = lines.vertices.row(axis), cloud = exact.cloud.positions.row(axis);
		EXPECT_LT(std::abs(line.maxCoeff() - cloud.maxCoeff()), h);
		EXPECT_LT(std::abs(line.minCoeff() - cloud.minCoeff()), h);
	}
}

TEST(LineTracing, EndsOnTheCreasesOfACube)
{
	const LineNetwork lines   = trace(test::exactCloud(request("cube", 4000)));
	Index             creases = 0, rims = 0;
	for (const auto& both : lines.ends)
		for (const LineEnd end : both) {
			creases += end == LineEnd::Crease;
			rims += end == LineEnd::Rim;
		}
	EXPECT_GT(creases, lines.lines());
	EXPECT_LE(rims, creases / 50);
}

TEST(LineTracing, NoneEndsAtARimOfATorus)
{
	const LineNetwork lines = trace(test::exactCloud(request("torus", 4000)));
	Index             edges = 0, all = 0;
	for (Index l = 0; l < lines.lines(); ++l)
		for (const LineEnd end : lines.ends[l]) {
			EXPECT_EQ(end == LineEnd::None, bool(lines.closed[l]));
			edges += end == LineEnd::Rim || end == LineEnd::Crease;
			++all;
		}
	EXPECT_LE(edges, all / 50);
}

// Random points leave voids of two spacings and more; the surface goes on behind them.
TEST(LineTracing, NoVoidIsTakenForARim)
{
	for (const std::uint64_t seed : {3, 5, 8}) {
		const test::ExactCloud exact = test::exactCloud(request("torus", 10000, seed));
		LineTracingOptions     options;
		options.minSpacing = options.maxSpacing = 0.05;
		Index rims                              = 0;
		for (const auto& both : trace(exact, options).ends)
			for (const LineEnd end : both)
				rims += end == LineEnd::Rim;
		EXPECT_EQ(rims, 0) << "seed " << seed;
	}
}

TEST(LineTracing, ArcLengthsStartAnewWithEveryLine)
{
	LineNetwork lines;
	lines.vertices.resize(3, 5);
	lines.vertices << 0, 3, 3, 7, 7, 0, 4, 4, 0, 0, 0, 0, 2, 0, 1;
	lines.offsets             = {0, 3, 5};
	lines.family              = {1, 2};
	const Eigen::VectorXd arc = arcLengths(lines);
	EXPECT_EQ(arc, (Eigen::VectorXd(5) << 0.0, 5.0, 7.0, 0.0, 1.0).finished());
}

TEST(LineTracing, TouchingSheetsKeepTheirOwnLines)
{
	// A plate far thinner than the points' distance, its sides facing away from each other.
	const samples::SampleCloud one = samples::generate(request("plane", 900, 1));
	const samples::SampleCloud two = samples::generate(request("plane", 900, 2));
	const Index                n   = static_cast<Index>(one.positions.cols());
	test::ExactCloud           exact;
	samples::GroundTruth&      truth = exact.sample;
	truth.k1 = truth.k2 = Eigen::VectorXd::Zero(2 * n);
	truth.d1.resize(3, 2 * n);
	truth.d2.resize(3, 2 * n);
	exact.cloud.positions.resize(3, 2 * n);
	exact.cloud.normals.resize(3, 2 * n);
	for (Index i = 0; i < 2 * n; ++i) {
		const double side = i < n ? 1.0 : -1.0;
		exact.cloud.positions.col(i) =
			(i < n ? one : two).positions.col(i % n) + Vector3d(0.0, 0.0, 0.002 * side);
		exact.cloud.normals.col(i) = Vector3d(0.0, 0.0, side);
		truth.d1.col(i)            = Vector3d::UnitX();
		truth.d2.col(i)            = Vector3d(0.0, side, 0.0);
	}
	const NeighborSearch search(exact.cloud.positions);
	exact.minimum = minimumNeighborhoods(exact.cloud, search);
	exact.field   = test::exactField(truth, exact.cloud, search, exact.minimum);
	LineTracingOptions options;
	options.minSpacing = options.maxSpacing = 0.15;
	const LineNetwork lines                 = trace(exact, options);
	expectSane(lines);
	double length[2] = {0.0, 0.0};
	forEachSegment(lines, [&](Index, Index a, Index b) {
		length[lines.normals(2, a) > 0.0] += (lines.vertices.col(b) - lines.vertices.col(a)).norm();
	});
	EXPECT_GT(length[0], 0.25 * length[1]);
	EXPECT_GT(length[1], 0.25 * length[0]);
	EXPECT_GT(length[0] + length[1], 5.0);
}

TEST(LineTracing, CanBeCancelled)
{
	const test::ExactCloud exact    = test::exactCloud(request("torus", 1000));
	const UmbilicRegions   umbilics = findUmbilics(exact.cloud, exact.field, exact.minimum);
	const VoronoiCells     cells(exact.cloud.positions);
	const Progress         progress([](double, const char*) { return false; });
	EXPECT_THROW(
		traceLines(exact.cloud, exact.field, exact.minimum, umbilics, cells, {}, progress),
		Cancelled);
}

} // namespace
} // namespace curvature_lines
