// The predictions of the patches that cover a point, and their weighted mean.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "blended_surface.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "covering_patch.h"
#include "face_projection.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "robust_kernel.h"
#include "surface_patch.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;
using Support = BlendOptions::Support;

// By experiment (benchmarks/cleaning.py, sharp edges) but for the last two, which keep divisions finite.
// Weight by normals below which a patch is across an edge: 1.5 widths.
constexpr double acrossEdge = 0.1;
// Of a patch that predicts where the face beyond an edge is.
constexpr double maxAcrossLeverage = 0.2;
constexpr double radiusRatio = 1.25; // between the radii of overlapping patches: radii are smooth
constexpr double minLeverage = 1e-12;
// Of a point on the surface and its correction, over that on one of them: with the blend S, 2 S - S^2 has the diagonal
// (2 - k) S, k: integral of the squared kernel over its peak.
constexpr double influenceOfTwo = 1.4;
constexpr double minRemaining   = 0.02; // of a residual, without the influence of the point itself

// What a patch beyond an edge says about a point.
struct FaceVote {
	Vector3d normal, center; // center from the point
	double   height, weight;
};

// Kept by each thread.
struct Scratch {
	std::vector<Index>    near;
	std::vector<FaceVote> across;

	static Scratch& ofThisThread()
	{
		thread_local Scratch scratch;
		return scratch;
	}
};

// What one patch says about one point.
struct Prediction {
	Vector3d normal;             // of the surface there
	Vector3d direction;          // in which the point moves
	double   residual     = 0.0; // along it
	double   move         = 0.0; // against it
	double   weight       = 0.0; // inverse variance, less towards the rim of the support
	double   normalWeight = 0.0; // 0..1: whether the point is on the patch's side of an edge
	double   leverage     = 0.0; // variance of the prediction, over that of a point
	double   influence    = 0.0; // of the point on the prediction
};

// From where the point lies in the support, x^2 + y^2 < 1.
void weigh(Prediction& p, double x, double y, double leverage, double gate)
{
	const double inside = std::max(0.0, 1.0 - x * x - y * y);
	p.weight            = inside * inside / std::max(leverage, minLeverage);
	p.normalWeight      = gate;
	p.leverage          = leverage;
	p.influence         = leverage * supportWeight(x, y) * gate;
}

Prediction predict(
	const CoveringPatch& patch,
	const BlendOptions&  options,
	const Vector3d&      position,
	const Vector3d&      place,
	const Vector3d&      normal)
{
	const SurfacePatch&   surface = patch.surface;
	const Eigen::Vector2d at      = surface.toPlane(place - surface.origin);
	Prediction            p;
	if (at.squaredNorm() >= 1.0)
		return p;
	const SurfacePatch::Local local = surface.toLocal(position);
	p.direction = p.normal = surface.normal(local.x, local.y);
	const double width     = options.normalWidth;
	const double gate      = options.support == Support::OneFace
	                             ? normalWeight((normal - p.normal).squaredNorm() / (width * width))
	                             : double(p.normal.dot(normal) > minOpposing);
	p.move = p.residual = surface.residual(local);
	weigh(p, at.x(), at.y(), surface.leverage(local.x, local.y), gate);
	return p;
}

// The point stays at its arc length and moves along the guide's normal to the predicted height.
Prediction predictByArcLength(
	const CoveringPatch& patch,
	const Vector3d&      position,
	const Vector3d&      place,
	const Vector3d&      normal,
	double               noise)
{
	const SurfacePatch&  surface = patch.surface;
	const ArcCoordinates at =
		arcCoordinates(surface, position - surface.origin, place - surface.origin, normal);
	Prediction p;
	if (!at.valid || at.x * at.x + at.y * at.y >= 1.0)
		return p;
	const double cosine = normal.dot(surface.frame.n);
	// By arc length a height changes with the sine of the slope.
	const Eigen::Vector2d slope = surface.gradient(at.x, at.y);
	p.normal = surface.frame.n * std::sqrt(std::max(0.0, 1.0 - slope.squaredNorm())) -
	           surface.frame.toSpace(slope);
	p.direction = normal;
	p.residual  = (at.z - surface.height(at.x, at.y)) / cosine;
	// Isotropic noise along a surface of mean curvature H leaves the points sigma^2 H outside on average.
	p.move = p.residual + noise * noise * surface.meanCurvature();
	weigh(p, at.x, at.y, surface.leverage(at.x, at.y), 1.0);
	p.weight *= cosine * cosine; // of a residual's variance
	return p;
}

