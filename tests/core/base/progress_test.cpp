// The parallel loop: every index once, callbacks on the calling thread, exceptions and cancellation.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <atomic>
#include <chrono>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <omp.h>

#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines::test {
namespace {

class ThreadCount {
public:
	explicit ThreadCount(int threads) : m_before(omp_get_max_threads())
	{
		omp_set_num_threads(threads);
	}
	~ThreadCount() { omp_set_num_threads(m_before); }

private:
	int m_before;
};

TEST(ParallelFor, VisitsEveryIndexOnce)
{
	for (const int threads : {1, 2, 4}) {
		const ThreadCount set(threads);
		for (const Index n : {0, 1, 7, 511, 512, 513, 100003}) {
			std::vector<int> visits(n, 0);
			parallelFor(n, {}, [&](Index i) { ++visits[i]; });
			EXPECT_EQ(visits, std::vector<int>(n, 1));
		}
	}
}

TEST(ParallelFor, ReportsOnTheCallingThreadInOrder)
{
	const ThreadCount   set(4);
	const auto          caller = std::this_thread::get_id();
	std::vector<double> fractions;
	const Progress      progress([&](double fraction, const char*) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        fractions.push_back(fraction);
        return true;
    });
	parallelFor(
		600, progress, [](Index) { std::this_thread::sleep_for(std::chrono::milliseconds(1)); });
	ASSERT_GE(fractions.size(), 2u);
	EXPECT_EQ(fractions.front(), 0.0);
	EXPECT_EQ(fractions.back(), 1.0);
	for (std::size_t k = 1; k < fractions.size(); ++k)
		EXPECT_GE(fractions[k], fractions[k - 1]);
}

TEST(ParallelFor, RethrowsTheBodysException)
{
	for (const int threads : {1, 4}) {
		const ThreadCount set(threads);
		const auto        failing = [](Index i) {
            if (i == 700)
                throw InputError("point 700");
		};
		try {
			parallelFor(1000, {}, failing);
			FAIL() << "no exception";
		}
		catch (const InputError& error) {
			EXPECT_STREQ(error.what(), "point 700");
		}
	}
}

TEST(ParallelFor, CancelsEarly)
{
	const ThreadCount  set(2);
	std::atomic<Index> done{0};
	const Progress     progress([](double fraction, const char*) { return fraction == 0.0; });
	EXPECT_THROW(
		parallelFor(
			10000,
			progress,
			[&](Index) {
				std::this_thread::sleep_for(std::chrono::milliseconds(1));
				++done;
			}),
		Cancelled);
	EXPECT_LT(done, 10000);
}

TEST(ParallelTasks, RunAllAndReportOnTheCallingThread)
{
	const auto caller = std::this_thread::get_id();
	for (const int threads : {1, 2, 5}) {
		const ThreadCount   set(threads);
		std::vector<double> fractions;
		const Progress      progress([&](double fraction, const char*) {
            EXPECT_EQ(std::this_thread::get_id(), caller);
            fractions.push_back(fraction);
            return true;
        });
		for (const Index n : {0, 1, 2, 3}) {
			std::vector<int> runs(n, 0);
			parallelTasks(n, progress, [&](Index i, const Progress& own) {
				own.report(0.5);
				++runs[i];
				own.report(1.0);
			});
			EXPECT_EQ(runs, std::vector<int>(n, 1));
		}
		EXPECT_GE(fractions.size(), 2u);
		for (const double fraction : fractions)
			EXPECT_TRUE(fraction >= 0.0 && fraction <= 1.0);
	}
}

TEST(ParallelTasks, CancellationAndErrorsReachAll)
{
	for (const int threads : {1, 2, 4}) {
		const ThreadCount set(threads);
		int               asked = 0;
		const Progress    progress([&](double, const char*) { return ++asked < 20; });
		// Tasks that end only when told to; one ends early, so that its thread has nothing to report any more.
		EXPECT_THROW(
			parallelTasks(
				2,
				progress,
				[](Index i, const Progress& own) {
					for (int k = 0; i == 1 || k < 3; ++k) {
						own.report(0.1);
						std::this_thread::sleep_for(std::chrono::milliseconds(1));
					}
				}),
			Cancelled);
		EXPECT_THROW(
			parallelTasks(
				2,
				{},
				[](Index i, const Progress& own) {
					if (i == 0)
						throw std::runtime_error("failed");
					for (;;)
						own.report(0.1);
				}),
			std::runtime_error);
	}
}

TEST(Progress, SubStagesMapIntoTheirParent)
{
	double         last = -1.0;
	std::string    what;
	const Progress whole([&](double fraction, const char* name) {
		last = fraction;
		what = name;
		return true;
	});
	const Progress half  = whole.sub(0.5, 1.0, "second half");
	const Progress inner = half.sub(0.0, 0.5, "third quarter");
	half.report(0.5);
	EXPECT_DOUBLE_EQ(last, 0.75);
	EXPECT_EQ(what, "second half");
	inner.report(1.0);
	EXPECT_DOUBLE_EQ(last, 0.75);
	EXPECT_EQ(what, "third quarter");
	inner.report(7.0);
	EXPECT_DOUBLE_EQ(last, 0.75);
	EXPECT_NO_THROW(Progress().report(0.5));
}

TEST(Progress, HostSaysNo)
{
	EXPECT_THROW(Progress([](double, const char*) { return false; }).report(0.1), Cancelled);
}

} // namespace
} // namespace curvature_lines::test
