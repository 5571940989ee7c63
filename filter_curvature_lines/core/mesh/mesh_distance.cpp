// CGAL's tree of boxes over the triangles of the faces.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_distance.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include "point_cloud.h"
#include "polygon_mesh.h"
#include "progress.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;
using Kernel    = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree      = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 toCgal(const Vector3d& p)
{
	return {p.x(), p.y(), p.z()};
}

} // namespace

FaceTriangles faceTriangles(const PolygonMesh& mesh)
{
	FaceTriangles result;
	const auto    add = [&](Index face, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
        result.corners.push_back({a, b, c});
        result.face.push_back(face);
	};
	for (Index f = 0; f < mesh.faceCount(); ++f) {
		const NeighborLists::Row face = mesh.faces[f];
		const auto               at   = [&](Index k) -> Vector3d {
            return mesh.vertices.col(face[k % face.size()]);
		};
		if (face.size() == 4) {
			const Index first = (at(0) - at(2)).norm() <= (at(1) - at(3)).norm() ? 0 : 1;
			add(f, at(first), at(first + 1), at(first + 2));
			add(f, at(first + 2), at(first + 3), at(first));
			continue;
		}
		Vector3d center = Vector3d::Zero();
		for (const Index v : face)
			center += mesh.vertices.col(v) / double(face.size());
		for (Index k = 0; k < face.size(); ++k)
			add(f, center, at(k), at(k + 1));
	}
	return result;
}

MeshDistance
distanceToMesh(const PolygonMesh& mesh, const Eigen::Matrix3Xd& points, const Progress& progress)
{
	const auto   count = static_cast<Index>(points.cols());
	MeshDistance result;
	result.distance.setConstant(count, INFINITY);
	result.foot.setZero(3, count);
	result.face.assign(count, -1);
	const FaceTriangles faces = faceTriangles(mesh);
	Triangles           triangles;
	std::vector<Index>  face;
	for (std::size_t t = 0; t < faces.corners.size(); ++t) {
		const auto& [a, b, c] = faces.corners[t];
		const Kernel::Triangle_3 triangle(toCgal(a), toCgal(b), toCgal(c));
		if (triangle.is_degenerate()) // the triangles beside it cover its sides
			continue;
		triangles.push_back(triangle);
		face.push_back(faces.face[t]);
	}
	if (triangles.empty())
		return result;
	Tree tree(triangles.cbegin(), triangles.cend());
	tree.build();
	tree.accelerate_distance_queries();
	parallelFor(count, progress, [&](Index i) {
		const Kernel::Point_3 p     = toCgal(points.col(i));
		const auto [foot, triangle] = tree.closest_point_and_primitive(p);
		result.foot.col(i)          = Vector3d(foot.x(), foot.y(), foot.z());
		result.distance[i]          = (result.foot.col(i) - points.col(i)).norm();
		result.face[i]              = face[triangle - triangles.cbegin()];
	});
	return result;
}

} // namespace curvature_lines
