// Six slices of the tangent plane around every rejected point, as those of the minimum neighbourhood (A09 section 3).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_restoration.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "neighborhoods.h"
#include "outlier_voter.h"
#include "point_cloud.h"
#include "progress.h"
#include "quantile.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

constexpr char stage[] = "Restoring sparse surfaces";
constexpr int  slices  = 6;
// The spacing around a point is the median of so many accepted points next to it.
constexpr Index spacingPoints = 12;
// They are looked for among so many points, then four times and sixteen times as many; a point with none among them is far from the surface.
constexpr Index fewestAsked = 24, mostAsked = 384;
// In these spacings: the scaffold bridges gaps of so many; and what is nearer on average is no gap.
constexpr double farthest = 8.0, sparse = 1.5;
// Heights of neighbours over their distances (tangent of 11 degrees), cosines of their normals to that of the point: a
// point beside a sharp border has an edge of both faces as its neighbour.
constexpr double flat = 0.2, sameSide = 0.3;
// Mean of these cosines: those around the mouth of a cup are alike low.
constexpr double sameSideMean = 0.6;
// Slices that hold such a neighbour, at least.
constexpr int fewestSlices = 5;

// Median spacing of the accepted points that are nearest to p; 0: there is none.
double spacingAround(const VoterCloud& cloud, const std::vector<char>& rejected, const Vector3d& p)
{
	std::vector<double> spacings;
	for (Index asked = fewestAsked; spacings.empty() && asked <= mostAsked; asked *= 4) {
		for (const Index j : cloud.all.nearest(p, asked))
			if (!rejected[j] && static_cast<Index>(spacings.size()) < spacingPoints)
				spacings.push_back(spacingOfCrowd * cloud.crowding[j]);
	}
	return spacings.empty() ? 0.0 : medianInPlace(spacings);
}

// `spacing`: of the accepted points around; `surface`: of every point, whether it counts as one of the surface.
bool isSurrounded(
	const VoterCloud&        cloud,
	const Eigen::Matrix3Xd&  normals,
	const std::vector<char>& surface,
	double                   spacing,
	Index                    i)
{
	const Vector3d            p = cloud.positions.col(i), n = normals.col(i);
	const TangentFrame        frame(n);
	std::array<Index, slices> closest;
	closest.fill(-1);
	double first = 0.0; // direction of the closest of all, in the middle of its slice
	bool   any   = false;
	for (const Index j : cloud.all.within(p, farthest * spacing)) {
		if (j == i || !surface[j] || !(normals.col(j).dot(n) > sameSide))
			continue;
		const Eigen::Vector2d d = frame.toPlane(cloud.positions.col(j) - p);
		if (!(d.squaredNorm() > 0.0))
			return false; // straight above another, or at its place
		const double angle = std::atan2(d.y(), d.x());
		if (!any)
			first = angle;
		any                = true;
		const double turn  = (angle - first) / (2.0 * EIGEN_PI) + 0.5 / slices;
		const int    slice = static_cast<int>(slices * (turn - std::floor(turn))) % slices;
		if (closest[slice] < 0)
			closest[slice] = j;
	}
	int    level    = 0;
	double distance = 0.0, cosines = 0.0, count = 0.0;
	for (const Index j : closest) {
		if (j < 0)
			continue;
		const Vector3d d = cloud.positions.col(j) - p;
		level += std::abs(d.dot(n)) <= flat * d.norm();
		distance += d.norm();
		cosines += normals.col(j).dot(n);
		++count;
	}
	return level >= fewestSlices && distance >= sparse * spacing * count &&
	       cosines >= sameSideMean * count;
}

struct Candidate {
	Index  point;
	double spacing;
};

} // namespace

// All candidates count as points of the surface first; round by round those go that have not such points all around. All
// are judged on the state before, so that their order does not matter. A patch beside the surface is eaten up from its
// edge.
void restoreSparseSurfaces(
	const VoterCloud&        cloud,
	const Eigen::Matrix3Xd&  normals,
	const std::vector<char>& excluded,
	std::vector<char>&       rejected,
	const Progress&          progress)
{
	std::vector<char>      surface(rejected.size());
	std::vector<Candidate> candidates;
	for (std::size_t i = 0; i < rejected.size(); ++i) {
		const auto point = static_cast<Index>(i);
		surface[i]       = !rejected[i];
		if (rejected[i] && !excluded[i] && normals.col(point).squaredNorm() > 0.0)
			candidates.push_back({point, 0.0});
	}
	parallelFor(static_cast<Index>(candidates.size()), progress.sub(0.0, 0.5, stage), [&](Index k) {
		candidates[k].spacing =
			spacingAround(cloud, rejected, cloud.positions.col(candidates[k].point));
	});
	for (const Candidate& candidate : candidates)
		surface[candidate.point] = candidate.spacing > 0.0;
	double done = 0.5;
	for (bool changed = true; changed;) {
		std::vector<char> stays(candidates.size(), 0);
		// how many rounds there are is not known: each gets half of what is left
		const double then = 0.5 * (done + 1.0);
		parallelFor(
			static_cast<Index>(candidates.size()), progress.sub(done, then, stage), [&](Index k) {
				stays[k] = surface[candidates[k].point] &&
			               isSurrounded(
							   cloud, normals, surface, candidates[k].spacing, candidates[k].point);
			});
		done = then;
		std::vector<Candidate> left;
		for (std::size_t k = 0; k < candidates.size(); ++k)
			if (stays[k])
				left.push_back(candidates[k]);
			else
				surface[candidates[k].point] = 0;
		changed    = left.size() < candidates.size();
		candidates = std::move(left);
	}
	for (const Candidate& candidate : candidates)
		rejected[candidate.point] = 0;
}

} // namespace curvature_lines
