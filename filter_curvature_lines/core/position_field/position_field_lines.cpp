// Chords joined to chains, the family of each chord, and chains cut where it changes.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "position_field_lines.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include <Eigen/SparseCholesky>

#include "cloud_index.h"
#include "cross_field.h"
#include "curvature_field.h"
#include "line_network.h"
#include "line_untangling.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "scaffold.h"
#include "surface_curves.h"
#include "surface_projection.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// Points whose normals are within 37 degrees of the triangles' (dot product) are of their face; the nearest
// such among so many is taken. By experiment.
constexpr double sameFace     = 0.8;
constexpr Index  closestAsked = 16;
// Weight with which the arms d1 are taken for family 1 everywhere: decides only where nothing else does.
constexpr double unknownWeight = 1e-9;

// Along the arms d1 of the crosses: how much they are the directions of family 1 (+1) and not 2 (-1), at every
// vertex. Where nothing is known, as around it; across an odd number of quarter turns the sign changes.
Eigen::VectorXd
familyOfArms(const Scaffold& scaffold, const CrossField& field, const CurvatureField& curvature)
{
	const TriangleMesh&                 mesh    = scaffold.mesh;
	const Index                         n       = mesh.vertexCount();
	const Eigen::VectorXd               known   = directionGuide(scaffold, curvature).weights;
	const Eigen::VectorXd               weights = mesh.cotangentWeights();
	Eigen::VectorXd                     sums    = known.array() + unknownWeight;
	Eigen::VectorXd                     right   = Eigen::VectorXd::Constant(n, unknownWeight);
	std::vector<Eigen::Triplet<double>> entries;
	entries.reserve(n + mesh.edgeCount());
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		const TriangleMesh::Edge& edge = mesh.edges()[e];
		sums[edge.from] += weights[e];
		sums[edge.to] += weights[e];
		entries.emplace_back(edge.to, edge.from, field.turns[e] & 1 ? weights[e] : -weights[e]);
	}
	for (Index v = 0; v < n; ++v) {
		entries.emplace_back(v, v, sums[v]);
		if (known[v] > 0.0) {
			const double cosine = field.d1.col(v).dot(curvature.d1.col(scaffold.source[v]));
			right[v] += known[v] * (2.0 * cosine * cosine - 1.0);
		}
	}
	Eigen::SparseMatrix<double> matrix(n, n);
	matrix.setFromTriplets(entries.begin(), entries.end());
	return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower>(matrix).solve(right);
}

// In the triangle's own frame, that of corner 0, so that chords that cross there are of different families.
int familyOf(
	const SurfaceCurves::Chord& chord,
	const SurfaceCurves&        curves,
	const TriangleMesh&         mesh,
	const CrossField&           field,
	const Eigen::VectorXd&      arms)
{
	const Index t = chord.triangle;
	if (field.index[t] & 1) // one family goes on as the other
		return 0;
	const std::array<int, 3> turns  = cornerTurns(mesh, field, t);
	double                   first  = 0.0; // how much arm d1 of corner 0 is of family 1
	int                      family = curves.points[chord.a.edge][chord.a.point].family;
	for (int c = 0; c < 3; ++c) {
		const Index v = mesh.triangles()[t][c];
		first += turns[c] & 1 ? -arms[v] : arms[v];
		if (v == mesh.edges()[chord.a.edge].from)
			family = (family + turns[c]) & 1;
	}
	return (family == 1) == (first >= 0.0) ? 1 : 2; // where phase 0 is whole, a line runs along d2
}

// Edge points as nodes, numbered edge by edge; each is joined to at most one other per triangle.
struct Link {
	Index to;
	int   family; // 0: unknown
};
struct Chain {
	std::vector<Index> nodes;
	// of the links between nodes, and of a closed chain from its last node to its first
	std::vector<int> family;
	bool             closed = false;
};

std::vector<Chain> chainsOf(const std::vector<std::vector<Link>>& joined)
{
	std::vector<Chain> chains;
	std::vector<char>  visited(joined.size(), 0);
	const auto         follow = [&](Index start, bool closed) {
        Chain chain;
        chain.closed = closed;
        for (Index at = start; at >= 0;) {
            visited[at] = 1;
            chain.nodes.push_back(at);
            Index next = -1;
            for (const Link& link : joined[at])
                if (!visited[link.to] && next < 0) {
                    next = link.to;
                    chain.family.push_back(link.family);
                }
            at = next;
        }
        if (closed) // the first link was taken from the front
            chain.family.push_back(joined[start].back().family);
        chains.push_back(std::move(chain));
	};
	const auto count = static_cast<Index>(joined.size());
	for (const std::size_t degree : {1, 2})
		for (Index n = 0; n < count; ++n)
			if (!visited[n] && joined[n].size() == degree)
				follow(n, degree == 2);
	return chains;
}

