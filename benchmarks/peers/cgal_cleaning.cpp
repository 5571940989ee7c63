// CGAL's filters of point sets (Point_set_processing_3): smoothing by jets and by bilateral projection (Huang et al.
// 2013), removal of outliers. Peers of the benchmark, run by cgal_cleaning.py.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud_file.h"

#include <cstdlib>
#include <iostream>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/bilateral_smooth_point_set.h>
#include <CGAL/jet_smooth_point_set.h>
#include <CGAL/property_map.h>
#include <CGAL/remove_outliers.h>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point  = Kernel::Point_3;
using Vector = Kernel::Vector_3;
using Tag    = CGAL::Parallel_if_available_tag;

struct Sample {
	Point        position;
	Vector       normal;
	std::int64_t index;
};

template<class T, T Sample::* member>
struct Member {
	using key_type   = Sample;
	using value_type = T;
	using reference  = const T&;
	using category   = boost::lvalue_property_map_tag;

	friend const T& get(const Member&, const Sample& sample) { return sample.*member; }
	friend void put(const Member&, Sample& sample, const T& value) { sample.*member = value; }
};

using Positions = Member<Point, &Sample::position>;
using Normals   = Member<Vector, &Sample::normal>;

std::vector<Sample> samplesOf(const CloudFile& cloud)
{
	std::vector<Sample> samples;
	for (const auto& [x, y, z, nx, ny, nz] : cloud.points)
		samples.push_back({{x, y, z}, {nx, ny, nz}, std::int64_t(samples.size())});
	return samples;
}

std::vector<std::array<double, 3>> positionsOf(const std::vector<Sample>& samples)
{
	std::vector<std::array<double, 3>> positions;
	for (const Sample& sample : samples)
		positions.push_back({sample.position.x(), sample.position.y(), sample.position.z()});
	return positions;
}

} // namespace

int main(int argc, char** argv)
{
	const std::string method = argc > 1 ? argv[1] : "";
	const int         given  = argc - 4; // numbers after the method and the two files
	const bool known = (method == "jet" && given == 1) || (method == "bilateral" && given == 3) ||
	                   (method == "outliers" && given == 2);
	if (!known) {
		std::cerr << "usage: cgal_cleaning jet CLOUD POSITIONS NEIGHBORS\n"
					 "       cgal_cleaning bilateral CLOUD POSITIONS NEIGHBORS DEGREES ITERATIONS\n"
					 "       cgal_cleaning outliers CLOUD INDICES NEIGHBORS PERCENT\n";
		return EXIT_FAILURE;
	}
	std::vector<Sample> samples    = samplesOf(CloudFile(argv[2]));
	const unsigned      k          = std::atoi(argv[4]);
	const auto          parameters = CGAL::parameters::point_map(Positions()).normal_map(Normals());

	const Stopwatch whole;
	if (method == "jet") {
		CGAL::jet_smooth_point_set<Tag>(samples, k, parameters);
	}
	else if (method == "bilateral") {
		for (int i = 0; i < std::atoi(argv[6]); ++i)
			CGAL::bilateral_smooth_point_set<Tag>(
				samples, k, parameters.sharpness_angle(std::atof(argv[5])));
	}
	else {
		const auto end = CGAL::remove_outliers<Tag>(
			samples, k, parameters.threshold_percent(std::atof(argv[5])).threshold_distance(0.0));
		std::cout << whole.seconds() << '\n';
		std::vector<std::int64_t> outliers;
		for (auto sample = end; sample != samples.end(); ++sample)
			outliers.push_back(sample->index);
		writeAll(argv[3], outliers);
		return EXIT_SUCCESS;
	}
	std::cout << whole.seconds() << '\n';
	writeAll(argv[3], positionsOf(samples));
	return EXIT_SUCCESS;
}
