// Global smoothing of principal directions (A09 section 4.3): period pi, not across features.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "robust_curvature.h"

namespace curvature_lines {

struct DirectionSmoothingOptions {
	double alpha      = 0.5; // 0: input directions, 1: smoothest field
	Index  iterations = 100; // L-BFGS-B iterations, after a linear start in exp(2 i theta)
};

struct DirectionSmoothingResult {
	Eigen::Matrix3Xd d1, d2; // 3 x N unit, tangent
	Index  iterations    = 0;
	double initialEnergy = 0.0, finalEnergy = 0.0;
	double meanTurn      = 0.0; // mean |angle| to the input directions, radians
};

DirectionSmoothingResult smoothDirections(
	const PointCloud&                cloud,
	const CurvatureField&            field,
	const DirectionSmoothingOptions& options  = {},
	const Progress&                  progress = {});

// A09's energy in the angles theta (N) against frames TangentFrame(n_i), and its gradient, for tests.
// Unordered pairs {i, j} with W_i[j] > 0 or W_j[i] > 0 count once, each end's term divided by its degree.
class DirectionEnergy {
public:
	DirectionEnergy(const PointCloud& cloud, const CurvatureField& field, double alpha);
	double operator()(const Eigen::VectorXd& theta, Eigen::VectorXd& gradient) const;
	const Eigen::VectorXd& initialAngles() const { return m_theta0; }

private:
	struct Pair { Index i, j; double phi, weight; }; // theta_i - theta_j = phi where parallel (mod pi)
	double          m_alpha;
	Eigen::VectorXd m_theta0, m_omega;
	std::vector<Pair> m_pairs;
	friend DirectionSmoothingResult smoothDirections(
		const PointCloud&, const CurvatureField&, const DirectionSmoothingOptions&, const Progress&);
};

} // namespace curvature_lines
