// Smart Laplacian smoothing (Freitag 1997) of the vertices of bad faces, and where that does not help a search around them;
// each step is projected onto the surface.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "face_untangling.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "cloud_index.h"
#include "curvature_field.h"
#include "mesh_distance.h"
#include "mesh_quality.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "surface_projection.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// Faces below this scaled Jacobian are unsound: with a corner of more than 174 degrees, or turned over.
constexpr double sound = 0.1;
// Those below this one are worth a try.
constexpr double wanted = 0.3;
constexpr int    rounds = 16;
// Of the worst scaled Jacobian around a vertex that moves: more than rounding, which would follow the order of the points
// where the worst corner is one that the move leaves alone.
constexpr double leastGain = 1e-3;
// Shares of the way to the mean of the neighbours that are tried.
constexpr double shares[] = {1.0, 0.5, 0.25};
// And steps in so many directions around, in mean edges.
constexpr int    directions = 8;
constexpr double steps[]    = {0.3, 0.1};
// In mean edges: projections go no farther.
constexpr double farthest = 0.3;
// Nor do vertices, from where they have been at first: step after step, and with edges that grow on the way, one would leave
// the surface.
constexpr double longestWay = 1.0;
// Nor farther from the points than that, or than they have been: the surface of a few points is known near them only.
constexpr double fromPoints = 0.5;
// In mean edges: where a vertex of faces that are not turned over has been, the faces are no farther. The vertex at a tip
// would cut it off.
constexpr double farthestLoss = 0.2;

class Untangling {
public:
	Untangling(
		const CloudIndex&        index,
		const CurvatureField&    curvature,
		const std::vector<char>& fixed,
		PolygonMesh&             mesh) :
			m_index(index), m_curvature(curvature), m_fixed(fixed), m_mesh(mesh),
			m_home(mesh.vertices), m_edge(mesh.vertexCount()), m_off(mesh.vertexCount()),
			m_faces(mesh.vertexCount())
	{
		for (Index f = 0; f < mesh.faceCount(); ++f)
			for (const Index v : mesh.faces[f])
				m_faces[v].push_back(f);
		for (Index v = 0; v < mesh.vertexCount(); ++v)
			m_edge[v] = meanEdge(v);
		for (Index v = 0; v < mesh.vertexCount(); ++v)
			if (!fixed[v])
				m_off[v] = std::max(fromPoints * m_edge[v], distanceFromPoints(v));
		m_kept.reserve(mesh.vertexCount());
		for (Index v = 0; v < mesh.vertexCount(); ++v)
			m_kept.push_back(!fixed[v] && worstAround(v) >= 0.0);
	}

	Index run()
	{
		std::vector<Index> bad = below(wanted);
		for (int round = 0; round < rounds && !bad.empty(); ++round) {
			std::vector<char> asked(m_mesh.vertexCount(), 0);
			bool              moved = false;
			for (const Index f : bad)
				for (const Index v : m_mesh.faces[f])
					if (!m_fixed[v] && !std::exchange(asked[v], 1))
						moved = improve(v) || moved;
			if (!moved)
				break;
			bad = below(wanted);
		}
		return static_cast<Index>(below(sound).size());
	}

private:
	std::vector<Index> below(double bound) const
	{
		std::vector<Index> bad;
		for (Index f = 0; f < m_mesh.faceCount(); ++f)
			if (scaledJacobian(m_mesh, f) < bound)
				bad.push_back(f);
		return bad;
	}

	double worstAround(Index v) const
	{
		double worst = 1.0;
		for (const Index f : m_faces[v])
			worst = std::min(worst, scaledJacobian(m_mesh, f));
		return worst;
	}

	// Mean of the vertices that an edge joins to v; every inner edge counts twice.
	Vector3d meanOfNeighbors(Index v) const
	{
		Vector3d sum = Vector3d::Zero();
		for (const Index f : m_faces[v]) {
			const NeighborLists::Row face = m_mesh.faces[f];
			const auto               at =
				static_cast<Index>(std::find(face.begin(), face.end(), v) - face.begin());
			sum += m_mesh.vertices.col(face[(at + 1) % face.size()]);
			sum += m_mesh.vertices.col(face[(at + face.size() - 1) % face.size()]);
		}
		return sum / (2.0 * double(m_faces[v].size()));
	}

