// Solids of revolution with tips and rods, sampled without noise: every point is on the surface.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
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

// A sphere that ends in a cone or a rod of this radius, 1 high, with all that is known of its points.
struct ThinSolid {
	bool   cone   = false;
	double radius = 0.1;

	Profile profile() const
	{
		return cone ? sphereWithCone(radius, 1.0) : sphereWithRod(radius, 1.0);
	}

	samples::SampleCloud sampled(int n, std::uint64_t seed) const
	{
		using Eigen::Vector3d;
		samples::SampleCloud sample;
		sample.positions = sample.footPoints = sampledRevolution(profile(), n, seed);
		sample.normals = sample.d1 = sample.d2 = sample.positions;
		sample.k1.setOnes(n);
		sample.k2.setOnes(n);
		sample.label.setZero(n);
		const double base = std::sqrt(1.0 - radius * radius); // where cone and rod begin
		for (int i = 0; i < n; ++i) {
			const Vector3d p   = sample.positions.col(i);
			const double   out = std::hypot(p.x(), p.y()) + 1e-12;
			const Vector3d around(-p.y() / out, p.x() / out, 0.0);
			Vector3d       normal = p;
			if (p.norm() > 1.0 + 1e-9 && cone) {
				normal       = Vector3d(p.x() / out, p.y() / out, radius);
				sample.k1[i] = 1.0 / (out * std::hypot(1.0, radius));
				sample.k2[i] = 0.0;
			}
			else if (p.norm() > 1.0 + 1e-9) {
				const double up = std::max(0.0, p.z() - base - 1.0);
				normal          = Vector3d(p.x(), p.y(), up);
				sample.k1[i]    = 1.0 / radius;
				sample.k2[i]    = up > 0.0 ? 1.0 / radius : 0.0;
			}
			sample.normals.col(i) = normal.normalized();
			sample.d1.col(i)      = around;
			sample.d2.col(i)      = sample.normals.col(i).cross(around);
		}
		return sample;
	}
};

} // namespace curvature_lines::test
