// The ground truth of all other tests, against definitions: closest points by brute force, curvatures by
// differences of the projection, sampling densities by numerical integration of the area element.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "analytic_surfaces.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

using namespace curvature_lines::samples;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

namespace {

constexpr double pi = 3.14159265358979323846;

SampleCloud cleanCloud(const std::string& name, int points, std::uint64_t seed = 1)
{
	SampleRequest request;
	request.surface = name;
	request.points  = points;
	request.seed    = seed;
	return generate(request);
}

// Pearson's statistic of counts against expected shares that need not sum to 1.
double chiSquare(const std::vector<int>& counts, const std::vector<double>& shares)
{
	const double points = std::accumulate(counts.begin(), counts.end(), 0.0);
	const double total  = std::accumulate(shares.begin(), shares.end(), 0.0);
	double       sum    = 0.0;
	for (std::size_t i = 0; i < counts.size(); ++i) {
		const double expected = points * shares[i] / total;
		sum += (counts[i] - expected) * (counts[i] - expected) / expected;
	}
	return sum;
}

// Area of the patch between two values of the second parameter, by midpoint sums of |P_u x P_v|.
double stripArea(
	const std::function<Vector3d(double, double)>& at,
	double                                         uFrom,
	double                                         uTo,
	double                                         vFrom,
	double                                         vTo)
{
	constexpr int    steps = 200;
	constexpr double h     = 1e-5;
	double           area  = 0.0;
	for (int i = 0; i < steps; ++i) {
		for (int j = 0; j < steps; ++j) {
			const double   u  = uFrom + (uTo - uFrom) * (i + 0.5) / steps;
			const double   v  = vFrom + (vTo - vFrom) * (j + 0.5) / steps;
			const Vector3d pu = (at(u + h, v) - at(u - h, v)) / (2.0 * h);
			const Vector3d pv = (at(u, v + h) - at(u, v - h)) / (2.0 * h);
			area += pu.cross(pv).norm();
		}
	}
	return area * (uTo - uFrom) * (vTo - vFrom) / (steps * steps);
}

constexpr int    bins           = 16;
constexpr double chiSquareLimit = 37.7; // 15 degrees of freedom, probability 0.001

// Points per bin of a coordinate function, against the areas of the same bins.
void expectAreaUniform(
	const std::string&                             name,
	const std::function<double(const Vector3d&)>&  coordinate,
	const std::function<Vector3d(double, double)>& at,
	double                                         uFrom,
	double                                         uTo,
	double                                         vFrom,
	double                                         vTo)
{
	std::vector<int>    counts(bins, 0);
	std::vector<double> areas;
	const SampleCloud   cloud = cleanCloud(name, 40000);
	for (Eigen::Index i = 0; i < cloud.positions.cols(); ++i) {
		const double share = (coordinate(cloud.positions.col(i)) - vFrom) / (vTo - vFrom);
		++counts[std::clamp(static_cast<int>(share * bins), 0, bins - 1)];
	}
	for (int b = 0; b < bins; ++b) {
		const double width = (vTo - vFrom) / bins;
		areas.push_back(stripArea(at, uFrom, uTo, vFrom + b * width, vFrom + (b + 1) * width));
	}
	EXPECT_LT(chiSquare(counts, areas), chiSquareLimit) << name;
}

class EverySurface : public testing::TestWithParam<std::string> {
protected:
	const AnalyticSurface& shape() const { return surface(GetParam()); }
	// Room for a difference step without meeting a rim, an edge or a jump of curvature.
	bool roomy(const Vector3d& foot, double distance) const
	{
		return shape().rimDistance(foot) > distance && shape().featureDistance(foot) > distance;
	}
};

// Its equator, where the caps of a capsule of height 0 meet, is no cylinder.
TEST(AnalyticSurfaces, ASphereIsRoundOnItsEquator)
{
	for (const Eigen::Vector3d& p :
	     {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(0, 0, 1)}) {
		const SurfaceFrame frame = surface("sphere").frame(p);
		EXPECT_EQ(frame.k1, 1.0);
		EXPECT_EQ(frame.k2, 1.0);
	}
}

} // namespace

