// Height and normal-field polynomials with Geman-McClure weights.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "local_surface.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "bracketed_selection.h"

namespace curvature_lines {

namespace {

// Fits need a few samples more than coefficients.
constexpr int spareSamples = 3;

// A residual this many RMS away hardly occurs among a few hundred Gaussian ones: only then is the fit worth
// repeating with robust weights. Beyond `cut` scales a sample counts no more.
constexpr double suspicious  = 3.5;
constexpr double madFactor   = 1.4826;
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

// The same kernel for a block of samples.
inline void kernelOf(const Block& t2, Block& weight)
{
	const Block s    = 1.0 - t2;
	const Block zero = {};
	weight           = s > 0.0 ? s * s : zero;
}

// sum w (1, d, n, d d^T) over the points whose normals do not oppose `side`; d d^T by its lower triangle.
struct PlaneMoments {
	double weight = 0.0;
	double offset[3], normal[3], square[6];
};

CURVATURE_LINES_AVX2_CLONE void
sumUp(const BallPoints& ball, const double* side, PlaneMoments& moments)
{
	const Block zero   = {};
	Block       weight = {}, offset[3] = {}, normal[3] = {}, square[6] = {};
	for (int s = 0; s < ball.size; s += blockSize) {
		const Block d[3] = {
			blockAt(&ball.position[0][s]),
			blockAt(&ball.position[1][s]),
			blockAt(&ball.position[2][s])};
		const Block n[3] = {
			blockAt(&ball.normal[0][s]), blockAt(&ball.normal[1][s]), blockAt(&ball.normal[2][s])};
		const Block along = n[0] * side[0] + n[1] * side[1] + n[2] * side[2];
		Block       w;
		kernelOf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2], w);
		w = along < 0.0 ? zero : w;
		weight += w;
		for (int r = 0, m = 0; r < 3; ++r) {
			const Block wd = w * d[r];
			offset[r] += wd;
			normal[r] += w * n[r];
			for (int c = 0; c <= r; ++c, ++m)
				square[m] += wd * d[c];
		}
	}
	moments.weight = sumOf(weight);
	for (int r = 0; r < 3; ++r) {
		moments.offset[r] = sumOf(offset[r]);
		moments.normal[r] = sumOf(normal[r]);
	}
	for (int m = 0; m < 6; ++m)
		moments.square[m] = sumOf(square[m]);
}

// The points of a ball in a tangent frame at `origin` (in radii from the centre).
struct LocalFrame {
	double origin[3], u[3], v[3], n[3];

	LocalFrame(const TangentFrame& frame, const Eigen::Vector3d& center)
	{
		for (int c = 0; c < 3; ++c) {
			origin[c] = center[c];
			u[c]      = frame.u[c];
			v[c]      = frame.v[c];
			n[c]      = frame.n[c];
		}
	}
};

// Samples of the heights over the plane of `frame`; of weight 0 where the normal opposes. Returns how many
// have a weight.
CURVATURE_LINES_AVX2_CLONE int toHeights(
	const BallPoints& ball, const LocalFrame& frame, const double* robust, LocalSamples<1>& samples)
{
	const Block zero = {}, one = zero + 1.0;
	Block       used = {};
	for (int s = 0; s < ball.size; s += blockSize) {
		const Block x     = blockAt(&ball.position[0][s]) - frame.origin[0];
		const Block y     = blockAt(&ball.position[1][s]) - frame.origin[1];
		const Block z     = blockAt(&ball.position[2][s]) - frame.origin[2];
		const Block along = blockAt(&ball.normal[0][s]) * frame.n[0] +
		                    blockAt(&ball.normal[1][s]) * frame.n[1] +
		                    blockAt(&ball.normal[2][s]) * frame.n[2];
		Block w;
		kernelOf(x * x + y * y + z * z, w);
		w = along < 0.0 ? zero : w * blockAt(&robust[s]);
		used += w > 0.0 ? one : zero;
		blockAt(&samples.weight[s])   = w;
		blockAt(&samples.x[s])        = x * frame.u[0] + y * frame.u[1] + z * frame.u[2];
		blockAt(&samples.y[s])        = x * frame.v[0] + y * frame.v[1] + z * frame.v[2];
		blockAt(&samples.value[0][s]) = x * frame.n[0] + y * frame.n[1] + z * frame.n[2];
	}
	return int(sumOf(used));
}

