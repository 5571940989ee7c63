// Chords joined to chains, and the family of each.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "position_field_lines.h"

#include <cmath>

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// Edge points as nodes, numbered edge by edge; each is joined to at most one other per triangle.
struct Chains {
	std::vector<std::vector<Index>> nodes;
	std::vector<char>               closed;
};

Chains chainsOf(const std::vector<std::vector<Index>>& joined)
{
	Chains            chains;
	std::vector<char> visited(joined.size(), 0);
	const auto        follow = [&](Index start, bool closed) {
		std::vector<Index> chain;
		for (Index at = start; at >= 0;) {
			visited[at] = 1;
			chain.push_back(at);
			Index next = -1;
			for (const Index n : joined[at])
				if (!visited[n] && next < 0)
					next = n;
			at = next;
		}
		chains.nodes.push_back(std::move(chain));
		chains.closed.push_back(closed);
	};
	const auto count = static_cast<Index>(joined.size());
	for (const std::size_t degree : {1, 2})
		for (Index n = 0; n < count; ++n)
			if (!visited[n] && joined[n].size() == degree)
				follow(n, degree == 2);
	return chains;
}

} // namespace

LineNetwork linesOf(
	const SurfaceCurves&  curves,
	const Scaffold&       scaffold,
	const CrossField&     field,
	const PointCloud&     cloud,
	const CurvatureField& curvature)
{
	const TriangleMesh& mesh = scaffold.mesh;
	std::vector<Index>  first(mesh.edgeCount() + 1, 0);
	for (Index e = 0; e < mesh.edgeCount(); ++e)
		first[e + 1] = first[e] + static_cast<Index>(curves.points[e].size());
	std::vector<std::vector<Index>> joined(first.back());
	for (const SurfaceCurves::Chord& chord : curves.chords) {
		const Index a = first[chord.a.edge] + chord.a.point, b = first[chord.b.edge] + chord.b.point;
		joined[a].push_back(b);
		joined[b].push_back(a);
	}
	std::vector<Index>         edgeOf(joined.size());
	std::vector<SurfaceSample> samples(joined.size());
	const NeighborSearch       search(cloud.positions);
	parallelFor(mesh.edgeCount(), {}, [&](Index e) {
		for (std::size_t p = 0; p < curves.points[e].size(); ++p) {
			const Vector3d at = mesh.vertices.col(mesh.edges()[e].from) + curves.points[e][p].t * mesh.along(e);
			const Index    closest = search.nearest(at, 1)[0];
			edgeOf[first[e] + p]   = e;
			samples[first[e] + p]  = projectToSurface(cloud, curvature, at, closest, ProjectionKind::Mixed);
		}
	});
	const auto endAt = [&](Index node) {
		const TriangleMesh::Edge& edge = mesh.edges()[edgeOf[node]];
		if (edge.isRim())
			return LineEnd::Rim;
		if (scaffold.creaseEdge[edgeOf[node]])
			return LineEnd::Crease;
		return field.index[edge.left] != 0 || field.index[edge.right] != 0 ? LineEnd::Umbilic : LineEnd::Line;
	};

	LineNetwork  lines;
	const Chains chains = chainsOf(joined);
	lines.vertices.resize(3, joined.size());
	lines.normals.resize(3, joined.size());
	lines.curvature.resize(joined.size());
	Index written = 0;
	for (std::size_t l = 0; l < chains.nodes.size(); ++l) {
		const std::vector<Index>& nodes = chains.nodes[l];
		double                    vote  = 0.0;
		for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
			const SurfaceSample& here = samples[nodes[k]];
			const Vector3d       step = samples[nodes[k + 1]].position - here.position;
			vote += std::abs(step.dot(here.d1)) - std::abs(step.dot(here.d2));
		}
		const int family = vote >= 0.0 ? 1 : 2;
		for (const Index n : nodes) {
			lines.vertices.col(written) = samples[n].position;
			lines.normals.col(written)  = samples[n].normal;
			lines.curvature[written++]  = family == 1 ? samples[n].k1 : samples[n].k2;
		}
		const bool closed = chains.closed[l];
		lines.offsets.push_back(written);
		lines.family.push_back(family);
		lines.closed.push_back(closed);
		lines.ends.push_back(
			{closed ? LineEnd::None : endAt(nodes.front()), closed ? LineEnd::None : endAt(nodes.back())});
	}
	lines.vertices.conservativeResize(3, written);
	lines.normals.conservativeResize(3, written);
	lines.curvature.conservativeResize(written);
	return lines;
}

} // namespace curvature_lines
