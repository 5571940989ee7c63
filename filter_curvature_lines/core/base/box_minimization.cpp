// L-BFGS and L-BFGS-B through LBFGSpp and Polak-Ribiere through dlib, with one guard around both.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "box_minimization.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <new>
#include <stdexcept>
#include <utility>

#include <Eigen/Core>

#include <LBFGS.h>
#include <LBFGSB.h>

// Only dlib's headers are used: the check that they match a compiled dlib would need that library.
#define DLIB_TEST_FOR_ODR_VIOLATIONS_H_
#include <dlib/optimization.h>

#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

namespace {

// A step that lowers the energy by less than this share of it ends the search: what it gains is rounding.
constexpr double relativeGain = 1e-9;
// Share of the box by which the largest coordinate of the first step moves. A gradient alone says nothing about
// the length of a step.
constexpr double firstMove = 0.05;

struct StepFailed : std::runtime_error {
	using std::runtime_error::runtime_error;
};

// Eigen's parallel matrix product gives sums that depend on the number of threads, and its threads
// wait for each other in busy loops that stall for minutes on a loaded machine.
class SerialProducts {
public:
	SerialProducts() : m_threads(Eigen::nbThreads()) { Eigen::setNbThreads(1); }
	~SerialProducts() { Eigen::setNbThreads(m_threads); }
	SerialProducts(const SerialProducts&)            = delete;
	SerialProducts& operator=(const SerialProducts&) = delete;

private:
	int m_threads;
};

// Sees every evaluation, so that the best point survives whatever the line search does afterwards.
class Guard {
public:
	Guard(
		const Objective&       objective,
		const Eigen::VectorXd& start,
		Index                  limit,
		const Progress& progress) : m_objective(objective), m_limit(limit), m_progress(progress)
	{
		best.x     = start;
		best.value = m_objective(start, m_gradient);
	}

	double operator()(const Eigen::VectorXd& x, Eigen::VectorXd& gradient)
	{
		const double value = x.allFinite() ? m_objective(x, gradient) : NAN;
		if (!std::isfinite(value) || !gradient.allFinite())
			throw StepFailed("the objective is not finite");
		if (value < best.value) {
			best.value = value;
			best.x     = x;
		}
		return value;
	}

	void beginIteration()
	{
		m_progress.report(double(best.iterations) / double(std::max<Index>(m_limit, 1)));
		++best.iterations;
	}
	Index iterationsLeft() const { return m_limit - best.iterations; }

	Minimum best;

private:
	const Objective& m_objective;
	Index            m_limit;
	const Progress&  m_progress;
	Eigen::VectorXd  m_gradient;
};

// LBFGSpp has no hook per iteration; it calls the line search exactly once in each.
template<template<class> class Search>
struct Counting {
	template<class Scalar>
	struct Step {
		template<class... Arguments>
		static void LineSearch(Guard& objective, Arguments&&... arguments)
		{
			objective.beginIteration();
			Search<Scalar>::LineSearch(objective, std::forward<Arguments>(arguments)...);
		}
	};
};

template<class Parameters>
Parameters lbfgsParameters()
{
	Parameters parameters;
	parameters.m           = 10;
	parameters.epsilon     = 0.0; // the gradient's size has no natural scale here
	parameters.epsilon_rel = 0.0;
	parameters.past        = 1;
	parameters.delta       = relativeGain;
	return parameters;
}

// Whether the minimiser came to its own end; otherwise its line search failed.
template<class Minimize>
bool ended(const Minimize& minimize)
{
	try {
		minimize();
		return true;
	}
	catch (const Cancelled&) {
		throw;
	}
	catch (const std::bad_alloc&) {
		throw;
	}
	catch (const std::exception&) {
		return false;
	}
}

// A failed line search means a useless memory: begin again without it, as long as that helps.
template<class Minimize>
Minimum restarted(Guard& guard, const Minimize& minimize)
{
	const SerialProducts serial;
	double               before = std::numeric_limits<double>::infinity();
	while (guard.iterationsLeft() > 0 && guard.best.value < before) {
		before                = guard.best.value;
		Eigen::VectorXd x     = guard.best.x;
		double          value = 0.0;
		if (ended([&] { minimize(x, value); }))
			break;
	}
	return guard.best;
}

using DlibVector = dlib::matrix<double, 0, 1>;

// dlib's conjugate gradients know no bounds. They see the objective of the closest point of the
// box, which is continuous and constant along every bound that has been passed. And their line
// search tries the whole gradient first, which in a rough objective lands in another valley: it is
// scaled to a small part of the box.
class ClampedObjective {
public:
	ClampedObjective(Guard& guard, const Box& box) : m_guard(guard), m_box(box)
	{
		m_x                   = guard.best.x;
		m_value               = guard(m_x, m_gradient);
		const double steepest = m_gradient.cwiseAbs().maxCoeff();
		if (steepest > 0.0)
			m_scale = firstMove * (box.upper - box.lower).minCoeff() / steepest;
	}

