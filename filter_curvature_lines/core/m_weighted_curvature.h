// Principal curvatures by Euler's theorem with M-shaped weights (T06: Tejada, Gois, Nonato, Castelo, Ertl,
// "Curvature-driven modeling and rendering of point-based surfaces", 2006, section 4).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "robust_curvature.h"

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
// w^2 relative to its peak; 0 where w is below a thousandth of it (T06 section 6).
double squaredWeight(double x, double h, const MWeightedCurvatureOptions& options);

// The least squares of T06 eq. 11 at one place: directional curvatures k(phi) = v1 + v2 cos 2 phi + v3 sin 2 phi.
class EulerLeastSquares {
public:
	explicit EulerLeastSquares(const TangentFrame& frame) : m_frame(frame) {}

	// A neighbour at `offset` from the place.
	void add(const Eigen::Vector3d& offset, double weight);

	struct Fit {
		double          k1 = 0.0, k2 = 0.0; // convex positive: T06's with the opposite sign
		Eigen::Vector3d d1, d2;             // unit, tangent
		double          error = 0.0;        // standard error of k1 - k2
		bool            valid = false;      // the neighbours' directions determine a tensor
	};
	Fit solve() const;

private:
	TangentFrame    m_frame;
	Eigen::Matrix3d m_normal  = Eigen::Matrix3d::Zero();
	Eigen::Matrix3d m_spread  = Eigen::Matrix3d::Zero(); // of squared weights: for the error
	Eigen::Vector3d m_rhs     = Eigen::Vector3d::Zero();
	double          m_squares = 0.0;
	Index           m_count   = 0;
};

// Normals are used as they are. weights and confidence are those of the least squares, each row summing up
// to 1; error is from the scatter of the directional curvatures; feature is 0.
CurvatureField mWeightedCurvature(
	const PointCloud&                cloud,
	const NeighborSearch&            search,
	const MinimumNeighborhoods&      minimum,
	const MWeightedCurvatureOptions& options  = {},
	const Progress&                  progress = {});

} // namespace curvature_lines