TEST_P(EverySurface, FramesAreOrthonormalAndOrdered)
{
	const SampleCloud c = cleanCloud(GetParam(), 500);
	for (Eigen::Index i = 0; i < c.k1.size(); ++i) {
		Eigen::Matrix3d frame;
		frame << c.d1.col(i), c.d2.col(i), c.normals.col(i);
		EXPECT_LT((frame.transpose() * frame - Eigen::Matrix3d::Identity()).norm(), 1e-12);
		EXPECT_NEAR(frame.determinant(), 1.0, 1e-12);
		EXPECT_GE(c.k1[i], c.k2[i]);
	}
}

TEST_P(EverySurface, SamplesLieOnTheSurfaceAndProjectionIsIdempotent)
{
	const SampleCloud c = cleanCloud(GetParam(), 500);
	EXPECT_LT((c.positions - c.footPoints).colwise().norm().maxCoeff(), 1e-12);
	const Matrix3Xd again = groundTruth(shape(), c.footPoints).footPoints;
	EXPECT_LT((again - c.footPoints).colwise().norm().maxCoeff(), 1e-12);
}

TEST_P(EverySurface, FootPointIsClosestPoint)
{
	const Matrix3Xd dense = cleanCloud(GetParam(), 20000).positions;
	Random          random(5, 0);
	for (int trial = 0; trial < 100; ++trial) {
		const Eigen::AlignedBox3d box = shape().boundingBox();
		const Vector3d            p =
			box.center() + 1.5 * (random.normal3().array() * box.sizes().array()).matrix() / 2.0;
		const double found = (shape().project(p) - p).norm();
		const double brute = (dense.colwise() - p).colwise().norm().minCoeff();
		EXPECT_LE(found, brute + 1e-12);
		// Among 20000 samples of an area below 20 one is within 0.1 of the foot point.
		EXPECT_GT(found, brute - 0.1);
	}
}

TEST_P(EverySurface, NormalPointsOutwardAlongTheProjection)
{
	const SampleCloud c = cleanCloud(GetParam(), 300);
	for (Eigen::Index i = 0; i < c.k1.size(); ++i) {
		if (!roomy(c.positions.col(i), 0.05))
			continue;
		for (double h : {0.01, -0.01}) {
			const Vector3d off = c.positions.col(i) + h * c.normals.col(i);
			EXPECT_LT((shape().project(off) - c.positions.col(i)).norm(), 1e-9);
		}
	}
	if (!shape().closed())
		return;
	// Divergence theorem: the mean of position . normal over a closed surface is 3 volume / area > 0.
	EXPECT_GT(c.positions.cwiseProduct(c.normals).sum(), 0.0);
}

// A tangent step of h along a direction of normal curvature k ends k h^2 / 2 outside the surface.
TEST_P(EverySurface, CurvaturesAreThoseOfTheProjection)
{
	constexpr double  h       = 1e-3;
	int               checked = 0;
	const SampleCloud c       = cleanCloud(GetParam(), 500);
	for (Eigen::Index i = 0; i < c.k1.size(); ++i) {
		const Vector3d q = c.positions.col(i), n = c.normals.col(i);
		if (!roomy(q, 0.05))
			continue;
		++checked;
		const auto heightAfter = [&](const Vector3d& step) {
			const Vector3d end = q + step;
			return (end - shape().project(end)).dot(n);
		};
		const Vector3d d1 = c.d1.col(i), d2 = c.d2.col(i);
		// Opposite steps cancel the cubic term.
		const double k1 = (heightAfter(h * d1) + heightAfter(-h * d1)) / (h * h);
		const double k2 = (heightAfter(h * d2) + heightAfter(-h * d2)) / (h * h);
		EXPECT_NEAR(k1, c.k1[i], 1e-3);
		EXPECT_NEAR(k2, c.k2[i], 1e-3);
		// Principal directions are conjugate: no twist between them.
		const Vector3d plus = h * (d1 + d2), minus = h * (d1 - d2);
		EXPECT_NEAR((heightAfter(plus) - heightAfter(minus)) / (h * h), 0.0, 1e-2);
	}
	EXPECT_GT(checked, 300);
}

