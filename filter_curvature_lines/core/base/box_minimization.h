// The papers' two optimisers: L-BFGS-B (A09 ref. 52), within a box or without, and Polak-Ribiere conjugate
// gradients (R07) within one. Unlike the libraries behind them they never fail: what they return is the best point seen.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include <Eigen/Core>

#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

// Returns the value at x and writes the gradient, resized to x.
using Objective = std::function<double(const Eigen::VectorXd& x, Eigen::VectorXd& gradient)>;

struct Box {
	Eigen::VectorXd lower, upper;
};

struct Minimum {
	Eigen::VectorXd x;
	double          value      = 0.0; // never above the value at the start
	Index           iterations = 0;
};

// `start` lies in the box, which must be finite for Polak-Ribiere. All stop after maxIterations,
// or when an iteration gains less than 1e-9 of the value. Progress reports, and can cancel, once
// per iteration.
Minimum minimizeLbfgs(
	const Objective&       objective,
	const Eigen::VectorXd& start,
	Index                  maxIterations,
	const Progress&        progress);

Minimum minimizeLbfgsB(
	const Objective&       objective,
	const Eigen::VectorXd& start,
	const Box&             box,
	Index                  maxIterations,
	const Progress&        progress);

Minimum minimizePolakRibiere(
	const Objective&       objective,
	const Eigen::VectorXd& start,
	const Box&             box,
	Index                  maxIterations,
	const Progress&        progress);

} // namespace curvature_lines
