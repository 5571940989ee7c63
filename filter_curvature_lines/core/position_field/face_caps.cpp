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

// In mean edges of a face. The foot of a point above it lies inside: not so near to its sides. A point as high as `tall` is
// above the face nearby that faces it most; one beyond `farthest` tells that something else is missing than the end of a limb.
constexpr double besideSide = 0.05, tall = 0.7, farthest = 5.0;
constexpr Index  largestFace = 6; // sides
// Cosine between the way to such a point and the face's normal, at least; and faces nearby that are asked.
constexpr double facing     = 0.5;
constexpr Index  facesAsked = 16;
// Where all these points look back at the face (cosine between the normals, at most) they are on another sheet. Around a
// tip normals point to all sides, and a single point may be all there is.
constexpr double opposing = -0.8;
// The last ring is at one of these shares of the way to the apex: the first that leaves it so near, in mean edges.
constexpr double lastRings[] = {0.5, 0.65, 0.8, 0.9};
constexpr double apexLeft    = 0.15;
// Distance of rings in mean edges.
constexpr double ringStep = 1.2;
// A projection that moves a vertex further, in the height of the apex, has found another part of the surface.
constexpr double farthestMove = 0.5;

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

std::vector<FaceShape> shapesOf(const PolygonMesh& mesh)
{
	std::vector<FaceShape> shapes;
	shapes.reserve(mesh.faceCount());
	for (Index f = 0; f < mesh.faceCount(); ++f)
		shapes.push_back(shapeOf(mesh, f));
	return shapes;
}

Eigen::Matrix3Xd centersOf(const std::vector<FaceShape>& shapes)
{
	Eigen::Matrix3Xd centers(3, shapes.size());
	for (std::size_t f = 0; f < shapes.size(); ++f)
		centers.col(f) = shapes[f].center;
	return centers;
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
	Caps(
		const CloudIndex&     index,
		const CurvatureField& curvature,
		double                bulge,
		const PolygonMesh&    mesh) :
			m_index(index), m_curvature(curvature), m_bulge(bulge), m_mesh(mesh),
			m_apex(mesh.faceCount(), -1), m_loops(faceLoopsOf(mesh)), m_shapes(shapesOf(mesh)),
			m_centerPoints(centersOf(m_shapes)), m_centers(m_centerPoints)
	{
		for (Index v = 0; v < mesh.vertexCount(); ++v) {
			m_vertices.push_back(mesh.vertices.col(v));
			m_normals.push_back(mesh.normals.col(v));
		}
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
		std::vector<char>       agrees(m_mesh.faceCount(), 0);
		for (Index i = 0; i < m_index.size(); ++i) {
			const Index f = faceBelow(i, found);
			if (f < 0)
				continue;
			if (found.distance[i] >= m_bulge * m_shapes[f].edge &&
			    (m_apex[f] < 0 || found.distance[i] > found.distance[m_apex[f]]))
				m_apex[f] = i;
			if (m_index.cloud().normals.col(i).dot(m_shapes[f].normal) > opposing)
				agrees[f] = 1;
		}
		for (Index f = 0; f < m_mesh.faceCount(); ++f)
			if (!agrees[f])
				m_apex[f] = -1;
	}

	// The face that point i is above; -1: none, or not far.
	Index faceBelow(Index i, const MeshDistance& found) const
	{
		if (found.face[i] < 0) // no face has an area
			return -1;
		const Vector3d p     = m_index.cloud().positions.col(i);
		const Vector3d foot  = found.foot.col(i);
		const auto     rises = [&](Index f, double edges) {
            return found.distance[i] >= edges * m_shapes[f].edge &&
                   m_mesh.faces[f].size() <= largestFace;
		};
		const Index      nearest = found.face[i];
		const FaceShape& shape   = m_shapes[nearest];
		if ((p - foot).dot(shape.normal) >= facing * found.distance[i] &&
		    distanceToSides(m_mesh, nearest, foot) >= besideSide * shape.edge)
			return rises(nearest, 0.5 * m_bulge) ? nearest : -1;
		// Beside the end of a limb the nearest face is one of its sides; and of the faces beside an edge, which one is the
		// nearest is a matter of rounding.
		double best = facing;
		Index  f    = -1;
		if (!rises(nearest, 0.5 * tall))
			return -1;
		for (const Index other : m_centers.nearest(foot, facesAsked)) {
			const Vector3d way    = p - m_shapes[other].center;
			const double   cosine = way.normalized().dot(m_shapes[other].normal);
			if (cosine > best && found.distance[i] < farthest * m_shapes[other].edge) {
				best = cosine;
				f    = other;
			}
		}
		return f >= 0 && rises(f, tall) ? f : -1;
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
			const Vector3d      side   = (out.normalized() + 0.5 * axis / height).normalized();
			Vector3d            normal = side;
			const SurfaceSample sample = projectToSurface(
				m_index.cloud(),
				m_curvature,
				p,
				closestOnSide(m_index, p, side),
				ProjectionKind::Mixed);
			if ((sample.position - p).norm() < farthestMove * std::max(height, shape.edge) &&
			    sample.normal.dot(side) > 0.0) {
				p      = sample.position;
				normal = sample.normal;
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

	const CloudIndex&     m_index;
	const CurvatureField& m_curvature;
	double                m_bulge;
	const PolygonMesh&    m_mesh;
	std::vector<Index>    m_apex; // of every face: its highest point; -1: it does not bulge
	std::vector<std::vector<Index>> m_loops;
	std::vector<FaceShape>          m_shapes;
	Eigen::Matrix3Xd                m_centerPoints;
	NeighborSearch                  m_centers;
	std::vector<Vector3d>           m_vertices, m_normals;
};

} // namespace

Index capBulgingFaces(
	const CloudIndex&     index,
	const CurvatureField& curvature,
	double                bulge,
	PolygonMesh&          mesh,
	std::vector<char>&    onFeature)
{
	if (mesh.faceCount() == 0)
		return 0;
	Caps        caps(index, curvature, bulge, mesh);
	const Index count = caps.add();
	if (count > 0) {
		mesh = caps.result();
		onFeature.resize(mesh.vertexCount(), 0);
	}
	return count;
}

} // namespace curvature_lines
