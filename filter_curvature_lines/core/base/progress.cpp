// Progress and the parallel loop. Only the calling thread talks to the host: hosts redraw from there.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "progress.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <numeric>
#include <thread>
#include <vector>

#include <omp.h>

#include "point_cloud.h"

namespace curvature_lines {

namespace {

constexpr std::chrono::milliseconds reportInterval(100);

}

void Progress::report(double fraction) const
{
	if (!m_callback)
		return;
	const double mapped = m_from + std::clamp(fraction, 0.0, 1.0) * (m_to - m_from);
	if (!m_callback(mapped, m_what))
		throw Cancelled();
}

Progress Progress::sub(double from, double to, const char* what) const
{
	Progress part = *this;
	part.m_what   = what;
	part.m_from   = m_from + from * (m_to - m_from);
	part.m_to     = m_from + to * (m_to - m_from);
	return part;
}

void parallelFor(Index n, const Progress& progress, const std::function<void(Index)>& body)
{
	using Clock = std::chrono::steady_clock;
	// Small enough to balance uneven bodies and to answer a cancellation soon, large enough that
	// the shared counter costs nothing.
	const std::int64_t chunk  = std::clamp<std::int64_t>(n / 512, 1, 128);
	const auto         caller = std::this_thread::get_id();

	std::atomic<std::int64_t> next{0}, done{0};
	std::atomic<bool>         stop{false};
	std::exception_ptr        error;
	std::mutex                errorMutex;

	progress.report(0.0);
#pragma omp parallel
	{
		try {
			const bool reports = std::this_thread::get_id() == caller;
			auto       last    = Clock::now();
			while (!stop.load(std::memory_order_relaxed)) {
				const std::int64_t from = next.fetch_add(chunk, std::memory_order_relaxed);
				if (from >= n)
					break;
				const std::int64_t to = std::min<std::int64_t>(from + chunk, n);
				for (std::int64_t i = from; i < to; ++i)
					body(static_cast<Index>(i));
				done.fetch_add(to - from, std::memory_order_relaxed);
				if (reports && Clock::now() - last > reportInterval) {
					last = Clock::now();
					progress.report(double(done.load(std::memory_order_relaxed)) / double(n));
				}
			}
		}
		catch (...) {
			// An exception must not leave the parallel region on another thread.
			const std::lock_guard<std::mutex> lock(errorMutex);
			if (!error)
				error = std::current_exception();
			stop = true;
		}
	}
	if (error)
		std::rethrow_exception(error);
	progress.report(1.0);
}

void parallelTasks(
	Index n, const Progress& progress, const std::function<void(Index, const Progress&)>& task)
{
	const auto                       caller = std::this_thread::get_id();
	std::vector<std::atomic<double>> reached(n);
	std::atomic<bool>                stop{false};
	Index                            finished = 0; // with error, under the mutex
	std::exception_ptr               error;
	std::mutex                       mutex;
	std::condition_variable          oneFinished;

	const auto report = [&] {
		progress.report(std::accumulate(reached.begin(), reached.end(), 0.0) / n);
	};
	const auto run = [&](Index i) {
		const Progress own([&, i](double fraction, const char*) {
			reached[i] = fraction;
			if (std::this_thread::get_id() == caller)
				report();
			return !stop;
		});
		std::exception_ptr failed;
		try {
			task(i, own);
		}
		catch (...) {
			failed = std::current_exception();
			stop   = true;
		}
		const std::lock_guard<std::mutex> lock(mutex);
		if (failed && !error)
			error = failed;
		++finished;
		oneFinished.notify_one();
	};
#pragma omp parallel num_threads(std::clamp(omp_get_max_threads(), 1, std::max(n, 1)))
	{
		// This schedule gives the calling thread, the first of the team, a task of its own.
#pragma omp for schedule(static, 1) nowait
		for (Index i = 0; i < n; ++i)
			run(i);
		if (std::this_thread::get_id() == caller) {
			std::unique_lock<std::mutex> lock(mutex);
			while (finished < n) {
				oneFinished.wait_for(lock, reportInterval);
				try {
					report();
				}
				catch (...) {
					error = std::current_exception();
					stop  = true;
				}
			}
		}
	}
	if (error)
		std::rethrow_exception(error);
}

} // namespace curvature_lines
