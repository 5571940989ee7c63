// Faces against the normals of their vertices, points against their nearest face.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_quality.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "mesh_distance.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "progress.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

constexpr double coveredEdges = 2.0;

double meanEdge(const PolygonMesh& mesh, Index f)
{
	const NeighborLists::Row face = mesh.faces[f];
	double                   sum  = 0.0;
	for (Index k = 0; k < face.size(); ++k)
		sum += (mesh.vertices.col(face[k]) - mesh.vertices.col(face[(k + 1) % face.size()])).norm();
	return sum / double(std::max<Index>(face.size(), 1));
}

} // namespace

Index foldedFaces(const PolygonMesh& mesh)
{
	Index count = 0;
	for (Index f = 0; f < mesh.faceCount(); ++f) {
		const NeighborLists::Row face    = mesh.faces[f];
		Vector3d                 area    = Vector3d::Zero();
		Vector3d                 normals = Vector3d::Zero();
		const Vector3d           origin  = mesh.vertices.col(face[0]);
		for (Index k = 0; k < face.size(); ++k) {
			const Vector3d here = mesh.vertices.col(face[k]);
			const Vector3d next = mesh.vertices.col(face[(k + 1) % face.size()]);
			area += (here - origin).cross(next - origin);
			normals += mesh.normals.col(face[k]);
		}
		count += area.dot(normals) < 0.0;
	}
	return count;
}

double scaledJacobian(const PolygonMesh& mesh, Index face)
{
	return scaledJacobian(mesh.vertices, mesh.normals, mesh.faces[face]);
}

double scaledJacobian(
	const Eigen::Matrix3Xd& vertices, const Eigen::Matrix3Xd& normals, NeighborLists::Row face)
{
	const Index count  = face.size();
	Vector3d    normal = Vector3d::Zero();
	for (const Index v : face)
		normal += normals.col(v);
	normal.normalize();
	Vector3d own = normal;
	if (count == 4)
		own = (vertices.col(face[2]) - vertices.col(face[0]))
		          .cross(vertices.col(face[3]) - vertices.col(face[1]))
		          .normalized();
	double least = 1.0, ownLeast = 1.0;
	for (Index k = 0; k < count; ++k) {
		const Vector3d here   = vertices.col(face[k]);
		const Vector3d ahead  = vertices.col(face[(k + 1) % count]) - here;
		const Vector3d back   = vertices.col(face[(k + count - 1) % count]) - here;
		const Vector3d turned = ahead.cross(back) / (ahead.norm() * back.norm() + 1e-300);
		least                 = std::min(least, turned.dot(normal));
		ownLeast              = std::min(ownLeast, turned.dot(own));
	}
	// Of a quad on a strong bend the normals of its vertices say little about how it lies itself.
	return ownLeast < 0.0 ? std::min(least, ownLeast) : least;
}

MeshCoverage
coverageOf(const PolygonMesh& mesh, const Eigen::Matrix3Xd& points, const Progress& progress)
{
	MeshCoverage       coverage;
	const MeshDistance found = distanceToMesh(mesh, points, progress);
	for (Eigen::Index i = 0; i < points.cols(); ++i) {
		const Index f       = found.face[i];
		coverage.largestGap = std::max(coverage.largestGap, found.distance[i]);
		coverage.uncovered += f < 0 || found.distance[i] > coveredEdges * meanEdge(mesh, f);
	}
	return coverage;
}

} // namespace curvature_lines
