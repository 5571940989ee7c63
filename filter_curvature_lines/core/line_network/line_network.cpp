// Lengths, segments and points of polylines.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "line_network.h"

#include <algorithm>

#include <Eigen/Core>

#include "point_cloud.h"

namespace curvature_lines {

Eigen::VectorXd arcLengths(const LineNetwork& lines)
{
	Eigen::VectorXd arc(lines.vertices.cols());
	for (Index l = 0; l < lines.lines(); ++l)
		for (Index v = lines.offsets[l]; v < lines.offsets[l + 1]; ++v)
			arc[v] = v == lines.offsets[l]
			             ? 0.0
			             : arc[v - 1] + (lines.vertices.col(v) - lines.vertices.col(v - 1)).norm();
	return arc;
}

Index segmentCount(const LineNetwork& lines, Index line)
{
	const Index vertices = lines.offsets[line + 1] - lines.offsets[line];
	return isClosed(lines, line) ? vertices : std::max<Index>(vertices - 1, 0);
}

bool isClosed(const LineNetwork& lines, Index line)
{
	return lines.closed[line] && lines.offsets[line + 1] - lines.offsets[line] > 2;
}

Eigen::Vector3d pointOnLine(const LineNetwork& lines, Index line, double parameter)
{
	const Index k     = std::min(static_cast<Index>(parameter), segmentCount(lines, line) - 1);
	const Index first = lines.offsets[line], from = first + k;
	const Index to          = from + 1 == lines.offsets[line + 1] ? first : from + 1;
	const Eigen::Vector3d p = lines.vertices.col(from);
	return p + (parameter - k) * (lines.vertices.col(to) - p);
}

} // namespace curvature_lines
