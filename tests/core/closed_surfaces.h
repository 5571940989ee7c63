// Surfaces with crosses and closed position fields, for the tests of what comes after them.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "analytic_surfaces.h"
#include "closed_position_field.h"
#include "cross_field.h"
#include "feature_alignment.h"
#include "line_density.h"
#include "phase_pins.h"
#include "point_cloud.h"
#include "position_field.h"
#include "rims.h"
#include "scaffold.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines::test {

inline Scaffold scaffoldOf(const TriangleMesh& mesh)
{
	Scaffold     scaffold;
	const Index  n       = mesh.vertexCount();
	const double spacing = std::sqrt(mesh.vertexAreas().sum() / std::max(n, Index(1)));
	scaffold.mesh        = mesh;
	scaffold.source.resize(n);
	std::iota(scaffold.source.begin(), scaffold.source.end(), Index(0));
	scaffold.place = scaffold.source;
	scaffold.creaseEdge.assign(mesh.edgeCount(), 0);
	scaffold.spacing.setConstant(n, spacing);
	scaffold.size.setConstant(n, 2.0 * spacing);
	return scaffold;
}

inline DirectionGuide guideOf(const TriangulatedSurface& surface, double weight)
{
	DirectionGuide guide;
	guide.normals    = surface.truth.normals;
	guide.directions = surface.truth.d1;
	guide.weights.setConstant(surface.size(), weight);
	guide.onCrease.assign(surface.size(), 0);
	return guide;
}

// The three half axes are those of the sample surface.
inline TriangulatedSurface triangulatedEllipsoid(int levels)
{
	TriangleMesh mesh = triangulatedSphere(levels).mesh;
	const auto&  box  = samples::surface("ellipsoid").boundingBox();
	mesh.vertices     = (0.5 * box.sizes()).asDiagonal() * mesh.vertices;
	return withTruth("ellipsoid", std::move(mesh));
}

// The unit cube around the origin, its sides grids of so many squares.
inline TriangleMesh triangulatedCube(int cells)
{
	std::vector<Eigen::Vector3d> points;
	std::vector<Triangle>        triangles;
	const auto                   vertexAt = [&](const Eigen::Vector3d& p) {
        for (std::size_t v = 0; v < points.size(); ++v)
            if ((points[v] - p).norm() < 1e-9)
                return static_cast<Index>(v);
        points.push_back(p);
        return static_cast<Index>(points.size()) - 1;
	};
	for (int axis = 0; axis < 3; ++axis)
		for (const double side : {-0.5, 0.5}) {
			const Eigen::Vector3d u = Eigen::Vector3d::Unit((axis + 1) % 3),
								  v = Eigen::Vector3d::Unit((axis + 2) % 3);
			const auto at           = [&](int i, int j) {
                return vertexAt(
                    side * Eigen::Vector3d::Unit(axis) + (double(i) / cells - 0.5) * u +
                    (double(j) / cells - 0.5) * v);
			};
			for (int i = 0; i < cells; ++i)
				for (int j = 0; j < cells; ++j) {
					std::array<Index, 4> quad = {
						at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
					if (side < 0.0)
						std::swap(quad[1], quad[3]);
					triangles.push_back({quad[0], quad[1], quad[2]});
					triangles.push_back({quad[0], quad[2], quad[3]});
				}
		}
	Eigen::Matrix3Xd vertices(3, points.size());
	for (std::size_t k = 0; k < points.size(); ++k)
		vertices.col(static_cast<Index>(k)) = points[k];
	return TriangleMesh(vertices, triangles);
}

// Its edges are creases; nothing is known of directions.
struct CreasedCube {
	Scaffold       scaffold;
	DirectionGuide guide;

	explicit CreasedCube(int cells) : scaffold(scaffoldOf(triangulatedCube(cells)))
	{
		const TriangleMesh& mesh = scaffold.mesh;
		guide.normals            = mesh.vertexNormals();
		guide.weights.setZero(mesh.vertexCount());
		guide.onCrease.assign(mesh.vertexCount(), 0);
		for (Index e = 0; e < mesh.edgeCount(); ++e) {
			const auto& edge = mesh.edges()[e];
			if (mesh.areaVector(edge.left).normalized().dot(
					mesh.areaVector(edge.right).normalized()) > 0.5)
				continue;
			scaffold.creaseEdge[e]    = 1;
			guide.onCrease[edge.from] = guide.onCrease[edge.to] = 1;
		}
		guide.directions.resize(3, mesh.vertexCount());
		for (Index v = 0; v < mesh.vertexCount(); ++v)
			guide.directions.col(v) = guide.normals.col(v).unitOrthogonal();
	}
};

// A scaffold all the way to a closed position field, `perLength` lines of either family per unit of length.
struct ClosedSurface {
	Scaffold            scaffold;
	DirectionGuide      guide;
	FeatureAlignment    alignment;
	LineDensity         density;
	PhasePins           pins;
	PositionField       open; // before it is closed
	CrossField          openField;
	ClosedPositionField closed;

	ClosedSurface(Scaffold from, DirectionGuide known, double perLength) :
			scaffold(std::move(from)), guide(std::move(known))
	{
		const TriangleMesh& mesh = scaffold.mesh;
		alignment                = alignWithFeatures(scaffold, findRims(mesh), guide);
		openField                = smoothCrossField(mesh, guide);
		density                  = LineDensity::Constant(2, mesh.vertexCount(), perLength);
		pins                     = featurePins(alignment, openField);
		open                     = positionField(mesh, openField, density, pins);
		closed                   = closePositionField(mesh, guide, openField, density, pins, open);
	}
	ClosedSurface(const TriangulatedSurface& surface, double weight, double perLength) :
			ClosedSurface(scaffoldOf(surface.mesh), guideOf(surface, weight), perLength)
	{
	}
};

} // namespace curvature_lines::test
