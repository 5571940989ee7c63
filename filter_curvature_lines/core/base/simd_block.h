// Four doubles at a time, for the sums over the points of a neighbourhood.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace curvature_lines {

constexpr int blockSize = 4;

// A vector type of GCC and Clang: two registers of SSE2, or one of AVX. Fused multiply-adds are not asked
// for, so that every machine computes the same numbers.
typedef double Block __attribute__((vector_size(blockSize * sizeof(double))));
// In memory that is aligned for double only.
typedef double UnalignedBlock
	__attribute__((vector_size(blockSize * sizeof(double)), aligned(8), may_alias));

inline const UnalignedBlock& blockAt(const double* p)
{
	return *reinterpret_cast<const UnalignedBlock*>(p);
}
inline UnalignedBlock& blockAt(double* p)
{
	return *reinterpret_cast<UnalignedBlock*>(p);
}
inline double sumOf(const Block& b)
{
	return (b[0] + b[2]) + (b[1] + b[3]);
}
// exp(-x) for x >= 0, to 1e-5 of its value (1e-10 up to 5); 0 from 16 on. Gaussian weights need no more.
inline void toExpOfNegative(Block& x)
{
	const Block t = x * (-1.0 / 32.0); // exp(t)^32
	Block       e = t * (1.0 / 5040.0) + 1.0 / 720.0;
	e             = t * e + 1.0 / 120.0;
	e             = t * e + 1.0 / 24.0;
	e             = t * e + 1.0 / 6.0;
	e             = t * e + 0.5;
	e             = t * e + 1.0;
	e             = t * e + 1.0;
	for (int doubling = 0; doubling < 5; ++doubling)
		e *= e;
	x = x < 16.0 ? e : Block{};
}

// A function compiled twice; the program takes what the processor has. Elsewhere the portable one alone.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__AVX2__)
#define CURVATURE_LINES_AVX2_CLONE __attribute__((target_clones("avx2", "default")))
#else
#define CURVATURE_LINES_AVX2_CLONE
#endif

} // namespace curvature_lines
