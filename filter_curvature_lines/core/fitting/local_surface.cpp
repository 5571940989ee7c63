// Height and normal-field polynomials with Geman-McClure weights.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "local_surface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Dense>

#include "block_size.h"
#include "bracketed_selection.h"
#include "local_polynomial.h"
#include "monomials.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "robust_kernel.h"
#include "sample_kernels.h"

namespace curvature_lines {

namespace {

// docs/method.md, "Local polynomials".
// Samples that a fit needs beyond its coefficients: with none to spare it would follow the noise exactly.
constexpr int spareSamples = 3;

// A residual of this many root mean squares hardly occurs among a few hundred normally distributed ones (one in
// 2000): only then is the fit repeated with robust weights.
constexpr double suspicious = 3.5;
// Robust deviations in which the Geman-McClure weight takes a residual, and beyond which it is 0. Milder than the
// published 1 and 2 (A09), which leave a normally distributed residual 50 % of its weight on average; 2.5 leaves 80 %.
constexpr double robustScale = 2.5;
constexpr double cut         = 5.0;

// II = -hessian / sqrt(1 + |gradient|^2) of a height over the plane of `frame`, as a tensor in space.
Eigen::Matrix3d shapeOfHeight(
	const TangentFrame& frame, const Eigen::Vector2d& gradient, const Eigen::Matrix2d& hessian)
{
	const double                w = std::sqrt(1.0 + gradient.squaredNorm());
	Eigen::Matrix<double, 3, 2> tangents;
	tangents.col(0) = frame.u + gradient.x() * frame.n;
	tangents.col(1) = frame.v + gradient.y() * frame.n;
	// Rows of the pseudo-inverse take a step in space to its coordinates over the plane.
	const Eigen::Matrix2d             first = tangents.transpose() * tangents;
	const Eigen::Matrix<double, 2, 3> dual  = first.inverse() * tangents.transpose();
	return dual.transpose() * (-hessian / w) * dual;
}

FrameColumns columnsOf(const TangentFrame& frame, const Eigen::Vector3d& origin)
{
	FrameColumns result;
	for (int c = 0; c < 3; ++c) {
		result.origin[c] = origin[c];
		result.u[c]      = frame.u[c];
		result.v[c]      = frame.v[c];
		result.n[c]      = frame.n[c];
	}
	return result;
}

} // namespace

LocalSurfaceFitter& LocalSurfaceFitter::ofThisThread()
{
	thread_local LocalSurfaceFitter fitter;
	return fitter;
}

void LocalSurfaceFitter::takeBall(
	const PointCloud&         points,
	const std::vector<Index>& near,
	const Eigen::Vector3d&    center,
	double                    radius)
{
	const std::size_t room = near.size() + blockSize;
	if (m_robust.size() < room) {
		for (int c = 0; c < 3; ++c) {
			m_ball.position[c].resize(room);
			m_ball.normal[c].resize(room);
		}
		m_robust.resize(room);
		m_residuals.resize(room);
	}
	m_ball.center      = center;
	m_ball.radius      = radius;
	m_ball.size        = int(near.size());
	const double scale = 1.0 / radius;
	for (int k = 0; k < m_ball.size; ++k)
		for (int c = 0; c < 3; ++c) {
			m_ball.position[c][k] = (points.positions(c, near[k]) - center[c]) * scale;
			m_ball.normal[c][k]   = points.normals(c, near[k]);
		}
	for (int k = m_ball.size; k < m_ball.size + blockSize; ++k)
		for (int c = 0; c < 3; ++c) {
			m_ball.position[c][k] = 2.0;
			m_ball.normal[c][k]   = 0.0;
		}
}

BallPlane LocalSurfaceFitter::plane(const Eigen::Vector3d& normal) const
{
	const PlaneMoments moments = planeMomentsOf(m_ball.columns(), normal.data());
	BallPlane          plane;
	if (!(moments.weight > 0.0))
		return plane;
	const Eigen::Vector3d mean = Eigen::Vector3d::Map(moments.offset) / moments.weight;
	Eigen::Matrix3d       covariance;
	for (int r = 0, m = 0; r < 3; ++r)
		for (int c = 0; c <= r; ++c, ++m)
			covariance(r, c) = covariance(c, r) =
				moments.square[m] / moments.weight - mean[r] * mean[c];
	Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
	eigen.computeDirect(covariance);
	const Eigen::Vector3d thinnest = eigen.eigenvectors().col(0);
	if (!thinnest.allFinite())
		return plane;
	const bool opposes = thinnest.dot(Eigen::Vector3d::Map(moments.normal)) < 0.0;
	plane.normal       = opposes ? Eigen::Vector3d(-thinnest) : thinnest;
	plane.height       = m_ball.radius * plane.normal.dot(mean);
	return plane;
}

template<int Values>
void LocalSurfaceFitter::reweight(double rms, LocalSamples<Values>& samples)
{
	const auto   counted = [&](int s) { return samples.weight[s] > 0.0 ? m_residuals[s] : -1.0; };
	const double sigma =
		deviationOverMedian *
		quantileNear(rms / deviationOverMedian, samples.size(), counted, 0.5, m_scratch);
	for (int s = 0; s < samples.size(); ++s) {
		if (!(samples.weight[s] > 0.0))
			continue;
		const double t = m_residuals[s] / (robustScale * sigma + 1e-12);
		const double g =
			m_residuals[s] > cut * sigma + 1e-12 ? 0.0 : relativeGemanMcClureWeight(t * t);
		samples.weight[s] *= g / m_robust[s];
		m_robust[s] = g;
	}
}

template<int Degree>
bool LocalSurfaceFitter::heightStep(bool lookForOutliers, SurfaceElement& element)
{
	const double       radius = m_ball.radius;
	const TangentFrame frame(element.normal);
	const FrameColumns local = columnsOf(frame, (element.position - m_ball.center) / radius);
	m_heights.resize(m_ball.size);
	const int used = toHeights(m_ball.columns(), local, m_robust.data(), m_heights.columns());
	if (used < monomialCount(Degree) + spareSamples)
		return false;
	auto fit = fitPolynomial<Degree, 1>(m_heights);
	if (!fit.valid)
		return false;
	if (lookForOutliers) {
		const double largest = distancesFrom<Degree, 1>(
			fit.coefficients.data(), m_heights.columns(), m_residuals.data());
		const double rms = std::sqrt(fit.squaredResidual / fit.sumOfWeights);
		if (largest > suspicious * rms) {
			reweight(rms, m_heights);
			fit = fitPolynomial<Degree, 1>(m_heights);
			if (!fit.valid)
				return false;
		}
	}

	const auto& c = fit.coefficients;
	if (!(std::abs(c[0]) < 1.0) || !(c.squaredNorm() < 1e8))
		return false;
	const Eigen::Vector2d gradient(c[1], c[2]);
	Eigen::Matrix2d       hessian;
	hessian << 2.0 * c[3], c[4], c[4], 2.0 * c[5];
	const double freedom = double(used - monomialCount(Degree)) / used;
	element.samples      = used;
	element.support      = fit.sumOfWeights / used;
	element.residual     = radius * std::sqrt(fit.squaredResidual / (freedom * fit.sumOfWeights));
	element.offset       = std::hypot(fit.gram(0, 1), fit.gram(0, 2)) / fit.sumOfWeights;
	element.position += c[0] * radius * frame.n;
	element.normal = (frame.n - c[1] * frame.u - c[2] * frame.v).normalized();
	element.shape  = shapeOfHeight(frame, gradient, hessian) / radius;
	return true;
}

SurfaceElement
LocalSurfaceFitter::fitHeights(const Eigen::Vector3d& normal, int degree, int iterations)
{
	SurfaceElement element;
	element.position = m_ball.center;
	element.normal   = normal;
	if (!(normal.squaredNorm() > 0.0))
		return element;
	std::fill_n(m_robust.begin(), m_ball.size, 1.0);
	for (int it = 0; it < iterations; ++it) {
		const bool lookForOutliers = it > 0 || iterations == 1;
		if (!(degree == 2 ? heightStep<2>(lookForOutliers, element)
		                  : heightStep<4>(lookForOutliers, element)))
			return element;
	}
	element.valid = true;
	return element;
}

template<int Degree>
bool LocalSurfaceFitter::normalStep(bool lookForOutliers, SurfaceElement& element)
{
	const TangentFrame frame(element.normal);
	const double       scale = 1.0 / m_ball.radius;
	m_normals.resize(m_ball.size);
	const FrameColumns local = columnsOf(frame, Eigen::Vector3d::Zero());
	if (toNormals(m_ball.columns(), local, m_normals.columns()) <
	    monomialCount(Degree) + spareSamples)
		return false;
	auto fit = fitPolynomial<Degree, 3>(m_normals);
	if (!fit.valid)
		return false;
	if (lookForOutliers) {
		const double largest = distancesFrom<Degree, 3>(
			fit.coefficients.data(), m_normals.columns(), m_residuals.data());
		const double rms = std::sqrt(fit.squaredResidual / fit.sumOfWeights);
		if (largest > suspicious * rms) {
			std::fill_n(m_robust.begin(), m_normals.size(), 1.0);
			reweight(rms, m_normals);
			fit = fitPolynomial<Degree, 3>(m_normals);
			if (!fit.valid)
				return false;
		}
	}
	const auto&     c = fit.coefficients;
	Eigen::Matrix2d x;
	x << c(1, 0), c(2, 0), c(1, 1), c(2, 1);
	const Eigen::Matrix2d       s = 0.5 * scale * (x + x.transpose());
	Eigen::Matrix<double, 3, 2> tangents;
	tangents << frame.u, frame.v;
	const Eigen::Vector3d mean = c(0, 0) * frame.u + c(0, 1) * frame.v + c(0, 2) * frame.n;
	if (!(mean.norm() > 0.0))
		return false;
	element.normal = mean.normalized();
	element.shape  = tangents * s * tangents.transpose();
	return true;
}

SurfaceElement LocalSurfaceFitter::fitNormals(const SurfaceElement& start, int degree, bool robust)
{
	SurfaceElement element = start;
	element.valid          = true;
	for (int it = 0; it < 2 && element.valid; ++it) {
		const bool look = robust && it > 0;
		element.valid   = degree == 1   ? normalStep<1>(look, element)
		                  : degree == 2 ? normalStep<2>(look, element)
		                                : normalStep<3>(look, element);
	}
	return element;
}

} // namespace curvature_lines
