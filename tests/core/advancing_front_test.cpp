// The triangles of CGAL's advancing front, made independent of where they lie in memory.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/advancing_front.h"

#include <algorithm>
#include <list>

#include <gtest/gtest.h>

#include "sample_data/analytic_surfaces.h"

namespace curvature_lines {
namespace {

std::vector<Triangle> withSortedCorners(std::vector<Triangle> triangles)
{
	for (Triangle& t : triangles)
		std::sort(t.begin(), t.end());
	std::sort(triangles.begin(), triangles.end());
	return triangles;
}

// Noise of half a spacing makes the surface thick: tetrahedra several of whose faces have the same priority.
TEST(AdvancingFront, DoesNotDependOnAddresses)
{
	samples::SampleRequest request;
	request.surface = "l_block";
	request.points  = 4000;
	request.noise   = 0.01;
	const auto                   sample  = samples::generate(request);
	const Eigen::VectorXd        longest = Eigen::VectorXd::Constant(4000, 0.3);
	std::vector<Triangle>        first;
	std::list<std::vector<char>> held;
	for (int run = 0; run < 8; ++run) {
		const std::vector<Triangle> found = withSortedCorners(advancingFront(sample.positions, longest));
		ASSERT_GT(found.size(), 4000u);
		if (run == 0)
			first = found;
		EXPECT_EQ(found, first);
		// Holes in the heap, others in every run.
		std::list<std::vector<char>> freed;
		for (int k = 0; k < 20000; ++k)
			((k * 7919 + run) % 3 == 0 ? held : freed).emplace_back(64 + 16 * (k % 5));
	}
}

} // namespace
} // namespace curvature_lines
