// Umbilic flags, regions and their directions (A09 section 5.1, "umbilical regions"; R07 section 5).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "umbilics.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "curvature_field.h"
#include "disjoint_sets.h"
#include "neighborhoods.h"
#include "point_cloud.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// Constants that A09 and R07 do not give, by experiment (benchmarks/lines.py: capsule, sphere, cube, helicoid).
constexpr double maxNormalCosine = 0.5; // 60 degrees: beyond, two points are on different faces
// A shorter projected axis is no direction (poles of a sphere).
constexpr double minProjection = 0.15;
constexpr double maxAxisCosine = 0.9;  // an axis closer to a normal gives way to the second one
constexpr double flatTurn      = 0.02; // radians over one operating region that count as flat
// Ratio of the variances along the two axes above which these are due to the sampling.
constexpr double degenerateAxes = 0.7;
// Of the fourth moment: 0 for a disk, 0.43 for a square (derived).
constexpr double minFourfold = 0.2;
// 35 degrees from point to point; about a singular one there are 60 or more.
constexpr double continuedCosine = 0.82;
// Points around a region over the root of those in it: a disk has 3.5 (derived), half of one at a rim 2.5.
constexpr double leastBorder = 2.0;
constexpr double minFlatness = 0.9; // length of the mean normal of a region that is nearly flat

// A09: ratio above the threshold. The ratio is signed, so that minimal surfaces (k1 = -k2) are not
// umbilic; the other two tests see what a ratio of noisy or vanishing numbers cannot.
bool isUmbilic(double k1, double k2, double error, double spacing, const UmbilicOptions& options)
{
	const double large = std::abs(k1) >= std::abs(k2) ? k1 : k2;
	const double small = std::abs(k1) >= std::abs(k2) ? k2 : k1;
	if (std::abs(large) < flatTurn / (3.0 * std::max(spacing, 1e-300)) + 2.0 * error)
		return true;
	return small / large > options.ratio || std::abs(k1 - k2) < options.errors * error;
}

bool sameFace(const PointCloud& cloud, Index i, Index j)
{
	return cloud.normals.col(i).dot(cloud.normals.col(j)) > maxNormalCosine;
}

// Links of the minimum neighbourhoods that stay on one smooth face; mutual ones come twice.
template<class Visit>
void forEachLink(const PointCloud& cloud, const MinimumNeighborhoods& minimum, const Visit& visit)
{
	for (Index i = 0; i < cloud.size(); ++i)
		for (const Index j : minimum.neighbors[i])
			if (sameFace(cloud, i, j))
				visit(i, j);
}

std::vector<char> medianFiltered(
	const std::vector<char>& flags, const PointCloud& cloud, const MinimumNeighborhoods& minimum)
{
	std::vector<char> filtered(flags.size());
	for (Index i = 0; i < cloud.size(); ++i) {
		int votes = flags[i] ? 1 : -1;
		for (const Index j : minimum.neighbors[i])
			if (sameFace(cloud, i, j))
				votes += flags[j] ? 1 : -1;
		filtered[i] = votes == 0 ? flags[i] : votes > 0;
	}
	return filtered;
}

// Numbers the components of umbilic points, those of at least minRegion points, by their first
// point.
void labelRegions(
	const PointCloud&           cloud,
	const MinimumNeighborhoods& minimum,
	Index                       minRegion,
	UmbilicRegions&             result)
{
	const Index  n = cloud.size();
	DisjointSets sets(n);
	forEachLink(cloud, minimum, [&](Index i, Index j) {
		if (result.umbilic[i] && result.umbilic[j])
			sets.join(i, j);
	});
	std::vector<Index> size(n, 0), label(n, -1);
	for (Index i = 0; i < n; ++i)
		if (result.umbilic[i])
			++size[sets.find(i)];
	result.region.assign(n, -1);
	result.regions = 0;
	for (Index i = 0; i < n; ++i) {
		const Index root = sets.find(i);
		if (!result.umbilic[i] || size[root] < minRegion)
			continue;
		if (label[root] < 0)
			label[root] = result.regions++;
		result.region[i] = label[root];
	}
}

struct Region {
	std::vector<Index> points;       // umbilic, by index
	std::vector<Index> surroundings; // their non-umbilic neighbours, by index
};

std::vector<Region> gatherRegions(
	const PointCloud& cloud, const MinimumNeighborhoods& minimum, const UmbilicRegions& labels)
{
	std::vector<Region> regions(labels.regions);
	for (Index i = 0; i < cloud.size(); ++i)
		if (labels.region[i] >= 0)
			regions[labels.region[i]].points.push_back(i);
	const auto surround = [&](Index inside, Index outside) {
		const Index id = labels.region[inside];
		if (id >= 0 && !labels.umbilic[outside])
			regions[id].surroundings.push_back(outside);
	};
	forEachLink(cloud, minimum, [&](Index i, Index j) {
		surround(i, j);
		surround(j, i);
	});
	for (Region& region : regions) {
		auto& s = region.surroundings;
		std::sort(s.begin(), s.end());
		s.erase(std::unique(s.begin(), s.end()), s.end());
	}
	return regions;
}