	double value(const DlibVector& x)
	{
		evaluate(x);
		return m_scale * m_value;
	}
	DlibVector gradient(const DlibVector& x)
	{
		evaluate(x);
		const Eigen::Map<const Eigen::VectorXd> free(x.begin(), x.size());
		DlibVector                              result(x.size());
		for (long i = 0; i < x.size(); ++i)
			result(i) = free[i] == m_x[i] ? m_scale * m_gradient[i] : 0.0;
		return result;
	}

private:
	// dlib asks for value and gradient of the same point one after the other.
	void evaluate(const DlibVector& x)
	{
		const Eigen::Map<const Eigen::VectorXd> free(x.begin(), x.size());
		Eigen::VectorXd clamped = free.cwiseMax(m_box.lower).cwiseMin(m_box.upper);
		if (m_x.size() == clamped.size() && m_x == clamped)
			return;
		m_x.swap(clamped);
		m_value = m_guard(m_x, m_gradient);
	}

	Guard&          m_guard;
	const Box&      m_box;
	Eigen::VectorXd m_x, m_gradient;
	double          m_value = 0.0, m_scale = 1.0;
};

class StopWhenSettled {
public:
	explicit StopWhenSettled(Guard& guard) : m_guard(guard) {}

	bool should_continue_search(const DlibVector&, double value, const DlibVector& gradient)
	{
		const bool settled =
			m_started && std::abs(m_last - value) <= relativeGain * std::abs(value);
		m_started = true;
		m_last    = value;
		if (settled || m_guard.iterationsLeft() <= 0 || dlib::length_squared(gradient) == 0.0)
			return false;
		m_guard.beginIteration();
		return true;
	}

private:
	Guard& m_guard;
	bool   m_started = false;
	double m_last    = 0.0;
};

} // namespace

Minimum minimizeLbfgs(
	const Objective&       objective,
	const Eigen::VectorXd& start,
	Index                  maxIterations,
	const Progress&        progress)
{
	auto parameters       = lbfgsParameters<LBFGSpp::LBFGSParam<double>>();
	parameters.linesearch = LBFGSpp::LBFGS_LINESEARCH_BACKTRACKING_WOLFE;
	Guard guard(objective, start, maxIterations, progress);
	return restarted(guard, [&](Eigen::VectorXd& x, double& value) {
		parameters.max_iterations = guard.iterationsLeft();
		LBFGSpp::LBFGSSolver<double, Counting<LBFGSpp::LineSearchBacktracking>::Step> solver(
			parameters);
		solver.minimize(guard, x, value);
	});
}

Minimum minimizeLbfgsB(
	const Objective&       objective,
	const Eigen::VectorXd& start,
	const Box&             box,
	Index                  maxIterations,
	const Progress&        progress)
{
	auto  parameters = lbfgsParameters<LBFGSpp::LBFGSBParam<double>>();
	Guard guard(objective, start, maxIterations, progress);
	return restarted(guard, [&](Eigen::VectorXd& x, double& value) {
		parameters.max_iterations = guard.iterationsLeft();
		LBFGSpp::LBFGSBSolver<double, Counting<LBFGSpp::LineSearchMoreThuente>::Step> solver(
			parameters);
		solver.minimize(guard, x, value, box.lower, box.upper);
	});
}

Minimum minimizePolakRibiere(
	const Objective&       objective,
	const Eigen::VectorXd& start,
	const Box&             box,
	Index                  maxIterations,
	const Progress&        progress)
{
	Guard            guard(objective, start, maxIterations, progress);
	ClampedObjective clamped(guard, box);
	DlibVector       x(start.size());
	std::copy(start.data(), start.data() + start.size(), x.begin());
	try {
		dlib::find_min(
			dlib::cg_search_strategy(),
			StopWhenSettled(guard),
			[&](const DlibVector& at) { return clamped.value(at); },
			[&](const DlibVector& at) { return clamped.gradient(at); },
			x,
			-std::numeric_limits<double>::infinity());
	}
	catch (const StepFailed&) {
		return guard.best; // of the steps before
	}
	return guard.best;
}

} // namespace curvature_lines