// The guide moves along its normal by what the patch predicts of the heights over it.
Prediction predictCorrection(
	const CoveringPatch& patch, const Vector3d& place, const Vector3d& normal, double height)
{
	const SurfacePatch&  surface = patch.surface;
	const Vector3d       offset  = place - surface.origin;
	const ArcCoordinates at      = arcCoordinates(surface, offset, offset, normal);
	Prediction           p;
	if (!at.valid || at.x * at.x + at.y * at.y >= 1.0)
		return p;
	p.direction = normal;
	p.normal    = (normal - surface.frame.toSpace(surface.gradient(at.x, at.y))).normalized();
	p.move      = -surface.height(at.x, at.y);
	p.residual  = height + p.move;
	weigh(p, at.x, at.y, surface.leverage(at.x, at.y), 1.0);
	return p;
}

// Weight by the residual. A patch too far away is one of another face. Without this bound it would decide alone where the
// patches of the point's own face all reach over an edge.
double acceptance(const BlendInput& input, const BlendOptions& options, double residual, Index i)
{
	if (options.acceptance <= 0.0 || !(input.pointDeviation[i] > 0.0))
		return 1.0;
	if (std::abs(residual) > farthestMove(input, i))
		return 0.0;
	const double e = residual / (options.acceptance * input.pointDeviation[i]);
	return relativeGemanMcClureWeight(e * e);
}

// Votes with similar normals are one face; the heaviest first.
void addFacesAcross(std::vector<FaceVote>& votes, double width, LocalFaces& faces)
{
	while (faces.count < LocalFaces::capacity && !votes.empty()) {
		const Vector3d seed = std::max_element(votes.begin(), votes.end(), [](auto& a, auto& b) {
								  return a.weight < b.weight;
							  })->normal;
		LocalFace      face;
		double         sum                   = 0.0;
		std::vector<FaceVote>::iterator rest = votes.begin();
		for (const FaceVote& vote : votes) {
			const double gate = normalWeight((vote.normal - seed).squaredNorm() / (width * width));
			if (gate >= acrossEdge) {
				const double w = vote.weight * gate;
				face.normal += w * vote.normal;
				face.center += w * vote.center;
				face.height += w * vote.height;
				sum += w;
			}
			else {
				*rest++ = vote;
			}
		}
		votes.erase(rest, votes.end());
		face.normal.normalize();
		face.center /= sum;
		face.height /= sum;
		faces.face[faces.count++] = face;
	}
}

// The patches that cover the targets.
class CoveringPatches {
public:
	CoveringPatches(
		const BlendInput&         input,
		const BlendGuide&         guide,
		const BlendOptions&       options,
		const std::vector<Index>& targets,
		const Progress&           progress);

	void describeResiduals(BlendedSurface& blend) const;
	void blendAt(Index i, BlendedSurface& blend) const;

private:
	void findCovering(Index i, std::vector<Index>& found) const;

	const BlendInput&          m_input;
	const BlendGuide&          m_guide;
	const BlendOptions&        m_options;
	std::vector<Index>         m_points; // of the centres
	Eigen::Matrix3Xd           m_centers;
	NeighborSearch             m_search; // of the centres
	std::vector<CoveringPatch> m_patches;
};

// Wide patches need fewer centres to overlap as much: the first points of the shuffled order, as many
// as each place takes.
std::vector<Index> centersOf(const BlendInput& input, const BlendOptions& options)
{
	std::vector<Index> centers;
	const double       n = double(input.cloud.size());
	for (Index i = 0; i < input.cloud.size(); ++i) {
		const double ratio  = options.radius[i] / input.spacing[i];
		const double points = EIGEN_PI * ratio * ratio; // of a patch
		if (input.order.rank[i] < std::max(1.0, n * std::min(1.0, options.overlap / points)))
			centers.push_back(i);
	}
	return centers;
}

CoveringPatches::CoveringPatches(
	const BlendInput&         input,
	const BlendGuide&         guide,
	const BlendOptions&       options,
	const std::vector<Index>& targets,
	const Progress&           progress) :
		m_input(input), m_guide(guide), m_options(options), m_points(centersOf(input, options)),
		m_centers(columnsOf(guide.positions, m_points)), m_search(m_centers),
		m_patches(m_centers.cols())
{
	std::vector<std::atomic<bool>> used(m_patches.size());
	const bool                     all = static_cast<Index>(targets.size()) == input.cloud.size();
	if (!all)
		parallelFor(static_cast<Index>(targets.size()), {}, [&](Index t) {
			std::vector<Index>& found = Scratch::ofThisThread().near;
			findCovering(targets[t], found);
			for (const Index j : found)
				used[j].store(true, std::memory_order_relaxed);
		});
	parallelFor(static_cast<Index>(m_patches.size()), progress, [&](Index c) {
		if (all || used[c])
			m_patches[c] = coveringPatchAt(input, guide, options, m_points[c]);
	});
}

