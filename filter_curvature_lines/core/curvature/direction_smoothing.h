// Global smoothing of principal directions (A09 section 4.3): period pi, not across features.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <complex>

#include <Eigen/SparseCore>

#include "curvature_field.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

struct DirectionSmoothingOptions {
	double alpha      = 0.5; // 0: input directions, 1: smoothest field
	Index  iterations = 100; // L-BFGS-B iterations, after a linear start in exp(2 i theta)
};

struct DirectionSmoothingResult {
	Eigen::Matrix3Xd d1, d2; // 3 x N unit, tangent
	Index            iterations    = 0;
	double           initialEnergy = 0.0, finalEnergy = 0.0;
	double           meanTurn = 0.0; // mean |angle| to the input directions, radians
};

DirectionSmoothingResult smoothDirections(
	const PointCloud&                cloud,
	const CurvatureField&            field,
	const DirectionSmoothingOptions& options  = {},
	const Progress&                  progress = {});

// A09's energy in the angles theta (N) against frames TangentFrame(n_i), and its gradient:
//   (1 - alpha) sum_i omega_i sin^2(theta_i - theta0_i) - alpha sum_{i,j} w_ij cos^2(theta_i - theta_j - phi_ij)
// over unordered pairs with W_i[j] > 0 or W_j[i] > 0, each counted once, w_ij = 1 / degree_i + 1 /
// degree_j.
class DirectionEnergy {
public:
	DirectionEnergy(
		const PointCloud&     cloud,
		const CurvatureField& field,
		double                alpha,
		const Progress&       progress = {});

	double operator()(const Eigen::VectorXd& theta, Eigen::VectorXd& gradient) const;

	const Eigen::VectorXd& initialAngles() const { return m_theta0; }
	// Near the minimum: the energy is quadratic in u_i = exp(2 i theta_i) once |u_i| = 1 is given
	// up.
	Eigen::VectorXd linearStart() const;

private:
	// The largest thing in memory here, hence in single precision.
	using Hermitian = Eigen::SparseMatrix<std::complex<float>, Eigen::RowMajor>;

	void buildCoupling(
		const PointCloud&       cloud,
		const CurvatureField&   field,
		const Eigen::Matrix3Xd& turning,
		const Progress&         progress);
	double dataWeight(Index i) const; // of the linear start

	double           m_alpha;
	Eigen::VectorXd  m_theta0, m_omega;
	Eigen::VectorXcd m_u0;          // exp(2 i theta0)
	Eigen::VectorXd  m_totalWeight; // sum_j w_ij
	// -alpha w_ij exp(2 i phi_ij), where theta_i - theta_j = phi_ij when parallel; the diagonal, which the energy
	// does not know, makes it the system of the linear start.
	Hermitian m_coupling;
};

} // namespace curvature_lines
