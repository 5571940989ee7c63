// Height fits at the probes, anchors for the families that need them, and what both say of the shape operator.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "scale_trials.h"

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "anchor_fits.h"
#include "local_surface.h"
#include "point_cloud.h"
#include "point_subsets.h"
#include "progress.h"
#include "quantile.h"
#include "scale_ladder.h"
#include "surface_anchors.h"

namespace curvature_lines {

namespace {

struct Family {
	int    degree;      // of the height polynomial
	double normalRatio; // normalRadius / height.radius
};
// By the experiments that adaptive_scale.cpp tells of. From little bias and much variance to the reverse.
constexpr std::array<Family, 3> families            = {{{4, 0.0}, {4, 1.7}, {2, 2.4}}};
constexpr double                largestNormalRadius = 0.36; // unit frame

std::vector<ProbeEstimate> estimateProbes(
	const SurfaceAnchors*              anchors,
	const std::vector<SurfaceElement>& starts,
	const Eigen::Matrix3Xd&            positions,
	const CurvatureScale&              scale)
{
	std::vector<ProbeEstimate> estimates(starts.size());
	parallelFor(static_cast<Index>(starts.size()), {}, [&](Index p) {
		SurfaceElement element = starts[p];
		if (element.valid && anchors)
			element = anchors->normalField(anchors->onFace(element, positions.col(p)));
		estimates[p] = {
			shapeVector(element.shape),
			starts[p].residual / scale.height.radius,
			starts[p].offset,
			anchors && anchors->nearEdge(positions.col(p)),
			element.valid && (anchors || scale.normalRadius == 0.0)};
	});
	return estimates;
}

} // namespace

ShapeVector shapeVector(const Eigen::Matrix3d& shape)
{
	const double twice = std::sqrt(2.0);
	ShapeVector  v;
	v << shape(0, 0), shape(1, 1), shape(2, 2), twice * shape(0, 1), twice * shape(0, 2),
		twice * shape(1, 2);
	return v;
}

ScaleTrials::ScaleTrials(const PointSample& sample, Index probes, double quadricResidual) :
		m_sample(sample), m_first(blockOf(sample.cloud, 0, sample.cloud.size() / 2)),
		m_second(blockOf(sample.cloud, sample.cloud.size() / 2, sample.cloud.size())),
		m_positions(sample.cloud.positions.leftCols(probes)), m_quadricResidual(quadricResidual)
{
}

void ScaleTrials::run(double radius, int level)
{
	std::vector<ScaleTrial> here;
	for (int f = 0; f < int(families.size()); ++f)
		if (f == 0 || families[f].normalRatio * radius < largestNormalRadius)
			here.push_back(
				{{{radius, families[f].degree}, families[f].normalRatio * radius, f, level}, {}});
	for (int h = 0; h < 2; ++h)
		runOnHalf(h, radius, here);
	m_trials.insert(m_trials.end(), here.begin(), here.end());
}

// All trials have the same height radius: they share the search and, by degree, the fits.
void ScaleTrials::runOnHalf(int h, double radius, std::vector<ScaleTrial>& trials) const
{
	const PointSample& half   = h == 0 ? m_first : m_second;
	const Index        probes = static_cast<Index>(m_positions.cols());
	const PointSubsets subsets(half, radius);
	Degrees            degrees, ofAnchors;
	for (const ScaleTrial& trial : trials)
		(trial.scale.height.degree == 2 ? degrees.quadric : degrees.quartic) = true;
	std::vector<HeightFits> fits(probes);
	parallelFor(probes, {}, [&](Index p) {
		fits[p] = surfacesAt(
			subsets,
			p,
			m_positions.col(p),
			m_sample.cloud.normals.col(p),
			radius,
			degrees,
			probeIterations);
	});
	for (ScaleTrial& trial : trials) {
		std::vector<double> residuals;
		residuals.reserve(fits.size());
		for (const HeightFits& fit : fits)
			residuals.push_back(fit.of(trial.scale.height.degree).residual / radius);
		trial.scale.usualResidual = quantile(residuals, smoothShare) * radius;
		// Scales within the noise are dropped for their residual; anchors are not needed to see that.
		if (trial.scale.normalRadius > 0.0 && quantile(residuals, 0.1) < largestResidual)
			(trial.scale.height.degree == 2 ? ofAnchors.quadric : ofAnchors.quartic) = true;
	}
	AnchorFits anchorFits;
	if (ofAnchors.quadric || ofAnchors.quartic)
		anchorFits = fitAnchors(half, subsets, radius, ofAnchors, AnchorDetail::Sketch);
	for (ScaleTrial& trial : trials) {
		const int                   degree = trial.scale.height.degree;
		std::vector<SurfaceElement> starts(probes);
		for (Index p = 0; p < probes; ++p) {
			starts[p] = fits[p].of(degree);
			if (isOutlier(starts[p], m_positions.col(p), radius))
				starts[p].valid = false;
		}
		std::unique_ptr<const SurfaceAnchors> anchors;
		if (trial.scale.normalRadius > 0.0 && (degree == 2 ? ofAnchors.quadric : ofAnchors.quartic))
			anchors = std::make_unique<const SurfaceAnchors>(
				anchorFits, subsets, trial.scale, m_quadricResidual, AnchorDetail::Sketch);
		trial.halves[h] = estimateProbes(anchors.get(), starts, m_positions, trial.scale);
	}
}

} // namespace curvature_lines