// Samples of the normals in `frame`, likewise.
CURVATURE_LINES_AVX2_CLONE int
toNormals(const BallPoints& ball, const LocalFrame& frame, LocalSamples<3>& samples)
{
	const Block zero = {}, one = zero + 1.0;
	Block       used = {};
	for (int s = 0; s < ball.size; s += blockSize) {
		const Block x     = blockAt(&ball.position[0][s]);
		const Block y     = blockAt(&ball.position[1][s]);
		const Block z     = blockAt(&ball.position[2][s]);
		const Block nx    = blockAt(&ball.normal[0][s]);
		const Block ny    = blockAt(&ball.normal[1][s]);
		const Block nz    = blockAt(&ball.normal[2][s]);
		const Block along = nx * frame.n[0] + ny * frame.n[1] + nz * frame.n[2];
		Block       w;
		kernelOf(x * x + y * y + z * z, w);
		w = along < 0.0 ? zero : w;
		used += w > 0.0 ? one : zero;
		blockAt(&samples.weight[s])   = w;
		blockAt(&samples.x[s])        = x * frame.u[0] + y * frame.u[1] + z * frame.u[2];
		blockAt(&samples.y[s])        = x * frame.v[0] + y * frame.v[1] + z * frame.v[2];
		blockAt(&samples.value[0][s]) = nx * frame.u[0] + ny * frame.u[1] + nz * frame.u[2];
		blockAt(&samples.value[1][s]) = nx * frame.v[0] + ny * frame.v[1] + nz * frame.v[2];
		blockAt(&samples.value[2][s]) = along;
	}
	return int(sumOf(used));
}

// Distances of the samples from the polynomials (one column of coefficients per value), 0 without weight;
// returns the largest.
template<int Degree, int Values>
CURVATURE_LINES_AVX2_CLONE double
distances(const LocalSamples<Values>& samples, const double* coefficients, double* result)
{
	constexpr int count   = monomialCount(Degree);
	const Block   zero    = {};
	Block         largest = {};
	for (int s = 0; s < samples.size(); s += blockSize) {
		const Block x = blockAt(&samples.x[s]);
		const Block y = blockAt(&samples.y[s]);
		Block       left[Values];
		for (int v = 0; v < Values; ++v)
			left[v] = blockAt(&samples.value[v][s]);
		Block power = zero + 1.0; // x^a
#pragma GCC unroll 8
		for (int a = 0; a <= Degree; ++a) {
			Block both = power;
#pragma GCC unroll 8
			for (int b = 0; b <= Degree - a; ++b) {
				const double* c = coefficients + (a + b) * (a + b + 1) / 2 + b;
#pragma GCC unroll 4
				for (int v = 0; v < Values; ++v)
					left[v] -= c[v * count] * both;
				both *= y;
			}
			power *= x;
		}
		Block squared = zero;
		for (int v = 0; v < Values; ++v)
			squared += left[v] * left[v];
		squared             = blockAt(&samples.weight[s]) > 0.0 ? squared : zero;
		largest             = squared > largest ? squared : largest;
		blockAt(&result[s]) = squared;
	}
	for (int s = 0; s < samples.size(); ++s)
		result[s] = std::sqrt(result[s]);
	return std::sqrt(std::max(std::max(largest[0], largest[1]), std::max(largest[2], largest[3])));
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
	PlaneMoments moments;
	sumUp(m_ball, normal.data(), moments);
	BallPlane plane;
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
		madFactor * quantileNear(rms / madFactor, samples.size(), counted, 0.5, m_scratch);
	for (int s = 0; s < samples.size(); ++s) {
		if (!(samples.weight[s] > 0.0))
			continue;
		const double t = m_residuals[s] / (robustScale * sigma + 1e-12);
		const double g =
			m_residuals[s] > cut * sigma + 1e-12 ? 0.0 : 1.0 / ((1.0 + t * t) * (1.0 + t * t));
		samples.weight[s] *= g / m_robust[s];
		m_robust[s] = g;
	}
}

template<int Degree>
bool LocalSurfaceFitter::heightStep(bool lookForOutliers, SurfaceElement& element)
{
	const double       radius = m_ball.radius;
	const TangentFrame frame(element.normal);
	const LocalFrame   local(frame, (element.position - m_ball.center) / radius);
	m_heights.resize(m_ball.size);
	const int used = toHeights(m_ball, local, m_robust.data(), m_heights);
	if (used < monomialCount(Degree) + spareSamples)
		return false;
	auto fit = fitPolynomial<Degree, 1>(m_heights);
	if (!fit.valid)
		return false;
	if (lookForOutliers) {
		const double largest =
			distances<Degree, 1>(m_heights, fit.coefficients.data(), m_residuals.data());
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
	const LocalFrame local(frame, Eigen::Vector3d::Zero());
	if (toNormals(m_ball, local, m_normals) < monomialCount(Degree) + spareSamples)
		return false;
	auto fit = fitPolynomial<Degree, 3>(m_normals);
	if (!fit.valid)
		return false;
	if (lookForOutliers) {
		const double largest =
			distances<Degree, 3>(m_normals, fit.coefficients.data(), m_residuals.data());
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
