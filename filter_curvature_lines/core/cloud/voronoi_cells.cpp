// Voronoi cells of the cloud as the dual of CGAL's exact 3-D Delaunay triangulation (A09 section 5.1).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "voronoi_cells.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

namespace {

using Kernel        = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point         = Kernel::Point_3;
using VertexBase    = CGAL::Triangulation_vertex_base_with_info_3<Index, Kernel>;
using CellBase      = CGAL::Delaunay_triangulation_cell_base_3<Kernel>;
using Triangulation = CGAL::
	Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;
using Edge = std::pair<Index, Index>;

constexpr Index reportEvery = 8192;

// Insertion in space-filling order keeps point location nearly constant. The order is a pure function
// of the sites, and CGAL breaks cospherical ties by a symbolic perturbation of the coordinates, so the
// triangulation does not depend on it.
std::vector<Edge> delaunayEdges(const Eigen::Matrix3Xd& sites, const Progress& progress)
{
	const Index        n = static_cast<Index>(sites.cols());
	std::vector<Point> points;
	points.reserve(n);
	for (Index i = 0; i < n; ++i)
		points.emplace_back(sites(0, i), sites(1, i), sites(2, i));
	std::vector<std::size_t> order(n);
	std::iota(order.begin(), order.end(), 0);
	const auto map = CGAL::make_property_map(points);
	CGAL::spatial_sort(
		order.begin(),
		order.end(),
		CGAL::Spatial_sort_traits_adapter_3<Kernel, decltype(map)>(map));

	Triangulation                triangulation;
	Triangulation::Vertex_handle last;
	std::vector<Edge>            edges;
	for (Index k = 0; k < n; ++k) {
		const std::size_t known = triangulation.number_of_vertices();
		const Point&      p     = points[order[k]];
		last = known == 0 ? triangulation.insert(p) : triangulation.insert(p, last->cell());
		if (triangulation.number_of_vertices() > known)
			last->info() = static_cast<Index>(order[k]);
		// a site at the same position: reachable, at distance zero, through the one that came first
		else
			edges.emplace_back(last->info(), static_cast<Index>(order[k]));
		if (k % reportEvery == 0)
			progress.report(0.8 * k / n);
	}
	if (triangulation.dimension() < 2)
		throw InputError("The points lie on one line: curvature lines need a surface.");
	for (auto e = triangulation.finite_edges_begin(); e != triangulation.finite_edges_end(); ++e)
		edges.emplace_back(e->first->vertex(e->second)->info(), e->first->vertex(e->third)->info());
	return edges;
}

NeighborLists symmetricRows(Index n, const std::vector<Edge>& edges)
{
	NeighborLists rows;
	rows.offsets.assign(n + 1, 0);
	for (const Edge& e : edges) {
		++rows.offsets[e.first + 1];
		++rows.offsets[e.second + 1];
	}
	std::partial_sum(rows.offsets.begin(), rows.offsets.end(), rows.offsets.begin());
	rows.indices.resize(rows.offsets[n]);
	std::vector<Index> next(rows.offsets.begin(), rows.offsets.end() - 1);
	for (const Edge& e : edges) {
		rows.indices[next[e.first]++]  = e.second;
		rows.indices[next[e.second]++] = e.first;
	}
	for (Index i = 0; i < n; ++i)
		std::sort(
			rows.indices.begin() + rows.offsets[i], rows.indices.begin() + rows.offsets[i + 1]);
	return rows;
}

} // namespace

VoronoiCells::VoronoiCells(const Eigen::Matrix3Xd& sites, const Progress& progress) :
		m_sites(sites),
		m_neighbors(symmetricRows(static_cast<Index>(sites.cols()), delaunayEdges(sites, progress)))
{
	progress.report(1.0);
}

Index VoronoiCells::locate(const Eigen::Vector3d& point, Index start) const
{
	// The computed distance is a function of the site alone, so it decreases strictly even under
	// rounding and the descent ends. On a Delaunay graph a local minimum is the global one.
	Index  cell = start;
	double best = distance2(point, cell);
	bool   tie  = false;
	for (Index from = -1; from != cell;) {
		from = cell;
		tie  = false;
		for (Index n : m_neighbors[from]) {
			const double d = distance2(point, n);
			tie            = tie || d == best;
			if (d < best) {
				best = d;
				cell = n;
				tie  = false;
			}
		}
	}
	return tie ? lowestTie(point, cell) : cell;
}

// The sites nearest to a point on a wall are connected in the Delaunay graph, but not always directly.
Index VoronoiCells::lowestTie(const Eigen::Vector3d& point, Index cell) const
{
	const double       best = distance2(point, cell);
	std::vector<Index> tied = {cell};
	for (std::size_t k = 0; k < tied.size(); ++k)
		for (Index n : m_neighbors[tied[k]])
			if (distance2(point, n) == best && std::find(tied.begin(), tied.end(), n) == tied.end())
				tied.push_back(n);
	return *std::min_element(tied.begin(), tied.end());
}

std::vector<VoronoiCells::Crossing>
VoronoiCells::walk(const Eigen::Vector3d& a, const Eigen::Vector3d& b, Index start) const
{
	const Eigen::Vector3d direction = b - a;
	std::vector<Crossing> crossings;
	double                t       = 0.0;
	Index                 cell    = start;
	double                current = distance2(b, cell);
	// Only cells closer to b lie ahead, so the walk ends for the reason locate() does.
	while (true) {
		Crossing next{2.0, cell, -1};
		double   nextProgress = 0.0, nextDistance = 0.0;
		for (Index n : m_neighbors[cell]) {
			const double distance = distance2(b, n);
			if (distance >= current)
				continue;
			// h(x) = <s_n - s_cell, x - midpoint> is linear along the segment and positive beyond the wall.
			const Eigen::Vector3d across = m_sites.col(n) - m_sites.col(cell);
			const double before   = across.dot(a - 0.5 * (m_sites.col(n) + m_sites.col(cell)));
			const double progress = across.dot(direction);
			const double wall     = progress > 0.0 ? -before / progress : 1.0;
			const double entry    = std::clamp(wall, t, 1.0);
			// Where several walls meet, the cell entered is the one the segment runs towards most.
			if (entry < next.t || (entry == next.t && progress > nextProgress)) {
				next         = {entry, cell, n};
				nextProgress = progress;
				nextDistance = distance;
			}
		}
		if (next.to < 0)
			break;
		crossings.push_back(next);
		t       = next.t;
		cell    = next.to;
		current = nextDistance;
	}
	const Index last = lowestTie(b, cell);
	if (last != cell)
		crossings.push_back({1.0, cell, last});
	return crossings;
}

double siteSpacing(const VoronoiCells& cells, Index site)
{
	constexpr Index     neighbors = 6;
	std::vector<double> distances;
	for (Index n : cells.neighbors(site))
		distances.push_back((cells.site(n) - cells.site(site)).norm());
	const std::size_t k = std::min<std::size_t>(neighbors, distances.size());
	if (k == 0)
		return 0.0;
	std::partial_sort(distances.begin(), distances.begin() + k, distances.end());
	double sum = 0.0;
	for (std::size_t i = 0; i < k; ++i)
		sum += distances[i];
	return sum / k;
}

} // namespace curvature_lines
