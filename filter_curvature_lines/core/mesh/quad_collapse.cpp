// Collapses tried one after the other, on loops of vertices.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "quad_collapse.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "mesh_quality.h"
#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

constexpr int rounds = 5;
// Scaled Jacobian below which a face counts as bad, by what it lacks; and the share of that which a collapse must take away.
constexpr double wanted = 0.1, leastGain = 0.1;
// Edges of a vertex inside.
constexpr std::size_t fewestEdges = 3, mostEdges = 7;

class Collapsing {
public:
	Collapsing(const std::vector<char>& onFeature, PolygonMesh& mesh) :
			m_onFeature(onFeature), m_mesh(mesh), m_loops(faceLoopsOf(mesh)),
			m_faces(mesh.vertexCount())
	{
		for (std::size_t f = 0; f < m_loops.size(); ++f)
			for (const Index v : m_loops[f])
				m_faces[v].push_back(static_cast<Index>(f));
	}

	Index run()
	{
		Index gone = 0;
		for (int round = 0; round < rounds; ++round) {
			std::vector<std::pair<double, Index>> bad;
			for (std::size_t f = 0; f < m_loops.size(); ++f)
				if (m_loops[f].size() == 4 && jacobianOf(static_cast<Index>(f)) < 0.0)
					bad.emplace_back(jacobianOf(static_cast<Index>(f)), static_cast<Index>(f));
			std::sort(bad.begin(), bad.end());
			const Index before = gone;
			for (const auto& entry : bad)
				if (m_loops[entry.second].size() == 4 && jacobianOf(entry.second) < 0.0)
					gone += collapse(entry.second);
			if (gone == before)
				break;
		}
		return gone;
	}

	const std::vector<std::vector<Index>>& loops() const { return m_loops; } // empty: gone

private:
	// Of the faces around some vertices.
	struct Faults {
		double lack    = 0.0;
		int    unsound = 0;
	};
	// Corner k + 2 of a face goes to corner k, or the other way round.
	struct Way {
		Index    kept = -1, merged = -1;
		Vector3d position, normal;
	};
	// What a collapse changes, as it was.
	struct Undo {
		std::vector<std::pair<Index, std::vector<Index>>> loops, faces; // of faces, of vertices
		Index                                             kept = -1;
		Vector3d                                          position, normal;
	};

	double jacobianOf(Index f) const
	{
		const std::vector<Index>& loop = m_loops[f];
		return scaledJacobian(
			m_mesh.vertices, m_mesh.normals, {loop.data(), loop.data() + loop.size()});
	}

	std::vector<Index> facesAround(const std::vector<Index>& vertices) const
	{
		std::vector<Index> faces;
		for (const Index v : vertices)
			faces.insert(faces.end(), m_faces[v].begin(), m_faces[v].end());
		std::sort(faces.begin(), faces.end());
		faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
		return faces;
	}

	std::vector<Index> cornersOf(const std::vector<Index>& faces) const
	{
		std::vector<Index> corners;
		for (const Index f : faces)
			corners.insert(corners.end(), m_loops[f].begin(), m_loops[f].end());
		std::sort(corners.begin(), corners.end());
		corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
		return corners;
	}

	Faults faultsAround(const std::vector<Index>& vertices) const
	{
		Faults faults;
		for (const Index f : facesAround(vertices)) {
			const double jacobian = jacobianOf(f);
			faults.lack += std::max(0.0, wanted - jacobian);
			faults.unsound += jacobian < 0.0;
		}
		return faults;
	}

	// Vertices that an edge joins to v, less the faces around it. 0: inside, one fan of faces all around; 1: on a rim.
	Index surplus(Index v) const
	{
		std::vector<Index> neighbors;
		for (const Index f : m_faces[v]) {
			const std::vector<Index>& loop = m_loops[f];
			const auto                at =
				static_cast<std::size_t>(std::find(loop.begin(), loop.end(), v) - loop.begin());
			neighbors.push_back(loop[(at + 1) % loop.size()]);
			neighbors.push_back(loop[(at + loop.size() - 1) % loop.size()]);
		}
		std::sort(neighbors.begin(), neighbors.end());
		const auto end = std::unique(neighbors.begin(), neighbors.end());
		return static_cast<Index>(end - neighbors.begin()) - static_cast<Index>(m_faces[v].size());
	}

	bool isSimple(const std::vector<Index>& loop) const
	{
		std::vector<Index> sorted = loop;
		std::sort(sorted.begin(), sorted.end());
		return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
	}

	std::vector<Way> waysOf(Index f) const
	{
		const std::vector<Index>& loop = m_loops[f];
		std::vector<Way>          ways;
		for (const Index v : loop)
			if (surplus(v) != 0)
				return ways;
		for (std::size_t k = 0; k < 2; ++k) {
			const Index    a = loop[k], c = loop[k + 2];
			const Vector3d pa = m_mesh.vertices.col(a), pc = m_mesh.vertices.col(c);
			const Vector3d na = m_mesh.normals.col(a), nc = m_mesh.normals.col(c);
			if (!m_onFeature[c])
				ways.push_back({a, c, pa, na});
			if (!m_onFeature[a])
				ways.push_back({c, a, pc, nc});
			if (!m_onFeature[a] && !m_onFeature[c])
				ways.push_back({a, c, 0.5 * (pa + pc), (na + nc).normalized()});
		}
		return ways;
	}

	void unlink(Index f)
	{
		for (const Index v : m_loops[f]) {
			auto&      faces = m_faces[v];
			const auto at    = std::find(faces.begin(), faces.end(), f);
			if (at != faces.end())
				faces.erase(at);
		}
		m_loops[f].clear();
	}