TEST_P(EverySurface, NoiseHasTheStandardDeviationAskedFor)
{
	SampleRequest request;
	request.surface         = GetParam();
	request.points          = 4000;
	request.noise           = 0.005;
	request.seed            = 7;
	const SampleCloud c     = generate(request);
	double            sum   = 0.0;
	int               inner = 0;
	for (Eigen::Index i = 0; i < c.k1.size(); ++i) {
		if (!roomy(c.footPoints.col(i), 0.1))
			continue;
		++inner;
		sum += (c.positions.col(i) - c.footPoints.col(i)).squaredNorm();
	}
	// Standard error of an estimated standard deviation: 1 / sqrt(2 n).
	EXPECT_NEAR(
		std::sqrt(sum / inner) / (request.noise * shape().diagonal()),
		1.0,
		4.0 / std::sqrt(2.0 * inner));
}

TEST_P(EverySurface, GridIsEven)
{
	SampleRequest request;
	request.surface   = GetParam();
	request.points    = 1000;
	request.regular   = true;
	const Matrix3Xd p = generate(request).positions;
	EXPECT_NEAR(static_cast<double>(p.cols()), 1000.0, 60.0);
	Eigen::VectorXd nearest(p.cols());
	for (Eigen::Index i = 0; i < p.cols(); ++i) {
		Eigen::VectorXd d = (p.colwise() - p.col(i)).colwise().norm();
		d[i]              = 1e9;
		nearest[i]        = d.minCoeff();
	}
	// The stretched grids (helicoid, torus, ellipsoid) vary with their metric, random points without bound.
	EXPECT_GT(nearest.minCoeff(), 0.25 * nearest.mean());
	EXPECT_LT(nearest.maxCoeff(), 2.0 * nearest.mean());
}

TEST_P(EverySurface, OutliersAreCountedLabelledAndLeaveTheInliersAlone)
{
	SampleRequest request;
	request.surface         = GetParam();
	request.points          = 950;
	request.noise           = 0.005;
	request.seed            = 3;
	const SampleCloud pure  = generate(request);
	request.farOutliers     = 0.05;
	request.nearOutliers    = 0.05;
	const SampleCloud mixed = generate(request);

	ASSERT_EQ(mixed.label.size(), 1050);
	EXPECT_EQ((mixed.label.array() == Inlier).count(), 950);
	EXPECT_EQ((mixed.label.array() == FarOutlier).count(), 50);
	EXPECT_EQ((mixed.label.array() == NearOutlier).count(), 50);

	const double              unit  = request.noise * shape().diagonal();
	const Eigen::AlignedBox3d box   = shape().boundingBox();
	const Vector3d            reach = 0.6 * box.sizes().cwiseMax(0.2 * shape().diagonal());
	int                       off   = 0;
	for (Eigen::Index i = 0; i < mixed.label.size(); ++i) {
		const Vector3d p        = mixed.positions.col(i);
		const double   distance = (p - mixed.footPoints.col(i)).norm();
		if (mixed.label[i] == Inlier) {
			EXPECT_EQ((pure.positions.colwise() - p).colwise().norm().minCoeff(), 0.0);
		}
		else if (mixed.label[i] == FarOutlier) {
			EXPECT_TRUE(((p - box.center()).cwiseAbs().array() <= reach.array()).all());
		}
		else {
			EXPECT_LT(distance, (8.0 + 4.0 * 0.7 * std::sqrt(3.0)) * unit);
			off += distance > 2.0 * unit;
		}
	}
	// Near a rim or inside an edge the foot of a displaced point may be closer than its displacement.
	EXPECT_GE(off, 40);
}

