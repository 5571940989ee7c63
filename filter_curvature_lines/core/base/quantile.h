// Order statistics of lengths, residuals and counts.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace curvature_lines {

// The value below which `share` (0..1) of the values lie; they are reordered and must not be none.
inline double quantileInPlace(std::vector<double>& values, double share)
{
	const auto at = std::min(static_cast<std::size_t>(share * values.size()), values.size() - 1);
	std::nth_element(values.begin(), values.begin() + at, values.end());
	return values[at];
}

inline double quantile(std::vector<double> values, double share)
{
	return quantileInPlace(values, share);
}

inline double medianInPlace(std::vector<double>& values)
{
	return quantileInPlace(values, 0.5);
}

} // namespace curvature_lines
