// Polygons cut along diagonals that stay inside them, judged by their corners in the plane of the
// mean normal: lines of curvature meet at 90 degrees and end on others at 180.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "polygon_splitting.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double forbidden =
	std::numeric_limits<double>::infinity(); // cost of cuts that may not be
constexpr double halfTurn = 180.0;           // degrees
// Corners beyond this are reflex (R07 cuts there, and names no tolerance). A line that ends on another
// makes 180 degrees, which is no flaw; 5 more are for the flattening of a curved face.
constexpr double reflexCorner = 185.0;
// Degrees between a diagonal and the sides at its ends: below, the diagonal lies outside for the same reason.
constexpr double leastAngle = 2.0;

double square(double x)
{
	return x * x;
}
double cross(const Vector2d& a, const Vector2d& b)
{
	return a.x() * b.y() - a.y() * b.x();
}

// A face seen along its mean normal, counter-clockwise.
class FlatPolygon {
public:
	template<class Face, class Vectors>
	FlatPolygon(const Face& face, const Vectors& vertices, const Vectors& normals)
	{
		Vector3d n = Vector3d::Zero();
		for (Index v : face)
			n += normals[v];
		n                = n.squaredNorm() > 0.0 ? n.normalized() : Vector3d::UnitZ();
		const Vector3d x = n.unitOrthogonal(), y = n.cross(x);
		for (Index v : face)
			m_points.emplace_back(vertices[v].dot(x), vertices[v].dot(y));
	}

	Index size() const { return static_cast<Index>(m_points.size()); }
	Index next(Index i) const { return i + 1 == size() ? 0 : i + 1; }
	Index previous(Index i) const { return i == 0 ? size() - 1 : i - 1; }

	// Degrees at corner b, counter-clockwise from c to a, in [0, 360).
	double angle(Index a, Index b, Index c) const
	{
		const Vector2d u = m_points[c] - m_points[b], v = m_points[a] - m_points[b];
		const double   degrees =
			std::atan2(cross(u, v), u.dot(v)) * halfTurn / 3.14159265358979323846;
		return degrees < 0.0 ? degrees + 2.0 * halfTurn : degrees;
	}
	double corner(Index i) const { return angle(previous(i), i, next(i)); }

	bool isDiagonalInside(Index i, Index j) const
	{
		return pointsInside(i, j) && pointsInside(j, i) && !crossesSide(i, j);
	}

	// Flaws of the piece with corners i, i + 1, .., j: squared degrees, the mean over its corners.
	double pieceError(Index i, Index j) const
	{
		const Index corners = (j - i + size()) % size() + 1;
		double sum = flaw(angle(j, i, next(i)), corners) + flaw(angle(previous(j), j, i), corners);
		for (Index k = next(i); k != j; k = next(k))
			sum += flaw(corner(k), corners);
		return sum / corners;
	}
	double error(Index i, Index j) const { return pieceError(i, j) + pieceError(j, i); }

	double distance(Index i, Index j) const { return (m_points[i] - m_points[j]).norm(); }

	double leastAngleAt(Index i, Index j) const
	{
		return std::min(
			{angle(j, i, next(i)),
		     angle(previous(i), i, j),
		     angle(i, j, next(j)),
		     angle(previous(j), j, i)});
	}

private:
	static double flaw(double degrees, Index corners)
	{
		const double right = square(degrees - 90.0);
		if (corners == 3) // costs more than any quad of about right angles
			return square(degrees - 60.0) + square(30.0);
		return corners == 4 || degrees > reflexCorner ? right
		                                              : std::min(right, square(degrees - halfTurn));
	}

	bool pointsInside(Index i, Index j) const
	{
		const double part = angle(j, i, next(i));
		return part > leastAngle && part < corner(i) - leastAngle;
	}

	bool crossesSide(Index i, Index j) const
	{
		const Vector2d p = m_points[i], d = m_points[j] - p;
		for (Index k = 0; k < size(); ++k) {
			const Index l = next(k);
			if (k == i || k == j || l == i || l == j)
				continue;
			const Vector2d e     = m_points[l] - m_points[k];
			const bool     apart = cross(d, m_points[k] - p) * cross(d, m_points[l] - p) > 0.0;
			const bool outside   = cross(e, p - m_points[k]) * cross(e, p + d - m_points[k]) > 0.0;
			if (!apart && !outside)
				return true;
		}
		return false;
	}

	std::vector<Vector2d> m_points;
};

} // namespace

PolygonSplitter::PolygonSplitter(const PolygonMesh& mesh)
{
	for (Index v = 0; v < mesh.vertexCount(); ++v) {
		m_vertices.push_back(mesh.vertices.col(v));
		m_normals.push_back(mesh.normals.col(v));
	}
	m_faces = faceLoopsOf(mesh);
	for (const Face& face : m_faces)
		for (std::size_t k = 0; k < face.size(); ++k)
			m_edges.insert(key(face[k], face[(k + 1) % face.size()]));
}

std::uint64_t PolygonSplitter::key(Index a, Index b)
{
	return (static_cast<std::uint64_t>(std::min(a, b)) << 32) |
	       static_cast<std::uint32_t>(std::max(a, b));
}

template<class Error>
PolygonSplitter::Cut
PolygonSplitter::bestCut(const Face& face, const Error& error, Diagonals diagonals) const
{
	const FlatPolygon flat(face, m_vertices, m_normals);
	Cut               best;
	best.error = forbidden;
	for (Index i = 0; i < flat.size(); ++i) {
		for (Index j = i + 2; j < flat.size(); ++j) {
			if ((i == 0 && j == flat.size() - 1) || isEdge(face[i], face[j]))
				continue;
			const double e = error(flat, i, j);
			if (e < best.error && (diagonals == Diagonals::Any || flat.isDiagonalInside(i, j)))
				best = {i, j, e};
		}
	}
	return best;
}

