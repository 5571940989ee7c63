// Normal equations of Euler's theorem in closed form (T06 eqs. 5 to 11).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "m_weighted_curvature.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "cloud_index.h"
#include "curvature_field.h"
#include "gaussian_sums.h"
#include "local_polynomial.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

namespace {

// Points whose w is below this share of its peak do not count. T06 section 6 has such a threshold without its value.
constexpr double smallestShare    = 1e-3;
constexpr double fewestDirections = 4.0; // points: one more than unknowns

// sum w row row^T of rows (1, cos 2 phi, sin 2 phi), from sum w (1, c, s, c c, c s): s s = 1 - c c.
Eigen::Matrix3d symmetric(const double (&m)[5])
{
	Eigen::Matrix3d result;
	result << m[0], m[1], m[2], m[1], m[3], m[4], m[2], m[4], m[0] - m[3];
	return result;
}

} // namespace

double mWeight(double x, double h, Index exponent)
{
	return std::pow(x * x, double(exponent)) * gaussianWeight(x, h);
}

double gaussianWeight(double x, double h)
{
	return std::exp(-x * x / (h * h));
}

EulerFit fitEuler(LocalSamples<1>& samples)
{
	samples.pad();
	const EulerMoments    sums   = eulerMomentsOf(samples.columns());
	const Eigen::Matrix3d normal = symmetric(sums.normal), spread = symmetric(sums.spread);

	EulerFit        fit;
	Eigen::Matrix3d inverse;
	// Relative to the sum of the weights, the determinant of well spread directions is 1/4.
	const double total   = normal(0, 0);
	bool         regular = sums.count >= fewestDirections && total > 0.0;
	if (regular)
		(normal / total).eval().computeInverseWithCheck(inverse, regular, 1e-6);
	if (!regular)
		return fit;
	inverse /= total;
	const Eigen::Vector3d v    = inverse * Eigen::Vector3d::Map(sums.rhs);
	const double          half = std::sqrt(v[1] * v[1] + v[2] * v[2]); // (k1 - k2) / 2
	fit.k1                     = v[0] + half;
	fit.k2                     = v[0] - half;
	// d1 lies where the cosine and sine of twice its angle are v2 and v3, over (k1 - k2) / 2.
	const double cosine = half > 0.0 ? v[1] / half : 1.0, sine = half > 0.0 ? v[2] / half : 0.0;
	fit.d1 = {
		std::sqrt(std::max(0.0, 0.5 + 0.5 * cosine)),
		std::copysign(std::sqrt(std::max(0.0, 0.5 - 0.5 * cosine)), sine)};

	const Eigen::Matrix3d covariance = inverse * spread * inverse;
	const double          freedom    = total * (1.0 - 3.0 / sums.count);
	const double          variance =
		std::max(0.0, sums.squares - v.dot(Eigen::Vector3d::Map(sums.rhs))) / freedom;
	const Eigen::Vector3d slope(0.0, 2.0 * cosine, 2.0 * sine);
	fit.error = std::sqrt(variance * slope.dot(covariance * slope));
	fit.valid = std::isfinite(fit.k1) && std::isfinite(fit.k2) && std::isfinite(fit.error);
	return fit;
}

namespace {

// w^2 relative to its peak; 0 where w is below a thousandth of it (T06 section 6).
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

} // namespace

CurvatureField mWeightedCurvature(
	const CloudIndex& index, const MWeightedCurvatureOptions& options, const Progress& progress)
{
	const PointCloud&           cloud   = index.cloud();
	const NeighborSearch&       search  = index.search();
	const MinimumNeighborhoods& minimum = index.minimum();
	const Index                 n       = cloud.size();
	CurvatureField              field;
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
		thread_local LocalSamples<1> samples;
		std::vector<Index>           near = search.nearest(position, options.neighbors + 1);
		std::sort(near.begin(), near.end());
		samples.reserve(near.size());
		double total = 0.0;
		for (const Index j : near) {
			if (j == i || cloud.normals.col(j).dot(normal) <= 0.0)
				continue;
			const Eigen::Vector3d offset = cloud.positions.col(j) - position;
			const double          weight = squaredWeight(offset.norm(), h, options);
			if (!(weight > 0.0))
				continue;
			const Eigen::Vector2d projected = frame.toPlane(offset);
			samples.add(
				projected.x(),
				projected.y(),
				weight,
				Eigen::Matrix<double, 1, 1>(offset.dot(frame.n)));
			rows[i].push_back(j);
			weights[i].push_back(weight);
			total += weight;
			field.radius[i] = std::max(field.radius[i], offset.norm());
		}
		const EulerFit fit = fitEuler(samples);
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
		field.d1.col(i) = frame.toSpace(fit.d1);
		field.d2.col(i) = frame.n.cross(field.d1.col(i));
	});
	adoptWeights(rows, weights, field);
	return field;
}

} // namespace curvature_lines
