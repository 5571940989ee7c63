// Strips from irregular faces, found by walking through opposite sides of quads.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "quad_cleanup.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygon_splitting.h"
#include "rim_cleanup.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;
using Face = std::vector<Index>;

constexpr int rounds = 20; // a safeguard: each removes two irregular faces at least, and a few do

// A face and one of its sides, from corner `side` to the next.
struct FaceSide {
	Index face, side;
};

struct Strip {
	// The side every face is left through; but of the last one, unless at a rim, that it is entered through.
	std::vector<FaceSide> path;
	bool                  endsAtRim = false;
};

class StripFinder {
public:
	StripFinder(const std::vector<Face>& faces, const std::vector<Vector3d>& vertices) :
			m_faces(faces), m_vertices(vertices)
	{
		for (Index f = 0; f < static_cast<Index>(faces.size()); ++f)
			for (Index k = 0; k < sizeOf(f); ++k)
				m_sides.emplace(key(faces[f][k], faces[f][(k + 1) % sizeOf(f)]), FaceSide{f, k});
	}

	std::vector<Strip> strips(Index longest) const
	{
		std::vector<Strip> found;
		for (Index f = 0; f < static_cast<Index>(m_faces.size()); ++f)
			if (sizeOf(f) == 3 || sizeOf(f) == 5)
				for (Index k = 0; k < sizeOf(f); ++k)
					if (sizeOf(f) == 3 || k == splitSide(f))
						walk({f, k}, longest, found);
		std::stable_sort(found.begin(), found.end(), [](const Strip& a, const Strip& b) {
			return a.path.size() < b.path.size();
		});
		return found;
	}

	// Of a pentagon: its side on a rim, or the one opposite its flattest corner.
	Index splitSide(Index f) const
	{
		const Face& face = m_faces[f];
		Index       rims = 0, rim = -1;
		for (Index k = 0; k < 5; ++k) {
			if (behind({f, k}) != m_sides.end())
				continue;
			++rims;
			rim = k;
		}
		if (rims == 1)
			return rim;
		Index  flattest = 0;
		double least    = 2.0;
		for (Index k = 0; k < 5; ++k) {
			const Vector3d a      = m_vertices[face[(k + 4) % 5]] - m_vertices[face[k]];
			const Vector3d b      = m_vertices[face[(k + 1) % 5]] - m_vertices[face[k]];
			const double   cosine = a.dot(b) / (a.norm() * b.norm() + 1e-300);
			if (cosine < least) {
				least    = cosine;
				flattest = k;
			}
		}
		return (flattest + 2) % 5;
	}

private:
	using Sides = std::unordered_map<std::uint64_t, FaceSide>;

	Index sizeOf(Index f) const { return static_cast<Index>(m_faces[f].size()); }
	Sides::const_iterator behind(const FaceSide& g) const
	{
		const Face& face = m_faces[g.face];
		return m_sides.find(key(face[(g.side + 1) % face.size()], face[g.side]));
	}
	static std::uint64_t key(Index a, Index b)
	{
		return (static_cast<std::uint64_t>(a) << 32) | static_cast<std::uint32_t>(b);
	}

	void walk(FaceSide at, Index longest, std::vector<Strip>& found) const
	{
		Strip strip;
		for (Index quads = 0; quads <= longest;) {
			strip.path.push_back(at);
			const auto next = behind(at);
			if (next == m_sides.end()) {
				// A triangle at the rim itself would get a flat corner.
				strip.endsAtRim = true;
				if (strip.path.size() > 1 || sizeOf(at.face) == 5)
					found.push_back(std::move(strip));
				return;
			}
			const FaceSide in   = next->second;
			const auto     seen = [&](const FaceSide& g) { return g.face == in.face; };
			if (std::any_of(strip.path.begin(), strip.path.end(), seen))
				return;
			const Index corners = sizeOf(in.face);
			if (corners == 3 || (corners == 5 && splitSide(in.face) == in.side)) {
				strip.path.push_back(in);
				found.push_back(std::move(strip));
				return;
			}
			if (corners != 4)
				return;
			at = {in.face, (in.side + 2) % 4};
			++quads;
		}
	}

	const std::vector<Face>&     m_faces;
	const std::vector<Vector3d>& m_vertices;
	Sides                        m_sides; // by their two vertices, in order
};

