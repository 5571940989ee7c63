// Monomials x^a y^b of the whole degree, in the order 1, x, y, x^2, x y, y^2, x^3, ...
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace curvature_lines {

// How many there are up to this degree.
constexpr int monomialCount(int degree)
{
	return (degree + 1) * (degree + 2) / 2;
}

// The place of x^a y^b among them.
constexpr int monomialIndex(int a, int b)
{
	return (a + b) * (a + b + 1) / 2 + b;
}

} // namespace curvature_lines