bool PolygonSplitter::cut(const Face& face, const Cut& cut, Face& first, Face& second)
{
	if (cut.i < 0)
		return false;
	m_edges.insert(key(face[cut.i], face[cut.j]));
	first.assign(face.begin() + cut.i, face.begin() + cut.j + 1);
	second.assign(face.begin() + cut.j, face.end());
	second.insert(second.end(), face.begin(), face.begin() + cut.i + 1);
	return true;
}

template<class Error>
void PolygonSplitter::cutWhileAny(const Error& error, Diagonals diagonals)
{
	std::vector<Face> pending, done;
	pending.swap(m_faces);
	std::reverse(pending.begin(), pending.end()); // so that the faces stay in order
	while (!pending.empty()) {
		const Face face = std::move(pending.back());
		pending.pop_back();
		Face first, second;
		if (cut(face, bestCut(face, error, diagonals), first, second)) {
			pending.push_back(std::move(second));
			pending.push_back(std::move(first));
		}
		else {
			done.push_back(face);
		}
	}
	m_faces = std::move(done);
}

void PolygonSplitter::cutLargeFaces()
{
	cutWhileAny([](const FlatPolygon& flat, Index i, Index j) {
		const bool quad = j - i == 3 || flat.size() - (j - i) == 3;
		return flat.size() >= 6 && quad ? flat.error(i, j) : forbidden;
	});
}

void PolygonSplitter::splitConcaveFaces()
{
	cutWhileAny([](const FlatPolygon& flat, Index i, Index j) {
		const bool reflex = flat.corner(i) > reflexCorner || flat.corner(j) > reflexCorner;
		return flat.size() > 4 && reflex ? flat.error(i, j) : forbidden;
	});
}

void PolygonSplitter::triangulate()
{
	cutWhileAny([](const FlatPolygon& flat, Index i, Index j) { return -flat.leastAngleAt(i, j); });
	// Slivers and faces folded over have no diagonal inside.
	cutWhileAny(
		[](const FlatPolygon& flat, Index i, Index j) { return flat.distance(i, j); },
		Diagonals::Any);
	// What no diagonal can cut because each is an edge elsewhere becomes a star about a new vertex.
	const std::size_t count = m_faces.size();
	for (std::size_t f = 0; f < count; ++f) {
		const Face face = m_faces[f];
		if (face.size() == 3)
			continue;
		Vector3d center = Vector3d::Zero(), normal = Vector3d::Zero();
		for (Index v : face) {
			center += m_vertices[v] / static_cast<double>(face.size());
			normal += m_normals[v];
		}
		const Index hub = static_cast<Index>(m_vertices.size());
		m_vertices.push_back(center);
		m_normals.push_back(normal.squaredNorm() > 0.0 ? normal.normalized() : m_normals[face[0]]);
		m_faces[f] = {hub, face.back(), face.front()};
		for (std::size_t k = 0; k + 1 < face.size(); ++k)
			m_faces.push_back({hub, face[k], face[k + 1]});
		for (Index v : face)
			m_edges.insert(key(hub, v));
	}
}

void PolygonSplitter::pairWithPentagons()
{
	const auto side = [](Index a, Index b) {
		return (static_cast<std::uint64_t>(a) << 32) | static_cast<std::uint32_t>(b);
	};
	std::unordered_map<std::uint64_t, Index> faceOf; // of the directed side a -> b
	for (Index f = 0; f < static_cast<Index>(m_faces.size()); ++f)
		for (std::size_t k = 0; k < m_faces[f].size(); ++k)
			faceOf[side(m_faces[f][k], m_faces[f][(k + 1) % m_faces[f].size()])] = f;

	for (Index f = 0; f < static_cast<Index>(m_faces.size()); ++f) {
		if (m_faces[f].size() != 3)
			continue;
		for (std::size_t k = 0; k < 3; ++k) {
			const Face  triangle = m_faces[f];
			const Index a = triangle[k], b = triangle[(k + 1) % 3], apex = triangle[(k + 2) % 3];
			const auto  found = faceOf.find(side(b, a));
			if (found == faceOf.end() || m_faces[found->second].size() != 5)
				continue;
			const Index g        = found->second;
			Face        pentagon = m_faces[g];
			std::rotate(
				pentagon.begin(), std::find(pentagon.begin(), pentagon.end(), a), pentagon.end());
			// From a through the pentagon to b, then over the triangle's apex back to a.
			Face hexagon = pentagon;
			hexagon.push_back(apex);
			if (std::count(pentagon.begin(), pentagon.end(), apex))
				continue;
			const Cut best = bestCut(hexagon, [](const FlatPolygon& flat, Index i, Index j) {
				return j - i == 3 ? flat.error(i, j) : forbidden;
			});
			Face      first, second;
			if (!cut(hexagon, best, first, second))
				continue;
			m_edges.erase(key(a, b));
			m_faces[f] = first;
			m_faces[g] = second;
			for (const Index changed : {f, g})
				for (std::size_t s = 0; s < 4; ++s)
					faceOf[side(m_faces[changed][s], m_faces[changed][(s + 1) % 4])] = changed;
			break;
		}
	}
}

PolygonMesh PolygonSplitter::mesh() const
{
	return polygonMesh(m_vertices, m_normals, m_faces);
}

} // namespace curvature_lines
