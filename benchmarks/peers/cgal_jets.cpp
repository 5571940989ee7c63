// Curvature by CGAL's jets (Monge_via_jet_fitting; Cazals and Pouget 2005) on the k nearest points: a peer of the
// benchmark, run by jets.py.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Monge_via_jet_fitting.h>
#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/version.h>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point  = Kernel::Point_3;
using Vector = Kernel::Vector_3;
using Search = CGAL::Orthogonal_k_neighbor_search<CGAL::Search_traits_3<Kernel>>;
using Jet    = CGAL::Monge_via_jet_fitting<Kernel>;

// int64 number of points, int64 number of queries; per point position and outward normal as float64;
// per query the int64 index of its point.
struct Cloud {
	std::vector<std::array<double, 6>> points;
	std::vector<std::int64_t>          queries;

	Point  position(std::size_t i) const { return {points[i][0], points[i][1], points[i][2]}; }
	Vector outward(std::size_t i) const { return {points[i][3], points[i][4], points[i][5]}; }
};

template<class T>
void readAll(std::istream& file, std::vector<T>& values)
{
	file.read(reinterpret_cast<char*>(values.data()), std::streamsize(values.size() * sizeof(T)));
}

Cloud readCloud(const char* path)
{
	std::ifstream             file(path, std::ios::binary);
	std::vector<std::int64_t> counts(2);
	readAll(file, counts);
	Cloud cloud;
	cloud.points.resize(counts[0]);
	cloud.queries.resize(counts[1]);
	readAll(file, cloud.points);
	readAll(file, cloud.queries);
	if (!file)
		throw std::runtime_error(std::string("cannot read ") + path);
	return cloud;
}

using Row = std::array<double, 8>; // k1, k2, d1, normal

// Ours are positive where the surface bends away from the outward normal, CGAL's where it bends towards it.
Row estimate(const Cloud& cloud, const Search::Tree& tree, std::int64_t query, int degree, int k)
{
	const Point        center = cloud.position(query);
	std::vector<Point> neighbors;
	neighbors.reserve(k);
	for (const auto& [point, squaredDistance] : Search(tree, center, k))
		neighbors.push_back(point);

	Jet  jet;
	auto form = jet(neighbors.begin(), neighbors.end(), degree, 2);
	form.comply_wrt_given_normal(cloud.outward(query));
	const Vector d = form.minimal_principal_direction(), n = form.normal_direction();
	return {-form.principal_curvatures(1), -form.principal_curvatures(0), d.x(), d.y(), d.z(), n.x(), n.y(), n.z()};
}

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start)
{
	return std::chrono::duration<double>(Clock::now() - start).count();
}

} // namespace

int main(int argc, char** argv)
{
	if (argc == 2 && std::string(argv[1]) == "--version") {
		std::cout << CGAL_VERSION_STR << '\n';
		return EXIT_SUCCESS;
	}
	if (argc != 5) {
		std::cerr << "usage: cgal_jets CLOUD ESTIMATES DEGREE NEIGHBORS\n";
		return EXIT_FAILURE;
	}
	const Cloud cloud  = readCloud(argv[1]);
	const int   degree = std::atoi(argv[3]), k = std::atoi(argv[4]);

	const auto   start = Clock::now();
	Search::Tree tree;
	for (std::size_t i = 0; i < cloud.points.size(); ++i)
		tree.insert(cloud.position(i));
	tree.build();
	const double building = secondsSince(start);

	const auto       fittingStart = Clock::now();
	const auto       queries      = std::int64_t(cloud.queries.size());
	std::vector<Row> rows(queries);
#pragma omp parallel for schedule(dynamic, 64)
	for (std::int64_t q = 0; q < queries; ++q)
		rows[q] = estimate(cloud, tree, cloud.queries[q], degree, k);
	const double fitting = secondsSince(fittingStart);

	std::ofstream(argv[2], std::ios::binary)
		.write(reinterpret_cast<const char*>(rows.data()), std::streamsize(rows.size() * sizeof(Row)));
	std::cout << building / double(cloud.points.size()) + fitting / double(queries) << '\n';
	return EXIT_SUCCESS;
}
