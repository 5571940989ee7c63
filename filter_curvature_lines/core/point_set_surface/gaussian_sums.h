// The loops over the control points around a place: Gaussian sums (T06 section 4) and the normal equations of
// Euler's theorem (T06 eqs. 5 to 11). Compiled for more than one instruction set, as fitting/sample_kernels.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sample_kernels.h"

namespace curvature_lines {

// Control points: six rows of `padded` numbers, the positions and the normals. The last block is filled up with
// points so far away that their weight is 0.
struct ControlColumns {
	const double* rows;
	int           padded;
};

// Sums over points at d from a place, with normals n and weight w = exp(-sharpness |d|^2), see expOfNegative().
struct GaussianNormalSums {
	double weight, offset[3], normal[3], plane; // sum w (1, d, n, d.n)
};
struct GaussianPlaneSums {
	double weight, offset[3], square[6]; // sum w (1, d, d d^T): xx, xy, xz, yy, yz, zz
};

GaussianNormalSums
gaussianNormalSums(const ControlColumns& points, const double* place, double sharpness);
GaussianPlaneSums
gaussianPlaneSums(const ControlColumns& points, const double* place, double sharpness);

// Writes the points as samples, in coordinates of the frame: its axes may have any length.
void toGaussianSamples(
	const ControlColumns&   points,
	const FrameColumns&     frame,
	double                  sharpness,
	const SampleColumns<1>& samples);

// Of rows (1, c, s), the cosine and sine of twice the angle, for samples in units of the bandwidth.
struct EulerMoments {
	double normal[5]; // sum w (1, c, s, c c, c s)
	double spread[5]; // sum w^2 (1, c, s, c c, c s)
	double rhs[3]; // sum w k (1, c, s); k: normal curvature towards the sample, T06 eq. 6, our sign
	double squares; // sum w k^2
	double count;   // of weights that are not 0
};

// Samples at the origin itself do not count.
EulerMoments eulerMomentsOf(const SampleColumns<1>& samples);

} // namespace curvature_lines
