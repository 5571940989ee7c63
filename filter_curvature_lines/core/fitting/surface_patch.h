// One local quadric over a tangent plane: the voter of the outlier rejection and the predictor of the
// denoising (the osculating quadrics of A09 section 4, fitted to many points instead of few).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "local_polynomial.h"
#include "monomials.h"
#include "neighborhoods.h"

namespace curvature_lines {

// Fitted by fitPolynomial() and with the weights of robust_kernel.h, like the heights of LocalSurfaceFitter. The rest
// differs for a reason, so the two do not share it:
// - Samples are weighted by their distance along the tangent plane, there by their distance in space: the prediction
//   variance and the noise that a patch is asked for would be too small with weights that depend on the heights.
// - Residuals are distances from the surface, there heights over the plane: a voter's plane may be far from tangent.
// - A robust patch starts from a plane through a minority of the points and re-weights until it settles, because most
//   points may be outliers. A local surface knows its side by the gate normals and re-weights once per step, only when
//   a residual is suspicious.
// - The points of a local surface come with normals, those of a patch from a guide or without any.
//
// z = phi(x, y) . a with phi = (1, x, y, x^2, x y, y^2); x and y in semi-axes of the support, z a length. The support is
// a disk, or an ellipse whose short axis x is along scan lines.
struct SurfacePatch {
	using Fit = PolynomialFit<2, 1>;
	struct Local {
		double x = 0.0, y = 0.0, z = 0.0;
	};

	using Quadric  = Eigen::Matrix<double, Fit::count, 1>;
	using Leverage = Eigen::Matrix<double, monomialCount(4), 1>;

	Eigen::Vector3d origin = Eigen::Vector3d::Zero();
	TangentFrame    frame{Eigen::Vector3d::UnitZ()};
	double          radius = 0.0; // of an ellipse: geometric mean of the semi-axes
	double elongation      = 1.0; // longer semi-axis over the radius, radius over the shorter one
	Eigen::Vector3d lines =
		Eigen::Vector3d::Zero(); // direction of the scan lines, where there are any
	Quadric  coefficients         = Quadric::Zero();
	Leverage leverageCoefficients = Leverage::Zero(); // stays so in a robust fit
	double   scale                = 0.0;              // of the residuals, a length
	double   effectiveCount       = 0.0;              // (sum W)^2 / sum W^2
	bool     valid                = false;

	SurfacePatch() = default;
	SurfacePatch(const Eigen::Vector3d& origin, const Eigen::Vector3d& normal, double radius) :
			origin(origin), frame(normal), radius(radius)
	{
	}

	// Turned so that x is along the scan lines.
	void setFrame(const Eigen::Vector3d& normal);
	// Tangential coordinates, in semi-axes, of an offset from the origin.
	Eigen::Vector2d toPlane(const Eigen::Vector3d& d) const;
	Local toLocal(const Eigen::Vector3d& p) const;
	double height(double x, double y) const;
	Eigen::Vector2d gradient(double x, double y) const;
	Eigen::Vector3d normal(double x, double y) const;
	// Signed distance from the surface along its normal, to first order.
	double residual(const Local& p) const;
	// phi^T A^-1 phi with A = sum W phi phi^T: the variance of the prediction, over that of one sample.
	double leverage(double x, double y) const;
	double meanCurvature() const; // at the origin of a frame tilted to its normal; convex positive
	// Turns the frame to the fitted normal at the origin; the quadric has to be fitted again.
	void tilt();
};

// W(x, y): 0 outside of the unit disk, where a quadric is not asked. Of tangential distance only: weights of
// 3-D distance would correlate with the noise of the heights and hide it.
inline double supportWeight(double x, double y)
{
	const double outside = 1.0 - x * x - y * y;
	return outside > 0.0 ? outside * outside + 1e-4 : 0.0;
}

// residuals[s] of each sample (x, y; value z) of the patch; longer than the samples by a padding.
void patchResiduals(
	const SurfacePatch& patch, LocalSamples<1>& samples, std::vector<double>& residuals);

// Weighted least squares in the frame of the patch, with
// s^2 = sum W r^2 / (sum W - tr(A^-1 sum W^2 phi phi^T)). False, and invalid, when the samples do not
// determine a quadric.
bool fitPatch(SurfacePatch& patch, LocalSamples<1>& samples);

// The coefficients alone, for steps on the way. False, and left alone, when there are none.
bool fitQuadric(SurfacePatch& patch, LocalSamples<1>& samples);

// Scratch of a robust fit, one per thread; holds samples, their robust weights and residuals afterwards.
struct RobustPatchScratch {
	LocalSamples<1>     samples;
	std::vector<double> residuals, absolute;
};

// A quadric through the largest part of the points that lies on one, wherever the others are: a plane of
// least quantile of squares, then iteratively reweighted least squares (Geman-McClure). Points come nearest
// first and `seed` draws the planes tried. No support weight; the scale is 1.4826 median |r| of the points
// on the surface, at least minScale.
bool fitPatchRobustly(
	SurfacePatch&           patch,
	const Eigen::Matrix3Xd& points,
	double                  radius,
	double                  minScale,
	std::uint32_t           seed,
	RobustPatchScratch&     scratch);

} // namespace curvature_lines
