// Normal equations of Euler's theorem in closed form (T06 eqs. 5 to 11).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "m_weighted_curvature.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace curvature_lines {

namespace {

// Points whose w is below this share of its peak do not count (T06 section 6, value unpublished).
constexpr double smallestShare = 1e-3;
constexpr Index  fewestDirections = 4; // one more than unknowns

} // namespace

double mWeight(double x, double h, Index exponent)
{
	return std::pow(x * x, double(exponent)) * gaussianWeight(x, h);
}

double gaussianWeight(double x, double h)
{
	return std::exp(-x * x / (h * h));
}

double squaredWeight(double x, double h, const MWeightedCurvatureOptions& options)
{
	double w = 1.0;
	switch (options.weighting) {
	case MWeightedCurvatureOptions::Weighting::M: {
		const double peak = std::sqrt(double(options.exponent));
		w = mWeight(x / h, 1.0, options.exponent) / mWeight(peak, 1.0, options.exponent);
		break;
	}
	case MWeightedCurvatureOptions::Weighting::Gaussian:
		w = gaussianWeight(x, h);
		break;
	case MWeightedCurvatureOptions::Weighting::Unweighted:
		break;
	}
	return w < smallestShare ? 0.0 : w * w;
}

void EulerLeastSquares::add(const Eigen::Vector3d& offset, double weight)
{
	const Eigen::Vector2d q      = m_frame.toPlane(offset);
	const double          square = q.squaredNorm();
	if (!(square > 0.0) || !(weight > 0.0))
		return;
	// T06 eq. 6; along the normal the sign is ours.
	const double          curvature = -2.0 * offset.dot(m_frame.n) / offset.squaredNorm();
	const Eigen::Vector3d row(
		1.0, (q.x() * q.x() - q.y() * q.y()) / square, 2.0 * q.x() * q.y() / square);
	m_normal.noalias() += weight * row * row.transpose();
	m_spread.noalias() += weight * weight * row * row.transpose();
	m_rhs += weight * curvature * row;
	m_squares += weight * curvature * curvature;
	++m_count;
}

EulerLeastSquares::Fit EulerLeastSquares::solve() const
{
	Fit             fit;
	Eigen::Matrix3d inverse;
	// Relative to the sum of the weights, the determinant of well spread directions is 1/4.
	const double total   = m_normal(0, 0);
	bool         regular = m_count >= fewestDirections && total > 0.0;
	if (regular)
		(m_normal / total).eval().computeInverseWithCheck(inverse, regular, 1e-6);
	if (!regular)
		return fit;
	inverse /= total;
	const Eigen::Vector3d v = inverse * m_rhs;
	const double          half = std::hypot(v[1], v[2]); // (k1 - k2) / 2
	// d1 lies where the cosine and sine of twice its angle are v2 and v3, over (k1 - k2) / 2.
	const double angle = 0.5 * std::atan2(v[2], v[1]);
	fit.k1             = v[0] + half;
	fit.k2             = v[0] - half;
	fit.d1             = m_frame.toSpace({std::cos(angle), std::sin(angle)});
	fit.d2             = m_frame.n.cross(fit.d1);

	const Eigen::Matrix3d covariance = inverse * m_spread * inverse;
	const double freedom  = total * (1.0 - 3.0 / m_count);
	const double variance = std::max(0.0, m_squares - v.dot(m_rhs)) / freedom;
	const Eigen::Vector3d slope(0.0, 2.0 * std::cos(2.0 * angle), 2.0 * std::sin(2.0 * angle));
	fit.error = std::sqrt(variance * slope.dot(covariance * slope));
	fit.valid = std::isfinite(fit.k1) && std::isfinite(fit.k2) && std::isfinite(fit.error);
	return fit;
}

CurvatureField mWeightedCurvature(
	const PointCloud&                cloud,
	const NeighborSearch&            search,
	const MinimumNeighborhoods&      minimum,
	const MWeightedCurvatureOptions& options,
	const Progress&                  progress)
{
	const Index    n = cloud.size();
	CurvatureField field;
	for (auto* values :
		 {&field.k1, &field.k2, &field.error, &field.radius, &field.confidence, &field.feature})
		values->setZero(n);
	for (auto* vectors : {&field.d1, &field.d2})
		vectors->resize(3, n);
	field.status           = minimum.status;
	field.correctedNormals = cloud.normals;

	std::vector<std::vector<Index>>  rows(n);
	std::vector<std::vector<double>> weights(n);
	parallelFor(n, progress, [&](Index i) {
		const Eigen::Vector3d position = cloud.positions.col(i), normal = cloud.normals.col(i);
		const TangentFrame    frame(normal);
		const double          h = options.bandwidth * minimum.spacing[i];
		EulerLeastSquares     squares(frame);
		std::vector<Index>    near = search.nearest(position, options.neighbors + 1);
		std::sort(near.begin(), near.end());
		double total = 0.0;
		for (const Index j : near) {
			if (j == i || cloud.normals.col(j).dot(normal) <= 0.0)
				continue;
			const Eigen::Vector3d offset = cloud.positions.col(j) - position;
			const double          weight = squaredWeight(offset.norm(), h, options);
			if (!(weight > 0.0))
				continue;
			squares.add(offset, weight);
			rows[i].push_back(j);
			weights[i].push_back(weight);
			total += weight;
			field.radius[i] = std::max(field.radius[i], offset.norm());
		}
		const EulerLeastSquares::Fit fit = squares.solve();
		if (!fit.valid) {
			field.d1.col(i) = frame.u;
			field.d2.col(i) = frame.v;
			rows[i].clear();
			weights[i].clear();
			if (field.status[i] != PointStatus::Isolated)
				field.status[i] = PointStatus::TooFewNeighbors;
			return;
		}
		for (double& weight : weights[i])
			weight /= total;
		field.k1[i]     = fit.k1;
		field.k2[i]     = fit.k2;
		field.error[i]  = fit.error;
		field.d1.col(i) = fit.d1;
		field.d2.col(i) = fit.d2;
	});
	adoptWeights(rows, weights, field);
	return field;
}

} // namespace curvature_lines
