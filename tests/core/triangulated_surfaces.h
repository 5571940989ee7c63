// Triangulations of exact surfaces with their normals and principal directions at the vertices, for the tests of what
// works on a triangulation.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "analytic_surfaces.h"
#include "point_cloud.h"
#include "triangle_mesh.h"

namespace curvature_lines::test {

struct TriangulatedSurface {
	TriangleMesh         mesh;
	samples::GroundTruth truth; // of the vertices

	Index size() const { return mesh.vertexCount(); }
};

// A grid of columns x rows squares, each cut in two, whose columns or rows may be joined at their ends. Vertex (i, j) is
// at position(i / columns, j / rows); a face looks to the side of d/du x d/dv.
template<class Position>
TriangleMesh
triangulatedGrid(int columns, int rows, bool joinColumns, bool joinRows, const Position& position)
{
	const int             across = columns + !joinColumns, up = rows + !joinRows;
	Eigen::Matrix3Xd      vertices(3, across * up);
	std::vector<Triangle> triangles;
	const auto number = [&](int i, int j) { return Index((i % across) + across * (j % up)); };
	for (int j = 0; j < up; ++j)
		for (int i = 0; i < across; ++i)
			vertices.col(number(i, j)) = position(double(i) / columns, double(j) / rows);
	for (int j = 0; j < rows; ++j)
		for (int i = 0; i < columns; ++i) {
			// the diagonal changes its direction, so that no direction is a favourite
			const Index a = number(i, j), b = number(i + 1, j), c = number(i + 1, j + 1),
						d = number(i, j + 1);
			if ((i + j) % 2 == 0) {
				triangles.push_back({a, b, c});
				triangles.push_back({a, c, d});
			}
			else {
				triangles.push_back({a, b, d});
				triangles.push_back({b, c, d});
			}
		}
	return TriangleMesh(vertices, triangles);
}

inline TriangulatedSurface withTruth(const std::string& surface, TriangleMesh mesh)
{
	samples::GroundTruth truth = samples::groundTruth(samples::surface(surface), mesh.vertices);
	return {std::move(mesh), std::move(truth)};
}

// The unit square around the origin; inner vertices are moved by up to `jitter` of an edge.
inline TriangulatedSurface triangulatedPlane(int cells, double jitter = 0.0)
{
	samples::Random    random(11, 0);
	const TriangleMesh mesh = triangulatedGrid(cells, cells, false, false, [&](double u, double v) {
		const bool   inside = u > 0.0 && u < 1.0 && v > 0.0 && v < 1.0;
		const double most   = inside ? jitter / cells : 0.0;
		const double x = random.uniform(-most, most), y = random.uniform(-most, most);
		return Eigen::Vector3d(u - 0.5 + x, v - 0.5 + y, 0.0);
	});
	return withTruth("plane", mesh);
}

// R = 1, r = 0.4
inline TriangulatedSurface triangulatedTorus(int around, int tube)
{
	return withTruth("torus", triangulatedGrid(around, tube, true, true, [](double u, double v) {
						 const double a = 2.0 * EIGEN_PI * u, b = 2.0 * EIGEN_PI * v,
									  rho = 1.0 + 0.4 * std::cos(b);
						 return Eigen::Vector3d(
							 rho * std::cos(a), rho * std::sin(a), 0.4 * std::sin(b));
					 }));
}

// Radius 0.5, height 2, open at both ends
inline TriangulatedSurface triangulatedCylinder(int around, int up)
{
	return withTruth("cylinder", triangulatedGrid(around, up, true, false, [](double u, double v) {
						 const double a = 2.0 * EIGEN_PI * u;
						 return Eigen::Vector3d(
							 0.5 * std::cos(a), 0.5 * std::sin(a), 2.0 * v - 1.0);
					 }));
}

// An icosahedron, every triangle cut in four `levels` times, on the unit sphere
inline TriangulatedSurface triangulatedSphere(int levels)
{
	const double                 g      = 0.5 * (1.0 + std::sqrt(5.0));
	std::vector<Eigen::Vector3d> points = {
		{-1, g, 0},
		{1, g, 0},
		{-1, -g, 0},
		{1, -g, 0},
		{0, -1, g},
		{0, 1, g},
		{0, -1, -g},
		{0, 1, -g},
		{g, 0, -1},
		{g, 0, 1},
		{-g, 0, -1},
		{-g, 0, 1}};
	std::vector<Triangle> triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
	                                   {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
	                                   {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
	                                   {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
	for (int level = 0; level < levels; ++level) {
		std::map<std::pair<Index, Index>, Index> middles;
		const auto                               middle = [&](Index a, Index b) {
            const auto [at, isNew] =
                middles.try_emplace(std::minmax(a, b), static_cast<Index>(points.size()));
            if (isNew)
                points.push_back(points[a] + points[b]);
            return at->second;
		};
		std::vector<Triangle> finer;
		for (const auto& [a, b, c] : triangles) {
			const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
			for (const Triangle& t :
			     {Triangle{a, ab, ca},
			      Triangle{ab, b, bc},
			      Triangle{ca, bc, c},
			      Triangle{ab, bc, ca}})
				finer.push_back(t);
		}
		triangles = finer;
		for (Eigen::Vector3d& p : points)
			p.normalize();
	}
	Eigen::Matrix3Xd vertices(3, points.size());
	for (std::size_t k = 0; k < points.size(); ++k)
		vertices.col(k) = points[k].normalized();
	return withTruth("sphere", TriangleMesh(vertices, triangles));
}

// A rotation and a translation for tests of invariance.
struct RigidMotion {
	Eigen::Matrix3d rotation =
		Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, -2.0, 3.0).normalized()).toRotationMatrix();
	Eigen::Vector3d translation = {3.0, -5.0, 2.0};

	Eigen::Matrix3Xd ofPoints(const Eigen::Matrix3Xd& p) const
	{
		return (rotation * p).colwise() + translation;
	}
	Eigen::Matrix3Xd ofVectors(const Eigen::Matrix3Xd& v) const { return rotation * v; }

	// `scale` times as large, too.
	TriangulatedSurface of(TriangulatedSurface surface, double scale) const
	{
		samples::GroundTruth& truth = surface.truth;
		surface.mesh.vertices       = scale * ofPoints(surface.mesh.vertices);
		truth.footPoints            = scale * ofPoints(truth.footPoints);
		truth.normals               = ofVectors(truth.normals);
		truth.d1                    = ofVectors(truth.d1);
		truth.d2                    = ofVectors(truth.d2);
		truth.k1 /= scale;
		truth.k2 /= scale;
		return surface;
	}
};

} // namespace curvature_lines::test
