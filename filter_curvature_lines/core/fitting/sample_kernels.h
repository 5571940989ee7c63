// The loops over the points of a neighbourhood: sums for least squares, residuals, weights, and points turned into
// the frame of a tangent plane. Compiled for more than one instruction set; the program takes what the processor
// has, and the results are the same bits.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace curvature_lines {

// Arrays go into the kernels as pointers, and nothing here needs a type of another library: code of the standard
// library or of Eigen that is compiled for a newer processor could be what the linker keeps for the whole program.
// All arrays are readable and writable up to a whole number of blocks.

// Samples (x, y; value) with weights; see LocalSamples.
template<int Values>
struct SampleColumns {
	double *x, *y, *weight;
	double* value[Values];
	int     size;
};

// Sums over samples; the rest of the square tables stays unset.
template<int Degree, int Values>
struct Moments {
	double weighted[2 * Degree + 1][2 * Degree + 1]; // sum w x^a y^b, a + b <= 2 Degree
	double products[Degree + 1][Degree + 1][Values]; // sum w x^a y^b value, a + b <= Degree
	double squares;                                  // sum w |value|^2
};

// Samples beyond `size`, up to a whole number of blocks, must have weight 0. For (Degree, Values) = (1, 1), (2, 1),
// (4, 1), (1, 3), (2, 3), (3, 3), (2, 10).
template<int Degree, int Values>
Moments<Degree, Values> momentsOf(const SampleColumns<Values>& samples);

// result[s] = distance of sample s from the polynomials (one column of monomialCount(Degree) coefficients per
// value), 0 for a sample without weight. Returns the largest. For (2, 1), (4, 1), (1, 3), (2, 3), (3, 3).
template<int Degree, int Values>
double
distancesFrom(const double* coefficients, const SampleColumns<Values>& samples, double* result);

// Points of a ball with their normals, relative to its centre in radii; beyond `size` points outside.
struct OrientedColumns {
	const double* position[3];
	const double* normal[3];
	int           size;
};

// A tangent frame (u, v, n) at `origin`, in the coordinates of a ball.
struct FrameColumns {
	double origin[3], u[3], v[3], n[3];
};

// sum w (1, d, n, d d^T) over points d with normals n, w = ballKernel(|d|^2); d d^T by its lower triangle.
struct PlaneMoments {
	double weight, offset[3], normal[3], square[6];
};

// Of the points whose normals do not oppose `side`.
PlaneMoments planeMomentsOf(const OrientedColumns& ball, const double* side);

// Writes the points as samples: the height over the plane of the frame. The weight is ballKernel of the distance
// from the origin times robust[s], 0 where the normal opposes. Returns how many samples have a weight.
int toHeights(
	const OrientedColumns&  ball,
	const FrameColumns&     frame,
	const double*           robust,
	const SampleColumns<1>& samples);

// Likewise the normals, in coordinates of the frame at the centre of the ball, without robust weights.
int toNormals(
	const OrientedColumns& ball, const FrameColumns& frame, const SampleColumns<3>& samples);

// Over samples of a quadric (see SurfacePatch): sum W r^2 with r the distance from the surface to first order,
// sum W^2 leverage, sum W^2.
struct PatchSums {
	double squares, lost, squaredWeights;
};

// `quadric`: 6 coefficients, `leverage`: those of a quartic, both in x and y in semi-axes.
PatchSums patchSumsOf(
	const double*           quadric,
	const double*           leverage,
	double                  radiusX,
	double                  radiusY,
	const SampleColumns<1>& samples);

// result[k] = |p_k - center|^2, k < size.
void squaredDistances(
	const double* const position[3], const double* center, int size, double* result);

// result[k] = factor[k] exp(-(squaredDistance[k] - reference) sharpness), see expOfNegative(); k < size.
void gaussianWeights(
	const double* squaredDistance,
	const double* factor,
	double        reference,
	double        sharpness,
	int           size,
	double*       result);

} // namespace curvature_lines
