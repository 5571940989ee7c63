// The dictionary a filter returns. Hosts pass on int, double and bool only and drop the rest.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <QVariant>

namespace curvature_lines {

class FilterResults {
public:
	void count(const std::string& key, std::ptrdiff_t n) { m_values[key] = static_cast<int>(n); }
	void real(const std::string& key, double value)
	{
		m_values[key] = std::isfinite(value) ? value : 0.0;
	}
	void flag(const std::string& key, bool value) { m_values[key] = value; }
	void seconds(const std::string& stage, double value) { real("seconds_" + stage, value); }

	// A sentence for the log: what was lost and what to do. The dictionary carries how many there are.
	void warn(const std::string& sentence)
	{
		m_warnings.push_back(sentence);
		count("warnings", static_cast<std::ptrdiff_t>(m_warnings.size()));
	}

	const std::map<std::string, QVariant>& values() const { return m_values; }
	const std::vector<std::string>& warnings() const { return m_warnings; }

private:
	std::map<std::string, QVariant> m_values;
	std::vector<std::string>        m_warnings;
};

class Stopwatch {
public:
	double seconds() const { return std::chrono::duration<double>(Clock::now() - m_start).count(); }
	// Time since the start or the last lap.
	double lap()
	{
		const double elapsed = seconds();
		m_start              = Clock::now();
		return elapsed;
	}

private:
	using Clock               = std::chrono::steady_clock;
	Clock::time_point m_start = Clock::now();
};

} // namespace curvature_lines
