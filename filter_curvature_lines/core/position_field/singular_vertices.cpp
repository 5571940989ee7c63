// Every column and flag of the scaffold, carried over.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "singular_vertices.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "cross_field.h"
#include "point_cloud.h"
#include "position_field.h"
#include "scaffold.h"
#include "surface_graph.h"
#include "transition_circuit.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

// Values of the vertices, and for every singular triangle that of its first corner.
template<class Values>
Values
withFirstCorners(const Values& values, const TriangleMesh& mesh, const std::vector<Index>& singular)
{
	Values result = values;
	if (values.size() == 0)
		return result;
	result.resize(values.size() + singular.size());
	std::copy(values.begin(), values.end(), result.begin());
	for (std::size_t k = 0; k < singular.size(); ++k)
		result[values.size() + k] = values[mesh.triangles()[singular[k]][0]];
	return result;
}

Eigen::Matrix3Xd withMeans(
	const Eigen::Matrix3Xd& values, const TriangleMesh& mesh, const std::vector<Index>& singular)
{
	const Index      n = mesh.vertexCount();
	Eigen::Matrix3Xd result(3, n + static_cast<Index>(singular.size()));
	result.leftCols(n) = values;
	for (std::size_t k = 0; k < singular.size(); ++k)
		result.col(n + static_cast<Index>(k)) =
			values(Eigen::all, mesh.triangles()[singular[k]]).rowwise().mean();
	return result;
}

} // namespace

SingularVertices splitSingularTriangles(
	const Scaffold&        scaffold,
	const CrossField&      field,
	const PositionField&   positions,
	const SurfaceFeatures& features)
{
	const TriangleMesh&   mesh = scaffold.mesh;
	const Index           n    = mesh.vertexCount();
	std::vector<Triangle> triangles;
	std::vector<Index>    singular;
	for (Index t = 0; t < mesh.triangleCount(); ++t) {
		const Triangle& corners = mesh.triangles()[t];
		if (field.index[t] == 0) {
			triangles.push_back(corners);
			continue;
		}
		const Index centre = n + static_cast<Index>(singular.size());
		for (int c = 0; c < 3; ++c)
			triangles.push_back({corners[c], corners[(c + 1) % 3], centre});
		singular.push_back(t);
	}

	SingularVertices result;
	result.scaffold = scaffold;
	result.scaffold.mesh =
		TriangleMesh(withMeans(mesh.vertices, mesh, singular), std::move(triangles));
	result.scaffold.source.resize(n + singular.size(), -1);
	result.scaffold.place   = withFirstCorners(scaffold.place, mesh, singular);
	result.scaffold.onLimb  = withFirstCorners(scaffold.onLimb, mesh, singular);
	result.scaffold.spacing = withFirstCorners(scaffold.spacing, mesh, singular);
	result.scaffold.size    = withFirstCorners(scaffold.size, mesh, singular);

	const TriangleMesh& split = result.scaffold.mesh;
	const auto          added = static_cast<Index>(singular.size());
	result.field.normals      = withMeans(field.normals, mesh, singular);
	result.field.normals.colwise().normalize();
	result.field.d1       = withMeans(field.d1, mesh, singular); // not used: no frame
	result.field.d2       = withMeans(field.d2, mesh, singular);
	result.field.onCrease = withFirstCorners(field.onCrease, mesh, singular);
	result.field.turns.assign(split.edgeCount(), 0);
	result.field.index.assign(split.triangleCount(), 0);
	result.positions.lineEnds      = positions.lineEnds;
	result.positions.phase         = Eigen::VectorXcd::Zero(n + added);
	result.positions.phase.head(n) = positions.phase;
	result.positions.end.setZero(split.edgeCount());
	result.scaffold.creaseEdge.assign(split.edgeCount(), 0);
	result.features.edge.assign(split.edgeCount(), 0);
	result.features.corner = features.corner;
	result.features.corner.resize(n + added, 0);
	result.singular.assign(n, 0);
	result.singular.resize(n + added, 1);
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		const Index same           = split.edgeBetween(mesh.edges()[e].from, mesh.edges()[e].to);
		result.field.turns[same]   = field.turns[e];
		result.positions.end[same] = positions.end[e];
		result.features.edge[same] = features.edge[e];
		result.scaffold.creaseEdge[same] = scaffold.creaseEdge[e];
	}
	for (Index k = 0; k < added; ++k) {
		const TransitionCircuit circuit =
			circuitOf(mesh, field, positions.translations, singular[k]);
		for (int c = 0; c < 3; ++c)
			result.positions.end[split.edgeBetween(mesh.triangles()[singular[k]][c], n + k)] =
				circuit.fixedPoint(c);
	}
	return result;
}

} // namespace curvature_lines
