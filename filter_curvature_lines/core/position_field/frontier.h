// Where a planar sample ends, as a smooth curve: local maximum likelihood for an intensity that drops to zero
// behind the curve. Beyond the papers. Of exact samples it is close to the frontier estimate of Hall, Park and
// Stern 1998, "On polynomial estimators of frontiers and boundaries"; of noisy ones, its blurred form.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include <Eigen/Core>

namespace curvature_lines {

struct Frontier {
	double value = 0.0, slope = 0.0; // of the curve x(s) at s = 0
	double deviation = 0.0;          // standard error of `value`
};

// Points (s, x), 2 x N, fill x <= x(s) with `density` points per area, their x off by `noise` (standard
// deviation); lengths in any unit. Those with s in [begin, end] count, 0 among them: of the windows there
// around 0 the widest in which a parabola agrees with those of narrower ones within their errors (Lepski's
// rule), so that it is long where the frontier is plain and short where it winds, and no longer than its
// error needs: at the end of a window that is twice the one in its middle. A few strays beyond the frontier
// do no harm. Nothing where too few points lie.
std::optional<Frontier>
fitFrontier(const Eigen::Matrix2Xd& points, double begin, double end, double density, double noise);

} // namespace curvature_lines
