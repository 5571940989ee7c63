// Weighted fits to the points of a ball, one function per kind of support.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "covering_patch.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "local_polynomial.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "robust_kernel.h"
#include "surface_patch.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;
using Support = BlendOptions::Support;

// By experiment (benchmarks/cleaning.py); "deviations" are BlendInput::pointDeviation.
constexpr double slabNoise = 3.0; // deviations that a ball reaches beyond the disk of a patch
// Cosine, 70 degrees: arcs stay well below a quarter of a turn.
constexpr double minArcCosine    = 0.35;
constexpr double maxNormalWidths = 2.0; // beyond which normals are of another face
// Deviations: heights beyond do not count in patches of one face.
constexpr double heightCutoff = 5.0;
// Radii of the steps of fitOneFace(), over that of the patch: from the points that surely lie on the centre's face on.
constexpr double growth[]        = {1.0 / 3.0, 0.6, 1.0, 1.0};
constexpr double maxPurityExcess = 40.0; // standard errors: purity is next to 0 already
// A point is no farther than this from its surface, in deviations and in spacings. Without the bound 90 points beside the
// edges of an exact cube went to a wrong face.
constexpr double farthestNoise   = 10.0;
constexpr double farthestSpacing = 0.05;

// Longer semi-axis of a patch over its radius, 1 where it is a disk.
double elongationAt(const BlendInput& input, const BlendOptions& options, double radius, Index i)
{
	return input.lines.any() ? std::max(1.0, options.gapsAcross * input.lines.gap[i] / radius)
	                         : 1.0;
}

struct Scratch {
	std::vector<Index>    near;
	std::vector<Vector3d> height, place, normal; // of the input; of the guide; both from the centre
	LocalSamples<1>       samples;

	static Scratch& ofThisThread()
	{
		thread_local Scratch scratch;
		return scratch;
	}
};

void gather(
	const BlendInput& input, const BlendGuide& guide, Index center, double reach, Scratch& scratch)
{
	const Vector3d origin = guide.positions.col(center);
	guide.search.within(origin, reach, scratch.near);
	scratch.height.clear();
	scratch.place.clear();
	scratch.normal.clear();
	for (const Index j : scratch.near) {
		scratch.height.push_back(input.cloud.positions.col(j) - origin);
		scratch.place.push_back(guide.positions.col(j) - origin);
		scratch.normal.push_back(guide.normals.col(j));
	}
	scratch.samples.reserve(scratch.near.size());
}

// Of an offset from the origin, in semi-axes of the support if that of a disk were `reach`.
double distanceInSupport(const SurfacePatch& patch, const Vector3d& d, double reach)
{
	if (patch.elongation == 1.0)
		return d.norm() / reach;
	const double along = d.dot(patch.lines), q = patch.elongation * patch.elongation;
	return std::sqrt(d.squaredNorm() + along * along * (q * q - 1.0)) / reach;
}

Vector3d principalNormal(const SurfacePatch& patch, const Scratch& scratch, double reach)
{
	Vector3d        mean = Vector3d::Zero(), orientation = Vector3d::Zero();
	Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
	double          sum     = 0.0;
	for (std::size_t k = 0; k < scratch.near.size(); ++k) {
		const Vector3d& p = scratch.height[k];
		const double    w = supportWeight(distanceInSupport(patch, scratch.place[k], reach), 0.0);
		sum += w;
		mean += w * p;
		moments += w * p * p.transpose();
		orientation += w * scratch.normal[k];
	}
	moments -= mean * mean.transpose() / sum;
	Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
	axes.computeDirect(moments);
	const Vector3d normal = axes.eigenvectors().col(0);
	return normal.dot(orientation) < 0.0 ? Vector3d(-normal) : normal;
}

// Arc over chord of a circular arc that turns by an angle t of this cosine: t / sin t by the continued fraction
// of arcsin(z) / (z sqrt(1 - z^2)), z = sin(t/2), to six digits down to minArcCosine (Abramowitz & Stegun 4.4.43).
double arcOverChord(double cosine)
{
	const double s = 0.5 * std::max(0.0, 1.0 - cosine); // z^2
	return (15015.0 - s * (17710.0 - s * (4648.0 - 80.0 * s))) /
	       (15015.0 - s * (27720.0 - s * (15120.0 - 2240.0 * s)));
}

void addSample(Scratch& scratch, double x, double y, double z, double w)
{
	if (w > 0.0)
		scratch.samples.add(x, y, w, Eigen::Matrix<double, 1, 1>(z));
}

bool fitFree(SurfacePatch& patch, double reach, Scratch& scratch)
{
	patch.setFrame(principalNormal(patch, scratch, reach));
	for (const bool last : {false, true}) {
		scratch.samples.reserve(scratch.near.size());
		for (std::size_t k = 0; k < scratch.near.size(); ++k) {
			const Eigen::Vector2d p = patch.toPlane(scratch.height[k]);
			if (scratch.normal[k].dot(patch.frame.n) > minOpposing)
				addSample(
					scratch,
					p.x(),
					p.y(),
					scratch.height[k].dot(patch.frame.n),
					supportWeight(p.x(), p.y()));
		}
		if (!(last ? fitPatch(patch, scratch.samples) : fitQuadric(patch, scratch.samples)))
			return false;
		if (!last)
			patch.tilt();
	}
	return true;
}

