// CGAL's advancing front with a bound on edges: without one it closes open surfaces with long triangles.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "advancing_front.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <random>

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace curvature_lines {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

constexpr double tieBreak = 1e-6; // of the longest edge

// CGAL's own priority, the radius of the smallest empty ball, unless an edge is too long.
struct BoundedPriority {
	const Eigen::VectorXd& longest;

	template<class Front, class CellHandle>
	double operator()(const Front& front, CellHandle& cell, const int& facet) const
	{
		for (int a = 1; a <= 3; ++a) {
			const auto p = cell->vertex((facet + a) % 4);
			const auto q = cell->vertex((facet + a % 3 + 1) % 4);
			// CGAL helps itself with a vertex of no number when all points lie in a plane.
			const auto count = static_cast<std::size_t>(longest.size());
			if (p->id() >= count || q->id() >= count)
				return front.infinity();
			const double bound = std::max(longest[p->id()], longest[q->id()]);
			if (CGAL::squared_distance(p->point(), q->point()) > bound * bound)
				return front.infinity();
		}
		return front.smallest_radius_delaunay_sphere(cell, facet);
	}
};

// Where triangles are equally good, as on a grid, CGAL decides by addresses. Shifts far below the noise, told by
// the place alone, leave nothing to decide.
Kernel::Point_3 withoutTies(const Eigen::Vector3d& p, double longestEdge)
{
	std::uint64_t bits[3], seed = 0;
	std::memcpy(bits, p.data(), sizeof bits);
	for (const std::uint64_t b : bits)
		seed = (seed ^ b) * 0x9e3779b97f4a7c15u;
	std::minstd_rand                       random(static_cast<std::uint32_t>(seed >> 32));
	std::uniform_real_distribution<double> shift(-tieBreak * longestEdge, tieBreak * longestEdge);
	const double                           x = shift(random), y = shift(random), z = shift(random);
	return {p.x() + x, p.y() + y, p.z() + z};
}

} // namespace

std::vector<Triangle>
advancingFront(const Eigen::Matrix3Xd& points, const Eigen::VectorXd& longestEdge)
{
	std::vector<Triangle> triangles;
	if (points.cols() < 4)
		return triangles;
	std::vector<Kernel::Point_3> input;
	input.reserve(points.cols());
	for (Eigen::Index i = 0; i < points.cols(); ++i)
		input.push_back(withoutTies(points.col(i), longestEdge[i]));
	std::vector<std::array<std::size_t, 3>> found;
	CGAL::advancing_front_surface_reconstruction(
		input.begin(), input.end(), std::back_inserter(found), BoundedPriority{longestEdge});
	triangles.reserve(found.size());
	for (const auto& t : found)
		triangles.push_back(
			{static_cast<Index>(t[0]), static_cast<Index>(t[1]), static_cast<Index>(t[2])});
	// CGAL's order and side follow addresses.
	std::sort(triangles.begin(), triangles.end(), [](Triangle a, Triangle b) {
		std::sort(a.begin(), a.end());
		std::sort(b.begin(), b.end());
		return a < b;
	});
	return triangles;
}

} // namespace curvature_lines