// The parts of the face at the end of a strip, whose side `side` gets vertex m in its middle.
void splitEnd(const Face& face, Index side, Index m, std::vector<Face>& parts)
{
	if (face.size() == 3) {
		parts.push_back({face[side], m, face[(side + 1) % 3], face[(side + 2) % 3]});
		return;
	}
	const Index top = (side + 3) % 5;
	parts.push_back({face[top], face[(top + 1) % 5], face[side], m});
	parts.push_back({face[top], m, face[(side + 1) % 5], face[(side + 2) % 5]});
}

// A mesh of which strips are split along their middle.
class StripSplitter {
public:
	StripSplitter(const PolygonMesh& mesh, std::vector<char>& onFeature) :
			m_faces(faceLoopsOf(mesh)), m_onFeature(onFeature)
	{
		for (Index v = 0; v < mesh.vertexCount(); ++v) {
			m_vertices.push_back(mesh.vertices.col(v));
			m_normals.push_back(mesh.normals.col(v));
		}
	}

	// Splits strips without a common face, shortest first. Says whether there were any.
	bool splitRound(Index longestStrip)
	{
		const std::vector<Strip> strips = StripFinder(m_faces, m_vertices).strips(longestStrip);
		if (strips.empty())
			return false;
		std::vector<std::vector<Face>> parts(m_faces.size()); // empty: the face stays
		for (const Strip& strip : strips)
			if (std::none_of(strip.path.begin(), strip.path.end(), [&](const FaceSide& side) {
					return !parts[side.face].empty();
				}))
				split(strip, parts);
		std::vector<Face> next;
		for (std::size_t f = 0; f < m_faces.size(); ++f)
			if (parts[f].empty())
				next.push_back(m_faces[f]);
			else
				next.insert(next.end(), parts[f].begin(), parts[f].end());
		m_faces = std::move(next);
		return true;
	}

	PolygonMesh mesh() const { return polygonMesh(m_vertices, m_normals, m_faces); }

private:
	// A new vertex in the middle of a side.
	Index middle(const Face& face, Index side)
	{
		const Index a = face[side], b = face[(side + 1) % face.size()];
		m_vertices.push_back(0.5 * (m_vertices[a] + m_vertices[b]));
		const Vector3d normal = m_normals[a] + m_normals[b];
		m_normals.push_back(normal.norm() > 0.0 ? normal.normalized() : m_normals[a]);
		m_onFeature.push_back(m_onFeature[a] && m_onFeature[b]);
		return static_cast<Index>(m_vertices.size()) - 1;
	}

	void split(const Strip& strip, std::vector<std::vector<Face>>& parts)
	{
		const auto& path = strip.path;
		Index       m    = middle(m_faces[path[0].face], path[0].side);
		splitEnd(m_faces[path[0].face], path[0].side, m, parts[path[0].face]);
		const std::size_t last = path.size() - (strip.endsAtRim ? 0 : 1);
		for (std::size_t k = 1; k < last; ++k) {
			const Face& q   = m_faces[path[k].face];
			const Index out = path[k].side, in = (out + 2) % 4;
			const Index before = m;
			m                  = middle(q, out);
			parts[path[k].face].push_back({q[in], before, m, q[(in + 3) % 4]});
			parts[path[k].face].push_back({before, q[(in + 1) % 4], q[out], m});
		}
		if (!strip.endsAtRim)
			splitEnd(m_faces[path.back().face], path.back().side, m, parts[path.back().face]);
	}

	std::vector<Vector3d> m_vertices, m_normals;
	std::vector<Face>     m_faces;
	std::vector<char>&    m_onFeature;
};

} // namespace

PolygonMesh insertStrips(const PolygonMesh& mesh, std::vector<char>& onFeature, Index longestStrip)
{
	StripSplitter splitter(mesh, onFeature);
	for (int round = 0; round < rounds && splitter.splitRound(longestStrip);)
		++round;
	return splitter.mesh();
}

PolygonMesh cleanUpQuads(
	const PolygonMesh& mesh, std::vector<char>& onFeature, const QuadCleanupOptions& options)
{
	const auto cut = [](const PolygonMesh& polygons) {
		PolygonSplitter splitter(polygons);
		splitter.cutLargeFaces();
		splitter.pairWithPentagons();
		return splitter.mesh();
	};
	const PolygonMesh merged = mergeRimTriangles(mesh, onFeature, options.shortestRimEdge);
	const PolygonMesh strips = cut(insertStrips(cut(merged), onFeature, options.longestStrip));
	return mergeRimTriangles(strips, onFeature, options.longestRimEdge);
}

} // namespace curvature_lines
