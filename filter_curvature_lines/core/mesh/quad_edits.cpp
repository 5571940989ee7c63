// Edits of a few quads, on loops of vertices.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "quad_edits.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "mesh_quality.h"
#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// Edges of a vertex inside.
constexpr std::size_t fewestEdges = 3, mostEdges = 7;

bool isSimple(const std::vector<Index>& loop)
{
	std::vector<Index> sorted = loop;
	std::sort(sorted.begin(), sorted.end());
	return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
}

} // namespace

QuadEdits::QuadEdits(const std::vector<char>& onFeature, PolygonMesh& mesh) :
		m_onFeature(onFeature), m_mesh(mesh), m_loops(faceLoopsOf(mesh)),
		m_faces(mesh.vertexCount())
{
	for (std::size_t f = 0; f < m_loops.size(); ++f)
		for (const Index v : m_loops[f])
			m_faces[v].push_back(static_cast<Index>(f));
}

double QuadEdits::jacobianOf(Index face) const
{
	const std::vector<Index>& loop = m_loops[face];
	return scaledJacobian(
		m_mesh.vertices, m_mesh.normals, {loop.data(), loop.data() + loop.size()});
}

std::vector<Index> QuadEdits::facesAround(const std::vector<Index>& vertices) const
{
	std::vector<Index> faces;
	for (const Index v : vertices)
		faces.insert(faces.end(), m_faces[v].begin(), m_faces[v].end());
	std::sort(faces.begin(), faces.end());
	faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
	return faces;
}

std::vector<Index> QuadEdits::cornersOf(const std::vector<Index>& faces) const
{
	std::vector<Index> corners;
	for (const Index f : faces)
		corners.insert(corners.end(), m_loops[f].begin(), m_loops[f].end());
	std::sort(corners.begin(), corners.end());
	corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
	return corners;
}

// Vertices that an edge joins to this one, less the faces around it. 0: inside, one fan of faces all around; 1: on a rim.
Index QuadEdits::surplus(Index vertex) const
{
	std::vector<Index> neighbors;
	for (const Index f : m_faces[vertex]) {
		const std::vector<Index>& loop = m_loops[f];
		const auto                at =
			static_cast<std::size_t>(std::find(loop.begin(), loop.end(), vertex) - loop.begin());
		neighbors.push_back(loop[(at + 1) % loop.size()]);
		neighbors.push_back(loop[(at + loop.size() - 1) % loop.size()]);
	}
	std::sort(neighbors.begin(), neighbors.end());
	const auto end = std::unique(neighbors.begin(), neighbors.end());
	return static_cast<Index>(end - neighbors.begin()) - static_cast<Index>(m_faces[vertex].size());
}

// The face on the other side of the edge from a corner to the next one; -1 where there is none.
Index QuadEdits::across(Index face, Index corner) const
{
	const std::vector<Index>& loop = m_loops[face];
	const Index               a = loop[corner], b = loop[(corner + 1) % loop.size()];
	for (const Index other : m_faces[b]) {
		const std::vector<Index>& theirs = m_loops[other];
		const auto                at     = std::find(theirs.begin(), theirs.end(), b);
		const auto                next   = at + 1 == theirs.end() ? theirs.begin() : at + 1;
		if (other != face && *next == a)
			return other;
	}
	return -1;
}

std::vector<QuadEdits::Edit> QuadEdits::mergesOf(Index face) const
{
	const std::vector<Index>& loop = m_loops[face];
	std::vector<Edit>         merges;
	if (loop.size() != 4)
		return merges;
	for (const Index v : loop)
		if (surplus(v) != 0)
			return merges;
	for (std::size_t k = 0; k < 2; ++k) {
		const Index    a = loop[k], c = loop[k + 2];
		const Vector3d pa = m_mesh.vertices.col(a), pc = m_mesh.vertices.col(c);
		const Vector3d na = m_mesh.normals.col(a), nc = m_mesh.normals.col(c);
		if (!m_onFeature[c])
			merges.emplace_back(Merge{face, a, c, pa, na});
		if (!m_onFeature[a])
			merges.emplace_back(Merge{face, c, a, pc, nc});
		if (!m_onFeature[a] && !m_onFeature[c])
			merges.emplace_back(Merge{face, a, c, 0.5 * (pa + pc), (na + nc).normalized()});
	}
	return merges;
}

