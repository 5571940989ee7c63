// Numbers and points of the host and of core. A layer may be in single precision, and no host survives a NaN in its
// histogram.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <common/ml_document/cmesh.h>

#include <Eigen/Core>

namespace curvature_lines {

inline Eigen::Vector3d toEigen(const Point3m& p)
{
	return {double(p[0]), double(p[1]), double(p[2])};
}

// 0 for what is not finite, the largest number for what is too large.
inline Scalarm toScalar(double value)
{
	constexpr double largest = std::numeric_limits<Scalarm>::max();
	return std::isfinite(value) ? Scalarm(std::clamp(value, -largest, largest)) : Scalarm(0);
}

inline Point3m toPoint(const Eigen::Vector3d& v)
{
	return {toScalar(v.x()), toScalar(v.y()), toScalar(v.z())};
}

} // namespace curvature_lines
