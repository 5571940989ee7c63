// Sums around a triangle.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "transition_circuit.h"

#include <cmath>

#include <Eigen/Core>

#include "cross_field.h"
#include "point_cloud.h"
#include "triangle_mesh.h"

namespace curvature_lines {

bool isOdd(double whole)
{
	return (std::lround(whole) & 1) != 0;
}

Complex TransitionCircuit::fixedPoint(int c) const
{
	const Complex twice = 2.0 * sum / (1.0 - turned(1.0, -index)); // whole
	Complex       x     = {0.5 * std::round(twice.real()), 0.5 * std::round(twice.imag())};
	for (int k = 0; k < c; ++k)
		x = turned(x - translation[k], turns[k]);
	return x;
}

// The fixed point sum / (1 - i^-index) has whole parts exactly then.
bool TransitionCircuit::isClosed() const
{
	if (index == 0)
		return sum == 0.0;
	if (index == 2)
		return !isOdd(sum.real()) && !isOdd(sum.imag());
	return !isOdd(sum.real() + sum.imag());
}

TransitionCircuit circuitOf(
	const TriangleMesh&     mesh,
	const CrossField&       field,
	const Eigen::VectorXcd& translations,
	Index                   triangle)
{
	TransitionCircuit circuit;
	int               turns = 0;
	for (int c = 0; c < 3; ++c) {
		const Index e          = mesh.edgeOf(triangle, c);
		const int   k          = field.turns[e];
		const bool  ahead      = mesh.isForward(triangle, c);
		circuit.turns[c]       = (ahead ? k : -k) & 3;
		circuit.translation[c] = ahead ? translations[e] : -turned(translations[e], k);
		circuit.before[c]      = turns & 3;
		circuit.sum += turned(circuit.translation[c], -turns);
		turns += circuit.turns[c];
	}
	circuit.index = turns & 3;
	return circuit;
}

} // namespace curvature_lines