std::vector<QuadEdits::Edit> QuadEdits::turnsOf(Index face) const
{
	const std::vector<Index>& loop = m_loops[face];
	std::vector<Edit>         turns;
	if (loop.size() != 4)
		return turns;
	for (Index k = 0; k < 4; ++k) {
		const Index other = across(face, k);
		if (other < 0 || m_loops[other].size() != 4 ||
		    (m_onFeature[loop[k]] && m_onFeature[loop[(k + 1) % 4]]))
			continue;
		turns.emplace_back(Turn{face, k, true});
		turns.emplace_back(Turn{face, k, false});
	}
	return turns;
}

void QuadEdits::remember(const std::vector<Index>& faces, Undo& undo) const
{
	for (const Index face : faces)
		undo.loops.emplace_back(face, m_loops[face]);
	for (const Index v : cornersOf(faces))
		undo.faces.emplace_back(v, m_faces[v]);
}

void QuadEdits::unlink(Index face)
{
	for (const Index v : m_loops[face]) {
		auto&      faces = m_faces[v];
		const auto at    = std::find(faces.begin(), faces.end(), face);
		if (at != faces.end())
			faces.erase(at);
	}
	m_loops[face].clear();
}

void QuadEdits::link(Index face, std::vector<Index> loop)
{
	for (const Index corner : loop)
		m_faces[corner].push_back(face);
	m_loops[face] = std::move(loop);
}

// Two faces that are all there is around the vertex become one.
void QuadEdits::dissolve(Index vertex)
{
	const Index one = m_faces[vertex][0], other = m_faces[vertex][1];
	auto        first = m_loops[one], second = m_loops[other];
	std::rotate(first.begin(), std::find(first.begin(), first.end(), vertex), first.end());
	std::rotate(second.begin(), std::find(second.begin(), second.end(), vertex), second.end());
	unlink(one);
	unlink(other);
	// first: v, y, ..., x; second: v, x, ..., y
	std::vector<Index> whole(first.begin() + 1, first.end());
	whole.insert(whole.end(), second.begin() + 2, second.end() - 1);
	link(one, std::move(whole));
}

void QuadEdits::merge(const Merge& way)
{
	unlink(way.face);
	for (const Index face : m_faces[way.merged]) {
		std::replace(m_loops[face].begin(), m_loops[face].end(), way.merged, way.kept);
		m_faces[way.kept].push_back(face);
	}
	m_faces[way.merged].clear();
	m_mesh.vertices.col(way.kept) = way.position;
	m_mesh.normals.col(way.kept)  = way.normal;
}

void QuadEdits::turn(const Turn& way)
{
	const Index        other = across(way.face, way.corner);
	std::vector<Index> mine = m_loops[way.face], theirs = m_loops[other];
	std::rotate(mine.begin(), mine.begin() + (way.corner + 1) % 4, mine.end());
	std::rotate(theirs.begin(), std::find(theirs.begin(), theirs.end(), mine[3]), theirs.end());
	// The corners of both, counter-clockwise; the edge is from the first to the fourth.
	const std::array<Index, 6> ring = {mine[0], mine[1], mine[2], mine[3], theirs[1], theirs[2]};
	const std::size_t          from = way.forward ? 1 : 2;
	unlink(way.face);
	unlink(other);
	const auto quad = [&](std::size_t start) {
		return std::vector<Index>{
			ring[start % 6], ring[(start + 1) % 6], ring[(start + 2) % 6], ring[(start + 3) % 6]};
	};
	link(way.face, quad(from));
	link(other, quad(from + 3));
}

