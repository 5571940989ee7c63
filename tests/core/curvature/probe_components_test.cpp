// Connected parts of probes against clouds that are known to be apart.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "point_cloud.h"
#include "probe_components.h"

namespace curvature_lines {
namespace {

Eigen::Matrix3Xd twoSpheres(double apart)
{
	samples::Random  random(3, 0);
	Eigen::Matrix3Xd positions(3, 600);
	for (int k = 0; k < 600; ++k)
		positions.col(k) =
			random.normal3().normalized() + Eigen::Vector3d(k < 400 ? 0.0 : apart, 0, 0);
	return positions;
}

TEST(ProbeComponents, SpheresApartAreTwo)
{
	const Eigen::Matrix3Xd positions = twoSpheres(4.0);
	std::vector<Index>     probes;
	for (Index i = 0; i < 600; i += 2)
		probes.push_back(i);
	const auto components = connectedComponents(positions, probes);
	ASSERT_EQ(components.size(), 2u);
	std::set<Index> all;
	for (const ProbeComponent& component : components) {
		const bool first = component.probes()[0] < 400;
		EXPECT_EQ(component.size(), first ? 200 : 100);
		for (const Index p : component.probes()) {
			EXPECT_EQ(p < 400, first);
			all.insert(p);
		}
	}
	EXPECT_EQ(all, std::set<Index>(probes.begin(), probes.end()));
}

TEST(ProbeComponents, OneSurfaceIsOne)
{
	const Eigen::Matrix3Xd positions = twoSpheres(0.0);
	std::vector<Index>     probes(600);
	for (Index i = 0; i < 600; ++i)
		probes[i] = i;
	EXPECT_EQ(connectedComponents(positions, probes).size(), 1u);
}

TEST(ProbeComponents, NearestProbesAreThoseOfBruteForce)
{
	const Eigen::Matrix3Xd positions = twoSpheres(4.0);
	std::vector<Index>     probes;
	for (Index i = 0; i < 600; i += 7)
		probes.push_back(i);
	const ProbeComponent component(positions, probes);
	samples::Random      random(5, 0);
	for (int k = 0; k < 20; ++k) {
		const Eigen::Vector3d query  = 2.0 * random.normal3();
		std::vector<Index>    sorted = probes;
		std::sort(sorted.begin(), sorted.end(), [&](Index a, Index b) {
			return (positions.col(a) - query).norm() < (positions.col(b) - query).norm();
		});
		sorted.resize(9);
		EXPECT_EQ(component.nearest(query, 9), sorted);
	}
	EXPECT_EQ(component.nearest({0, 0, 0}, 10000).size(), probes.size());
}

} // namespace
} // namespace curvature_lines
