// Weights from standard errors, which are enlarged at rims, and the turning of the field from differences.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "direction_trust.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "curvature_field.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// A direction whose k1 - k2 is this many errors has weight 1; by experiment.
constexpr double sureErrors = 6.0;
constexpr double mostWeight = 100.0; // keeps the problem well-conditioned
constexpr double sameFace   = 0.5;   // dot product of normals
// Offset of the mean of the points around from the middle one, in their RMS distance: 0.6 at a straight rim.
constexpr double oneSided = 0.4;
constexpr Index  fewest   = 12; // points, or their mean says nothing
// Factor of the error at rims, and how fast it falls with the distance over the radius of the fit. Measured on noisy
// helicoids: at a rim directions err 25 times as much as inside, and e times less with every ninth of the radius. A
// larger factor gives better lines, because the errors of neighbours at a rim are alike (benchmarks/lines.py).
constexpr double rimDoubt  = 80.0;
constexpr double rimFading = 9.0;
// The turning of the field at a rim is that of the nearest points whose factor is below this.
constexpr double trusted        = 1.5;
constexpr Index  trustedNearest = 40;

// The points with positive weight at a point are about it, unless it is next to a rim or an edge.
bool isOneSided(const PointCloud& cloud, const StatisticalWeights& weights, Index i)
{
	const auto row = weights.neighbors[i];
	if (row.size() < fewest)
		return false;
	Vector3d sum     = Vector3d::Zero();
	double   squares = 0.0;
	for (const Index j : row) {
		const Vector3d d = cloud.positions.col(j) - cloud.positions.col(i);
		sum += d;
		squares += d.squaredNorm();
	}
	const Vector3d normal = cloud.normals.col(i);
	sum -= sum.dot(normal) * normal;
	return sum.squaredNorm() > oneSided * oneSided * squares * row.size();
}

// By how much the error of k1 - k2 is larger than it claims: estimates from points on one side only are
// extrapolated.
std::vector<double> doubtAtRims(const PointCloud& cloud, const CurvatureField& field)
{
	const Index         n = cloud.size();
	std::vector<char>   atRim(n);
	std::vector<double> doubt(n, 1.0);
	parallelFor(n, {}, [&](Index i) { atRim[i] = isOneSided(cloud, field.weights, i); });
	Matrix3Xd rim(3, std::count(atRim.begin(), atRim.end(), char(1)));
	for (Index i = 0, r = 0; i < n; ++i)
		if (atRim[i])
			rim.col(r++) = cloud.positions.col(i);
	if (rim.cols() == 0)
		return doubt;
	const NeighborSearch search(rim);
	parallelFor(n, {}, [&](Index i) {
		if (!(field.radius[i] > 0.0))
			return;
		const Vector3d position = cloud.positions.col(i);
		const double   distance = (rim.col(search.nearest(position, 1).front()) - position).norm();
		doubt[i] = std::max(1.0, rimDoubt * std::exp(-rimFading * distance / field.radius[i]));
	});
	return doubt;
}

double weightOf(const CurvatureField& field, Index i, double doubtAtRim)
{
	if (field.status[i] == PointStatus::TooFewNeighbors || field.status[i] == PointStatus::Invalid)
		return 0.0;
	const double k1 = field.k1[i], k2 = field.k2[i];
	const double error  = doubtAtRim * field.error[i];
	const double square = (k1 - k2) * (k1 - k2);
	const double doubt = error > 0.0 ? sureErrors * sureErrors * error * error + square / mostWeight
	                                 : k1 * k1 + k2 * k2;
	return doubt > 0.0 ? square / doubt : 0.0;
}

// Least-squares gradient of the angle, less where directions are in doubt.
Vector3d turningAt(
	const PointCloud&      cloud,
	const CurvatureField&  field,
	const Eigen::VectorXd& theta,
	const Eigen::VectorXd& weight,
	Index                  i)
{
	const TangentFrame frame(cloud.normals.col(i));
	Eigen::Matrix2d    moments = Eigen::Matrix2d::Zero();
	Eigen::Vector2d    right   = Eigen::Vector2d::Zero();
	for (const Index j : field.weights.neighbors[i]) {
		const Vector3d normal = cloud.normals.col(j);
		if (normal.dot(frame.n) < sameFace)
			continue;
		const TangentFrame    other(normal);
		const Eigen::Vector2d d = frame.toPlane(cloud.positions.col(j) - cloud.positions.col(i));
		const double          turn =
			std::remainder(theta[j] - theta[i] + transportAngle(frame, other), EIGEN_PI);
		moments += weight[j] * d * d.transpose();
		right += weight[j] * turn * d;
	}
	// A ridge that draws the turning to zero where the point's own direction is uncertain; the neighbours' weights
	// do so where theirs are.
	moments.diagonal().array() += 1e-300 + moments.trace() * (0.01 + 1.0 / (weight[i] + 1e-9));
	return frame.toSpace(moments.ldlt().solve(right));
}

} // namespace

double transportAngle(const TangentFrame& a, const TangentFrame& b)
{
	// a.u rotated into b's plane
	const Vector3d u = a.u - b.n.dot(a.u) / (1.0 + a.n.dot(b.n)) * (a.n + b.n);
	return -std::atan2(u.dot(b.v), u.dot(b.u));
}

DirectionTrust
directionTrust(const PointCloud& cloud, const CurvatureField& field, const Eigen::VectorXd& theta)
{
	const Index               n     = cloud.size();
	const std::vector<double> doubt = doubtAtRims(cloud, field);
	DirectionTrust            trust{Eigen::VectorXd(n), Matrix3Xd::Zero(3, n)};
	for (Index i = 0; i < n; ++i)
		trust.weight[i] = weightOf(field, i, doubt[i]);

	std::vector<Index> reliable;
	for (Index i = 0; i < n; ++i)
		if (doubt[i] < trusted)
			reliable.push_back(i);
	if (reliable.empty())
		return trust;
	Matrix3Xd positions(3, reliable.size());
	parallelFor(static_cast<Index>(reliable.size()), {}, [&](Index s) {
		const Index i        = reliable[s];
		positions.col(s)     = cloud.positions.col(i);
		trust.turning.col(i) = turningAt(cloud, field, theta, trust.weight, i);
	});
	const NeighborSearch search(positions);
	parallelFor(n, {}, [&](Index i) {
		if (doubt[i] < trusted)
			return;
		const Vector3d normal = cloud.normals.col(i);
		Vector3d       mean   = Vector3d::Zero();
		for (const Index s : search.nearest(cloud.positions.col(i), trustedNearest))
			if (cloud.normals.col(reliable[s]).dot(normal) > sameFace)
				mean += trust.turning.col(reliable[s]) / trustedNearest;
		trust.turning.col(i) = mean - mean.dot(normal) * normal;
	});
	return trust;
}

} // namespace curvature_lines
