// The choice, while the program runs, between the instruction sets that a loop was compiled for.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "simd_block.h"

namespace curvature_lines {

// CURVATURE_LINES_AVX2: the files *_avx2.cpp are compiled for AVX2 (core/CMakeLists.txt). Where the whole program
// is compiled for AVX2 or more there is nothing to choose.
#if defined(CURVATURE_LINES_AVX2) && !XSIMD_WITH_AVX2
#define CURVATURE_LINES_CHOOSES_AVX2 1
using CompiledArchs = xsimd::arch_list<xsimd::avx2, BaselineArch>;
#else
#define CURVATURE_LINES_CHOOSES_AVX2 0
using CompiledArchs = xsimd::arch_list<BaselineArch>;
#endif

// call(Arch()) with the best of them that this processor has.
template<class Call>
auto onThisProcessor(const Call& call)
{
	return xsimd::dispatch<CompiledArchs>(call)();
}

} // namespace curvature_lines
