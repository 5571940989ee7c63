// Gradients and wanted gradients of the elements.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "phase_elements.h"

#include <array>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "cross_field.h"
#include "line_density.h"
#include "point_cloud.h"
#include "transition_circuit.h"
#include "triangle_mesh.h"

namespace curvature_lines {

using Eigen::Vector3d;

PhaseElement wholeTriangle(
	const TriangleMesh&      mesh,
	const CrossField&        field,
	const LineDensity&       density,
	Index                    triangle,
	const TransitionCircuit& circuit)
{
	const TriangleField tri = triangleField(mesh, field, density, triangle);
	PhaseElement        result;
	result.triangle = triangle;
	result.vertex   = mesh.triangles()[triangle];
	result.turns    = tri.turns;
	result.whole = {0.0, circuit.translation[0], -turned(circuit.translation[2], circuit.turns[2])};
	result.gradient = tri.gradient;
	result.target   = tri.target;
	result.normal   = tri.normal;
	result.area     = tri.area;
	return result;
}

std::array<PhaseElement, 3> partsAroundFixedPoint(
	const TriangleMesh&      mesh,
	const CrossField&        field,
	const LineDensity&       density,
	Index                    triangle,
	const TransitionCircuit& circuit)
{
	const Triangle&             corners = mesh.triangles()[triangle];
	const Vector3d              normal  = mesh.areaVector(triangle).normalized();
	std::array<PhaseElement, 3> parts;
	for (int c = 0; c < 3; ++c) {
		const Index   a = corners[c], b = corners[(c + 1) % 3];
		PhaseElement& part = parts[c];
		part.triangle      = triangle;
		part.vertex        = {a, b, -1};
		part.turns         = {0, circuit.turns[c], 0};
		part.whole         = {0.0, circuit.translation[c], circuit.fixedPoint(c)};
		part.normal        = normal;
		part.area          = mesh.areaVector(triangle).norm() / 3.0;

		const Vector3d                centre = mesh.vertices(Eigen::all, corners).rowwise().mean();
		const std::array<Vector3d, 3> p      = {mesh.vertices.col(a), mesh.vertices.col(b), centre};
		for (int k = 0; k < 3; ++k)
			part.gradient.col(k) =
				part.area > 0.0
					? Vector3d(normal.cross(p[(k + 2) % 3] - p[(k + 1) % 3]) / (2.0 * part.area))
					: Vector3d::Zero();
		for (int f = 0; f < 2; ++f) {
			const auto arm = [&](Index v, const FamilyImage& image) {
				const Vector3d d = image.family == 0 ? field.d1.col(v) : field.d2.col(v);
				return Vector3d(
					image.sign * density(image.family, v) *
					transported(d, field.normals.col(v), normal));
			};
			part.target[f] = 0.5 * (arm(a, {f, 1}) + arm(b, familyBehind(circuit.turns[c], f)));
		}
	}
	return parts;
}

} // namespace curvature_lines
