// CGAL's advancing front with a bound on edges, without which it closes open surfaces with long triangles, and
// with the sheets told apart.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "advancing_front.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "point_cloud.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// CGAL takes the triangle with the smallest empty ball first, and of equal ones that with the lower
// address, so that results would change from run to run. On a grid many balls are equal: points are shifted
// by up to this share of the longest edge. Triangles of one tetrahedron may share its ball: their radii are
// multiplied by 1 plus up to this. Both follow from a hash of the coordinates alone. Triangles that fold back by 180 degrees
// are ordered by the cosine of their angle, which differs by the square of the shift only: 1e-6 left equal ones on
// lattices. Far below what matters to the surface, far above rounding errors.
constexpr double pointTieBreak = 1e-4, triangleTieBreak = 1e-9;

std::uint64_t hashOf(double x, double y, double z)
{
	const double  values[3] = {x, y, z};
	std::uint64_t bits[3], hash = 0;
	std::memcpy(bits, values, sizeof bits);
	for (const std::uint64_t b : bits)
		hash = (hash ^ b) * 0x9e3779b97f4a7c15u;
	return hash;
}

// Where two sheets come as near to each other as the points of one, the smallest ball may join them.
// Normals whose dot product is below `opposing` mean that two points are of different sheets; the radius of
// such a triangle counts times `acrossGap` if it spans an open gap, where only the bottom of a groove needs
// it, or times `acrossBlade` if it goes through a thin part, whose rims do. Chosen on cow, angel and
// armadillo: factors of 2 to 100 each, and limits of 0, -.3 and -.6.
constexpr double opposing = -0.3, acrossGap = 30.0, acrossBlade = 5.0;

// A triangle that none of its corners' normals faces (mean cosine) cuts through a limb; its radius counts so many times.
// Of the scaffolds of a tongue with three or four points around, 14 rims and 6 pieces became 8 and 1; tried: cosines of .2,
// .35, .5, factors of 1 to 100.
constexpr double crossSection = 0.2, acrossLimb = 30.0;

// CGAL's own priority, the radius of the smallest empty ball, unless an edge is too long or joins two sheets.
struct SheetPriority {
	const Eigen::Matrix3Xd& normals;
	const Eigen::VectorXd&  longest;

	template<class Vertex>
	double delay(const Vertex& p, const Vertex& q) const
	{
		const auto n = normals.col(p->id()), m = normals.col(q->id());
		if (!(n.dot(m) < opposing))
			return 1.0;
		const auto            step = q->point() - p->point();
		const Eigen::Vector3d d(step.x(), step.y(), step.z());
		return d.dot(n) > 0.0 && d.dot(m) < 0.0 ? acrossGap : acrossBlade;
	}

	// Mean of the cosines between the triangle's normal and those of its corners, of either sign; 1 without normals.
	template<class CellHandle>
	double facing(const CellHandle& cell, int facet) const
	{
		std::array<Eigen::Vector3d, 3> corner;
		double                         sum = 0.0, count = 0.0;
		for (int a = 0; a < 3; ++a) {
			const auto& p = cell->vertex((facet + a + 1) % 4)->point();
			corner[a]     = {p.x(), p.y(), p.z()};
		}
		const Eigen::Vector3d normal =
			(corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
		for (int a = 0; a < 3; ++a) {
			const auto n = normals.col(cell->vertex((facet + a + 1) % 4)->id());
			sum += std::abs(normal.dot(n));
			count += n.squaredNorm() > 0.0;
		}
		return count > 0.0 ? sum / count : 1.0;
	}

	template<class Front, class CellHandle>
	double operator()(const Front& front, CellHandle& cell, const int& facet) const
	{
		std::uint64_t hash  = 0; // the same for any order of the vertices
		double        later = 1.0;
		for (int a = 1; a <= 3; ++a) {
			const auto p = cell->vertex((facet + a) % 4);
			const auto q = cell->vertex((facet + a % 3 + 1) % 4);
			// When all points lie in a plane CGAL adds a vertex of its own, which has no number.
			const auto count = static_cast<std::size_t>(longest.size());
			if (p->id() >= count || q->id() >= count)
				return front.infinity();
			const double bound = std::max(longest[p->id()], longest[q->id()]);
			if (CGAL::squared_distance(p->point(), q->point()) > bound * bound)
				return front.infinity();
			later = std::max(later, delay(p, q));
			hash += hashOf(p->point().x(), p->point().y(), p->point().z());
		}
		if (facing(cell, facet) < crossSection)
			later = std::max(later, acrossLimb);
		const double share = double(hash >> 11) * 0x1p-53;
		return later * front.smallest_radius_delaunay_sphere(cell, facet) *
		       (1.0 + triangleTieBreak * share);
	}
};

Kernel::Point_3 withoutTies(const Eigen::Vector3d& p, double longestEdge)
{
	const double     most = pointTieBreak * longestEdge;
	std::minstd_rand random(static_cast<std::uint32_t>(hashOf(p.x(), p.y(), p.z()) >> 32));
	std::uniform_real_distribution<double> shift(-most, most);
	const double                           x = shift(random), y = shift(random), z = shift(random);
	return {p.x() + x, p.y() + y, p.z() + z};
}

} // namespace

std::vector<Triangle> advancingFront(
	const Eigen::Matrix3Xd& points,
	const Eigen::Matrix3Xd& normals,
	const Eigen::VectorXd&  longestEdge)
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
		input.begin(), input.end(), std::back_inserter(found), SheetPriority{normals, longestEdge});
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
