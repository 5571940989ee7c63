// The candidate scales of a ladder, each tried at the probes on two random halves of the points, which are independent.
// Internal to adaptive_scale.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"
#include "point_subsets.h"
#include "surface_anchors.h"

namespace curvature_lines {

// The components of a symmetric tensor, so that products of vectors are those of tensors.
using ShapeVector = Eigen::Matrix<double, 6, 1>;

ShapeVector shapeVector(const Eigen::Matrix3d& shape);

struct ProbeEstimate {
	ShapeVector shape    = ShapeVector::Zero(); // 1/length
	double      residual = 0.0;                 // of the heights, in radii
	double      offset   = 0.0; // of the mean of the points, in radii: large at a rim
	bool        atEdge   = false;
	bool        valid    = false;
};

// One candidate scale on both halves, an estimate per probe.
struct ScaleTrial {
	CurvatureScale                            scale;
	std::array<std::vector<ProbeEstimate>, 2> halves;

	bool valid(Index probe) const { return halves[0][probe].valid && halves[1][probe].valid; }
	bool atEdge(Index probe) const { return halves[0][probe].atEdge || halves[1][probe].atEdge; }
	// Of the mean of the two estimates, from these alone: 1/length^2.
	double variance(Index probe) const
	{
		return 0.25 * (halves[0][probe].shape - halves[1][probe].shape).squaredNorm();
	}
};

class ScaleTrials {
public:
	// `sample`: shuffled, with gate normals, outlives the trials. Its first points are the probes. `quadricResidual`: of
	// scale_ladder.h, a length.
	ScaleTrials(const PointSample& sample, Index probes, double quadricResidual);

	// Tries all candidates whose heights have this radius, a length. They are of one family for each way to estimate the
	// shape operator, in the order of their numbers from little bias and much variance to the reverse.
	void run(double radius, int level);

	const std::vector<ScaleTrial>& all() const { return m_trials; }
	// 3 x probes
	const Eigen::Matrix3Xd& positions() const { return m_positions; }

private:
	void runOnHalf(int h, double radius, std::vector<ScaleTrial>& trials) const;

	const PointSample&      m_sample;
	const PointSample       m_first, m_second;
	Eigen::Matrix3Xd        m_positions;
	double                  m_quadricResidual;
	std::vector<ScaleTrial> m_trials;
};

} // namespace curvature_lines
