// Points above each face, the farthest as its apex, and rings between the face and the apex.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "face_caps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "cloud_index.h"
#include "curvature_field.h"
#include "mesh_distance.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "surface_projection.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// A face bulges when a point is above it by more than this, in its mean edges, and so many points by half of it.
constexpr double bulge       = 0.35;
constexpr Index  fewestAbove = 1;
// The foot of such a point lies inside the face: not so near to its sides, in mean edges, unless the point is this high.
constexpr double besideSide = 0.05, tall = 0.7;
constexpr Index  largestFace = 6; // sides
// The last ring is at one of these shares of the way to the apex: the first that leaves it so near, in mean edges.
constexpr double lastRings[] = {0.5, 0.65, 0.8, 0.9};
constexpr double apexLeft    = 0.15;
// Distance of rings in mean edges.
constexpr double ringStep = 1.2;
// A projection that moves a vertex further, in the height of the apex, has found another part of the surface.
constexpr double farthestMove = 0.5;
constexpr double sameSide     = 0.2;
constexpr Index  closestAsked = 16;

struct FaceShape {
	Vector3d center = Vector3d::Zero(), normal = Vector3d::Zero();
	double   edge = 0.0; // mean length
};

FaceShape shapeOf(const PolygonMesh& mesh, Index f)
{
	const NeighborLists::Row face = mesh.faces[f];
	FaceShape                shape;
	for (const Index v : face)
		shape.center += mesh.vertices.col(v) / double(face.size());
	for (Index k = 0; k < face.size(); ++k) {
		const Vector3d a = mesh.vertices.col(face[k]);
		const Vector3d b = mesh.vertices.col(face[(k + 1) % face.size()]);
		shape.normal += (a - shape.center).cross(b - shape.center);
		shape.edge += (b - a).norm() / double(face.size());
	}
	shape.normal.normalize();
	return shape;
}

double distanceToSides(const PolygonMesh& mesh, Index f, const Vector3d& p)
{
	const NeighborLists::Row face  = mesh.faces[f];
	double                   least = INFINITY;
	for (Index k = 0; k < face.size(); ++k) {
		const Vector3d a    = mesh.vertices.col(face[k]);
		const Vector3d side = mesh.vertices.col(face[(k + 1) % face.size()]) - a;
		const double   t    = (p - a).dot(side) / (side.squaredNorm() + 1e-300);
		least               = std::min(least, (p - a - std::clamp(t, 0.0, 1.0) * side).norm());
	}
	return least;
}

struct Ring {
	std::vector<Vector3d> points, normals;
};

class Caps {
public:
	Caps(const CloudIndex& index, const CurvatureField& curvature, const PolygonMesh& mesh) :
			m_index(index), m_curvature(curvature), m_mesh(mesh), m_apex(mesh.faceCount(), -1),
			m_loops(faceLoopsOf(mesh))
	{
		for (Index v = 0; v < mesh.vertexCount(); ++v) {
			m_vertices.push_back(mesh.vertices.col(v));
			m_normals.push_back(mesh.normals.col(v));
		}
		for (Index f = 0; f < mesh.faceCount(); ++f)
			m_shapes.push_back(shapeOf(mesh, f));
		findApexes();
	}

	Index add()
	{
		Index count = 0;
		for (Index f = 0; f < m_mesh.faceCount(); ++f)
			if (m_apex[f] >= 0) {
				addCap(f);
				++count;
			}
		return count;
	}

	PolygonMesh result() const { return polygonMesh(m_vertices, m_normals, m_loops); }

private:
	void findApexes()
	{
		const Eigen::Matrix3Xd& points = m_index.cloud().positions;
		const MeshDistance      found  = distanceToMesh(m_mesh, points);
		const double            least  = bulge;
		std::vector<Index>      above(m_mesh.faceCount(), 0);
		for (Index i = 0; i < m_index.size(); ++i) {
			const Index      f     = found.face[i];
			const FaceShape& shape = m_shapes[f];
			const double     share = found.distance[i] / shape.edge;
			const Vector3d   step  = points.col(i) - found.foot.col(i);
			if (share < 0.5 * least || m_mesh.faces[f].size() > largestFace ||
			    step.dot(shape.normal) < 0.5 * found.distance[i])
				continue;
			if (share < tall &&
			    distanceToSides(m_mesh, f, found.foot.col(i)) < besideSide * shape.edge)
				continue;
			++above[f];
			if (share >= least && (m_apex[f] < 0 || found.distance[i] > found.distance[m_apex[f]]))
				m_apex[f] = i;
		}
		for (Index f = 0; f < m_mesh.faceCount(); ++f)
			if (above[f] < fewestAbove)
				m_apex[f] = -1;
	}

