// What the peers' programs share: numbers in and out of the files that programs.py writes, and a clock.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

using OrientedPoint = std::array<double, 6>; // position and outward normal

template<class T>
std::vector<T> readAll(std::istream& file, std::int64_t count)
{
	std::vector<T> values(count);
	file.read(reinterpret_cast<char*>(values.data()), std::streamsize(values.size() * sizeof(T)));
	return values;
}

template<class T>
void writeAll(const char* path, const std::vector<T>& values)
{
	std::ofstream(path, std::ios::binary)
		.write(
			reinterpret_cast<const char*>(values.data()),
			std::streamsize(values.size() * sizeof(T)));
}

// int64 number of points, int64 number of queries; the points; per query the int64 index of its point.
struct CloudFile {
	std::vector<OrientedPoint> points;
	std::vector<std::int64_t>  queries;

	explicit CloudFile(const char* path)
	{
		std::ifstream file(path, std::ios::binary);
		const auto    counts = readAll<std::int64_t>(file, 2);
		points               = readAll<OrientedPoint>(file, counts[0]);
		queries              = readAll<std::int64_t>(file, counts[1]);
		if (!file)
			throw std::runtime_error(std::string("cannot read ") + path);
	}
};

class Stopwatch {
public:
	double seconds() const { return std::chrono::duration<double>(Clock::now() - m_start).count(); }

private:
	using Clock               = std::chrono::steady_clock;
	Clock::time_point m_start = Clock::now();
};
