// A fair sample of points, each against its nearest neighbours.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "normal_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Dense>

#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "shuffled_order.h"
#include "side_domains.h"

namespace curvature_lines {

namespace {

constexpr Index  sampleSize     = 2000;
constexpr Index  fewest         = 20;
constexpr Index  planeNeighbors = 25;
constexpr Index  pairNeighbors  = 8;
constexpr double clearPlane = 0.1; // variance across the plane over the smaller one in it, at most
constexpr double halfAngle  = 0.5; // cosine of 60 degrees

struct Verdict {
	bool  notUnit = false, clear = false, disagrees = false;
	Index pairs = 0, torn = 0;
};

} // namespace

NormalCheck checkNormals(const Eigen::Matrix3Xd& positions, const Eigen::Matrix3Xd& normals)
{
	std::vector<Index> usable;
	for (Index i = 0; i < static_cast<Index>(positions.cols()); ++i)
		if (positions.col(i).allFinite() && normals.col(i).allFinite() &&
		    !normals.col(i).isZero(0.0))
			usable.push_back(i);
	const auto  n = static_cast<Index>(usable.size());
	NormalCheck result;
	if (n < fewest)
		return result;
	const Eigen::Matrix3Xd points = columnsOf(positions, usable),
						   given  = columnsOf(normals, usable);
	const NeighborSearch search(points);
	std::vector<Index>   sample = shuffledOrder(points);
	sample.resize(std::min(n, sampleSize));
	std::vector<Verdict> verdicts(sample.size());
	const auto unit = [&](Index i) -> Eigen::Vector3d { return given.col(i).stableNormalized(); };
	parallelFor(static_cast<Index>(sample.size()), {}, [&](Index k) {
		const Index              i       = sample[k];
		const std::vector<Index> near    = search.nearest(points.col(i), planeNeighbors + 1);
		const Eigen::Matrix3Xd   around  = columnsOf(points, near);
		const Eigen::Matrix3Xd   centred = around.colwise() - around.rowwise().mean();
		const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(
			Eigen::Matrix3d(centred * centred.transpose()));
		const Eigen::Vector3d normal = unit(i);
		Verdict&              v      = verdicts[k];
		v.notUnit                    = std::abs(given.col(i).stableNorm() - 1.0) > 0.1;
		v.clear                      = axes.eigenvalues()[0] < clearPlane * axes.eigenvalues()[1];
		v.disagrees = v.clear && std::abs(normal.dot(axes.eigenvectors().col(0))) < halfAngle;
		for (std::size_t j = 0; j < std::min<std::size_t>(near.size(), pairNeighbors + 1); ++j) {
			const Eigen::Vector3d d = points.col(near[j]) - points.col(i), other = unit(near[j]);
			if (near[j] == i || !areOnOnePiece(d, normal, other))
				continue;
			++v.pairs;
			v.torn += normal.dot(other) < 0.0;
		}
	});
	double clear = 0.0, disagree = 0.0, pairs = 0.0, torn = 0.0;
	bool   equal = true;
	for (std::size_t k = 0; k < verdicts.size(); ++k) {
		const Verdict& v = verdicts[k];
		result.notUnit += double(v.notUnit);
		clear += double(v.clear);
		disagree += double(v.disagrees);
		pairs += double(v.pairs);
		torn += double(v.torn);
		equal = equal && unit(sample[k]).dot(unit(sample[0])) > 1.0 - 1e-9;
	}
	result.notUnit /= double(verdicts.size());
	result.disagreeing = clear > 0.0 ? disagree / clear : 0.0;
	result.torn        = pairs > 0.0 ? torn / pairs : 0.0;
	result.allEqual    = equal && result.disagreeing > 0.1;
	return result;
}

} // namespace curvature_lines
