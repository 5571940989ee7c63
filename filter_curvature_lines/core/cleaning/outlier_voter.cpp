// The points a voter is fitted to, and the extent of what it knows.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "outlier_voter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Dense>

#include "point_cloud.h"
#include "surface_patch.h"

namespace curvature_lines {

namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Where points are denser than usual only a share of them is taken, so that neither a dense cluster nor the dense side
// of a jump in density has the majority. Usual: the distance to the 6th neighbour is `denseness` times that of evenly
// spread points in the ball, or `denserThanCentre` times the median of the nearCentre points next to the centre, whichever
// is larger. By experiment; tests in outlier_rejection_test.
constexpr double denseness        = 0.6;
constexpr double denserThanCentre = 0.5;
constexpr Index  nearCentre       = 9;
// Of the points asked for; else a ball of up to largestBall times as many.
constexpr double fewestKept  = 0.8;
constexpr double largestBall = 4.0; // points, over those asked for
// Least scale of a fit, in spacings: what a quadric misses on an exact surface.
constexpr double minDeviation = 0.06;
constexpr double onSurface    = 3.0; // scales: points within are on the surface
// Of the points are on the surface, or there is no vote (as in fitPatchRobustly).
constexpr double minMajority = 0.35;
// Squared Mahalanobis distance from the points on the surface: for a uniform disk the rim is at 4, for a quarter of a
// disk the corner at 7.4. A little more than both.
constexpr double insideDistance2 = 4.5;
constexpr double rimDistance2    = 9.0;
// A robust quadric of n points takes lostDeviation / n of the deviation, and its prediction adds predictionVariance / n
// of a point's variance: both found by fits to planes with normally distributed noise.
constexpr double lostDeviation      = 9.5;
constexpr double predictionVariance = 6.0;

double crowdingAround(const VoterCloud& cloud, const std::vector<Index>& nearest)
{
	double      crowding[nearCentre];
	const Index n = std::min<Index>(nearCentre, static_cast<Index>(nearest.size()));
	for (Index k = 0; k < n; ++k)
		crowding[k] = cloud.crowding[cloud.active[nearest[k]]];
	std::nth_element(crowding, crowding + n / 2, crowding + n);
	return crowding[n / 2];
}

// The nearest points, where they are much denser than around only a sample of them: a dense cluster of
// outliers must not have the majority, nor the dense side of a jump in density. Returns their radius.
double evenNeighbors(
	const Vector3d& centre, Index count, const VoterCloud& cloud, std::vector<Index>& even)
{
	const double n     = cloud.positions.cols();
	Index        asked = count;
	for (int attempt = 0; attempt < 2; ++attempt) {
		const std::vector<Index> nearest = cloud.activeSearch.nearest(centre, asked);
		even.clear();
		if (nearest.empty())
			return 0.0;
		const double radius = (cloud.positions.col(cloud.active[nearest.back()]) - centre).norm();
		const double usual  = std::max(
            denseness * radius * std::sqrt(double(crowdSize) / double(nearest.size())),
            denserThanCentre * crowdingAround(cloud, nearest));
		for (const Index k : nearest) {
			const Index  i     = cloud.active[k];
			const double ratio = cloud.crowding[i] / usual;
			if (cloud.rank[i] < ratio * ratio * n)
				even.push_back(i);
		}
		if (double(even.size()) >= fewestKept * count || static_cast<Index>(nearest.size()) < asked)
			break;
		const double growth = double(asked) / std::max<double>(1.0, even.size());
		asked               = static_cast<Index>(count * std::min(growth, largestBall));
	}
	if (static_cast<Index>(even.size()) > count)
		even.resize(count);
	return even.empty() ? 0.0 : (cloud.positions.col(even.back()) - centre).norm();
}

// Mean and covariance in the tangent plane of the points on the surface; returns their number.
int measureSupport(
	const RobustPatchScratch& fit, double reach, Vector2d& mean, Matrix2d& covariance)
{
	int count  = 0;
	mean       = Vector2d::Zero();
	covariance = Matrix2d::Zero();
	for (int k = 0; k < fit.samples.size(); ++k) {
		if (std::abs(fit.residuals[k]) >= reach)
			continue;
		const Vector2d p(fit.samples.x[k], fit.samples.y[k]);
		mean += p;
		covariance += p * p.transpose();
		++count;
	}
	mean /= std::max(count, 1);
	covariance = (covariance / std::max(count, 1) - mean * mean.transpose()).eval();
	return count;
}

} // namespace

double OutlierVoter::deviation() const
{
	return surface.scale / (1.0 - lostDeviation / neighbors);
}

double OutlierVoter::heightError() const
{
	return heightDeviation * std::sqrt(1.0 + predictionVariance / neighbors);
}

OutlierVoter::Support OutlierVoter::support(const SurfacePatch::Local& p) const
{
	const Vector2d offset(p.x - supportCentre.x(), p.y - supportCentre.y());
	const double   distance2 = offset.dot(supportShape * offset);
	return distance2 <= insideDistance2 ? Support::Inside
	       : distance2 <= rimDistance2  ? Support::Rim
	                                    : Support::Outside;
}

void fitVoter(OutlierVoter& voter, const VoterCloud& cloud)
{
	thread_local RobustPatchScratch scratch;
	thread_local Matrix3Xd          points;
	thread_local std::vector<Index> even;
	const Vector3d                  centre = cloud.positions.col(voter.centre);
	const double                    radius = evenNeighbors(centre, voter.neighbors, cloud, even);
	voter.ball.clear();
	points.resize(3, even.size());
	for (std::size_t k = 0; k < even.size(); ++k)
		points.col(k) = cloud.positions.col(even[k]);
	const double spacing = radius * std::sqrt(EIGEN_PI / std::max<double>(1.0, even.size()));
	const auto   seed    = static_cast<std::uint32_t>(cloud.rank[voter.centre]);
	if (!fitPatchRobustly(voter.surface, points, radius, minDeviation * spacing, seed, scratch))
		return;
	Matrix2d     covariance;
	const double reach = onSurface * voter.surface.scale;
	const int    count = measureSupport(scratch, reach, voter.supportCentre, covariance);
	const double area  = 4.0 * EIGEN_PI * radius * radius *
	                    std::sqrt(std::max(0.0, covariance.determinant())); // of an even ellipse
	voter.surface.valid = count > minMajority * double(even.size()) && area > 0.0;
	if (!voter.surface.valid)
		return;
	voter.spacing      = std::sqrt(area / count);
	voter.supportShape = (covariance + 1e-12 * Matrix2d::Identity()).inverse();
	cloud.all.within(centre, radius, voter.ball);
}

} // namespace curvature_lines
