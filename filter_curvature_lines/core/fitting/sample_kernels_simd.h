// The loops of sample_kernels.h in blocks, for any instruction set. Internal to sample_kernels.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <type_traits>
#include <utility>

#include "block_size.h"
#include "monomials.h"
#include "sample_kernels.h"
#include "simd_block.h"

namespace curvature_lines::simd {

// body(0), ..., body(Count - 1) with the number as a type: loops over sums that must stay in registers.
template<int... K, class Body>
CURVATURE_LINES_INLINE void unrolledOver(std::integer_sequence<int, K...>, const Body& body)
{
	(body(std::integral_constant<int, K>()), ...);
}
template<int Count, class Body>
CURVATURE_LINES_INLINE void unrolled(const Body& body)
{
	unrolledOver(std::make_integer_sequence<int, Count>(), body);
}

// Weight of a sample at distance d from the centre of a ball of radius r, t2 = (d / r)^2; see ballKernel().
template<class Arch>
CURVATURE_LINES_INLINE Block<Arch> kernelOf(const Block<Arch>& t2)
{
	const Block<Arch> s = 1.0 - t2;
	return ifLess(Block<Arch>(), s, s * s, Block<Arch>());
}

template<class Arch>
CURVATURE_LINES_INLINE Block<Arch>
dot(const Block<Arch>& x, const Block<Arch>& y, const Block<Arch>& z, const double* v)
{
	return x * v[0] + y * v[1] + z * v[2];
}

template<class Arch, int Degree, int Values>
Moments<Degree, Values> momentsOf(const SampleColumns<Values>& samples)
{
	using B               = Block<Arch>;
	constexpr int highest = 2 * Degree;
	B             weighted[monomialCount(highest)];
	B             products[monomialCount(Degree)][Values];
	B             squares;
	for (int s = 0; s < samples.size; s += blockSize) {
		const B x = B::at(samples.x + s);
		const B y = B::at(samples.y + s);
		B       v[Values];
		B       power = B::at(samples.weight + s); // w x^a
		for (int c = 0; c < Values; ++c) {
			v[c] = B::at(samples.value[c] + s);
			squares += power * v[c] * v[c];
		}
		unrolled<highest + 1>([&](auto columnOfA) {
			constexpr int a    = decltype(columnOfA)::value;
			B             both = power; // w x^a y^b
			unrolled<highest - a + 1>([&](auto columnOfB) {
				constexpr int b = decltype(columnOfB)::value;
				weighted[monomialIndex(a, b)] += both;
				if constexpr (a + b <= Degree)
					for (int c = 0; c < Values; ++c)
						products[monomialIndex(a, b)][c] += both * v[c];
				if constexpr (a + b < highest)
					both *= y;
			});
			if constexpr (a < highest)
				power *= x;
		});
	}
	Moments<Degree, Values> result;
	for (int a = 0; a <= highest; ++a)
		for (int b = 0; a + b <= highest; ++b)
			result.weighted[a][b] = sumOf(weighted[monomialIndex(a, b)]);
	for (int a = 0; a <= Degree; ++a)
		for (int b = 0; a + b <= Degree; ++b)
			for (int c = 0; c < Values; ++c)
				result.products[a][b][c] = sumOf(products[monomialIndex(a, b)][c]);
	result.squares = sumOf(squares);
	return result;
}

template<class Arch, int Degree, int Values>
double
distancesFrom(const double* coefficients, const SampleColumns<Values>& samples, double* result)
{
	using B             = Block<Arch>;
	constexpr int count = monomialCount(Degree);
	B             largest;
	for (int s = 0; s < samples.size; s += blockSize) {
		const B x = B::at(samples.x + s);
		const B y = B::at(samples.y + s);
		B       left[Values];
		for (int v = 0; v < Values; ++v)
			left[v] = B::at(samples.value[v] + s);
		B power(1.0); // x^a
		unrolled<Degree + 1>([&](auto columnOfA) {
			constexpr int a    = decltype(columnOfA)::value;
			B             both = power; // x^a y^b
			unrolled<Degree - a + 1>([&](auto columnOfB) {
				constexpr int b = decltype(columnOfB)::value;
				for (int v = 0; v < Values; ++v)
					left[v] -= coefficients[v * count + monomialIndex(a, b)] * both;
				both *= y;
			});
			power *= x;
		});
		B squared;
		for (int v = 0; v < Values; ++v)
			squared += left[v] * left[v];
		squared = ifLess(B(), B::at(samples.weight + s), squared, B());
		largest = ifLess(largest, squared, squared, largest);
		squared.storeTo(result + s);
	}
	double most[blockSize];
	largest.storeTo(most);
	double value = 0.0;
	for (const double m : most)
		value = m > value ? m : value;
	return value;
}

template<class Arch>
PlaneMoments planeMomentsOf(const OrientedColumns& ball, const double* side)
{
	using B = Block<Arch>;
	B weight, offset[3], normal[3], square[6];
	for (int s = 0; s < ball.size; s += blockSize) {
		const B d[3] = {
			B::at(ball.position[0] + s), B::at(ball.position[1] + s), B::at(ball.position[2] + s)};
		const B n[3] = {
			B::at(ball.normal[0] + s), B::at(ball.normal[1] + s), B::at(ball.normal[2] + s)};
		const B along = dot(n[0], n[1], n[2], side);
		B       w     = kernelOf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
		w             = ifLess(along, B(), B(), w);
		weight += w;
		unrolled<3>([&](auto rowOf) {
			constexpr int r  = decltype(rowOf)::value;
			const B       wd = w * d[r];
			offset[r] += wd;
			normal[r] += w * n[r];
			unrolled<r + 1>([&](auto columnOf) {
				constexpr int c = decltype(columnOf)::value;
				square[r * (r + 1) / 2 + c] += wd * d[c];
			});
		});
	}
	PlaneMoments moments;
	moments.weight = sumOf(weight);
	unrolled<3>([&](auto rowOf) {
		constexpr int r   = decltype(rowOf)::value;
		moments.offset[r] = sumOf(offset[r]);
		moments.normal[r] = sumOf(normal[r]);
	});
	unrolled<6>([&](auto entryOf) {
		constexpr int m   = decltype(entryOf)::value;
		moments.square[m] = sumOf(square[m]);
	});
	return moments;
}

template<class Arch>
int toHeights(
	const OrientedColumns&  ball,
	const FrameColumns&     frame,
	const double*           robust,
	const SampleColumns<1>& samples)
{
	using B = Block<Arch>;
	B used;
	for (int s = 0; s < ball.size; s += blockSize) {
		const B x = B::at(ball.position[0] + s) - frame.origin[0];
		const B y = B::at(ball.position[1] + s) - frame.origin[1];
		const B z = B::at(ball.position[2] + s) - frame.origin[2];
		const B along =
			dot(B::at(ball.normal[0] + s),
		        B::at(ball.normal[1] + s),
		        B::at(ball.normal[2] + s),
		        frame.n);
		B w = kernelOf(x * x + y * y + z * z);
		w   = ifLess(along, B(), B(), w * B::at(robust + s));
		used += ifLess(B(), w, B(1.0), B());
		w.storeTo(samples.weight + s);
		dot(x, y, z, frame.u).storeTo(samples.x + s);
		dot(x, y, z, frame.v).storeTo(samples.y + s);
		dot(x, y, z, frame.n).storeTo(samples.value[0] + s);
	}
	return static_cast<int>(sumOf(used));
}

template<class Arch>
int toNormals(
	const OrientedColumns& ball, const FrameColumns& frame, const SampleColumns<3>& samples)
{
	using B = Block<Arch>;
	B used;
	for (int s = 0; s < ball.size; s += blockSize) {
		const B x     = B::at(ball.position[0] + s);
		const B y     = B::at(ball.position[1] + s);
		const B z     = B::at(ball.position[2] + s);
		const B nx    = B::at(ball.normal[0] + s);
		const B ny    = B::at(ball.normal[1] + s);
		const B nz    = B::at(ball.normal[2] + s);
		const B along = dot(nx, ny, nz, frame.n);
		B       w     = kernelOf(x * x + y * y + z * z);
		w             = ifLess(along, B(), B(), w);
		used += ifLess(B(), w, B(1.0), B());
		w.storeTo(samples.weight + s);
		dot(x, y, z, frame.u).storeTo(samples.x + s);
		dot(x, y, z, frame.v).storeTo(samples.y + s);
		dot(nx, ny, nz, frame.u).storeTo(samples.value[0] + s);
		dot(nx, ny, nz, frame.v).storeTo(samples.value[1] + s);
		along.storeTo(samples.value[2] + s);
	}
	return static_cast<int>(sumOf(used));
}

template<class Arch>
PatchSums patchSumsOf(
	const double*           quadric,
	const double*           leverage,
	double                  radiusX,
	double                  radiusY,
	const SampleColumns<1>& samples)
{
	using B                 = Block<Arch>;
	const double* const a   = quadric;
	const double        irx = 1.0 / radiusX, iry = 1.0 / radiusY;
	const double        a3x = 2.0 * a[3], a5y = 2.0 * a[5];
	B                   squares, lost, squaredWeights;
	for (int s = 0; s < samples.size; s += blockSize) {
		const B x = B::at(samples.x + s), y = B::at(samples.y + s), w = B::at(samples.weight + s);
		const B slopeX = (a[1] + a3x * x + a[4] * y) * irx;
		const B slopeY = (a[2] + a[4] * x + a5y * y) * iry;
		const B off    = B::at(samples.value[0] + s) - a[0] - x * (a[1] + a[3] * x + a[4] * y) -
		              y * (a[2] + a[5] * y);
		B variance; // of the prediction, over that of one sample
		unrolled<5>([&](auto rowOf) {
			constexpr int i = 4 - decltype(rowOf)::value;
			B             inner;
			unrolled<5 - i>([&](auto columnOf) {
				constexpr int j = 4 - i - decltype(columnOf)::value;
				inner           = inner * y + leverage[monomialIndex(i, j)];
			});
			variance = variance * x + inner;
		});
		squares += w * off * off / (1.0 + slopeX * slopeX + slopeY * slopeY);
		lost += w * w * variance;
		squaredWeights += w * w;
	}
	return {sumOf(squares), sumOf(lost), sumOf(squaredWeights)};
}

template<class Arch>
void squaredDistances(
	const double* const position[3], const double* center, int size, double* result)
{
	using B = Block<Arch>;
	for (int k = 0; k < size; k += blockSize) {
		const B x = B::at(position[0] + k) - center[0];
		const B y = B::at(position[1] + k) - center[1];
		const B z = B::at(position[2] + k) - center[2];
		(x * x + y * y + z * z).storeTo(result + k);
	}
}

template<class Arch>
void gaussianWeights(
	const double* squaredDistance,
	const double* factor,
	double        reference,
	double        sharpness,
	int           size,
	double*       result)
{
	using B = Block<Arch>;
	for (int k = 0; k < size; k += blockSize) {
		const B exponent = (B::at(squaredDistance + k) - reference) * sharpness;
		(expOfNegative(exponent) * B::at(factor + k)).storeTo(result + k);
	}
}

// All of them for one instruction set: `extern` where they are called, nothing where they are compiled.
// NOLINTBEGIN(bugprone-macro-parentheses): the arguments are `extern` and a type.
// clang-format off
#define CURVATURE_LINES_SAMPLE_KERNELS(EXTERN, ARCH) \
	EXTERN template Moments<1, 1> momentsOf<ARCH, 1, 1>(const SampleColumns<1>&); \
	EXTERN template Moments<2, 1> momentsOf<ARCH, 2, 1>(const SampleColumns<1>&); \
	EXTERN template Moments<4, 1> momentsOf<ARCH, 4, 1>(const SampleColumns<1>&); \
	EXTERN template Moments<1, 3> momentsOf<ARCH, 1, 3>(const SampleColumns<3>&); \
	EXTERN template Moments<2, 3> momentsOf<ARCH, 2, 3>(const SampleColumns<3>&); \
	EXTERN template Moments<3, 3> momentsOf<ARCH, 3, 3>(const SampleColumns<3>&); \
	EXTERN template Moments<2, 10> momentsOf<ARCH, 2, 10>(const SampleColumns<10>&); \
	EXTERN template double distancesFrom<ARCH, 2, 1>(const double*, const SampleColumns<1>&, double*); \
	EXTERN template double distancesFrom<ARCH, 4, 1>(const double*, const SampleColumns<1>&, double*); \
	EXTERN template double distancesFrom<ARCH, 1, 3>(const double*, const SampleColumns<3>&, double*); \
	EXTERN template double distancesFrom<ARCH, 2, 3>(const double*, const SampleColumns<3>&, double*); \
	EXTERN template double distancesFrom<ARCH, 3, 3>(const double*, const SampleColumns<3>&, double*); \
	EXTERN template PlaneMoments planeMomentsOf<ARCH>(const OrientedColumns&, const double*); \
	EXTERN template int toHeights<ARCH>( \
		const OrientedColumns&, const FrameColumns&, const double*, const SampleColumns<1>&); \
	EXTERN template int toNormals<ARCH>(const OrientedColumns&, const FrameColumns&, const SampleColumns<3>&); \
	EXTERN template PatchSums patchSumsOf<ARCH>( \
		const double*, const double*, double, double, const SampleColumns<1>&); \
	EXTERN template void squaredDistances<ARCH>(const double* const*, const double*, int, double*); \
	EXTERN template void gaussianWeights<ARCH>( \
		const double*, const double*, double, double, int, double*);
// clang-format on
// NOLINTEND(bugprone-macro-parentheses)

} // namespace curvature_lines::simd
