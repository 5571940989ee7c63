// Height and normal-field polynomials with Geman-McClure weights.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "local_surface.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace curvature_lines {

namespace {

// Fits need a few samples more than coefficients.
constexpr int spareSamples = 3;

// A residual this many RMS away hardly occurs among a few hundred Gaussian ones: only then is the fit worth
// repeating with robust weights. Beyond `cut` scales a sample counts no more.
constexpr double suspicious   = 3.5;
constexpr double madFactor    = 1.4826;
constexpr double robustScale  = 2.5;
constexpr double cut          = 5.0;

// II = -hessian / sqrt(1 + |gradient|^2) of a height over the plane of `frame`, as a tensor in space.
Eigen::Matrix3d shapeOfHeight(
	const TangentFrame& frame, const Eigen::Vector2d& gradient, const Eigen::Matrix2d& hessian)
{
	const double          w = std::sqrt(1.0 + gradient.squaredNorm());
	Eigen::Matrix<double, 3, 2> tangents;
	tangents.col(0) = frame.u + gradient.x() * frame.n;
	tangents.col(1) = frame.v + gradient.y() * frame.n;
	// Rows of the pseudo-inverse take a step in space to its coordinates over the plane.
	const Eigen::Matrix2d             first = tangents.transpose() * tangents;
	const Eigen::Matrix<double, 2, 3> dual  = first.inverse() * tangents.transpose();
	return dual.transpose() * (-hessian / w) * dual;
}

} // namespace

LocalSurfaceFitter& LocalSurfaceFitter::ofThisThread()
{
	thread_local LocalSurfaceFitter fitter;
	return fitter;
}

bool LocalSurfaceFitter::planeStart(
	const PointCloud&         cloud,
	const std::vector<Index>& near,
	double                    radius,
	SurfaceElement&           element) const
{
	double          total      = 0.0;
	Eigen::Vector3d mean       = Eigen::Vector3d::Zero();
	Eigen::Vector3d side       = Eigen::Vector3d::Zero();
	Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
	for (const Index i : near) {
		const auto n = cloud.normals.col(i);
		if (n.dot(element.normal) < 0.0)
			continue;
		const Eigen::Vector3d d = cloud.positions.col(i) - element.position;
		const double          w = ballKernel(d.squaredNorm() / (radius * radius));
		total += w;
		mean += w * d;
		side += w * n;
		covariance.noalias() += w * d * d.transpose();
	}
	if (!(total > 0.0))
		return false;
	mean /= total;
	covariance = covariance / total - mean * mean.transpose();
	Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
	eigen.computeDirect(covariance);
	Eigen::Vector3d normal = eigen.eigenvectors().col(0);
	if (!normal.allFinite())
		return false;
	element.normal = normal.dot(side) < 0.0 ? Eigen::Vector3d(-normal) : normal;
	return true;
}

bool LocalSurfaceFitter::robustFactors(double rms)
{
	if (!(*std::max_element(m_residuals.begin(), m_residuals.end()) > suspicious * rms))
		return false;
	m_sorted    = m_residuals;
	auto middle = m_sorted.begin() + m_sorted.size() / 2;
	std::nth_element(m_sorted.begin(), middle, m_sorted.end());
	const double sigma = madFactor * *middle;
	m_factors.clear();
	for (const double residual : m_residuals) {
		const double t = residual / (robustScale * sigma + 1e-12);
		m_factors.push_back(residual > cut * sigma + 1e-12 ? 0.0 : 1.0 / ((1.0 + t * t) * (1.0 + t * t)));
	}
	return true;
}