bool QuadEdits::isSurface(const Undo& undo, const std::vector<Index>& surplusBefore) const
{
	for (std::size_t i = 0; i < undo.faces.size(); ++i) {
		const auto& [v, facesBefore] = undo.faces[i];
		if (m_faces[v].empty())
			continue;
		const std::size_t edges = m_faces[v].size(), edgesBefore = facesBefore.size();
		if (surplus(v) != surplusBefore[i])
			return false;
		if (surplusBefore[i] == 0 && ((edges < fewestEdges && edges < edgesBefore) ||
		                              (edges > mostEdges && edges > edgesBefore)))
			return false;
	}
	return std::all_of(undo.loops.begin(), undo.loops.end(), [this](const auto& entry) {
		const std::vector<Index>& loop = m_loops[entry.first];
		return loop.empty() || (loop.size() >= 3 && isSimple(loop));
	});
}

bool QuadEdits::apply(const Edit& edit, Undo& undo)
{
	const auto* const        merged  = std::get_if<Merge>(&edit);
	const auto* const        turned  = std::get_if<Turn>(&edit);
	const Index              face    = merged ? merged->face : turned->face;
	const std::vector<Index> loop    = m_loops[face];
	std::vector<Index>       corners = loop;
	if (turned) {
		const std::vector<Index>& theirs = m_loops[across(face, turned->corner)];
		corners.insert(corners.end(), theirs.begin(), theirs.end());
	}
	remember(facesAround(corners), undo);
	std::vector<Index> surplusBefore;
	surplusBefore.reserve(undo.faces.size());
	for (const auto& entry : undo.faces)
		surplusBefore.push_back(surplus(entry.first));
	if (turned) {
		turn(*turned);
		return isSurface(undo, surplusBefore);
	}
	undo.kept     = merged->kept;
	undo.position = m_mesh.vertices.col(merged->kept);
	undo.normal   = m_mesh.normals.col(merged->kept);
	merge(*merged);
	for (const auto& entry : undo.loops)
		if (!isSimple(m_loops[entry.first]))
			return false;
	for (const Index v : loop)
		if (v != merged->kept && v != merged->merged && m_faces[v].size() == 2 && !m_onFeature[v])
			dissolve(v);
	return isSurface(undo, surplusBefore);
}

void QuadEdits::restore(const Undo& undo)
{
	for (const auto& [face, loop] : undo.loops)
		m_loops[face] = loop;
	for (const auto& [v, faces] : undo.faces)
		m_faces[v] = faces;
	if (undo.kept < 0)
		return;
	m_mesh.vertices.col(undo.kept) = undo.position;
	m_mesh.normals.col(undo.kept)  = undo.normal;
}

void replaceFaces(
	const std::vector<std::vector<Index>>& loops, std::vector<char>& onFeature, PolygonMesh& mesh)
{
	std::vector<Index> name(mesh.vertexCount(), -1), used;
	for (const std::vector<Index>& loop : loops)
		for (const Index v : loop)
			name[v] = 0;
	for (Index v = 0; v < mesh.vertexCount(); ++v)
		if (name[v] == 0) {
			name[v] = static_cast<Index>(used.size());
			used.push_back(v);
		}
	std::vector<std::vector<Index>> renamed;
	for (std::vector<Index> loop : loops) {
		if (loop.empty())
			continue;
		for (Index& v : loop)
			v = name[v];
		renamed.push_back(std::move(loop));
	}
	std::vector<char> marks;
	marks.reserve(used.size());
	for (const Index v : used)
		marks.push_back(onFeature[v]);
	mesh.vertices = mesh.vertices(Eigen::all, used).eval();
	mesh.normals  = mesh.normals(Eigen::all, used).eval();
	mesh.faces    = NeighborLists::fromRows(renamed);
	onFeature     = std::move(marks);
}

} // namespace curvature_lines
