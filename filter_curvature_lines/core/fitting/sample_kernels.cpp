// The loops of sample_kernels.h for the instruction set of the whole program, and the choice between the two.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "sample_kernels.h"

#include <cmath>

#include "sample_kernels_simd.h"
#include "simd_dispatch.h"

namespace curvature_lines {

#if CURVATURE_LINES_CHOOSES_AVX2
namespace simd {
CURVATURE_LINES_SAMPLE_KERNELS(extern, xsimd::avx2)
}
#endif

template<int Degree, int Values>
Moments<Degree, Values> momentsOf(const SampleColumns<Values>& samples)
{
	return onThisProcessor(
		[&](auto arch) { return simd::momentsOf<decltype(arch), Degree, Values>(samples); });
}

template<int Degree, int Values>
double
distancesFrom(const double* coefficients, const SampleColumns<Values>& samples, double* result)
{
	const double largest = onThisProcessor([&](auto arch) {
		return simd::distancesFrom<decltype(arch), Degree, Values>(coefficients, samples, result);
	});
	for (int s = 0; s < samples.size; ++s)
		result[s] = std::sqrt(result[s]);
	return std::sqrt(largest);
}

PlaneMoments planeMomentsOf(const OrientedColumns& ball, const double* side)
{
	return onThisProcessor(
		[&](auto arch) { return simd::planeMomentsOf<decltype(arch)>(ball, side); });
}

int toHeights(
	const OrientedColumns&  ball,
	const FrameColumns&     frame,
	const double*           robust,
	const SampleColumns<1>& samples)
{
	return onThisProcessor(
		[&](auto arch) { return simd::toHeights<decltype(arch)>(ball, frame, robust, samples); });
}

int toNormals(
	const OrientedColumns& ball, const FrameColumns& frame, const SampleColumns<3>& samples)
{
	return onThisProcessor(
		[&](auto arch) { return simd::toNormals<decltype(arch)>(ball, frame, samples); });
}

PatchSums patchSumsOf(
	const double*           quadric,
	const double*           leverage,
	double                  radiusX,
	double                  radiusY,
	const SampleColumns<1>& samples)
{
	return onThisProcessor([&](auto arch) {
		return simd::patchSumsOf<decltype(arch)>(quadric, leverage, radiusX, radiusY, samples);
	});
}

void squaredDistances(
	const double* const position[3], const double* center, int size, double* result)
{
	onThisProcessor(
		[&](auto arch) { simd::squaredDistances<decltype(arch)>(position, center, size, result); });
}

void gaussianWeights(
	const double* squaredDistance,
	const double* factor,
	double        reference,
	double        sharpness,
	int           size,
	double*       result)
{
	onThisProcessor([&](auto arch) {
		simd::gaussianWeights<decltype(arch)>(
			squaredDistance, factor, reference, sharpness, size, result);
	});
}

template Moments<1, 1> momentsOf(const SampleColumns<1>&);
template Moments<2, 1> momentsOf(const SampleColumns<1>&);
template Moments<4, 1> momentsOf(const SampleColumns<1>&);
template Moments<1, 3> momentsOf(const SampleColumns<3>&);
template Moments<2, 3> momentsOf(const SampleColumns<3>&);
template Moments<3, 3> momentsOf(const SampleColumns<3>&);
template Moments<2, 10> momentsOf(const SampleColumns<10>&);
template double distancesFrom<2, 1>(const double*, const SampleColumns<1>&, double*);
template double distancesFrom<4, 1>(const double*, const SampleColumns<1>&, double*);
template double distancesFrom<1, 3>(const double*, const SampleColumns<3>&, double*);
template double distancesFrom<2, 3>(const double*, const SampleColumns<3>&, double*);
template double distancesFrom<3, 3>(const double*, const SampleColumns<3>&, double*);

} // namespace curvature_lines
