// Seeded clouds: points on a surface, noise, far outliers and clusters of outliers near the surface.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_families.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "analytic_surfaces.h"

namespace curvature_lines::samples {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

enum Stream : std::uint64_t { PointStream, NoiseStream, FarStream, NearStream, OrderStream };

// The numbers of the papers' experiments, as our reference measurements read them.
constexpr double farBoxScale      = 1.2;
constexpr int    clusterSize      = 12;
constexpr double clusterOffset[2] = {3.0, 8.0}; // noise units
constexpr double clusterSpread    = 0.7;        // noise units
// of the diagonal, so that clean clouds have outliers too
constexpr double smallestNoiseUnit = 0.0025;
// of the diagonal: outliers of a plane must leave it
constexpr double thinnestBox = 0.2;

// splitmix64 (Steele et al. 2014), to spread neighbouring seeds over the whole range.
std::uint64_t spread(std::uint64_t x)
{
	x += 0x9e3779b97f4a7c15ull;
	x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
	x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
	return x ^ (x >> 31);
}

void check(const SampleRequest& request)
{
	if (request.points < 1)
		throw std::invalid_argument("a sample cloud needs at least one point");
	if (!(request.noise >= 0.0) || !(request.farOutliers >= 0.0) || !(request.nearOutliers >= 0.0))
		throw std::invalid_argument("noise and outlier shares cannot be negative");
	if (request.farOutliers >= 1.0 || request.nearOutliers >= 1.0)
		throw std::invalid_argument("an outlier share must be below 1");
}

// How many outliers make up `share` of inliers and outliers together.
int outlierCount(double share, Eigen::Index inliers)
{
	return static_cast<int>(std::lround(share * inliers / (1.0 - share)));
}

Matrix3Xd farOutliers(const AnalyticSurface& surface, int count, Random random)
{
	const AlignedBox3d box    = surface.boundingBox();
	const Vector3d     center = box.center();
	const Vector3d     half =
		0.5 * farBoxScale * box.sizes().cwiseMax(thinnestBox * surface.diagonal());
	Matrix3Xd points(3, count);
	for (int i = 0; i < count; ++i)
		for (int axis = 0; axis < 3; ++axis)
			points(axis, i) = center[axis] + random.uniform(-half[axis], half[axis]);
	return points;
}

Matrix3Xd nearOutliers(const AnalyticSurface& surface, int count, double noise, Random random)
{
	const double unit = std::max(noise, smallestNoiseUnit) * surface.diagonal();
	Matrix3Xd    points(3, count);
	Vector3d     center = Vector3d::Zero();
	for (int i = 0; i < count; ++i) {
		if (i % clusterSize == 0) {
			const Vector3d foot   = surface.sample(random);
			const double   side   = random.index(2) == 0 ? 1.0 : -1.0;
			const double   offset = unit * random.uniform(clusterOffset[0], clusterOffset[1]);
			center                = foot + side * offset * surface.frame(foot).normal;
		}
		points.col(i) = center + clusterSpread * unit * random.normal3();
	}
	return points;
}

std::vector<Eigen::Index> shuffledOrder(Eigen::Index count, Random random)
{
	std::vector<Eigen::Index> order(count);
	std::iota(order.begin(), order.end(), 0);
	for (Eigen::Index i = count - 1; i > 0; --i)
		std::swap(order[i], order[random.index(i + 1)]);
	return order;
}

} // namespace

Random::Random(std::uint64_t seed, std::uint64_t stream) : m_engine(spread(spread(seed) + stream))
{
}

double Random::uniform(double from, double to)
{
	return from + (to - from) * (static_cast<double>(m_engine() >> 11) * 0x1p-53);
}

double Random::normal()
{
	// Box and Muller; the second value is not kept, so that the state is the engine's alone.
	const double u = 1.0 - uniform(), v = uniform();
	return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * detail::pi * v);
}

Vector3d Random::normal3()
{
	const double x = normal(), y = normal();
	return {x, y, normal()};
}

std::size_t Random::index(std::size_t count)
{
	return static_cast<std::size_t>(uniform() * static_cast<double>(count));
}

SampleCloud generate(const SampleRequest& request)
{
	check(request);
	const AnalyticSurface& shape = surface(request.surface);

	Matrix3Xd inliers;
	if (request.regular) {
		inliers = shape.grid(request.points);
	}
	else {
		Random random(request.seed, PointStream);
		inliers.resize(3, request.points);
		for (Eigen::Index i = 0; i < inliers.cols(); ++i)
			inliers.col(i) = shape.sample(random);
	}
	if (request.noise > 0.0) {
		Random random(request.seed, NoiseStream);
		for (Eigen::Index i = 0; i < inliers.cols(); ++i)
			inliers.col(i) += request.noise * shape.diagonal() * random.normal3();
	}

	const int       farCount  = outlierCount(request.farOutliers, inliers.cols());
	const int       nearCount = outlierCount(request.nearOutliers, inliers.cols());
	Matrix3Xd       all(3, inliers.cols() + farCount + nearCount);
	Eigen::VectorXi label(all.cols());
	all << inliers, farOutliers(shape, farCount, Random(request.seed, FarStream)),
		nearOutliers(shape, nearCount, request.noise, Random(request.seed, NearStream));
	label << Eigen::VectorXi::Constant(inliers.cols(), Inlier),
		Eigen::VectorXi::Constant(farCount, FarOutlier),
		Eigen::VectorXi::Constant(nearCount, NearOutlier);

	SampleCloud cloud;
	cloud.positions = std::move(all);
	cloud.label     = std::move(label);
	if (farCount + nearCount > 0) {
		const auto order = shuffledOrder(cloud.label.size(), Random(request.seed, OrderStream));
		cloud.positions  = Matrix3Xd(cloud.positions(Eigen::all, order));
		cloud.label      = Eigen::VectorXi(cloud.label(order));
	}
	static_cast<GroundTruth&>(cloud) = groundTruth(shape, cloud.positions);
	return cloud;
}

} // namespace curvature_lines::samples
