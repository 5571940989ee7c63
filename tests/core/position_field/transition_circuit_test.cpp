// Transitions around single triangles against affine maps that are composed one by one.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "transition_circuit.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "cross_field.h"
#include "point_cloud.h"
#include "triangle_mesh.h"

namespace curvature_lines {
namespace {

// x -> linear x + shift
struct Affine {
	Complex linear = 1.0, shift = 0.0;

	Complex operator()(const Complex& x) const { return linear * x + shift; }
	Affine after(const Affine& first) const
	{
		return {linear * first.linear, linear * first.shift + shift};
	}
	Affine inverse() const { return {1.0 / linear, -shift / linear}; }
};

Complex powerOfI(int k)
{
	const std::array<Complex, 4> powers = {1.0, {0.0, 1.0}, -1.0, {0.0, -1.0}};
	return powers[((k % 4) + 4) % 4];
}

struct OneTriangle {
	TriangleMesh     mesh;
	CrossField       field;
	Eigen::VectorXcd translations;

	// From the frame at corner c + 1 to that at corner c.
	Affine overSide(int c) const
	{
		const Index  e = mesh.edgeOf(0, c);
		const Affine ahead{powerOfI(-int(field.turns[e])), translations[e]};
		return mesh.triangles()[0][c] == mesh.edges()[e].from ? ahead : ahead.inverse();
	}
	// Once around, from corner c back to it.
	Affine around(int c) const
	{
		return overSide(c).after(overSide((c + 1) % 3)).after(overSide((c + 2) % 3));
	}
	TransitionCircuit circuit() const { return circuitOf(mesh, field, translations, 0); }
};

// All orders of the corners, so that edges run along the triangle and against it, with random turns and whole numbers.
std::vector<OneTriangle> randomTriangles(int perOrder)
{
	std::vector<OneTriangle> result;
	samples::Random          random(3, 0);
	const auto whole = [&](int most) { return std::floor(random.uniform(-most, most + 1.0)); };
	for (const Triangle& corners :
	     {Triangle{0, 1, 2},
	      Triangle{1, 2, 0},
	      Triangle{2, 0, 1},
	      Triangle{0, 2, 1},
	      Triangle{2, 1, 0},
	      Triangle{1, 0, 2}})
		for (int k = 0; k < perOrder; ++k) {
			OneTriangle one;
			one.mesh = TriangleMesh(Eigen::Matrix3d::Identity(), {corners});
			one.translations.resize(3);
			for (int e = 0; e < 3; ++e) {
				one.field.turns.push_back(static_cast<std::uint8_t>(whole(50)) & 3);
				one.translations[e] = {whole(3), whole(3)};
			}
			result.push_back(std::move(one));
		}
	return result;
}

TEST(TransitionCircuit, IsTheCompositionOfItsThreeSides)
{
	int seen[4] = {0, 0, 0, 0};
	for (const OneTriangle& one : randomTriangles(300)) {
		const TransitionCircuit circuit = one.circuit();
		for (int c = 0; c < 3; ++c) {
			EXPECT_EQ(powerOfI(-circuit.turns[c]), one.overSide(c).linear);
			EXPECT_EQ(circuit.translation[c], one.overSide(c).shift);
		}
		EXPECT_EQ(circuit.before[0], 0);
		EXPECT_EQ(circuit.before[1], circuit.turns[0]);
		EXPECT_EQ(circuit.before[2], (circuit.turns[0] + circuit.turns[1]) & 3);
		EXPECT_EQ(powerOfI(-circuit.index), one.around(0).linear);
		EXPECT_EQ(circuit.sum, one.around(0).shift);
		++seen[circuit.index];
	}
	for (const int count : seen)
		EXPECT_GT(count, 100);
}

TEST(TransitionCircuit, TheFixedPointComesBackToEveryCorner)
{
	for (const OneTriangle& one : randomTriangles(300)) {
		const TransitionCircuit circuit = one.circuit();
		if (circuit.index == 0)
			continue;
		for (int c = 0; c < 3; ++c) {
			const Complex x = circuit.fixedPoint(c);
			EXPECT_EQ(one.around(c)(x), x);
			// the same point, seen from the next corner
			EXPECT_EQ(one.overSide(c)(circuit.fixedPoint((c + 1) % 3)), x);
		}
	}
}

// Whether any crossing of lines of both families is left as it is, by trying them.
TEST(TransitionCircuit, IsClosedExactlyWhereACrossingStays)
{
	for (int index = 1; index < 4; ++index)
		for (int re = -4; re <= 4; ++re)
			for (int im = -4; im <= 4; ++im) {
				TransitionCircuit circuit;
				circuit.index = index;
				circuit.sum   = {double(re), double(im)};
				const Affine around{powerOfI(-index), circuit.sum};
				bool         found = false;
				for (int a = -10; a <= 10; ++a)
					for (int b = -10; b <= 10; ++b)
						found |= around({double(a), double(b)}) == Complex(a, b);
				EXPECT_EQ(circuit.isClosed(), found) << index << " " << circuit.sum;
			}
	TransitionCircuit regular;
	EXPECT_TRUE(regular.isClosed());
	for (const Complex& sum : {Complex(1, 0), Complex(0, -1), Complex(2, 2)}) {
		regular.sum = sum;
		EXPECT_FALSE(regular.isClosed());
	}
}

TEST(TransitionCircuit, ClosesWhicheverCornerIsTheFirst)
{
	for (const OneTriangle& one : randomTriangles(100)) {
		const Triangle&         corners = one.mesh.triangles()[0];
		const TransitionCircuit circuit = one.circuit();
		OneTriangle             other   = one;
		other.mesh = TriangleMesh(one.mesh.vertices, {{corners[1], corners[2], corners[0]}});
		EXPECT_EQ(other.circuit().index, circuit.index);
		EXPECT_EQ(other.circuit().isClosed(), circuit.isClosed());
		// Seen from the other side all turns go back.
		other.mesh = TriangleMesh(one.mesh.vertices, {{corners[2], corners[1], corners[0]}});
		EXPECT_EQ((other.circuit().index + circuit.index) & 3, 0);
		EXPECT_EQ(other.circuit().isClosed(), circuit.isClosed());
	}
}

} // namespace
} // namespace curvature_lines
