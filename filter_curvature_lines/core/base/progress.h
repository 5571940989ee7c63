// Progress and cancellation for long stages, and the parallel loop all per-point work goes through.
// Hosts require that the callback runs on the calling thread only and about ten times a second at most.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <stdexcept>
#include <utility>

#include "point_cloud.h"

namespace curvature_lines {

class Cancelled : public std::runtime_error {
public:
	Cancelled() : std::runtime_error("cancelled") {}
};

// A stage reports fractions 0..1 of its own work; sub() maps a sub-stage into a part of its parent.
class Progress {
public:
	// Returns false to cancel. Called on the thread that runs the stage.
	using Callback = std::function<bool(double fraction, const char* what)>;

	Progress() = default;
	explicit Progress(Callback callback, const char* what = "") :
			m_callback(std::move(callback)), m_what(what)
	{
	}

	// Throws Cancelled when the host says so.
	void report(double fraction) const;
	Progress sub(double from, double to, const char* what) const;

private:
	Callback    m_callback;
	const char* m_what = "";
	double      m_from = 0.0, m_to = 1.0;
};

// Runs body(i) for i in [0, n) on all OpenMP threads, reporting from the calling thread. Results are
// independent of the number of threads as long as body(i) writes only what belongs to i. The first
// exception thrown by a body is rethrown here.
void parallelFor(Index n, const Progress& progress, const std::function<void(Index)>& body);

// Runs a few long tasks side by side. Each reports to a progress of its own, from whatever thread it runs on:
// the host hears of it on the calling thread, and a cancellation reaches them all when they report next.
void parallelTasks(
	Index n, const Progress& progress, const std::function<void(Index, const Progress&)>& task);

} // namespace curvature_lines
