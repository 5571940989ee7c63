// Four doubles at a time in the registers of one instruction set, by the library xsimd.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <type_traits>

#include <xsimd/xsimd.hpp>

#include "block_size.h"

// Operations of blocks have to be part of the loop that uses them: a call would put all sums of the loop into memory.
#ifdef _MSC_VER
#define CURVATURE_LINES_INLINE __forceinline
#else
#define CURVATURE_LINES_INLINE inline __attribute__((always_inline))
#endif

namespace curvature_lines {

// The instruction set that the whole program may use. Registers wider than a block (AVX-512) are not asked for.
using BaselineArch = std::conditional_t<
	(xsimd::batch<double, xsimd::default_arch>::size > blockSize),
	xsimd::avx2,
	xsimd::default_arch>;

// A block of values: one register of AVX2, or two of SSE2 or NEON. Each operation is rounded by itself (there is
// no fused multiply-add), and sumOf() adds in one fixed order: every instruction set computes the same bits.
template<class Arch>
class Block {
public:
	using Batch                = xsimd::batch<double, Arch>;
	static constexpr int parts = blockSize / static_cast<int>(Batch::size);

	Block() : Block(0.0) {}
	Block(double value) // a number in an expression stands for a block of it
	{
		for (Batch& p : part)
			p = Batch(value);
	}
	// From memory that is aligned for double only, and back.
	static Block at(const double* p)
	{
		Block b;
		for (int k = 0; k < parts; ++k)
			b.part[k] = Batch::load_unaligned(p + k * Batch::size);
		return b;
	}
	void storeTo(double* p) const
	{
		for (int k = 0; k < parts; ++k)
			part[k].store_unaligned(p + k * Batch::size);
	}

	Block& operator+=(const Block& b) { return *this = *this + b; }
	Block& operator-=(const Block& b) { return *this = *this - b; }
	Block& operator*=(const Block& b) { return *this = *this * b; }

	friend Block operator+(const Block& a, const Block& b)
	{
		return each([&](int k) { return a.part[k] + b.part[k]; });
	}
	friend Block operator-(const Block& a, const Block& b)
	{
		return each([&](int k) { return a.part[k] - b.part[k]; });
	}
	friend Block operator*(const Block& a, const Block& b)
	{
		return each([&](int k) { return a.part[k] * b.part[k]; });
	}
	friend Block operator/(const Block& a, const Block& b)
	{
		return each([&](int k) { return a.part[k] / b.part[k]; });
	}
	// a < b ? yes : no, value by value.
	friend Block ifLess(const Block& a, const Block& b, const Block& yes, const Block& no)
	{
		return each(
			[&](int k) { return xsimd::select(a.part[k] < b.part[k], yes.part[k], no.part[k]); });
	}
	friend double sumOf(const Block& b)
	{
		double v[blockSize];
		b.storeTo(v);
		return (v[0] + v[2]) + (v[1] + v[3]);
	}

private:
	template<class Operation>
	static Block each(const Operation& operation)
	{
		Block b;
		for (int k = 0; k < parts; ++k)
			b.part[k] = operation(k);
		return b;
	}

	Batch part[parts];
};

// exp(-x) for x >= 0, to 1e-5 of its value (1e-10 up to 5); 0 from 16 on. Gaussian weights need no more. The
// Taylor polynomial of degree 7 of exp(-x / 32), squared five times.
template<class Arch>
CURVATURE_LINES_INLINE Block<Arch> expOfNegative(const Block<Arch>& x)
{
	const Block<Arch> t = x * (-1.0 / 32.0);
	Block<Arch>       e = t * (1.0 / 5040.0) + 1.0 / 720.0;
	e                   = t * e + 1.0 / 120.0;
	e                   = t * e + 1.0 / 24.0;
	e                   = t * e + 1.0 / 6.0;
	e                   = t * e + 0.5;
	e                   = t * e + 1.0;
	e                   = t * e + 1.0;
	for (int doubling = 0; doubling < 5; ++doubling)
		e *= e;
	return ifLess(x, Block<Arch>(16.0), e, Block<Arch>());
}

} // namespace curvature_lines