// Links of unknown family take that of the link before, the first ones that of the link behind.
void completeFamilies(std::vector<int>& family)
{
	const auto known = std::find_if(family.begin(), family.end(), [](int f) { return f != 0; });
	int        last  = known == family.end() ? 1 : *known;
	for (int& f : family)
		last = f = f != 0 ? f : last;
}

// Cut where the family changes.
std::vector<Chain> cut(Chain chain)
{
	completeFamilies(chain.family);
	const auto change =
		std::adjacent_find(chain.family.begin(), chain.family.end(), std::not_equal_to<int>());
	if (change == chain.family.end())
		return {std::move(chain)};
	if (chain.closed) {
		const auto start = change - chain.family.begin() + 1;
		std::rotate(chain.nodes.begin(), chain.nodes.begin() + start, chain.nodes.end());
		std::rotate(chain.family.begin(), chain.family.begin() + start, chain.family.end());
		chain.nodes.push_back(chain.nodes.front());
	}
	std::vector<Chain> parts;
	for (std::size_t k = 0; k < chain.family.size(); ++k) {
		if (k == 0 || chain.family[k] != chain.family[k - 1]) {
			parts.emplace_back();
			parts.back().nodes.push_back(chain.nodes[k]);
		}
		parts.back().nodes.push_back(chain.nodes[k + 1]);
		parts.back().family.push_back(chain.family[k]);
	}
	return parts;
}

// Unit normal of the triangles at an edge.
Vector3d sideOf(const TriangleMesh& mesh, Index edge)
{
	Vector3d sum = Vector3d::Zero();
	for (const Index t : {mesh.edges()[edge].left, mesh.edges()[edge].right})
		if (t >= 0)
			sum += mesh.areaVector(t);
	return sum.normalized();
}

// Beside a crease the nearest point may be one of the other face: projected onto that, a line would turn back.
Index closestOnSide(
	const PointCloud& cloud, const NeighborSearch& search, const Vector3d& at, const Vector3d& side)
{
	const auto near = search.nearest(at, closestAsked);
	for (const Index i : near)
		if (cloud.normals.col(i).dot(side) > sameFace)
			return i;
	return near[0];
}

// Number of the first point of every edge, and after the last the number of all.
std::vector<Index> firstPoints(const SurfaceCurves& curves)
{
	std::vector<Index> first = {0};
	for (const std::vector<EdgePoint>& points : curves.points)
		first.push_back(first.back() + static_cast<Index>(points.size()));
	return first;
}

// The points of the curves on the surface of the cloud; those on rims and creases stay where the mesh has
// them.
std::vector<SurfaceSample> projectedPoints(
	const SurfaceCurves&      curves,
	const std::vector<Index>& first,
	const Scaffold&           scaffold,
	const CloudIndex&         index,
	const CurvatureField&     curvature)
{
	const PointCloud&          cloud  = index.cloud();
	const NeighborSearch&      search = index.search();
	const TriangleMesh&        mesh   = scaffold.mesh;
	std::vector<SurfaceSample> samples(first.back());
	parallelFor(mesh.edgeCount(), {}, [&](Index e) {
		const Vector3d side = sideOf(mesh, e);
		for (std::size_t p = 0; p < curves.points[e].size(); ++p) {
			const Vector3d at =
				mesh.vertices.col(mesh.edges()[e].from) + curves.points[e][p].t * mesh.along(e);
			SurfaceSample& sample = samples[first[e] + p];
			sample                = projectToSurface(
                cloud,
                curvature,
                at,
                closestOnSide(cloud, search, at, side),
                ProjectionKind::Mixed);
			if (mesh.edges()[e].isRim() || scaffold.creaseEdge[e])
				sample.position = at;
		}
	});
	return samples;
}

std::vector<char> creaseVertices(const Scaffold& scaffold)
{
	std::vector<char> result(scaffold.mesh.vertexCount(), 0);
	for (Index e = 0; e < scaffold.mesh.edgeCount(); ++e)
		if (scaffold.creaseEdge[e] || scaffold.mesh.edges()[e].isRim())
			result[scaffold.mesh.edges()[e].from] = result[scaffold.mesh.edges()[e].to] = 1;
	return result;
}

