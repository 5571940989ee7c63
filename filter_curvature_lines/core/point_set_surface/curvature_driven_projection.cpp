// The eight steps of T06 section 5.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature_driven_projection.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "control_neighborhood.h"
#include "local_polynomial.h"
#include "m_weighted_curvature.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "point_set_surface.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;
using Diffusion = CurvatureDrivenOptions::Diffusion;

// How far points are looked at. exp(-x^2 / h^2) is below a fiftieth beyond two bandwidths; M weights are largest at
// h sqrt(xi), 1.4 bandwidths for xi = 2.
constexpr double gaussianReach  = 2.0;
constexpr double curvatureReach = 1.6;
// Spacings: diffusion ends when a step moves less (T06: a number of steps).
constexpr double settled = 1e-3;

} // namespace

CurvatureDrivenSurface::CurvatureDrivenSurface(
	const ControlPoints& control, const CurvatureDrivenOptions& options) :
		PointSetSurface(
			control,
			std::max(
				gaussianReach * options.bandwidth, curvatureReach * options.curvatureBandwidth),
			gaussianReach * options.bandwidth),
		m_options(options)
{
}

double CurvatureDrivenSurface::heightAlong(
	const Vector3d&            normal,
	const ControlNeighborhood& around,
	const Vector3d&            point,
	const NormalSums&          sums) const
{
	if (m_options.diffusion == Diffusion::Hermite)
		return 0.5 * (sums.offset.dot(normal) + sums.plane) / sums.weight;
	const double h      = m_options.bandwidth * around.spacing();
	const double lambda = m_options.bend / around.spacing();
	double       sum    = 0.0;
	for (int k = 0; k < around.size(); ++k) {
		const Vector3d q      = around.position(k) - point;
		const double   height = q.dot(normal), square = q.squaredNorm();
		const double   bend  = square > 0.0 ? 2.0 * std::abs(height) / square : 0.0; // T06 eq. 6
		double         share = bend < lambda ? 1.0 : 0.0;
		if (m_options.diffusion == Diffusion::Rational && bend >= lambda)
			share = lambda * lambda / (lambda * lambda + 10.0 * (bend - lambda) * (bend - lambda));
		sum += std::exp(-square / (h * h)) * share * height;
	}
	return sum / sums.weight;
}

// Steps 3 and 4: onto the surface along the normal at `from`.
std::optional<CurvatureDrivenSurface::Base>
CurvatureDrivenSurface::diffuse(const ControlNeighborhood& around, const Vector3d& from) const
{
	const double h    = m_options.bandwidth * around.spacing();
	Base         base = {from, Vector3d::Zero()};
	NormalSums   sums = around.normalSums(from, h);
	if (!(sums.weight > 0.0) || !(sums.normal.norm() > 0.0))
		return std::nullopt;
	const Vector3d along  = sums.normal.normalized();
	double         before = 0.0, move = 0.0;
	for (Index step = 0; step < m_options.diffusionSteps; ++step) {
		const double height = heightAlong(along, around, base.point, sums);
		// A secant step once two heights are known: the weights move with the point. Shares jump, and do not
		// allow it.
		const double slope  = before - height;
		const bool   secant = step > 0 && m_options.diffusion == Diffusion::Hermite &&
		                    slope * move > 0.5 * move * move;
		move   = secant ? height * move / slope : height;
		before = height;
		base.point += move * along;
		sums = around.normalSums(base.point, h);
		if (!(sums.weight > 0.0))
			return std::nullopt;
		if (std::abs(move) < settled * around.spacing())
			break;
	}
	if (!(sums.normal.norm() > 0.0))
		return std::nullopt;
	base.normal = sums.normal.normalized();
	return base;
}

// Steps 5 and 6: principal curvatures and directions there. M weights only here.
std::optional<LocalQuadric>
CurvatureDrivenSurface::quadricAt(const ControlNeighborhood& around, const Base& base) const
{
	thread_local LocalSamples<1> samples;
	const TangentFrame           frame(base.normal);
	const double                 h = m_options.curvatureBandwidth * around.spacing();
	around.heights(base.point, frame, h, samples);
	for (int s = 0; s < samples.size(); ++s) {
		const double square = samples.x[s] * samples.x[s] + samples.y[s] * samples.y[s] +
		                      samples.value[0][s] * samples.value[0][s];
		double w = samples.weight[s]; // T06 eq. 10: x^(2 xi) exp(-x^2 / h^2)
		for (Index power = 0; power < m_options.curvatureExponent; ++power)
			w *= square;
		samples.weight[s] = w * w;
	}
	const EulerFit fit = fitEuler(samples);
	if (!fit.valid)
		return std::nullopt;
	LocalQuadric quadric;
	quadric.origin = base.point;
	quadric.u      = frame.toSpace(fit.d1);
	quadric.n      = base.normal;
	quadric.v      = quadric.n.cross(quadric.u);
	// T06's curvatures are positive where the surface bends towards the normal, ours where it is convex.
	quadric.c[3] = -0.5 * fit.k1 / h;
	quadric.c[5] = -0.5 * fit.k2 / h;
	return quadric;
}

std::optional<LocalQuadric>
CurvatureDrivenSurface::near(const ControlNeighborhood& around, const Vector3d& place) const
{
	// 1, 2: the quasi-tangent plane (o, l) and the foot q of the place on it.
	const NormalSums sums = around.normalSums(place, m_options.bandwidth * around.spacing());
	if (!(sums.weight > 0.0) || !(sums.normal.norm() > 0.0))
		return std::nullopt;
	const Vector3d l    = sums.normal.normalized();
	const auto     base = diffuse(around, place + sums.offset.dot(l) / sums.weight * l);
	if (!base)
		return std::nullopt;
	return quadricAt(around, *base);
}

std::optional<LocalQuadric>
CurvatureDrivenSurface::roughlyAt(const ControlNeighborhood& around, const Vector3d& place) const
{
	return quadricAt(around, {place, around.side()});
}

bool CurvatureDrivenSurface::follow(
	const ControlNeighborhood& around, const Vector3d& place, LocalQuadric& quadric) const
{
	const NormalSums sums = around.normalSums(place, m_options.bandwidth * around.spacing());
	if (!(sums.weight > 0.0) || !(sums.normal.norm() > 0.0))
		return false;
	quadric.n      = sums.normal.normalized();
	quadric.origin = place + heightAlong(quadric.n, around, place, sums) * quadric.n;
	quadric.u      = (quadric.u - quadric.u.dot(quadric.n) * quadric.n).normalized();
	quadric.v      = quadric.n.cross(quadric.u);
	return true;
}

} // namespace curvature_lines