	// Between the corners of face f and the apex, on the surface.
	Ring ringAt(Index f, double share) const
	{
		const FaceShape& shape  = m_shapes[f];
		const Vector3d   apex   = m_index.cloud().positions.col(m_apex[f]);
		const Vector3d   axis   = apex - shape.center;
		const double     height = axis.norm();
		Ring             ring;
		for (const Index v : m_mesh.faces[f]) {
			Vector3d p = m_mesh.vertices.col(v);
			p += share * (apex - p);
			const Vector3d out =
				p - shape.center - (p - shape.center).dot(axis) / (height * height) * axis;
			const Vector3d side   = (out.normalized() + 0.5 * axis / height).normalized();
			Vector3d       normal = side;
			for (const Index i : m_index.search().nearest(p, closestAsked)) {
				if (m_index.cloud().normals.col(i).dot(side) < sameSide)
					continue;
				const SurfaceSample sample =
					projectToSurface(m_index.cloud(), m_curvature, p, i, ProjectionKind::Mixed);
				if ((sample.position - p).norm() < farthestMove * std::max(height, shape.edge) &&
				    sample.normal.dot(side) > 0.0) {
					p      = sample.position;
					normal = sample.normal;
				}
				break;
			}
			ring.points.push_back(p);
			ring.normals.push_back(normal);
		}
		return ring;
	}

	void addCap(Index f)
	{
		const FaceShape& shape = m_shapes[f];
		const Vector3d   apex  = m_index.cloud().positions.col(m_apex[f]);
		double           last  = 0.0;
		for (const double share : lastRings) {
			last              = share;
			const Ring ring   = ringAt(f, share);
			Vector3d   center = Vector3d::Zero();
			for (const Vector3d& p : ring.points)
				center += p / double(ring.points.size());
			if ((apex - center).norm() < apexLeft * shape.edge)
				break;
		}
		double way = 0.0;
		for (const Index v : m_mesh.faces[f])
			way += (apex - m_mesh.vertices.col(v)).norm() / double(m_mesh.faces[f].size());
		const int rings = std::max(1, int(std::lround(last * way / (ringStep * shape.edge))));
		std::vector<Index> below = m_loops[f];
		for (int r = 1; r <= rings; ++r) {
			const Ring         ring = ringAt(f, last * r / rings);
			std::vector<Index> names;
			for (std::size_t k = 0; k < ring.points.size(); ++k) {
				names.push_back(static_cast<Index>(m_vertices.size()));
				m_vertices.push_back(ring.points[k]);
				m_normals.push_back(ring.normals[k]);
			}
			for (std::size_t k = 0; k < names.size(); ++k) {
				const std::size_t next = (k + 1) % names.size();
				m_loops.push_back({below[k], below[next], names[next], names[k]});
			}
			below = std::move(names);
		}
		m_loops[f] = below;
	}

	const CloudIndex&      m_index;
	const CurvatureField&  m_curvature;
	const PolygonMesh&     m_mesh;
	std::vector<Index>     m_apex; // of every face: its highest point; -1: it does not bulge
	std::vector<FaceShape> m_shapes;
	std::vector<Vector3d>  m_vertices, m_normals;
	std::vector<std::vector<Index>> m_loops;
};

} // namespace

Index capBulgingFaces(
	const CloudIndex&     index,
	const CurvatureField& curvature,
	PolygonMesh&          mesh,
	std::vector<char>&    onFeature)
{
	if (mesh.faceCount() == 0)
		return 0;
	Caps        caps(index, curvature, mesh);
	const Index count = caps.add();
	if (count > 0) {
		mesh = caps.result();
		onFeature.resize(mesh.vertexCount(), 0);
	}
	return count;
}

} // namespace curvature_lines
