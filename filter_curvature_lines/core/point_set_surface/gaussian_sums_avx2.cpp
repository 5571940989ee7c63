// The loops of gaussian_sums.h for processors with AVX2, and nothing else: see fitting/sample_kernels_avx2.cpp.
// SPDX-License-Identifier: GPL-3.0-or-later
#ifdef CURVATURE_LINES_AVX2

#include "gaussian_sums_simd.h"

namespace curvature_lines::simd {

CURVATURE_LINES_GAUSSIAN_SUMS(, xsimd::avx2)

} // namespace curvature_lines::simd

#endif
