// Curvature by CGAL's jets (Monge_via_jet_fitting; Cazals and Pouget 2005) on the k nearest points: a peer of the
// benchmark, run by jets.py.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud_file.h"

#include <cstdlib>
#include <iostream>

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

Point position(const OrientedPoint& p)
{
	return {p[0], p[1], p[2]};
}

using Row = std::array<double, 8>; // k1, k2, d1, normal

// Ours are positive where the surface bends away from the outward normal, CGAL's where it bends towards it.
Row estimate(const OrientedPoint& query, const Search::Tree& tree, int degree, int k)
{
	std::vector<Point> neighbors;
	neighbors.reserve(k);
	for (const auto& [point, squaredDistance] : Search(tree, position(query), k))
		neighbors.push_back(point);

	Jet  jet;
	auto form = jet(neighbors.begin(), neighbors.end(), degree, 2);
	form.comply_wrt_given_normal({query[3], query[4], query[5]});
	const Vector d = form.minimal_principal_direction(), n = form.normal_direction();
	return {
		-form.principal_curvatures(1),
		-form.principal_curvatures(0),
		d.x(),
		d.y(),
		d.z(),
		n.x(),
		n.y(),
		n.z()};
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
	const CloudFile cloud(argv[1]);
	const int       degree = std::atoi(argv[3]), k = std::atoi(argv[4]);

	const Stopwatch whole;
	Search::Tree    tree;
	for (const OrientedPoint& point : cloud.points)
		tree.insert(position(point));
	tree.build();
	const double building = whole.seconds();

	const Stopwatch  stage;
	const auto       queries = std::int64_t(cloud.queries.size());
	std::vector<Row> rows(queries);
#pragma omp parallel for schedule(dynamic, 64)
	for (std::int64_t q = 0; q < queries; ++q)
		rows[q] = estimate(cloud.points[cloud.queries[q]], tree, degree, k);
	const double fitting = stage.seconds();

	writeAll(argv[2], rows);
	std::cout << building / double(cloud.points.size()) + fitting / double(queries) << '\n';
	return EXIT_SUCCESS;
}
