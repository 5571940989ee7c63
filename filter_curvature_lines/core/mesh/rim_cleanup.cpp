// Collapses of rim edges, one round after another of those that do not touch.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rim_cleanup.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;
using Face = std::vector<Index>;

// Cosine of a rim's turn at a vertex, 37 degrees: beyond, the vertex is a corner and stays. By experiment.
constexpr double straight = 0.8;

std::uint64_t key(Index a, Index b)
{
	return (static_cast<std::uint64_t>(a) << 32) | static_cast<std::uint32_t>(b);
}

struct Collapse {
	Index  face = -1, a = -1, b = -1; // of the triangle: its side on the rim
	double length = 0.0;
};

class RimTriangles {
public:
	RimTriangles(
		const std::vector<Face>& faces,
		const Eigen::Matrix3Xd&  vertices,
		const std::vector<char>& onFeature) :
			m_faces(faces), m_vertices(vertices), m_onFeature(onFeature),
			m_valence(vertices.cols(), 0), m_before(vertices.cols(), -1),
			m_after(vertices.cols(), -1), m_longest(vertices.cols(), 0.0)
	{
		std::unordered_map<std::uint64_t, Index> sides;
		for (const Face& face : faces)
			for (std::size_t k = 0; k < face.size(); ++k)
				sides.emplace(key(face[k], face[(k + 1) % face.size()]), 0);
		for (const Face& face : faces)
			for (std::size_t k = 0; k < face.size(); ++k) {
				const Index a = face[k], b = face[(k + 1) % face.size()];
				const bool  rim = sides.count(key(b, a)) == 0;
				if (!rim && a > b)
					continue;
				const double length = (m_vertices.col(a) - m_vertices.col(b)).norm();
				for (const Index v : {a, b}) {
					++m_valence[v];
					m_longest[v] = std::max(m_longest[v], length);
				}
				if (rim) {
					m_after[a]  = b;
					m_before[b] = a;
				}
			}
	}

	std::vector<Collapse> find(double longest) const
	{
		std::vector<Collapse> found;
		for (Index f = 0; f < static_cast<Index>(m_faces.size()); ++f)
			for (int k = 0; k < 3 && m_faces[f].size() == 3; ++k) {
				const Index a = m_faces[f][k], b = m_faces[f][(k + 1) % 3],
							c       = m_faces[f][(k + 2) % 3];
				const double length = (m_vertices.col(a) - m_vertices.col(b)).norm();
				if (m_after[a] != b || m_after[c] >= 0 || m_onFeature[c] || m_valence[c] < 4 ||
				    !isLineEnd(a) || !isLineEnd(b) || m_before[a] == m_after[b] ||
				    length > longest * m_longest[c])
					continue;
				found.push_back({f, a, b, length});
			}
		std::stable_sort(found.begin(), found.end(), [](const Collapse& p, const Collapse& q) {
			return p.length < q.length;
		});
		return found;
	}

private:
	// One line ends here on a rim that goes straight on.
	bool isLineEnd(Index v) const
	{
		if (m_valence[v] != 3 || m_before[v] < 0 || m_after[v] < 0)
			return false;
		const Vector3d in  = m_vertices.col(v) - m_vertices.col(m_before[v]);
		const Vector3d out = m_vertices.col(m_after[v]) - m_vertices.col(v);
		return in.normalized().dot(out.normalized()) > straight;
	}

	const std::vector<Face>& m_faces;
	const Eigen::Matrix3Xd&  m_vertices;
	const std::vector<char>& m_onFeature;
	std::vector<Index>       m_valence, m_before, m_after; // neighbours along the rim
	std::vector<double>      m_longest;                    // edge
};

PolygonMesh
compacted(const PolygonMesh& mesh, const std::vector<Face>& faces, std::vector<char>& onFeature)
{
	std::vector<Index> nameOf(mesh.vertexCount(), -1);
	for (const Face& face : faces)
		for (const Index v : face)
			nameOf[v] = 0;
	Index used = 0;
	for (Index& name : nameOf)
		name = name < 0 ? -1 : used++;
	PolygonMesh       result;
	std::vector<char> marks(used);
	result.vertices.resize(3, used);
	result.normals.resize(3, used);
	for (Index v = 0; v < mesh.vertexCount(); ++v) {
		if (nameOf[v] < 0)
			continue;
		result.vertices.col(nameOf[v]) = mesh.vertices.col(v);
		result.normals.col(nameOf[v])  = mesh.normals.col(v);
		marks[nameOf[v]]               = onFeature[v];
	}
	std::vector<Face> renamed = faces;
	for (Face& face : renamed)
		for (Index& v : face)
			v = nameOf[v];
	result.faces = NeighborLists::fromRows(renamed);
	onFeature    = std::move(marks);
	return result;
}

} // namespace

PolygonMesh mergeRimTriangles(const PolygonMesh& mesh, std::vector<char>& onFeature, double longest)
{
	std::vector<Face> faces = faceLoopsOf(mesh);
	PolygonMesh       moved = mesh;
	while (true) {
		const auto found = RimTriangles(faces, moved.vertices, onFeature).find(longest);
		if (found.empty())
			return compacted(moved, faces, onFeature);
		// Those of one round have no corner in common, nor is one beside another on the rim.
		std::vector<char>  touched(mesh.vertexCount(), 0);
		std::vector<Index> into(mesh.vertexCount());
		std::iota(into.begin(), into.end(), Index(0));
		std::vector<std::vector<Index>> around(mesh.vertexCount());
		for (const Face& face : faces)
			for (std::size_t k = 0; k < face.size(); ++k) {
				around[face[k]].push_back(face[(k + 1) % face.size()]);
				around[face[(k + 1) % face.size()]].push_back(face[k]);
			}
		for (const auto& [face, a, b, length] : found) {
			std::vector<Index> near = around[a];
			near.insert(near.end(), around[b].begin(), around[b].end());
			if (std::any_of(near.begin(), near.end(), [&](Index v) { return touched[v] != 0; }))
				continue;
			for (const Index v : near)
				touched[v] = 1;
			moved.vertices.col(a) = 0.5 * (moved.vertices.col(a) + moved.vertices.col(b));
			moved.normals.col(a)  = (moved.normals.col(a) + moved.normals.col(b)).normalized();
			into[b]               = a;
			faces[face].clear();
		}
		faces.erase(
			std::remove_if(faces.begin(), faces.end(), [](const Face& f) { return f.empty(); }),
			faces.end());
		for (Face& face : faces)
			for (Index& v : face)
				v = into[v];
	}
}

} // namespace curvature_lines
