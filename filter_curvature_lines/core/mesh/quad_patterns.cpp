// Sines of corners, and costs.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "quad_patterns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <vector>

#include <Eigen/Geometry>

#include "linked_faces.h"
#include "point_cloud.h"

namespace curvature_lines {

using Eigen::Vector3d;
using Loop = LinkedFaces::Loop;

namespace {

constexpr double angleCost     = 2.0; // times 1 - the least sine of a corner
constexpr double concavityCost = 6.0; // times a sine below 0, more

} // namespace

double leastSine(const std::array<Vector3d, 4>& corners, const Vector3d& normal)
{
	double least = 1.0;
	for (std::size_t k = 0; k < 4; ++k) {
		const Vector3d ahead = corners[(k + 1) % 4] - corners[k];
		const Vector3d back  = corners[(k + 3) % 4] - corners[k];
		const double   sine  = ahead.cross(back).dot(normal);
		least                = std::min(least, sine / (ahead.norm() * back.norm() + 1e-300));
	}
	return least;
}

double
leastSine(const QuadPattern& pattern, const std::vector<Vector3d>& points, const Vector3d& normal)
{
	double least = 1.0;
	for (int p = 0; p < pattern.count; ++p) {
		const auto& part = pattern.parts[p];
		least            = std::min(
            least,
            leastSine(
                {points[part[0]], points[part[1]], points[part[2]], points[part[3]]}, normal));
	}
	return least;
}

void addParts(const QuadPattern& pattern, const Loop& points, std::vector<Loop>& parts)
{
	for (int p = 0; p < pattern.count; ++p) {
		const auto& part = pattern.parts[p];
		parts.push_back({points[part[0]], points[part[1]], points[part[2]], points[part[3]]});
	}
}

double inSteps(double cost)
{
	constexpr double steps = 1 << 20;
	return std::round(cost * steps) / steps;
}

double cornerCost(double leastSine)
{
	return inSteps(angleCost * (1.0 - leastSine) + concavityCost * std::max(0.0, -leastSine));
}

double concaveCost(double leastSine)
{
	return inSteps(concavityCost * std::max(0.0, -leastSine));
}

double irregularityCost(const LinkedFaces& faces, Index vertex, Index change)
{
	const Index beyond = faces.valence(vertex) - (faces.isOnRim(vertex) ? 3 : 4);
	return valenceCost * (std::abs(beyond + change) - std::abs(beyond));
}

} // namespace curvature_lines
