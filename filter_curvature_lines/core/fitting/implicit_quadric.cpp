// A generalised eigenproblem of ten monomials.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "implicit_quadric.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

namespace curvature_lines {

namespace {

using Eigen::Vector3d;
using Coefficients = ImplicitQuadric::Coefficients;
using Gradients    = Eigen::Matrix<double, ImplicitQuadric::count, 3>;
using Moments      = Eigen::Matrix<double, ImplicitQuadric::count, ImplicitQuadric::count>;

// Added to the mean squared gradients of every monomial, so that those of the constant, which are zero, have an inverse.
constexpr double regularization = 1e-9;

Coefficients monomials(const Vector3d& p)
{
	const double x = p.x(), y = p.y(), z = p.z();
	Coefficients m;
	m << 1.0, x, y, z, x * x, y * y, z * z, x * y, y * z, z * x;
	return m;
}

Gradients monomialGradients(const Vector3d& p)
{
	const double x = p.x(), y = p.y(), z = p.z();
	Gradients    g;
	g.col(0) << 0.0, 1.0, 0.0, 0.0, 2.0 * x, 0.0, 0.0, y, 0.0, z;
	g.col(1) << 0.0, 0.0, 1.0, 0.0, 0.0, 2.0 * y, 0.0, x, z, 0.0;
	g.col(2) << 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 2.0 * z, 0.0, y, x;
	return g;
}

} // namespace

double ImplicitQuadric::value(const Vector3d& p) const
{
	return m_coefficients.dot(monomials(p));
}

Vector3d ImplicitQuadric::gradient(const Vector3d& p) const
{
	return monomialGradients(p).transpose() * m_coefficients;
}

double ImplicitQuadric::distance(const Vector3d& p) const
{
	const Coefficients& c     = m_coefficients;
	const double        f     = value(p);
	const Vector3d      slope = gradient(p);
	const double        g     = slope.norm();
	if (f == 0.0)
		return 0.0;
	if (g > 0.0) {
		const Vector3d u    = slope / g;
		const double   bend = c[4] * u.x() * u.x() + c[5] * u.y() * u.y() + c[6] * u.z() * u.z() +
		                    c[7] * u.x() * u.y() + c[8] * u.y() * u.z() + c[9] * u.z() * u.x();
		const double discriminant = g * g - 4.0 * bend * f;
		if (discriminant >= 0.0) // the root next to 0, without cancellation
			return 2.0 * std::abs(f) / (g + std::sqrt(discriminant));
	}
	const double hessian =
		std::sqrt(4.0 * c.segment<3>(4).squaredNorm() + 2.0 * c.segment<3>(7).squaredNorm());
	return 2.0 * std::abs(f) / (g + std::sqrt(g * g + 2.0 * hessian * std::abs(f)));
}

ImplicitQuadricFit fitImplicitQuadrics(const Eigen::Ref<const Eigen::Matrix3Xd>& points)
{
	Moments values = Moments::Zero(), gradients = Moments::Zero();
	for (const auto& p : points.colwise()) {
		const Coefficients m = monomials(p);
		const Gradients    g = monomialGradients(p);
		values += m * m.transpose();
		gradients += g * g.transpose();
	}
	const double n = std::max<double>(1.0, static_cast<double>(points.cols()));
	values /= n;
	gradients /= n;
	gradients.diagonal().array() += regularization;
	const Eigen::GeneralizedSelfAdjointEigenSolver<Moments> solver(values, gradients);
	ImplicitQuadricFit                                      fit;
	fit.valid = solver.info() == Eigen::Success && solver.eigenvectors().allFinite();
	if (!fit.valid)
		return fit;
	for (int k = 0; k < ImplicitQuadric::count; ++k) {
		fit.quadrics[k]   = ImplicitQuadric(solver.eigenvectors().col(k));
		fit.deviations[k] = std::sqrt(std::max(0.0, solver.eigenvalues()[k]));
	}
	return fit;
}

} // namespace curvature_lines
