// Trials of scales whose bias and variance are known, because they are made up of both.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <numeric>
#include <vector>

#include <Eigen/Core>

#include "analytic_surfaces.h"
#include "point_cloud.h"
#include "scale_trials.h"

namespace curvature_lines::test {

// A scale of family 0. Each of the six components of each half is that of the truth plus `bias` plus a normally
// distributed error of its own.
struct MadeUpScale {
	double      radius    = 0.1;
	int         level     = 0;
	ShapeVector bias      = ShapeVector::Zero();
	double      deviation = 0.1;  // of a component
	double      residual  = 0.05; // radii

	// Of the mean of both halves, summed over the components.
	double variance() const { return 3.0 * deviation * deviation; }
	double risk() const { return variance() + bias.squaredNorm(); }
};

inline ScaleTrial trialOf(const MadeUpScale& scale, Index probes, samples::Random& random)
{
	ScaleTrial trial;
	trial.scale.height.radius = scale.radius;
	trial.scale.level         = scale.level;
	for (auto& half : trial.halves) {
		half.resize(probes);
		for (Index p = 0; p < probes; ++p) {
			const double truth = 1.0 + p % 7; // any: no scale sees it otherwise than by its bias
			ShapeVector  error;
			error << random.normal3(), random.normal3();
			half[p].shape    = ShapeVector::Constant(truth) + scale.bias + scale.deviation * error;
			half[p].residual = scale.residual;
			half[p].valid    = true;
		}
	}
	return trial;
}

inline std::vector<ScaleTrial> trialsOf(const std::vector<MadeUpScale>& scales, Index probes)
{
	samples::Random         random(9, 0);
	std::vector<ScaleTrial> trials;
	trials.reserve(scales.size());
	for (const MadeUpScale& scale : scales)
		trials.push_back(trialOf(scale, probes, random));
	return trials;
}

inline std::vector<Index> firstProbes(Index count)
{
	std::vector<Index> probes(count);
	std::iota(probes.begin(), probes.end(), 0);
	return probes;
}

} // namespace curvature_lines::test
