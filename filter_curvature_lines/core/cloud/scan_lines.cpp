// Principal components of growing neighbourhoods: as long as they see one line, the second is small.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "scan_lines.h"

#include <algorithm>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "quantile.h"
#include "spatial_order.h"

namespace curvature_lines {

namespace {

constexpr const char* stage = "Measuring the cloud";

// Of the neighbours: the first number, and where the search for the next line ends.
constexpr Index fewest = 8, most = 600;
// Second principal moment over the first: at most oneLine of points on a line, and more than twoLines of several. By
// experiment: 2 of 1000 neighbourhoods of nine random points on a plane are so thin.
constexpr double oneLine = 0.05, twoLines = 0.1;
// Lines are looked for at one of so many points; a point's gap is the median of those around it.
constexpr Index thinning = 8, averaged = 32;
// Share of these places below which the cloud has no lines.
constexpr double fewestPlaces = 0.05;

struct Line {
	double          gap       = 0.0; // 0: there is none
	Eigen::Vector3d direction = Eigen::Vector3d::Zero();
};

Line lineAt(
	const Eigen::Matrix3Xd& positions, const NeighborSearch& search, const Eigen::Vector3d& p)
{
	Line line;
	for (Index k = fewest; k <= most && k < positions.cols(); k += k / 2) {
		const std::vector<Index> near    = search.nearest(p, k + 1);
		Eigen::Vector3d          sum     = Eigen::Vector3d::Zero();
		Eigen::Matrix3d          moments = Eigen::Matrix3d::Zero();
		for (const Index j : near) {
			const Eigen::Vector3d d = positions.col(j) - p;
			sum += d;
			moments += d * d.transpose();
		}
		moments -= sum * sum.transpose() / double(near.size());
		Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
		axes.computeDirect(moments);
		const double thinness = axes.eigenvalues()[1] / axes.eigenvalues()[2];
		if (k == fewest && !(thinness <= oneLine))
			return {};
		if (thinness <= twoLines) {
			line.direction = axes.eigenvectors().col(2);
			continue;
		}
		// The points of the next lines are in the farther half.
		std::vector<double> across;
		for (const Index j : near) {
			const Eigen::Vector3d d = positions.col(j) - p;
			across.push_back((d - d.dot(line.direction) * line.direction).norm());
		}
		const double middle = 0.5 * *std::max_element(across.begin(), across.end());
		across.erase(
			std::remove_if(across.begin(), across.end(), [&](double a) { return a < middle; }),
			across.end());
		line.gap = quantileInPlace(across, 0.5);
		return line;
	}
	return {};
}

} // namespace

ScanLines scanLines(
	const Eigen::Matrix3Xd& positions,
	const NeighborSearch&   search,
	const SpatialOrder&     order,
	const Progress&         progress)
{
	const auto               n      = static_cast<Index>(positions.cols());
	const std::vector<Index> sample = order.sample(std::max(std::min(n, averaged), n / thinning));
	std::vector<Line>        lines(sample.size());
	parallelFor(static_cast<Index>(sample.size()), progress.sub(0.0, 0.5, stage), [&](Index s) {
		lines[s] = lineAt(positions, search, positions.col(sample[s]));
	});
	const auto found =
		std::count_if(lines.begin(), lines.end(), [](const Line& l) { return l.gap > 0.0; });
	ScanLines result;
	if (double(found) <= fewestPlaces * double(lines.size()))
		return result;
	result.gap.resize(n);
	result.direction.resize(3, n);
	const Eigen::Matrix3Xd places = columnsOf(positions, sample);
	const NeighborSearch   around(places);
	parallelFor(n, progress.sub(0.5, 1.0, stage), [&](Index i) {
		std::vector<double> gaps;
		Eigen::Matrix3d     directions = Eigen::Matrix3d::Zero();
		for (const Index k : around.nearest(positions.col(i), averaged)) {
			gaps.push_back(lines[k].gap);
			directions += lines[k].direction * lines[k].direction.transpose();
		}
		Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
		axes.computeDirect(directions);
		result.gap[i]           = quantileInPlace(gaps, 0.5);
		result.direction.col(i) = axes.eigenvectors().col(2);
	});
	return result;
}

} // namespace curvature_lines
