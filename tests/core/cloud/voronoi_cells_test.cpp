// Voronoi cells against Qhull (neighbours) and against brute force (location, walks).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "voronoi_cells.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <libqhullcpp/Qhull.h>
#include <libqhullcpp/QhullFacetList.h>
#include <libqhullcpp/QhullVertexSet.h>

#include "analytic_surfaces.h"
#include "point_cloud.h"

namespace curvature_lines {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using EdgeSet = std::set<std::pair<Index, Index>>;

Matrix3Xd volumeCloud(Index n, std::uint64_t seed)
{
	samples::Random random(seed, 1);
	Matrix3Xd       points(3, n);
	for (Index i = 0; i < n; ++i)
		points.col(i) = Vector3d(random.uniform(), random.uniform(), random.uniform());
	return points;
}

Matrix3Xd surfaceCloud(const char* surface, Index n, bool regular = false)
{
	samples::SampleRequest request;
	request.surface = surface;
	request.points  = n;
	request.regular = regular;
	return samples::generate(request).positions;
}

Matrix3Xd planarGrid(Index rows)
{
	Matrix3Xd points(3, rows * rows);
	for (Index r = 0; r < rows; ++r)
		for (Index c = 0; c < rows; ++c)
			points.col(r * rows + c) = Vector3d(c, r, 0.0) / rows;
	return points;
}

EdgeSet edgesOf(const VoronoiCells& cells)
{
	EdgeSet edges;
	for (Index i = 0; i < cells.size(); ++i)
		for (Index j : cells.neighbors(i))
			edges.emplace(std::min(i, j), std::max(i, j));
	return edges;
}

EdgeSet qhullEdges(const Matrix3Xd& points)
{
	orgQhull::Qhull qhull("", 3, static_cast<int>(points.cols()), points.data(), "d Qbb Qt");
	EdgeSet         edges;
	for (const orgQhull::QhullFacet& facet : qhull.facetList()) {
		if (facet.isUpperDelaunay())
			continue;
		std::vector<Index> ids;
		for (const orgQhull::QhullVertex& v : facet.vertices())
			ids.push_back(v.point().id());
		for (Index i : ids)
			for (Index j : ids)
				if (i < j)
					edges.emplace(i, j);
	}
	return edges;
}

Index nearestByBruteForce(const Matrix3Xd& sites, const Vector3d& point)
{
	Index best = 0;
	for (Index i = 1; i < sites.cols(); ++i)
		if ((sites.col(i) - point).squaredNorm() < (sites.col(best) - point).squaredNorm())
			best = i;
	return best;
}

TEST(VoronoiCells, NeighboursAreQhulls)
{
	for (const Matrix3Xd& points : {volumeCloud(500, 1), surfaceCloud("torus", 1500)}) {
		const EdgeSet ours = edgesOf(VoronoiCells(points));
		EXPECT_EQ(ours, qhullEdges(points));
	}
}

TEST(VoronoiCells, NeighboursAreSymmetricAndSorted)
{
	const VoronoiCells cells(surfaceCloud("helicoid", 1000));
	for (Index i = 0; i < cells.size(); ++i) {
		const NeighborLists::Row row = cells.neighbors(i);
		ASSERT_GE(row.size(), 3);
		EXPECT_TRUE(std::is_sorted(row.begin(), row.end()));
		for (Index j : row) {
			EXPECT_NE(i, j);
			EXPECT_TRUE(
				std::binary_search(cells.neighbors(j).begin(), cells.neighbors(j).end(), i));
		}
	}
}

TEST(VoronoiCells, CoplanarSitesKeepTheirPlanarNeighbours)
{
	samples::Random random(3, 1);
	Matrix3Xd       points(3, 20);
	for (Index i = 0; i < 20; ++i)
		points.col(i) = Vector3d(random.uniform(), random.uniform(), 0.25);
	const VoronoiCells cells(points);
	const EdgeSet      edges = edgesOf(cells);
	// Euler: a planar triangulation of n points, h of them on the hull, has 3 n - 3 - h edges.
	EXPECT_LE(edges.size(), 3u * 20u - 6u);
	EXPECT_GE(edges.size(), 2u * 20u - 3u);
	for (int k = 0; k < 200; ++k) {
		const Vector3d p(random.uniform(), random.uniform(), random.uniform());
		EXPECT_EQ(cells.locate(p, random.index(20)), nearestByBruteForce(points, p));
	}
}

TEST(VoronoiCells, RefusesPointsOnALine)
{
	Matrix3Xd points(3, 30);
	for (Index i = 0; i < 30; ++i)
		points.col(i) = Vector3d(i, 2.0 * i, -i);
	EXPECT_THROW(VoronoiCells cells(points), InputError);
	EXPECT_THROW(VoronoiCells cells(Matrix3Xd(3, 0)), InputError);
}

TEST(VoronoiCells, DuplicateSitesStayReachable)
{
	Matrix3Xd points = volumeCloud(60, 5);
	points.col(41)   = points.col(7);
	const VoronoiCells cells(points);
	EXPECT_GE(cells.neighbors(41).size(), 1);
	EXPECT_GE(cells.neighbors(7).size(), 1);
	for (Index start : {7, 41, 0})
		EXPECT_EQ(cells.locate(points.col(7), start), 7);
}

TEST(VoronoiCells, LocateIsTheNearestSiteFromAnyStart)
{
	const Matrix3Xd clouds[] = {
		volumeCloud(400, 2), surfaceCloud("torus", 800), surfaceCloud("cylinder", 800, true)};
	for (const Matrix3Xd& points : clouds) {
		const VoronoiCells cells(points);
		samples::Random    random(9, 1);
		for (int k = 0; k < 500; ++k) {
			const Index    near     = random.index(points.cols());
			const Vector3d p        = points.col(near) + 0.2 * random.normal3();
			const Index    expected = nearestByBruteForce(points, p);
			EXPECT_EQ(cells.locate(p, random.index(points.cols())), expected);
			EXPECT_EQ(cells.locate(p, near), expected);
		}
	}
}

TEST(VoronoiCells, LocateBreaksTiesByIndexWhereFourCellsMeet)
{
	const Index        rows   = 8;
	const Matrix3Xd    points = planarGrid(rows);
	const VoronoiCells cells(points);
	for (Index r = 0; r + 1 < rows; ++r)
		for (Index c = 0; c + 1 < rows; ++c) {
			const Vector3d corner = Vector3d(c + 0.5, r + 0.5, 0.0) / rows;
			for (Index start = 0; start < cells.size(); start += 7)
				EXPECT_EQ(cells.locate(corner, start), r * rows + c);
		}
}

// On every piece between two walls the cell must be the nearest site of all, and every wall must be as far
// from both its sites.
void expectExactWalk(
	const Matrix3Xd& points, const VoronoiCells& cells, const Vector3d& a, const Vector3d& b)
{
	Index        cell  = cells.locate(a, 0);
	const auto   walls = cells.walk(a, b, cell);
	double       t     = 0.0;
	const double slack = 1e-12;
	const auto   check = [&](double from, double to) {
        const Vector3d middle = a + 0.5 * (from + to) * (b - a);
        const Index    best   = nearestByBruteForce(points, middle);
        EXPECT_LE((points.col(cell) - middle).norm(), (points.col(best) - middle).norm() + slack);
	};
	for (const VoronoiCells::Crossing& wall : walls) {
		EXPECT_EQ(wall.from, cell);
		EXPECT_GE(wall.t, t);
		EXPECT_LE(wall.t, 1.0);
		check(t, wall.t);
		const Vector3d x = a + wall.t * (b - a);
		EXPECT_NEAR((points.col(wall.from) - x).norm(), (points.col(wall.to) - x).norm(), slack);
		t    = wall.t;
		cell = wall.to;
	}
	check(t, 1.0);
	EXPECT_EQ(cell, cells.locate(b, 0));
}

TEST(VoronoiCells, WalkCrossesEveryWall)
{
	for (const Matrix3Xd& points : {volumeCloud(300, 4), surfaceCloud("torus", 600)}) {
		const VoronoiCells cells(points);
		samples::Random    random(11, 1);
		for (int k = 0; k < 200; ++k)
			expectExactWalk(
				points,
				cells,
				points.col(random.index(points.cols())) + 0.1 * random.normal3(),
				points.col(random.index(points.cols())) + 0.1 * random.normal3());
	}
}

TEST(VoronoiCells, WalkSurvivesTies)
{
	const Index        rows   = 9;
	const Matrix3Xd    points = planarGrid(rows);
	const VoronoiCells cells(points);
	const Vector3d     first = points.col(0), last = points.col(points.cols() - 1);
	expectExactWalk(points, cells, first, last); // through the corners of the cells
	expectExactWalk(points, cells, last, first);
	const Vector3d half(0.5 / rows, 0.0, 0.0);
	expectExactWalk(points, cells, first + half, Vector3d(last + half)); // along walls
	EXPECT_TRUE(cells.walk(first, first, 0).empty());
}

TEST(VoronoiCells, CellsDoNotDependOnTheOrderOfSites)
{
	const Matrix3Xd points = surfaceCloud("cylinder", 500, true); // cospherical everywhere
	const Index     n      = static_cast<Index>(points.cols());
	Matrix3Xd       reversed(3, n);
	for (Index i = 0; i < n; ++i)
		reversed.col(i) = points.col(n - 1 - i);
	const EdgeSet forward = edgesOf(VoronoiCells(points));
	EdgeSet       backward;
	for (const auto& [i, j] : edgesOf(VoronoiCells(reversed)))
		backward.emplace(n - 1 - j, n - 1 - i);
	EXPECT_EQ(forward, backward);
}

} // namespace
} // namespace curvature_lines