void CoveringPatches::findCovering(Index i, std::vector<Index>& found) const
{
	const double radius = radiusRatio * m_options.radius[i];
	m_search.within(m_guide.positions.col(i), ballRadius(m_input, m_options, radius, i), found);
}

void CoveringPatches::describeResiduals(BlendedSurface& blend) const
{
	for (std::size_t c = 0; c < m_patches.size(); ++c) {
		const CoveringPatch& patch = m_patches[c];
		if (patch.surface.valid) {
			blend.center.push_back(m_points[c]);
			blend.variance.push_back(patch.surface.scale * patch.surface.scale);
			blend.effectiveCount.push_back(patch.surface.effectiveCount);
		}
	}
}

void CoveringPatches::blendAt(Index i, BlendedSurface& blend) const
{
	const Vector3d      position = m_input.cloud.positions.col(i);
	const Vector3d      place = m_guide.positions.col(i), normal = m_guide.normals.col(i);
	const double        noise = m_input.pointDeviation[i];
	std::vector<Index>& found = Scratch::ofThisThread().near;
	findCovering(i, found);
	double   total = 0.0, pure = 0.0, accepted = 0.0; // weights
	double   residual = 0.0, influence = 0.0;
	Vector3d move = Vector3d::Zero(), direction = Vector3d::Zero(), center = Vector3d::Zero();
	std::vector<FaceVote>& across = Scratch::ofThisThread().across;
	across.clear();
	for (const Index j : found) {
		const CoveringPatch& patch = m_patches[j];
		if (!patch.surface.valid)
			continue;
		const Prediction p = m_options.support == Support::ArcLength
		                         ? predictByArcLength(patch, position, place, normal, noise)
		                     : m_options.support == Support::Correction
		                         ? predictCorrection(patch, place, normal, m_options.heights[i])
		                         : predict(patch, m_options, position, place, normal);
		if (m_options.edges && p.normalWeight < acrossEdge && p.weight > 0.0 &&
		    p.leverage < maxAcrossLeverage)
			across.push_back(
				{p.normal, patch.surface.origin - position, p.residual, p.weight * patch.purity});
		const double w = p.weight * p.normalWeight * patch.purity;
		if (w <= 0.0)
			continue;
		const double a = w * acceptance(m_input, m_options, p.residual, i);
		total += p.weight * p.normalWeight;
		pure += w;
		residual += w * p.residual;
		influence += w * p.influence;
		accepted += a;
		move -= a * p.move * p.direction;
		direction += a * p.normal;
		if (m_options.edges)
			center += a * (patch.surface.origin - position);
	}
	if (!(accepted > 0.0))
		return;
	move /= accepted;
	if (!across.empty() && direction.norm() > 0.0) {
		const Vector3d n = direction.normalized();
		LocalFaces     faces;
		faces.face[faces.count++] = {n, center / accepted, -move.dot(n)};
		addFacesAcross(across, m_options.normalWidth, faces);
		if (faces.count > 1)
			move = moveOntoFaces(faces);
	}
	const bool correction  = m_options.support == Support::Correction;
	blend.positions.col(i) = (correction ? place : position) + move;
	if (direction.norm() > 0.0)
		blend.normals.col(i) = direction.normalized();
	if (correction)
		influence *= influenceOfTwo;
	blend.height[i]   = residual / pure;
	blend.residual[i] = residual / pure / std::max(1.0 - influence / pure, minRemaining);
	blend.purity[i]   = pure / total;
}

} // namespace

BlendedSurface blendPatches(
	const BlendInput&         input,
	const BlendGuide&         guide,
	const BlendOptions&       options,
	const std::vector<Index>& targets,
	const Progress&           progress)
{
	const Index           n = input.cloud.size();
	const CoveringPatches patches(
		input, guide, options, targets, progress.sub(0.0, 0.7, "Fitting patches"));

	BlendedSurface blend;
	blend.positions = guide.positions;
	blend.normals   = guide.normals;
	blend.residual.assign(n, std::numeric_limits<double>::infinity());
	blend.height.assign(n, 0.0);
	blend.purity.assign(n, 0.0);
	patches.describeResiduals(blend);
	parallelFor(
		static_cast<Index>(targets.size()),
		progress.sub(0.7, 1.0, "Blending patches"),
		[&](Index t) { patches.blendAt(targets[t], blend); });
	return blend;
}

} // namespace curvature_lines