// A vertex at which a line ends, on the surface of the cloud, or where it is if that is on a rim or crease.
SurfaceSample vertexSample(
	Index                 v,
	const Scaffold&       scaffold,
	const CrossField&     field,
	bool                  onCrease,
	const CloudIndex&     index,
	const CurvatureField& curvature)
{
	const Vector3d at     = scaffold.mesh.vertices.col(v);
	SurfaceSample  sample = projectToSurface(
        index.cloud(),
        curvature,
        at,
        closestOnSide(index.cloud(), index.search(), at, field.normals.col(v)),
        ProjectionKind::Mixed);
	if (onCrease)
		sample.position = at;
	return sample;
}

// Why a curve ends at a point of an edge.
LineEnd endAt(Index e, const Scaffold& scaffold, const CrossField& field)
{
	const TriangleMesh::Edge& edge = scaffold.mesh.edges()[e];
	if (edge.isRim())
		return LineEnd::Rim;
	if (scaffold.creaseEdge[e])
		return LineEnd::Crease;
	return field.index[edge.left] != 0 || field.index[edge.right] != 0 ? LineEnd::Umbilic
	                                                                   : LineEnd::Line;
}

// `endOf` tells why a chain that is not closed ends at a node.
template<class EndOf>
LineNetwork networkOf(
	const std::vector<Chain>& chains, const std::vector<SurfaceSample>& samples, const EndOf& endOf)
{
	Index count = 0;
	for (const Chain& chain : chains)
		count += static_cast<Index>(chain.nodes.size());
	LineNetwork lines;
	lines.vertices.resize(3, count);
	lines.normals.resize(3, count);
	lines.curvature.resize(count);
	Index written = 0;
	for (const Chain& chain : chains) {
		const int family = chain.family.front();
		for (const Index n : chain.nodes) {
			lines.vertices.col(written) = samples[n].position;
			lines.normals.col(written)  = samples[n].normal;
			lines.curvature[written++]  = family == 1 ? samples[n].k1 : samples[n].k2;
		}
		const auto end = [&](Index node) { return chain.closed ? LineEnd::None : endOf(node); };
		lines.offsets.push_back(written);
		lines.family.push_back(family);
		lines.closed.push_back(chain.closed);
		lines.ends.push_back({end(chain.nodes.front()), end(chain.nodes.back())});
	}
	return lines;
}

} // namespace

LineNetwork linesOf(
	const SurfaceCurves&  curves,
	const Scaffold&       scaffold,
	const CrossField&     field,
	const CloudIndex&     index,
	const CurvatureField& curvature)
{
	const std::vector<Index>       first = firstPoints(curves);
	const Eigen::VectorXd          arms  = familyOfArms(scaffold, field, curvature);
	std::vector<std::vector<Link>> joined(first.back());
	std::vector<Index> endVertex; // where a chord ends at a vertex: nodes after those of the edges
	const auto         nodeOf = [&](const SurfaceCurves::End& end) {
        if (end.edge >= 0)
            return first[end.edge] + end.point;
        endVertex.push_back(end.point);
        joined.emplace_back();
        return static_cast<Index>(joined.size()) - 1;
	};
	for (const SurfaceCurves::Chord& chord : curves.chords) {
		const Index a = nodeOf(chord.a), b = nodeOf(chord.b);
		const int   family = familyOf(chord, curves, scaffold.mesh, field, arms);
		joined[a].push_back({b, family});
		joined[b].push_back({a, family});
	}
	std::vector<Chain> chains;
	for (const Chain& whole : chainsOf(joined))
		for (Chain& part : cut(whole))
			chains.push_back(std::move(part));

	const std::vector<char> onCrease = creaseVertices(scaffold);
	const auto              endOf    = [&](Index node) {
        if (joined[node].size() == 2) // cut where the family changes
            return LineEnd::Umbilic;
        if (node >= first.back())
            return onCrease[endVertex[node - first.back()]] ? LineEnd::Crease : LineEnd::Umbilic;
        const auto e = std::upper_bound(first.begin(), first.end(), node) - first.begin() - 1;
        return endAt(static_cast<Index>(e), scaffold, field);
	};
	std::vector<SurfaceSample> samples = projectedPoints(curves, first, scaffold, index, curvature);
	for (const Index v : endVertex)
		samples.push_back(vertexSample(v, scaffold, field, onCrease[v] != 0, index, curvature));
	return untangled(networkOf(chains, samples, endOf));
}

} // namespace curvature_lines
