// The loops of gaussian_sums.h for the instruction set of the whole program, and the choice between the two.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "gaussian_sums.h"

#include "gaussian_sums_simd.h"
#include "sample_kernels.h"
#include "simd_dispatch.h"

namespace curvature_lines {

#if CURVATURE_LINES_CHOOSES_AVX2
namespace simd {
CURVATURE_LINES_GAUSSIAN_SUMS(extern, xsimd::avx2)
}
#endif

GaussianNormalSums
gaussianNormalSums(const ControlColumns& points, const double* place, double sharpness)
{
	return onThisProcessor([&](auto arch) {
		return simd::gaussianNormalSums<decltype(arch)>(points, place, sharpness);
	});
}

GaussianPlaneSums
gaussianPlaneSums(const ControlColumns& points, const double* place, double sharpness)
{
	return onThisProcessor([&](auto arch) {
		return simd::gaussianPlaneSums<decltype(arch)>(points, place, sharpness);
	});
}

void toGaussianSamples(
	const ControlColumns&   points,
	const FrameColumns&     frame,
	double                  sharpness,
	const SampleColumns<1>& samples)
{
	onThisProcessor([&](auto arch) {
		simd::toGaussianSamples<decltype(arch)>(points, frame, sharpness, samples);
	});
}

EulerMoments eulerMomentsOf(const SampleColumns<1>& samples)
{
	return onThisProcessor(
		[&](auto arch) { return simd::eulerMomentsOf<decltype(arch)>(samples); });
}

} // namespace curvature_lines