TEST_P(EverySurface, SeedsDecide)
{
	EXPECT_EQ(cleanCloud(GetParam(), 100, 4).positions, cleanCloud(GetParam(), 100, 4).positions);
	EXPECT_NE(cleanCloud(GetParam(), 100, 4).positions, cleanCloud(GetParam(), 100, 5).positions);
}

INSTANTIATE_TEST_SUITE_P(
	AnalyticSurfaces, EverySurface, testing::ValuesIn(surfaceNames()), [](const auto& info) {
		return info.param;
	});

TEST(AnalyticSurfaces, RandomPointsAreAreaUniform)
{
	expectAreaUniform(
		"torus",
		[](const Vector3d& p) { return std::atan2(p.z(), std::hypot(p.x(), p.y()) - 1.0); },
		[](double u, double v) {
			const double w = 1.0 + 0.4 * std::cos(v);
			return Vector3d(w * std::cos(u), w * std::sin(u), 0.4 * std::sin(v));
		},
		0.0,
		2.0 * pi,
		-pi,
		pi);
	expectAreaUniform(
		"helicoid",
		[](const Vector3d& p) {
			const double v = p.z() / 0.5;
			return p.x() * std::cos(v) + p.y() * std::sin(v);
		},
		[](double v, double u) { return Vector3d(u * std::cos(v), u * std::sin(v), 0.5 * v); },
		-pi,
		pi,
		-1.0,
		1.0);
	expectAreaUniform(
		"ellipsoid",
		[](const Vector3d& p) { return std::acos(std::clamp(p.z() / 0.5, -1.0, 1.0)); },
		[](double u, double v) {
			return Vector3d(
				std::sin(v) * std::cos(u), 0.7 * std::sin(v) * std::sin(u), 0.5 * std::cos(v));
		},
		0.0,
		2.0 * pi,
		0.0,
		pi);
}

// Gauss and Bonnet, with the area known: the mean of k1 k2 over area-uniform samples times the area is
// 2 pi chi.
TEST(AnalyticSurfaces, TotalCurvatureIsTheEulerCharacteristic)
{
	const std::vector<std::pair<std::string, double>> areas = {
		{"torus", 4.0 * pi * pi * 0.4}, {"sphere", 4.0 * pi}, {"capsule", 2.0 * pi}};
	for (const auto& [name, area] : areas) {
		const SampleCloud c     = cleanCloud(name, 40000);
		const double      total = c.k1.dot(c.k2) / 40000.0 * area;
		EXPECT_NEAR(total / (2.0 * pi), surface(name).eulerCharacteristic(), 0.05) << name;
	}
}

// The same where no formula gives the area: the shell within h of the surface has the volume
// 2 h area (1 + h^2 / 3 times the mean of k1 k2).
TEST(AnalyticSurfaces, TotalCurvatureOfTheDoubleTorusIsThatOfGenusTwo)
{
	constexpr double          h      = 0.03;
	constexpr int             points = 60000;
	const AnalyticSurface&    shape  = surface("double_torus");
	const Eigen::AlignedBox3d box    = shape.boundingBox();
	const Vector3d            margin = Vector3d::Constant(h);
	const Eigen::AlignedBox3d around(box.min() - margin, box.max() + margin);
	Random                    random(3, 0);
	int                       near = 0;
	for (int i = 0; i < points; ++i) {
		const Vector3d share(random.uniform(), random.uniform(), random.uniform());
		const Vector3d p = around.min() + around.sizes().cwiseProduct(share);
		near += (shape.project(p) - p).norm() < h;
	}
	const SampleCloud c     = cleanCloud("double_torus", 40000);
	const double      mean  = c.k1.dot(c.k2) / 40000.0;
	const double      shell = around.volume() * near / points;
	const double      area  = shell / (2.0 * h) / (1.0 + h * h / 3.0 * mean);
	EXPECT_NEAR(mean * area / (2.0 * pi), shape.eulerCharacteristic(), 0.2);
}