	// Two faces that are all there is around v become one.
	void dissolve(Index v)
	{
		const Index one = m_faces[v][0], other = m_faces[v][1];
		auto        first = m_loops[one], second = m_loops[other];
		std::rotate(first.begin(), std::find(first.begin(), first.end(), v), first.end());
		std::rotate(second.begin(), std::find(second.begin(), second.end(), v), second.end());
		unlink(one);
		unlink(other);
		// first: v, y, ..., x; second: v, x, ..., y
		std::vector<Index> whole(first.begin() + 1, first.end());
		whole.insert(whole.end(), second.begin() + 2, second.end() - 1);
		m_loops[one] = whole;
		for (const Index corner : whole)
			m_faces[corner].push_back(one);
	}

	// False: the surface would not be one any more; then undo.
	bool apply(Index f, const Way& way, Undo& undo)
	{
		const std::vector<Index> loop = m_loops[f], around = facesAround(loop),
								 corners = cornersOf(around);
		for (const Index face : around)
			undo.loops.emplace_back(face, m_loops[face]);
		std::vector<Index> surplusBefore;
		for (const Index v : corners) {
			undo.faces.emplace_back(v, m_faces[v]);
			surplusBefore.push_back(surplus(v));
		}
		undo.kept     = way.kept;
		undo.position = m_mesh.vertices.col(way.kept);
		undo.normal   = m_mesh.normals.col(way.kept);

		unlink(f);
		for (const Index face : m_faces[way.merged]) {
			std::replace(m_loops[face].begin(), m_loops[face].end(), way.merged, way.kept);
			m_faces[way.kept].push_back(face);
		}
		m_faces[way.merged].clear();
		m_mesh.vertices.col(way.kept) = way.position;
		m_mesh.normals.col(way.kept)  = way.normal;
		for (const Index face : around)
			if (!isSimple(m_loops[face]))
				return false;
		for (const Index v : loop)
			if (v != way.kept && v != way.merged && m_faces[v].size() == 2 && !m_onFeature[v])
				dissolve(v);
		for (std::size_t i = 0; i < corners.size(); ++i) {
			const Index v = corners[i];
			if (m_faces[v].empty())
				continue;
			const std::size_t edges = m_faces[v].size(), edgesBefore = undo.faces[i].second.size();
			if (surplus(v) != surplusBefore[i])
				return false;
			if (surplusBefore[i] == 0 && ((edges < fewestEdges && edges < edgesBefore) ||
			                              (edges > mostEdges && edges > edgesBefore)))
				return false;
		}
		for (const Index face : around)
			if (!m_loops[face].empty() && (m_loops[face].size() < 3 || !isSimple(m_loops[face])))
				return false;
		return true;
	}

	void restore(const Undo& undo)
	{
		for (const auto& [face, loop] : undo.loops)
			m_loops[face] = loop;
		for (const auto& [v, faces] : undo.faces)
			m_faces[v] = faces;
		m_mesh.vertices.col(undo.kept) = undo.position;
		m_mesh.normals.col(undo.kept)  = undo.normal;
	}

	// The faces that are gone.
	Index collapse(Index f)
	{
		const std::vector<Index> corners = m_loops[f];
		const Faults             before  = faultsAround(corners);
		Faults                   best;
		const Way*               found = nullptr;
		const std::vector<Way>   ways  = waysOf(f);
		for (const Way& way : ways) {
			Undo       undo;
			const bool allowed = apply(f, way, undo);
			if (allowed) {
				const Faults after = faultsAround(corners);
				if (after.unsound < before.unsound &&
				    after.lack <= (1.0 - leastGain) * before.lack &&
				    (!found || after.lack < best.lack)) {
					found = &way;
					best  = after;
				}
			}
			restore(undo);
		}
		if (!found)
			return 0;
		Undo undo;
		apply(f, *found, undo);
		return static_cast<Index>(
			std::count_if(undo.loops.begin(), undo.loops.end(), [&](const auto& face) {
				return m_loops[face.first].empty();
			}));
	}

	const std::vector<char>&        m_onFeature;
	PolygonMesh&                    m_mesh;
	std::vector<std::vector<Index>> m_loops; // of every face
	std::vector<std::vector<Index>> m_faces; // of every vertex
};

} // namespace

Index collapseUnsoundQuads(std::vector<char>& onFeature, PolygonMesh& mesh)
{
	Collapsing  collapsing(onFeature, mesh);
	const Index gone = collapsing.run();
	if (gone == 0)
		return 0;
	std::vector<Index> name(mesh.vertexCount(), -1), used;
	for (const std::vector<Index>& loop : collapsing.loops())
		for (const Index v : loop)
			name[v] = 0;
	for (Index v = 0; v < mesh.vertexCount(); ++v)
		if (name[v] == 0) {
			name[v] = static_cast<Index>(used.size());
			used.push_back(v);
		}
	std::vector<std::vector<Index>> loops;
	for (std::vector<Index> loop : collapsing.loops()) {
		if (loop.empty())
			continue;
		for (Index& v : loop)
			v = name[v];
		loops.push_back(std::move(loop));
	}
	std::vector<char> marks;
	marks.reserve(used.size());
	for (const Index v : used)
		marks.push_back(onFeature[v]);
	mesh.vertices = mesh.vertices(Eigen::all, used).eval();
	mesh.normals  = mesh.normals(Eigen::all, used).eval();
	mesh.faces    = NeighborLists::fromRows(loops);
	onFeature     = std::move(marks);
	return gone;
}

} // namespace curvature_lines
