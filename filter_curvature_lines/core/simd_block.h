// Four doubles at a time, for the sums over the points of a neighbourhood.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace curvature_lines {

constexpr int blockSize = 4;

// A vector type of GCC and Clang: two registers of SSE2, or one of AVX. Fused multiply-adds are not asked
// for, so that every machine computes the same numbers.
typedef double Block __attribute__((vector_size(blockSize * sizeof(double))));
// In memory that is aligned for double only.
typedef double UnalignedBlock __attribute__((vector_size(blockSize * sizeof(double)), aligned(8), may_alias));

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

// A function compiled twice; the program takes what the processor has. Elsewhere the portable one alone.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__AVX2__)
#define CURVATURE_LINES_AVX2_CLONE __attribute__((target_clones("avx2", "default")))
#else
#define CURVATURE_LINES_AVX2_CLONE
#endif

} // namespace curvature_lines