// Every part of the surface by itself, so that a sampler that prefers a side cannot pass.
TEST(AnalyticSurfaces, TheDoubleTorusIsSampledSymmetrically)
{
	std::vector<int>  counts(8, 0);
	const SampleCloud c = cleanCloud("double_torus", 40000);
	for (Eigen::Index i = 0; i < c.positions.cols(); ++i)
		++counts
			[(c.positions(0, i) > 0.0) + 2 * (c.positions(1, i) > 0.0) +
		     4 * (c.positions(2, i) > 0.0)];
	// 7 degrees of freedom, probability 0.001
	EXPECT_LT(chiSquare(counts, std::vector<double>(8, 1.0)), 24.3);
}

TEST(AnalyticSurfaces, RegularCloudsOfThePapersHaveTheirSizes)
{
	SampleRequest request;
	request.regular = true;
	request.points  = 1575;
	EXPECT_EQ(generate(request).positions.cols(), 63 * 25);
	request.surface = "cube";
	request.points  = 600;
	EXPECT_EQ(generate(request).positions.cols(), 600);
}

TEST(AnalyticSurfaces, RimDistanceIsZeroOnTheRimAndInfiniteWithoutOne)
{
	EXPECT_NEAR(surface("cylinder").rimDistance({0.5, 0.0, 1.0}), 0.0, 1e-12);
	EXPECT_NEAR(surface("helicoid").rimDistance({1.0, 0.0, 0.0}), 0.0, 1e-12);
	EXPECT_NEAR(surface("helicoid").rimDistance({0.0, 0.0, 0.5 * pi}), 0.0, 1e-12);
	EXPECT_NEAR(surface("plane").rimDistance({0.2, -0.1, 0.0}), 0.3, 1e-12);
	EXPECT_NEAR(surface("bent_sheet").rimDistance({0.5, 0.0, -0.5}), 0.0, 1e-12);
	EXPECT_TRUE(std::isinf(surface("torus").rimDistance({1.4, 0.0, 0.0})));
	EXPECT_NEAR(surface("cube").featureDistance({0.5, 0.3, 0.1}), 0.2, 1e-12);
	EXPECT_NEAR(surface("capped_cylinder").featureDistance({0.5, 0.0, 0.3}), 0.2, 1e-12);
	EXPECT_NEAR(surface("capped_cylinder").featureDistance({0.3, 0.0, 0.5}), 0.2, 1e-12);
	EXPECT_NEAR(surface("l_block").featureDistance({0.0, 0.1, 0.0}), 0.1, 1e-12);
	EXPECT_NEAR(surface("l_block").featureDistance({-0.1, -0.1, 0.25}), std::sqrt(0.02), 1e-12);
	EXPECT_NEAR(surface("capsule").featureDistance({0.5, 0.0, 0.2}), 0.3, 1e-12);
}

TEST(AnalyticSurfaces, SenselessRequestsAreRefused)
{
	EXPECT_THROW(surface("klein_bottle"), std::invalid_argument);
	const auto refused = [](auto change) {
		SampleRequest request;
		change(request);
		EXPECT_THROW(generate(request), std::invalid_argument);
	};
	refused([](SampleRequest& r) { r.points = 0; });
	refused([](SampleRequest& r) { r.noise = -0.1; });
	refused([](SampleRequest& r) { r.farOutliers = 1.0; });
	refused([](SampleRequest& r) { r.nearOutliers = std::nan(""); });
	refused([](SampleRequest& r) { r.surface = ""; });
}