// Clears the flags of regions that the directions around go on into. False: there is none.
bool clearContinued(
	const PointCloud&           cloud,
	const CurvatureField&       field,
	const MinimumNeighborhoods& minimum,
	UmbilicRegions&             labels)
{
	const std::vector<Region> regions = gatherRegions(cloud, minimum, labels);
	std::vector<char>         turns(regions.size(), 0);
	forEachLink(cloud, minimum, [&](Index i, Index j) {
		if (std::abs(field.d1.col(i).dot(field.d1.col(j))) < continuedCosine)
			for (const Index r : {labels.region[i], labels.region[j]})
				if (r >= 0)
					turns[r] = 1;
	});
	bool any = false;
	for (std::size_t r = 0; r < regions.size(); ++r) {
		const Region& region = regions[r];
		if (turns[r] ||
		    region.surroundings.size() < leastBorder * std::sqrt(double(region.points.size())))
			continue;
		any = true;
		for (const Index i : region.points)
			labels.umbilic[i] = 0;
	}
	return any;
}

// Principal axes of a region and its surroundings, by decreasing variance.
struct Axes {
	Eigen::Matrix3d directions;
	Vector3d        variances;
};

Axes principalAxes(const PointCloud& cloud, const Region& region)
{
	Vector3d        mean    = Vector3d::Zero();
	Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
	double          count   = 0.0;
	const auto      both    = {&region.points, &region.surroundings};
	for (const auto* points : both)
		for (const Index i : *points) {
			mean += cloud.positions.col(i);
			count += 1.0;
		}
	mean /= count;
	for (const auto* points : both)
		for (const Index i : *points) {
			const Vector3d d = cloud.positions.col(i) - mean;
			scatter += d * d.transpose() / count;
		}
	const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
	return {solver.eigenvectors().rowwise().reverse(), solver.eigenvalues().reverse()};
}

double smallestProjection(const PointCloud& cloud, const Region& region, const Vector3d& axis)
{
	double smallest = 1.0;
	for (const Index i : region.points)
		smallest = std::min(smallest, cloud.normals.col(i).cross(axis).norm());
	return smallest;
}

// A square face has no long axis, and PCA would turn the lines on it at random. The next moment
// with axes at right angles is that of (x + iy)^4: it points away from the sides of a square and
// vanishes on a disk.
bool fourfoldAxis(const PointCloud& cloud, const Region& region, const Axes& axes, Vector3d& axis)
{
	if (axes.variances[1] < degenerateAxes * axes.variances[0])
		return false;
	Vector3d mean = Vector3d::Zero(), normal = Vector3d::Zero();
	for (const Index i : region.points) {
		mean += cloud.positions.col(i) / double(region.points.size());
		normal += cloud.normals.col(i) / double(region.points.size());
	}
	if (normal.norm() < minFlatness)
		return false;
	const TangentFrame   frame(normal.normalized());
	std::complex<double> moment = 0.0;
	double               total  = 0.0;
	for (const Index i : region.points) {
		const Eigen::Vector2d      d = frame.toPlane(cloud.positions.col(i) - mean);
		const std::complex<double> z(d.x(), d.y());
		moment += z * z * z * z;
		total += d.squaredNorm() * d.squaredNorm();
	}
	if (!(std::abs(moment) > minFourfold * total))
		return false;
	const double angle = 0.25 * std::arg(-moment);
	axis               = frame.toSpace({std::cos(angle), std::sin(angle)});
	return true;
}

// The axis whose projections to the region's tangent planes serve as d1. One axis for a whole
// region keeps its directions parallel; n x d1 is the other direction.
Vector3d regionAxis(const PointCloud& cloud, const Region& region)
{
	const Axes axes = principalAxes(cloud, region);
	Vector3d   axis = axes.directions.col(0);
	if (fourfoldAxis(cloud, region, axes, axis))
		return axis;
	const double first = smallestProjection(cloud, region, axis);
	const bool   steep = first < std::sqrt(1.0 - maxAxisCosine * maxAxisCosine);
	if (steep && smallestProjection(cloud, region, axes.directions.col(1)) > first)
		axis = axes.directions.col(1);
	return axis;
}

void setDirections(
	const PointCloud& cloud, const Region& region, const Vector3d& axis, UmbilicRegions& result)
{
	for (const Index i : region.points) {
		const Vector3d n         = cloud.normals.col(i);
		const Vector3d projected = axis - n.dot(axis) * n;
		const double   length    = projected.norm();
		if (length < minProjection)
			result.singular[i] = 1;
		if (length > 1e-6) { // else the field's own directions, which are at least a frame, stay
			result.d1.col(i) = projected / length;
			result.d2.col(i) = n.cross(result.d1.col(i));
		}
	}
}

} // namespace

UmbilicRegions findUmbilics(
	const PointCloud&           cloud,
	const CurvatureField&       field,
	const MinimumNeighborhoods& minimum,
	const UmbilicOptions&       options)
{
	const Index       n = cloud.size();
	std::vector<char> flags(n);
	for (Index i = 0; i < n; ++i)
		flags[i] = isUmbilic(field.k1[i], field.k2[i], field.error[i], minimum.spacing[i], options);

	UmbilicRegions result;
	result.umbilic = medianFiltered(flags, cloud, minimum);
	result.d1      = field.d1;
	result.d2      = field.d2;
	result.singular.assign(n, 0);
	labelRegions(cloud, minimum, options.minRegion, result);
	if (options.smoothed && clearContinued(cloud, field, minimum, result))
		labelRegions(cloud, minimum, options.minRegion, result);
	for (const Region& region : gatherRegions(cloud, minimum, result))
		setDirections(cloud, region, regionAxis(cloud, region), result);
	return result;
}

} // namespace curvature_lines
