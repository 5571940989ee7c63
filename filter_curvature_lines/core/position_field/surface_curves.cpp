// Integers along edges, and normal-curve matching in triangles (Haken's normal coordinates).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "cross_field.h"
#include "point_cloud.h"
#include "position_field.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

// A phase so near to an integer is one: pinned phases are integers but for rounding, and the curve through
// them is the rim or crease itself.
constexpr double tolerance = 1e-9;

std::vector<EdgePoint> pointsOn(const Complex& start, const Complex& end)
{
	std::vector<std::tuple<double, int, double>> found; // t, family, integer
	for (int f = 0; f < 2; ++f) {
		const double a = f == 0 ? start.real() : start.imag(), b = f == 0 ? end.real() : end.imag();
		const double low = std::min(a, b), high = std::max(a, b);
		for (double q = std::floor(low + tolerance) + 1.0; q < high - tolerance; q += 1.0)
			found.emplace_back((q - a) / (b - a), f, q);
	}
	std::sort(found.begin(), found.end());
	std::vector<EdgePoint> points;
	points.reserve(found.size());
	for (const auto& [t, family, q] : found)
		points.push_back({t, family});
	return points;
}

// The middle one of the points on a side that are in no arc, -1: there is none.
int looseOn(int side, int count, const std::vector<std::pair<SidePoint, SidePoint>>& arcs)
{
	std::vector<char> matched(count, 0);
	for (const auto& [p, q] : arcs)
		for (const SidePoint& s : {p, q})
			if (s.side == side)
				matched[s.index] = 1;
	std::vector<int> loose;
	for (int k = 0; k < count; ++k)
		if (!matched[k])
			loose.push_back(k);
	return loose.empty() ? -1 : loose[loose.size() / 2];
}

} // namespace

std::vector<std::pair<SidePoint, SidePoint>> matchSides(const std::array<int, 3>& counts)
{
	// around[c]: arcs about corner c, between the side that ends there and the one that begins there.
	std::array<int, 3> around;
	for (int c = 0; c < 3; ++c) {
		const int in = counts[(c + 2) % 3], out = counts[c], opposite = counts[(c + 1) % 3];
		around[c] = std::max(0, std::min({in, out, (in + out - opposite) / 2}));
	}
	std::vector<std::pair<SidePoint, SidePoint>> arcs;
	for (int c = 0; c < 3; ++c)
		for (int k = 0; k < around[c]; ++k)
			arcs.push_back({{(c + 2) % 3, counts[(c + 2) % 3] - 1 - k}, {c, k}});
	// What is left on two sides is joined, what is left on one is where curves end.
	std::array<int, 3> first, last;
	for (int c = 0; c < 3; ++c) {
		first[c] = around[c];
		last[c]  = counts[c] - around[(c + 1) % 3];
	}
	for (int c = 0; c < 3; ++c) {
		const int in = (c + 2) % 3;
		while (first[in] < last[in] && first[c] < last[c])
			arcs.push_back({{in, --last[in]}, {c, first[c]++}});
	}
	return arcs;
}

SurfaceCurves integerLines(
	const TriangleMesh&      mesh,
	const CrossField&        field,
	const PositionField&     positions,
	const std::vector<char>& crossing)
{
	SurfaceCurves curves;
	curves.points.resize(mesh.edgeCount());
	for (Index e = 0; e < mesh.edgeCount(); ++e)
		curves.points[e] = pointsOn(positions.phase[mesh.edges()[e].from], positions.end[e]);

	const auto isWhole = [&](Index v, int f) {
		const Complex& w = positions.phase[v];
		const double   x = f == 0 ? w.real() : w.imag();
		return (!crossing.empty() && crossing[v]) || std::abs(x - std::round(x)) <= tolerance;
	};
	std::array<std::array<std::vector<Index>, 3>, 2> sides; // family in the frame of corner 0, side
	for (Index t = 0; t < mesh.triangleCount(); ++t) {
		const std::array<int, 3> turns = cornerTurns(mesh, field, t);
		// Around a point of odd index a line of one family goes on as one of the other.
		const bool joint = field.index[t] & 1;
		for (int c = 0; c < 3; ++c) {
			const Index e     = mesh.edgeOf(t, c);
			const bool  ahead = mesh.isForward(t, c);
			const int   swaps = turns[ahead ? c : (c + 1) % 3];
			for (int f = 0; f < 2; ++f)
				sides[f][c].clear();
			const auto count = static_cast<Index>(curves.points[e].size());
			for (Index k = 0; k < count; ++k) {
				const Index p      = ahead ? k : count - 1 - k;
				const int   family = joint ? 0 : (curves.points[e][p].family + swaps) & 1;
				sides[family][c].push_back(p);
			}
		}
		for (int f = 0; f < 2; ++f) {
			const auto&        family = sides[f];
			std::array<int, 3> counts;
			for (int c = 0; c < 3; ++c)
				counts[c] = static_cast<int>(family[c].size());
			const auto arcs = matchSides(counts);
			for (const auto& [p, q] : arcs)
				curves.chords.push_back(
					{t,
				     {mesh.edgeOf(t, p.side), family[p.side][p.index]},
				     {mesh.edgeOf(t, q.side), family[q.side][q.index]}});
			const int loose = counts[0] + counts[1] + counts[2] - 2 * static_cast<int>(arcs.size());
			curves.ends += loose;
			if (loose == 0 || joint)
				continue;
			for (int c = 0; c < 3; ++c) {
				const int   opposite = (c + 2) % 3;
				const Index v        = mesh.triangles()[t][opposite];
				const int   k        = looseOn(c, counts[c], arcs);
				if (k < 0 || !isWhole(v, familyBehind(turns[opposite], f).family))
					continue;
				curves.chords.push_back({t, {mesh.edgeOf(t, c), family[c][k]}, {-1, v}});
				--curves.ends;
			}
		}
	}
	return curves;
}

} // namespace curvature_lines
