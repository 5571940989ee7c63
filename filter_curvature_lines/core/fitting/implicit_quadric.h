// Implicit quadrics through points: they follow tips, rods, rims and creases, over which no height is a function.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include <Eigen/Core>

namespace curvature_lines {

// { p : f(p) = 0 } with f = c . (1, x, y, z, x^2, y^2, z^2, x y, y z, z x).
class ImplicitQuadric {
public:
	static constexpr int count = 10;
	using Coefficients         = Eigen::Matrix<double, count, 1>;

	ImplicitQuadric() : m_coefficients(Coefficients::Zero()) {}
	explicit ImplicitQuadric(const Coefficients& coefficients) : m_coefficients(coefficients) {}

	double value(const Eigen::Vector3d& p) const;
	Eigen::Vector3d gradient(const Eigen::Vector3d& p) const;
	// Distance of p from the surface along the gradient at p, where that direction meets it. Else, near creases and the
	// middle of rods, a lower bound: the least t with |f| = |gradient| t + |Hessian| t^2 / 2 (Frobenius norm).
	double distance(const Eigen::Vector3d& p) const;

	const Coefficients& coefficients() const { return m_coefficients; }

private:
	Coefficients m_coefficients;
};

// Quadrics that make sum f^2 / sum |gradient f|^2 over the points stationary, the least first (G. Taubin, Estimation of
// planar curves, surfaces and nonplanar space curves, IEEE PAMI 13, 1991). Where several fit alike, each is a surface
// that the points allow: points of a plane allow that plane and any other together.
struct ImplicitQuadricFit {
	std::array<ImplicitQuadric, ImplicitQuadric::count> quadrics;
	// Root mean square of the distances of the points, to first order: sqrt of the quotient.
	std::array<double, ImplicitQuadric::count> deviations{};
	bool                                       valid = false;
};

// Points (columns) of about unit size around the origin.
ImplicitQuadricFit fitImplicitQuadrics(const Eigen::Ref<const Eigen::Matrix3Xd>& points);

} // namespace curvature_lines
