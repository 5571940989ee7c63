// Counts of near pairs tell whether there are duplicates, and how far they are from each other.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "near_duplicates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include <Eigen/Core>

#include "cloud_index.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "spatial_order.h"

namespace curvature_lines {

namespace {

// Distances are in local spacings. Of pairs that are `farthest` apart none is found by chance more often than one that
// is half as far, so that ladders of `perOctave` steps to the half hold all answers.
constexpr double      farthest  = 0.3;
constexpr std::size_t perOctave = 2, octaves = 7;
constexpr Index       judges = 5000; // points whose neighbours are counted
// Share of the points that are in a pair, and pairs counted, below which the cloud is left as it is.
constexpr double fewestShare = 0.05, fewestPairs = 10.0;
// Pairs within a distance, over those from there to twice the distance: a third in a random sample of a surface, 1 on
// lines. And over those that a random sample has within the distance.
constexpr double minContrast = 2.0, minExcess = 3.0;
// Of a sum of unit normals that still has a direction.
constexpr double shortestNormal = 1e-6;

// Pairs nearer than each rung of a ladder that falls from twice `farthest` on, per point.
constexpr std::size_t rungs = perOctave * (octaves + 1);
using PairCounts            = std::array<double, rungs>;

double rung(std::size_t k)
{
	return 2.0 * farthest * std::pow(0.5, double(k) / double(perOctave));
}

PairCounts countPairs(const CloudIndex& index, const std::vector<Index>& points)
{
	const Eigen::Matrix3Xd&             positions = index.arrangedPositions();
	const std::vector<double>&          spacing   = index.spacing();
	std::vector<std::array<int, rungs>> counts(points.size());
	parallelFor(static_cast<Index>(points.size()), {}, [&](Index t) {
		const Index           i = points[t];
		const Eigen::Vector3d p = positions.col(i);
		counts[t].fill(0);
		std::vector<Index> near;
		index.arrangedSearch().within(p, rung(0) * spacing[i], near);
		for (const Index j : near) {
			const double distance = (positions.col(j) - p).norm() / spacing[i];
			for (std::size_t k = 0; j != i && k < rungs && distance < rung(k); ++k)
				++counts[t][k];
		}
	});
	PairCounts sum{};
	for (const auto& own : counts)
		for (std::size_t k = 0; k < rungs; ++k)
			sum[k] += own[k] / double(points.size());
	return sum;
}

// The distance that tells duplicates from others best; 0 where none does.
double reachOfDuplicates(const CloudIndex& index, const Progress& progress)
{
	index.spacing(progress);
	const std::vector<Index> points = index.order().sample(judges);
	const PairCounts         within = countPairs(index, points);
	const double             fewest = std::max(fewestShare, fewestPairs / double(points.size()));
	double                   best = 0.0, reach = 0.0;
	for (std::size_t k = perOctave; k < within.size(); ++k) {
		const double near = within[k], beyond = within[k - perOctave] - near;
		const double byChance = EIGEN_PI * rung(k) * rung(k);
		if (near < fewest || near < minContrast * beyond || near < minExcess * byChance)
			continue;
		// Pairs beyond are duplicates that this reach misses, or three times the others that it takes for such.
		if (near - beyond >= best) {
			best  = near - beyond;
			reach = rung(k);
		}
	}
	return reach;
}

// Each takes those within its radius that none before it has taken, in the random order of the index.
void group(const CloudIndex& index, NearDuplicates& result)
{
	const SpatialOrder&     order   = index.order();
	const Eigen::Matrix3Xd& normals = index.gateNormals();
	std::vector<double>     radius(index.size());
	for (Index place = 0; place < index.size(); ++place)
		radius[order.source[place]] = result.reach * index.spacing()[place];
	result.groups = 0;
	result.group.assign(index.size(), -1);
	std::vector<Index> near;
	for (const Index first : index.shuffled()) {
		if (result.group[first] >= 0)
			continue;
		result.group[first] = result.groups;
		index.search().within(index.cloud().positions.col(first), radius[first], near);
		for (const Index j : near)
			if (result.group[j] < 0 && normals.col(first).dot(normals.col(j)) > 0.0)
				result.group[j] = result.groups;
		++result.groups;
	}
}

} // namespace

NearDuplicates nearDuplicates(const CloudIndex& index, const Progress& progress)
{
	NearDuplicates result;
	if (index.size() > 1)
		result.reach = reachOfDuplicates(index, progress);
	if (result.reach > 0.0) {
		group(index, result);
		return result;
	}
	result.groups = index.size();
	result.group.resize(index.size());
	std::iota(result.group.begin(), result.group.end(), 0);
	return result;
}

PointCloud meanPoints(const CloudIndex& index, const NearDuplicates& duplicates)
{
	const PointCloud& cloud = index.cloud();
	PointCloud        mean{
        Eigen::Matrix3Xd::Zero(3, duplicates.groups), Eigen::Matrix3Xd::Zero(3, duplicates.groups)};
	Eigen::Matrix3Xd    first(3, duplicates.groups);
	std::vector<double> count(duplicates.groups, 0.0);
	for (const Index i : index.shuffled()) {
		const Index g = duplicates.group[i];
		if (count[g] == 0.0)
			first.col(g) = cloud.normals.col(i);
		mean.positions.col(g) += cloud.positions.col(i);
		mean.normals.col(g) += cloud.normals.col(i);
		count[g] += 1.0;
	}
	for (Index g = 0; g < duplicates.groups; ++g) {
		mean.positions.col(g) /= count[g];
		if (mean.normals.col(g).norm() > shortestNormal)
			mean.normals.col(g).normalize();
		else
			mean.normals.col(g) = first.col(g);
	}
	return mean;
}

PointCloud placedAroundMeans(
	const PointCloud&     cloud,
	const NearDuplicates& duplicates,
	const PointCloud&     before,
	const PointCloud&     after)
{
	PointCloud moved = cloud;
	for (Index i = 0; i < cloud.size(); ++i) {
		const Index           g      = duplicates.group[i];
		const Eigen::Vector3d normal = after.normals.col(g);
		const Eigen::Vector3d offset = cloud.positions.col(i) - before.positions.col(g);
		moved.positions.col(i) = after.positions.col(g) + (offset - normal.dot(offset) * normal);
		moved.normals.col(i)   = normal;
	}
	return moved;
}

} // namespace curvature_lines
