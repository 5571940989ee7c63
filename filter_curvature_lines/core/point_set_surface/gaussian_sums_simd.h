// The loops of gaussian_sums.h in blocks, for any instruction set. Internal to gaussian_sums.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "block_size.h"
#include "gaussian_sums.h"
#include "sample_kernels.h"
#include "simd_block.h"

namespace curvature_lines::simd {

// Offsets of a block of points from a place, and their Gaussian weights.
template<class Arch>
struct Offsets {
	Block<Arch> x, y, z, weight;

	CURVATURE_LINES_INLINE
	Offsets(const ControlColumns& points, int s, const double* place, double sharpness) :
			x(Block<Arch>::at(points.rows + s) - place[0]),
			y(Block<Arch>::at(points.rows + points.padded + s) - place[1]),
			z(Block<Arch>::at(points.rows + 2 * points.padded + s) - place[2]),
			weight(expOfNegative(sharpness * (x * x + y * y + z * z)))
	{
	}
};

template<class Arch>
GaussianNormalSums
gaussianNormalSums(const ControlColumns& points, const double* place, double sharpness)
{
	using B = Block<Arch>;
	B weight, plane, offset[3], normal[3];
	for (int s = 0; s < points.padded; s += blockSize) {
		const Offsets<Arch> d(points, s, place, sharpness);
		const B             nx = B::at(points.rows + 3 * points.padded + s);
		const B             ny = B::at(points.rows + 4 * points.padded + s);
		const B             nz = B::at(points.rows + 5 * points.padded + s);
		const B             w  = d.weight;
		weight += w;
		offset[0] += w * d.x;
		offset[1] += w * d.y;
		offset[2] += w * d.z;
		normal[0] += w * nx;
		normal[1] += w * ny;
		normal[2] += w * nz;
		plane += w * (d.x * nx + d.y * ny + d.z * nz);
	}
	return {
		sumOf(weight),
		{sumOf(offset[0]), sumOf(offset[1]), sumOf(offset[2])},
		{sumOf(normal[0]), sumOf(normal[1]), sumOf(normal[2])},
		sumOf(plane)};
}

template<class Arch>
GaussianPlaneSums
gaussianPlaneSums(const ControlColumns& points, const double* place, double sharpness)
{
	using B = Block<Arch>;
	B weight, offset[3], xx, xy, xz, yy, yz, zz;
	for (int s = 0; s < points.padded; s += blockSize) {
		const Offsets<Arch> d(points, s, place, sharpness);
		const B             wx = d.weight * d.x, wy = d.weight * d.y, wz = d.weight * d.z;
		weight += d.weight;
		offset[0] += wx;
		offset[1] += wy;
		offset[2] += wz;
		xx += wx * d.x;
		xy += wx * d.y;
		xz += wx * d.z;
		yy += wy * d.y;
		yz += wy * d.z;
		zz += wz * d.z;
	}
	return {
		sumOf(weight),
		{sumOf(offset[0]), sumOf(offset[1]), sumOf(offset[2])},
		{sumOf(xx), sumOf(xy), sumOf(xz), sumOf(yy), sumOf(yz), sumOf(zz)}};
}

template<class Arch>
void toGaussianSamples(
	const ControlColumns&   points,
	const FrameColumns&     frame,
	double                  sharpness,
	const SampleColumns<1>& samples)
{
	const double *u = frame.u, *v = frame.v, *n = frame.n;
	for (int s = 0; s < points.padded; s += blockSize) {
		const Offsets<Arch> d(points, s, frame.origin, sharpness);
		(d.x * u[0] + d.y * u[1] + d.z * u[2]).storeTo(samples.x + s);
		(d.x * v[0] + d.y * v[1] + d.z * v[2]).storeTo(samples.y + s);
		(d.x * n[0] + d.y * n[1] + d.z * n[2]).storeTo(samples.value[0] + s);
		d.weight.storeTo(samples.weight + s);
	}
}

template<class Arch>
EulerMoments eulerMomentsOf(const SampleColumns<1>& samples)
{
	using B = Block<Arch>;
	const B zero;
	B       n1, nc, ns, ncc, ncs, q1, qc, qs, qcc, qcs, r1, rc, rs, squares, count;
	for (int s = 0; s < samples.size; s += blockSize) {
		const B x = B::at(samples.x + s), y = B::at(samples.y + s), z = B::at(samples.value[0] + s);
		const B xx = x * x, yy = y * y, square = xx + yy;
		const B w       = ifLess(zero, square, B::at(samples.weight + s), zero);
		const B inverse = 1.0 / ifLess(zero, square, square, square + 1.0);
		const B c = (xx - yy) * inverse, si = 2.0 * x * y * inverse;
		const B k  = -2.0 * z / ifLess(zero, square, square + z * z, square + 1.0);
		const B wc = w * c, wk = w * k, ww = w * w, wwc = ww * c;
		n1 += w;
		nc += wc;
		ns += w * si;
		ncc += wc * c;
		ncs += wc * si;
		q1 += ww;
		qc += wwc;
		qs += ww * si;
		qcc += wwc * c;
		qcs += wwc * si;
		r1 += wk;
		rc += wk * c;
		rs += wk * si;
		squares += wk * k;
		count += ifLess(zero, w, B(1.0), zero);
	}
	return {
		{sumOf(n1), sumOf(nc), sumOf(ns), sumOf(ncc), sumOf(ncs)},
		{sumOf(q1), sumOf(qc), sumOf(qs), sumOf(qcc), sumOf(qcs)},
		{sumOf(r1), sumOf(rc), sumOf(rs)},
		sumOf(squares),
		sumOf(count)};
}

// All of them for one instruction set: `extern` where they are called, nothing where they are compiled.
// NOLINTBEGIN(bugprone-macro-parentheses): the arguments are `extern` and a type.
// clang-format off
#define CURVATURE_LINES_GAUSSIAN_SUMS(EXTERN, ARCH) \
	EXTERN template GaussianNormalSums gaussianNormalSums<ARCH>(const ControlColumns&, const double*, double); \
	EXTERN template GaussianPlaneSums gaussianPlaneSums<ARCH>(const ControlColumns&, const double*, double); \
	EXTERN template void toGaussianSamples<ARCH>( \
		const ControlColumns&, const FrameColumns&, double, const SampleColumns<1>&); \
	EXTERN template EulerMoments eulerMomentsOf<ARCH>(const SampleColumns<1>&);
// clang-format on
// NOLINTEND(bugprone-macro-parentheses)

} // namespace curvature_lines::simd
