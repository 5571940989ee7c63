// The optimisers on quadratics whose minimum, within a box or without, is known, and on a valley; what they promise when
// the objective fails.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "box_minimization.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {
namespace {

using Eigen::VectorXd;
using Minimizer =
	Minimum (*)(const Objective&, const VectorXd&, const Box&, Index, const Progress&);

const std::pair<const char*, Minimizer> inBoxes[] = {
	{"L-BFGS-B", minimizeLbfgsB}, {"Polak-Ribiere", minimizePolakRibiere}};

// sum scale_i (x_i - center_i)^2 / 2: within a box every coordinate is clamped by itself.
Objective separable(const VectorXd& scale, const VectorXd& center)
{
	return [=](const VectorXd& x, VectorXd& gradient) {
		const VectorXd d = x - center;
		gradient         = scale.cwiseProduct(d);
		return 0.5 * d.dot(gradient);
	};
}

TEST(BoxMinimization, ClampsTheMinimumOfASeparableQuadratic)
{
	const Index  n = 30;
	std::mt19937 random(2);
	const auto   uniform = [&](double a, double b) {
        return a + (b - a) * double(random()) / double(random.max());
	};
	VectorXd scale(n), center(n);
	for (Index i = 0; i < n; ++i) {
		scale[i]  = uniform(0.5, 5.0);
		center[i] = uniform(-3.0, 3.0);
	}
	const Box      box{VectorXd::Constant(n, -1.0), VectorXd::Constant(n, 1.0)};
	const VectorXd expected = center.cwiseMax(box.lower).cwiseMin(box.upper);
	EXPECT_GT((expected - center).cwiseAbs().maxCoeff(), 1.0); // some bounds are active
	for (const auto& [name, minimize] : inBoxes) {
		const Minimum found =
			minimize(separable(scale, center), VectorXd::Zero(n), box, 500, Progress());
		EXPECT_LT((found.x - expected).cwiseAbs().maxCoeff(), 1e-3) << name;
		VectorXd gradient;
		EXPECT_EQ(found.value, separable(scale, center)(found.x, gradient)) << name;
		EXPECT_TRUE((found.x.array() >= -1.0).all() && (found.x.array() <= 1.0).all()) << name;
		EXPECT_GT(found.iterations, 0) << name;
	}
}

// At a minimum in a box the gradient is zero where the coordinate is free, and points outward where it is not.
TEST(BoxMinimization, MinimumOfACoupledQuadraticMeetsTheConditionsOfOptimality)
{
	const Index n = 12;
	std::srand(4);
	const Eigen::MatrixXd half   = Eigen::MatrixXd::Random(n, n);
	const Eigen::MatrixXd matrix = half * half.transpose() + Eigen::MatrixXd::Identity(n, n);
	const VectorXd        right  = 4.0 * VectorXd::Random(n);
	const Objective       energy = [&](const VectorXd& x, VectorXd& gradient) {
        gradient = matrix * x - right;
        return 0.5 * x.dot(matrix * x) - x.dot(right);
	};
	const Box     box{VectorXd::Constant(n, -0.3), VectorXd::Constant(n, 0.3)};
	const Minimum found = minimizeLbfgsB(energy, VectorXd::Zero(n), box, 1000, Progress());
	VectorXd      gradient;
	energy(found.x, gradient);
	Index active = 0;
	for (Index i = 0; i < n; ++i) {
		const bool low = found.x[i] < -0.3 + 1e-4, high = found.x[i] > 0.3 - 1e-4;
		active += low || high;
		if (low)
			EXPECT_GT(gradient[i], -5e-3);
		else if (high)
			EXPECT_LT(gradient[i], 5e-3);
		else
			EXPECT_NEAR(gradient[i], 0.0, 5e-3);
	}
	EXPECT_GT(active, 2);
	EXPECT_LT(active, n);
	// Conjugate gradients see no slope behind a bound they passed, and stop a little above.
	const Minimum other = minimizePolakRibiere(energy, VectorXd::Zero(n), box, 1000, Progress());
	EXPECT_NEAR(other.value, found.value, 0.01 * std::abs(found.value));
}

TEST(BoxMinimization, FollowsACurvedValley)
{
	const Objective rosenbrock = [](const VectorXd& x, VectorXd& gradient) {
		const double a = 1.0 - x[0], b = x[1] - x[0] * x[0];
		gradient.resize(2);
		gradient << -2.0 * a - 400.0 * x[0] * b, 200.0 * b;
		return a * a + 100.0 * b * b;
	};
	VectorXd start(2);
	start << -1.2, 1.0;
	const Minimum free = minimizeLbfgs(rosenbrock, start, 500, Progress());
	EXPECT_LT((free.x - VectorXd::Ones(2)).norm(), 1e-3);
	const Box box{VectorXd::Constant(2, -2.0), VectorXd::Constant(2, 2.0)};
	EXPECT_LT(
		(minimizeLbfgsB(rosenbrock, start, box, 500, Progress()).x - VectorXd::Ones(2)).norm(),
		1e-2);
	EXPECT_LT(minimizePolakRibiere(rosenbrock, start, box, 500, Progress()).value, 0.5);
}

TEST(BoxMinimization, NeverReturnsMoreThanTheStart)
{
	// A gradient that lies, and an objective that ends in nothing beyond a wall.
	const Objective liar = [](const VectorXd& x, VectorXd& gradient) {
		gradient = -x;
		return x.squaredNorm();
	};
	const Objective wall = [](const VectorXd& x, VectorXd& gradient) {
		gradient = VectorXd::Ones(x.size());
		return x[0] < 0.2 ? std::numeric_limits<double>::quiet_NaN() : x.sum();
	};
	const VectorXd start = VectorXd::Constant(3, 0.5);
	const Box      box{VectorXd::Constant(3, -1.0), VectorXd::Constant(3, 1.0)};
	for (const Objective& objective : {liar, wall}) {
		VectorXd     gradient;
		const double atStart = objective(start, gradient);
		for (const auto& [name, minimize] : inBoxes) {
			const Minimum found = minimize(objective, start, box, 50, Progress());
			EXPECT_LE(found.value, atStart) << name;
			EXPECT_TRUE(found.x.allFinite()) << name;
		}
		EXPECT_LE(minimizeLbfgs(objective, start, 50, Progress()).value, atStart);
	}
}

TEST(BoxMinimization, StopsAfterTheIterationsItWasGiven)
{
	const VectorXd scale  = VectorXd::LinSpaced(20, 1.0, 500.0),
				   center = VectorXd::Constant(20, 0.4);
	const Box box{VectorXd::Constant(20, -1.0), VectorXd::Constant(20, 1.0)};
	for (const auto& [name, minimize] : inBoxes) {
		const auto run = [&, minimize = minimize](Index most) {
			return minimize(
				separable(scale, center), VectorXd::Constant(20, -0.9), box, most, Progress());
		};
		EXPECT_LE(run(2).iterations, 2) << name;
		EXPECT_LE(run(50).value, run(2).value) << name;
	}
}

TEST(BoxMinimization, CanBeCancelled)
{
	const VectorXd scale  = VectorXd::LinSpaced(20, 1.0, 500.0),
				   center = VectorXd::Constant(20, 0.4);
	const Box box{VectorXd::Constant(20, -1.0), VectorXd::Constant(20, 1.0)};
	for (const auto& [name, minimize] : inBoxes) {
		const Progress no([](double, const char*) { return false; });
		EXPECT_THROW(
			minimize(separable(scale, center), VectorXd::Constant(20, -0.9), box, 50, no),
			Cancelled)
			<< name;
	}
}

} // namespace
} // namespace curvature_lines
