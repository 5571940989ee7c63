// Cross fields made by hand, and the same ones with other frames: which arm of a cross is the first is arbitrary, so that
// nothing may depend on it.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "analytic_surfaces.h"
#include "cross_field.h"
#include "line_density.h"
#include "point_cloud.h"
#include "transition_circuit.h"
#include "triangle_mesh.h"

namespace curvature_lines::test {

// Crosses along the axes x and y, on a plane or where directions do not matter.
inline CrossField alongTheAxes(const TriangleMesh& mesh)
{
	CrossField field;
	field.normals = Eigen::Vector3d::UnitZ().replicate(1, mesh.vertexCount());
	field.d1      = Eigen::Vector3d::UnitX().replicate(1, mesh.vertexCount());
	field.d2      = Eigen::Vector3d::UnitY().replicate(1, mesh.vertexCount());
	field.onCrease.assign(mesh.vertexCount(), 0);
	field.turns.assign(mesh.edgeCount(), 0);
	field.index.assign(mesh.triangleCount(), 0);
	return field;
}

// Of every edge, parts from -most to most.
inline Eigen::VectorXcd randomWholes(const TriangleMesh& mesh, int most, samples::Random& random)
{
	Eigen::VectorXcd result(mesh.edgeCount());
	const auto       part = [&] { return double(random.index(2 * std::size_t(most) + 1)) - most; };
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		const double re = part();
		result[e]       = {re, part()};
	}
	return result;
}

inline void setIndices(const TriangleMesh& mesh, CrossField& field)
{
	const Eigen::VectorXcd none = Eigen::VectorXcd::Zero(mesh.edgeCount());
	field.index.resize(mesh.triangleCount());
	for (Index t = 0; t < mesh.triangleCount(); ++t)
		field.index[t] = static_cast<std::uint8_t>(circuitOf(mesh, field, none, t).index);
}

// Everything that is said in the frames of the vertices.
struct Framed {
	CrossField       field;
	LineDensity      density;
	Eigen::VectorXcd translations, phase; // of edges, of vertices
};

// The same with the frame at every vertex turned by so many quarters.
inline Framed
inTurnedFrames(const TriangleMesh& mesh, const Framed& framed, const std::vector<int>& quarters)
{
	Framed result = framed;
	for (Index v = 0; v < mesh.vertexCount(); ++v) {
		for (int k = 0; k < (quarters[v] & 3); ++k) {
			const Eigen::Vector3d d1 = result.field.d1.col(v);
			result.field.d1.col(v)   = result.field.d2.col(v);
			result.field.d2.col(v)   = -d1;
			result.density.col(v).reverseInPlace();
		}
		if (framed.phase.size() > 0)
			result.phase[v] = turned(framed.phase[v], -quarters[v]);
	}
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		const auto& edge      = mesh.edges()[e];
		result.field.turns[e] = static_cast<std::uint8_t>(
			(framed.field.turns[e] - quarters[edge.to] + quarters[edge.from]) & 3);
		if (framed.translations.size() > 0)
			result.translations[e] = turned(framed.translations[e], -quarters[edge.from]);
	}
	return result;
}

inline std::vector<int> randomQuarters(const TriangleMesh& mesh, samples::Random& random)
{
	std::vector<int> result(mesh.vertexCount());
	for (int& q : result)
		q = static_cast<int>(random.index(4));
	return result;
}

} // namespace curvature_lines::test