template<int Degree>
bool LocalSurfaceFitter::heightStep(
	const PointCloud&         cloud,
	const std::vector<Index>& near,
	double                    radius,
	bool                      lookForOutliers,
	SurfaceElement&           element)
{
	const TangentFrame frame(element.normal);
	const double       scale = 1.0 / radius;
	m_heights.reserve(near.size());
	m_entries.clear();
	for (Index k = 0; k < static_cast<Index>(near.size()); ++k) {
		const Index i = near[k];
		if (cloud.normals.col(i).dot(frame.n) < 0.0)
			continue;
		const Eigen::Vector3d d = (cloud.positions.col(i) - element.position) * scale;
		const double          w = ballKernel(d.squaredNorm()) * m_robust[k];
		if (w <= 0.0)
			continue;
		m_heights.add(d.dot(frame.u), d.dot(frame.v), w, Eigen::Matrix<double, 1, 1>(d.dot(frame.n)));
		m_entries.push_back(k);
	}
	if (m_heights.size() < monomialCount(Degree) + spareSamples)
		return false;
	auto fit = fitPolynomial<Degree, 1>(m_heights);
	if (!fit.valid)
		return false;

	if (lookForOutliers) {
		m_residuals.clear();
		for (int s = 0; s < m_heights.size(); ++s)
			m_residuals.push_back(std::abs(m_heights.value[0][s] - fit(m_heights.x[s], m_heights.y[s])[0]));
		if (robustFactors(std::sqrt(fit.squaredResidual / fit.sumOfWeights))) {
			for (int s = 0; s < m_heights.size(); ++s) {
				m_heights.weight[s] *= m_factors[s] / m_robust[m_entries[s]];
				m_robust[m_entries[s]] = m_factors[s];
			}
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
	const double freedom = double(m_heights.size() - monomialCount(Degree)) / m_heights.size();
	element.samples      = m_heights.size();
	element.support      = fit.sumOfWeights / m_heights.size();
	element.residual     = radius * std::sqrt(fit.squaredResidual / (freedom * fit.sumOfWeights));
	element.offset   = std::hypot(fit.gram(0, 1), fit.gram(0, 2)) / fit.sumOfWeights;
	element.position += c[0] * radius * frame.n;
	element.normal = (frame.n - c[1] * frame.u - c[2] * frame.v).normalized();
	element.shape  = shapeOfHeight(frame, gradient, hessian) * scale;
	return true;
}

SurfaceElement LocalSurfaceFitter::fitHeights(
	const PointCloud&         cloud,
	const std::vector<Index>& near,
	const Eigen::Vector3d&    position,
	const Eigen::Vector3d&    normal,
	double                    radius,
	int                       degree,
	int                       iterations)
{
	SurfaceElement element;
	element.position = position;
	element.normal   = normal;
	if (!planeStart(cloud, near, radius, element))
		return element;
	m_robust.assign(near.size(), 1.0);
	for (int it = 0; it < iterations; ++it) {
		const bool fitted = degree == 2 ? heightStep<2>(cloud, near, radius, it > 0 || iterations == 1, element) :
										  heightStep<4>(cloud, near, radius, it > 0 || iterations == 1, element);
		if (!fitted)
			return element;
	}
	element.valid = true;
	return element;
}

template<int Degree>
bool LocalSurfaceFitter::normalStep(
	const std::vector<SurfaceElement>& elements,
	const std::vector<Index>&          near,
	const Eigen::Vector3d&             center,
	double                             radius,
	bool                               lookForOutliers,
	SurfaceElement&                    element)
{
	const TangentFrame frame(element.normal);
	const double       scale = 1.0 / radius;
	m_normals.reserve(near.size());
	for (const Index k : near) {
		const SurfaceElement& other = elements[k];
		const double          along = other.normal.dot(frame.n);
		const Eigen::Vector3d d     = (other.position - center) * scale;
		const double          w     = ballKernel(d.squaredNorm());
		if (!other.valid || along < 0.0 || w <= 0.0)
			continue;
		m_normals.add(
			d.dot(frame.u),
			d.dot(frame.v),
			w,
			{other.normal.dot(frame.u), other.normal.dot(frame.v), along});
	}
	if (m_normals.size() < monomialCount(Degree) + spareSamples)
		return false;
	auto fit = fitPolynomial<Degree, 3>(m_normals);
	if (!fit.valid)
		return false;
	if (lookForOutliers) {
		m_residuals.clear();
		for (int s = 0; s < m_normals.size(); ++s) {
			Eigen::Vector3d residual = fit(m_normals.x[s], m_normals.y[s]);
			for (int c = 0; c < 3; ++c)
				residual[c] -= m_normals.value[c][s];
			m_residuals.push_back(residual.norm());
		}
		if (robustFactors(std::sqrt(fit.squaredResidual / fit.sumOfWeights))) {
			for (int s = 0; s < m_normals.size(); ++s)
				m_normals.weight[s] *= m_factors[s];
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

SurfaceElement LocalSurfaceFitter::fitNormals(
	const std::vector<SurfaceElement>& elements,
	const std::vector<Index>&          near,
	const SurfaceElement&              start,
	double                             radius,
	int                                degree,
	bool                               robust)
{
	SurfaceElement element = start;
	element.valid          = true;
	for (int it = 0; it < 2 && element.valid; ++it) {
		const bool look = robust && it > 0;
		element.valid =
			degree == 1 ? normalStep<1>(elements, near, start.position, radius, look, element) :
			degree == 2 ? normalStep<2>(elements, near, start.position, radius, look, element) :
						  normalStep<3>(elements, near, start.position, radius, look, element);
	}
	return element;
}

} // namespace curvature_lines