// Into the frame of the patch, which the steps of a gated fit keep.
void toFrame(const SurfacePatch& patch, Scratch& scratch)
{
	const auto inFrame = [&](const Vector3d& p, double scaleX, double scaleY) {
		const Eigen::Vector2d plane = patch.frame.toPlane(p);
		return Vector3d(scaleX * plane.x(), scaleY * plane.y(), p.dot(patch.frame.n));
	};
	const double perRadius = 1.0 / patch.radius;
	const double perX = perRadius * patch.elongation, perY = perRadius / patch.elongation;
	for (std::size_t k = 0; k < scratch.near.size(); ++k) {
		scratch.height[k] = inFrame(scratch.height[k], perX, perY);
		scratch.place[k]  = inFrame(scratch.place[k], perX, perY);
		scratch.normal[k] = inFrame(scratch.normal[k], 1.0, 1.0);
	}
}

// Grows from the centre: points count whose normals are near what the quadric of the step before predicts.
bool fitOneFace(SurfacePatch& patch, double noise, double width, Scratch& scratch)
{
	const double cutoff = heightCutoff * noise;
	toFrame(patch, scratch);
	for (int step = 0; step < 4; ++step) {
		const double shrink = growth[step];
		scratch.samples.reserve(scratch.near.size());
		for (std::size_t k = 0; k < scratch.near.size(); ++k) {
			const double x = scratch.place[k].x(), y = scratch.place[k].y();
			if (x * x + y * y >= shrink * shrink)
				continue;
			const Eigen::Vector2d slope = patch.gradient(x, y);
			const Vector3d        predicted(-slope.x(), -slope.y(), 1.0);
			const double          gate = normalWeight(
                (scratch.normal[k] - predicted / std::sqrt(1.0 + slope.squaredNorm()))
                    .squaredNorm() /
                (width * width));
			if (gate <= 0.0)
				continue;
			const Vector3d& p = scratch.height[k];
			if (shrink == 1.0 && std::abs(patch.residual({p.x(), p.y(), p.z()})) > cutoff)
				continue;
			addSample(scratch, p.x(), p.y(), p.z(), gate * supportWeight(x / shrink, y / shrink));
		}
		if (step == 3)
			return fitPatch(patch, scratch.samples);
		fitQuadric(patch, scratch.samples);
	}
	return false;
}

bool fitByArcLength(SurfacePatch& patch, const BlendOptions& options, Scratch& scratch)
{
	for (std::size_t k = 0; k < scratch.near.size(); ++k) {
		const ArcCoordinates s =
			arcCoordinates(patch, scratch.height[k], scratch.place[k], scratch.normal[k]);
		if (s.valid)
			addSample(
				scratch,
				s.x,
				s.y,
				options.support == Support::Correction ? options.heights[scratch.near[k]] : s.z,
				supportWeight(s.x, s.y));
	}
	return fitPatch(patch, scratch.samples);
}

// Patches bent over an edge leave residuals larger than the noise explains.
double purityOf(const SurfacePatch& patch, double noise, double rate)
{
	if (!(noise > 0.0) || rate <= 0.0)
		return 1.0;
	const double ratio  = patch.scale / noise;
	const double excess = (ratio * ratio - 1.0) / std::sqrt(2.0 / patch.effectiveCount) - 1.0;
	return std::exp(-rate * std::clamp(excess, 0.0, maxPurityExcess));
}

} // namespace

double farthestMove(const BlendInput& input, Index i)
{
	return farthestNoise * input.pointDeviation[i] + farthestSpacing * input.spacing[i];
}

// Guides of the other supports are free of noise, so that their points lie within the radius.
double ballRadius(const BlendInput& input, const BlendOptions& options, double radius, Index i)
{
	const double longest = radius * elongationAt(input, options, radius, i);
	return options.support == Support::Free
	           ? std::hypot(longest, slabNoise * input.pointDeviation[i])
	           : longest;
}

double normalWeight(double e2)
{
	return e2 < maxNormalWidths * maxNormalWidths ? relativeGemanMcClureWeight(e2) : 0.0;
}

ArcCoordinates arcCoordinates(
	const SurfacePatch& patch,
	const Vector3d&     height,
	const Vector3d&     place,
	const Vector3d&     normal)
{
	const double cosine = normal.dot(patch.frame.n);
	if (cosine < minArcCosine)
		return {};
	const double          stretch = arcOverChord(cosine) / patch.radius;
	const Eigen::Vector2d p       = patch.frame.toPlane(place);
	return {
		p.x() * stretch * patch.elongation,
		p.y() * stretch / patch.elongation,
		height.dot(patch.frame.n),
		true};
}

CoveringPatch coveringPatchAt(
	const BlendInput& input, const BlendGuide& guide, const BlendOptions& options, Index i)
{
	CoveringPatch patch;
	Scratch&      scratch = Scratch::ofThisThread();
	const double  radius  = options.radius[i];
	const double  reach   = ballRadius(input, options, radius, i);
	SurfacePatch& surface = patch.surface;
	surface               = SurfacePatch(guide.positions.col(i), guide.normals.col(i), radius);
	surface.elongation    = elongationAt(input, options, radius, i);
	if (surface.elongation > 1.0) {
		surface.lines = input.lines.direction.col(i);
		surface.setFrame(guide.normals.col(i));
	}
	gather(input, guide, i, reach, scratch);
	const bool fitted =
		options.support == Support::Free ? fitFree(surface, reach, scratch)
		: options.support == Support::OneFace
			? fitOneFace(surface, input.pointDeviation[i], options.normalWidth, scratch)
			: fitByArcLength(surface, options, scratch);
	surface.valid = fitted && surface.effectiveCount > SurfacePatch::Fit::count + 1;
	patch.purity  = purityOf(surface, input.pointDeviation[i], options.purity);
	return patch;
}

} // namespace curvature_lines
