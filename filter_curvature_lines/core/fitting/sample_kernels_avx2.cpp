// The loops of sample_kernels.h for processors with AVX2. This file alone is compiled for them: see core/CMakeLists.txt.
// It must hold nothing else that the linker could take for the rest of the program, so it includes no other library.
// SPDX-License-Identifier: GPL-3.0-or-later
#ifdef CURVATURE_LINES_AVX2

#include "sample_kernels_simd.h"

namespace curvature_lines::simd {

CURVATURE_LINES_SAMPLE_KERNELS(, xsimd::avx2)

} // namespace curvature_lines::simd

#endif
