// Principal curvatures by Euler's theorem with M-shaped weights (T06: Tejada, Gois, Nonato, Castelo, Ertl,
// "Curvature-driven modeling and rendering of point-based surfaces", 2006, section 4).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "cloud_index.h"
#include "curvature_field.h"
#include "local_polynomial.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

struct MWeightedCurvatureOptions {
	enum class Weighting { M, Gaussian, Unweighted };
	Weighting weighting = Weighting::M;
	double    bandwidth = 2.5; // h, in local spacings
	Index     exponent  = 2;   // xi: the larger, the less the closest points count
	Index     neighbors = 60;  // looked at per point; those on another sheet do not count
};

// w(x) of T06 eq. 10: x^(2 xi) exp(-x^2 / h^2), largest at x = h sqrt(xi). Directional curvatures of close
// points are wild under noise, those of far ones do not belong: both count little. Gaussian: without the
// power. Each equation of the least squares is weighted by w^2.
double mWeight(double x, double h, Index exponent);
double gaussianWeight(double x, double h);

// The least squares of T06 eq. 11 at one place: directional curvatures k(phi) = v1 + v2 cos 2 phi + v3 sin 2 phi.
struct EulerFit {
	double          k1 = 0.0, k2 = 0.0; // convex positive: T06's with the opposite sign
	Eigen::Vector2d d1    = Eigen::Vector2d::UnitX(); // unit, in the tangent plane
	double          error = 0.0;                      // standard error of k1 - k2
	bool            valid = false; // the neighbours' directions determine a tensor
};
// Samples: heights of neighbours over the tangent plane at the place, which is the origin.
EulerFit fitEuler(LocalSamples<1>& samples);

// Normals are used as they are. weights and confidence are those of the least squares, each row summing up
// to 1; error is from the scatter of the directional curvatures; feature is 0.
CurvatureField mWeightedCurvature(
	const CloudIndex&                index,
	const MWeightedCurvatureOptions& options  = {},
	const Progress&                  progress = {});

} // namespace curvature_lines
