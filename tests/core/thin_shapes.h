// Solids of revolution with tips and rods, sampled without noise: every point is on the surface.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "analytic_surfaces.h"

namespace curvature_lines::test {

using Profile = std::vector<Eigen::Vector2d>; // (distance from the z axis, z)

// The unit sphere from the bottom up to where it is `radius` wide.
inline Profile sphereUpTo(double radius)
{
	Profile      profile;
	const double end = std::asin(radius);
	for (int k = 0; k <= 150; ++k) {
		const double angle = EIGEN_PI + (end - EIGEN_PI) * k / 150.0;
		profile.emplace_back(std::sin(angle), std::cos(angle));
	}
	return profile;
}

inline Profile sphereWithCone(double radius, double height)
{
	Profile      profile = sphereUpTo(radius);
	const double base    = profile.back().y();
	profile.emplace_back(0.0, base + height);
	return profile;
}

inline Profile sphereWithRod(double radius, double length)
{
	Profile      profile = sphereUpTo(radius);
	const double top     = profile.back().y() + length;
	for (int k = 0; k <= 24; ++k) {
		const double angle = 0.5 * EIGEN_PI * k / 24.0;
		profile.emplace_back(radius * std::cos(angle), top + radius * std::sin(angle));
	}
	return profile;
}

// 3 x n, evenly over the area.
inline Eigen::Matrix3Xd sampledRevolution(const Profile& profile, int n, std::uint64_t seed)
{
	std::vector<double> area(1, 0.0); // up to each point of the profile
	for (std::size_t k = 1; k < profile.size(); ++k)
		area.push_back(
			area.back() +
			(profile[k] - profile[k - 1]).norm() * (profile[k].x() + profile[k - 1].x()));
	samples::Random  random(seed, 0);
	Eigen::Matrix3Xd points(3, n);
	for (int i = 0; i < n; ++i) {
		const double wanted = random.uniform(0.0, area.back());
		const auto   end    = std::clamp<std::size_t>(
            std::lower_bound(area.begin(), area.end(), wanted) - area.begin(),
            1,
            profile.size() - 1);
		const double a = profile[end - 1].x(), b = profile[end].x();
		// Along a piece the area grows with the square of the radius.
		double along = random.uniform(0.0, 1.0);
		if (std::abs(b - a) > 1e-12)
			along = (std::sqrt(a * a + along * (b * b - a * a)) - a) / (b - a);
		const Eigen::Vector2d at    = profile[end - 1] + along * (profile[end] - profile[end - 1]);
		const double          angle = random.uniform(0.0, 2.0 * EIGEN_PI);
		points.col(i) << at.x() * std::cos(angle), at.x() * std::sin(angle), at.y();
	}
	return points;
}

} // namespace curvature_lines::test
