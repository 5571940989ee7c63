// Chains of crease edges, their lengths and angles.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "crease_selection.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"
#include "scaffold.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

// In cells of the mesh.
constexpr double shortestCrease = 1.0, shortestLoop = 4.0;
constexpr double reach = 1.0;
// Cosine of the angle between the faces beyond which a crease is kept in any case. By experiment: a block whose edges were
// given up was twice as far from its mesh.
const double sharp = std::cos(60.0 * double(EIGEN_PI) / 180.0);

std::vector<std::vector<Index>> creasesAt(const Scaffold& scaffold)
{
	std::vector<std::vector<Index>> at(scaffold.mesh.vertexCount());
	for (Index e = 0; e < scaffold.mesh.edgeCount(); ++e)
		if (scaffold.creaseEdge[e]) {
			at[scaffold.mesh.edges()[e].from].push_back(e);
			at[scaffold.mesh.edges()[e].to].push_back(e);
		}
	return at;
}

double cellAt(const Scaffold& scaffold, Index v)
{
	return scaffold.size.size() > 0 ? scaffold.size[v] : scaffold.spacing[v];
}

double cellsAlong(const Scaffold& scaffold, Index e)
{
	const auto& edge = scaffold.mesh.edges()[e];
	return 2.0 * scaffold.mesh.along(e).norm() /
	       (cellAt(scaffold, edge.from) + cellAt(scaffold, edge.to));
}

// A piece of a crease between vertices where it ends or meets others.
struct Chain {
	std::vector<Index> edges;
	int                freeEnds = 0;
	bool               closed   = false;
};

Chain chainFrom(
	const TriangleMesh&                    mesh,
	const std::vector<std::vector<Index>>& at,
	Index                                  start,
	std::vector<char>&                     visited)
{
	Chain chain;
	chain.edges    = {start};
	visited[start] = 1;
	for (const Index first : {mesh.edges()[start].from, mesh.edges()[start].to}) {
		Index e = start, v = first;
		while (at[v].size() == 2) {
			e = at[v][0] == e ? at[v][1] : at[v][0];
			if (visited[e]) {
				chain.closed = true;
				return chain;
			}
			visited[e] = 1;
			chain.edges.push_back(e);
			v = mesh.edges()[e].from == v ? mesh.edges()[e].to : mesh.edges()[e].from;
		}
		chain.freeEnds += at[v].size() == 1;
	}
	return chain;
}

double cosineAcross(const TriangleMesh& mesh, Index e)
{
	const auto& edge = mesh.edges()[e];
	return edge.isRim() ? 1.0
	                    : mesh.areaVector(edge.left).normalized().dot(
							  mesh.areaVector(edge.right).normalized());
}

} // namespace

Index dropShortCreases(Scaffold& scaffold)
{
	Index dropped = 0;
	for (bool changed = true; changed;) {
		changed = false;
		std::vector<char> visited(scaffold.mesh.edgeCount(), 0);
		const auto        at = creasesAt(scaffold);
		for (Index e = 0; e < scaffold.mesh.edgeCount(); ++e) {
			if (!scaffold.creaseEdge[e] || visited[e])
				continue;
			const Chain  chain = chainFrom(scaffold.mesh, at, e, visited);
			const double cells = std::accumulate(
				chain.edges.begin(), chain.edges.end(), 0.0, [&](double sum, Index edge) {
					return sum + cellsAlong(scaffold, edge);
				});
			const double shortest = chain.closed         ? shortestLoop
			                        : chain.freeEnds > 0 ? shortestCrease
			                                             : 0.0;
			if (cells >= shortest)
				continue;
			for (const Index edge : chain.edges)
				scaffold.creaseEdge[edge] = 0;
			dropped += static_cast<Index>(chain.edges.size());
			changed = true;
		}
	}
	return dropped;
}

Index dropCreasesAt(const std::vector<Index>& triangles, Scaffold& scaffold)
{
	const TriangleMesh& mesh    = scaffold.mesh;
	Index               dropped = 0;
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		if (!scaffold.creaseEdge[e] || cosineAcross(mesh, e) < sharp)
			continue;
		const auto&           edge   = mesh.edges()[e];
		const Eigen::Vector3d middle = mesh.vertices.col(edge.from) + 0.5 * mesh.along(e);
		if (std::any_of(triangles.begin(), triangles.end(), [&](Index t) {
				return (mesh.vertices.col(mesh.triangles()[t][0]) - middle).norm() <
			           reach * cellAt(scaffold, edge.from);
			})) {
			scaffold.creaseEdge[e] = 0;
			++dropped;
		}
	}
	return dropped;
}

} // namespace curvature_lines