	double distanceFromPoints(Index v) const
	{
		const Vector3d p = m_home.col(v);
		return (m_index.cloud().positions.col(closestOnSide(m_index, p, m_mesh.normals.col(v))) - p)
		    .norm();
	}

	bool improve(Index v)
	{
		const Vector3d position = m_mesh.vertices.col(v), normal = m_mesh.normals.col(v);
		const Vector3d mean   = meanOfNeighbors(v);
		const double   before = worstAround(v);
		if (before >= wanted)
			return false;
		for (const double share : shares)
			if (isBetterAt(v, position + share * (mean - position), before, position, normal))
				return true;
		const Vector3d x = normal.unitOrthogonal(), y = normal.cross(x);
		const double   edge = m_edge[v];
		for (const double step : steps)
			for (int k = 0; k < directions; ++k) {
				const double   angle = 2.0 * double(EIGEN_PI) * k / directions;
				const Vector3d p =
					position + step * edge * (std::cos(angle) * x + std::sin(angle) * y);
				if (isBetterAt(v, p, before, position, normal))
					return true;
			}
		return false;
	}

	// Moves v to p, on the surface, or leaves it with its position and normal.
	bool isBetterAt(
		Index v, const Vector3d& p, double before, const Vector3d& position, const Vector3d& normal)
	{
		const Index         closest = closestOnSide(m_index, p, normal);
		const SurfaceSample sample =
			projectToSurface(m_index.cloud(), m_curvature, p, closest, ProjectionKind::Mixed);
		const double off       = (sample.position - m_index.cloud().positions.col(closest)).norm();
		m_mesh.vertices.col(v) = sample.position;
		m_mesh.normals.col(v)  = sample.normal;
		// Onto another part of the surface is no step.
		if ((sample.position - p).norm() < farthest * m_edge[v] &&
		    (sample.position - m_home.col(v)).norm() < longestWay * m_edge[v] && off <= m_off[v] &&
		    worstAround(v) > before + leastGain &&
		    (!m_kept[v] || lossAt(v) < farthestLoss * m_edge[v]))
			return true;
		m_mesh.vertices.col(v) = position;
		m_mesh.normals.col(v)  = normal;
		return false;
	}

	// How far the faces around v, and those around them, are from where it has been at first.
	double lossAt(Index v) const
	{
		std::vector<Index> near;
		for (const Index f : m_faces[v])
			for (const Index corner : m_mesh.faces[f])
				near.insert(near.end(), m_faces[corner].begin(), m_faces[corner].end());
		std::sort(near.begin(), near.end());
		near.erase(std::unique(near.begin(), near.end()), near.end());
		std::vector<Vector3d>           corners;
		std::vector<std::vector<Index>> loops;
		for (const Index f : near) {
			loops.emplace_back();
			for (const Index corner : m_mesh.faces[f]) {
				loops.back().push_back(static_cast<Index>(corners.size()));
				corners.emplace_back(m_mesh.vertices.col(corner));
			}
		}
		return distanceToMesh(polygonMesh(corners, corners, loops), m_home.col(v)).distance[0];
	}

	double meanEdge(Index v) const
	{
		double sum = 0.0;
		for (const Index f : m_faces[v]) {
			const NeighborLists::Row face = m_mesh.faces[f];
			const auto               at =
				static_cast<Index>(std::find(face.begin(), face.end(), v) - face.begin());
			sum +=
				(m_mesh.vertices.col(face[(at + 1) % face.size()]) - m_mesh.vertices.col(v)).norm();
		}
		return sum / double(std::max<std::size_t>(m_faces[v].size(), 1));
	}

	const CloudIndex&        m_index;
	const CurvatureField&    m_curvature;
	const std::vector<char>& m_fixed;
	PolygonMesh&             m_mesh;
	Eigen::Matrix3Xd         m_home; // positions at first
	Eigen::VectorXd          m_edge; // mean length at every vertex at first
	Eigen::VectorXd          m_off;  // how far every vertex may be from the points
	std::vector<char>        m_kept; // where every vertex has been, the surface is not to be lost
	std::vector<std::vector<Index>> m_faces; // around every vertex
};

} // namespace

Index untangleFaces(
	const CloudIndex&        index,
	const CurvatureField&    curvature,
	const std::vector<char>& fixed,
	PolygonMesh&             mesh)
{
	return Untangling(index, curvature, fixed, mesh).run();
}

} // namespace curvature_lines
