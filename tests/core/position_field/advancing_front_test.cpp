// The triangles of CGAL's advancing front, made independent of where they lie in memory.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "advancing_front.h"

#include <algorithm>
#include <cmath>
#include <list>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "point_cloud.h"
#include "triangle_mesh.h"

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
	request.surface                      = "l_block";
	request.points                       = 4000;
	request.noise                        = 0.01;
	const auto                   sample  = samples::generate(request);
	const Eigen::VectorXd        longest = Eigen::VectorXd::Constant(4000, 0.3);
	std::vector<Triangle>        first;
	std::list<std::vector<char>> held;
	for (int run = 0; run < 8; ++run) {
		const std::vector<Triangle> found =
			withSortedCorners(advancingFront(sample.positions, sample.normals, longest));
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

// Two sheets that face each other over a gap of half a spacing.
TEST(AdvancingFront, DoesNotJoinSheetsThatTouch)
{
	samples::SampleRequest request;
	request.surface               = "sphere";
	request.points                = 3000;
	const auto            sample  = samples::generate(request);
	const Eigen::Vector3d center  = sample.positions.rowwise().mean();
	const double          radius  = (sample.positions.colwise() - center).colwise().norm().mean();
	const double          spacing = std::sqrt(4.0 * EIGEN_PI / 3000.0) * radius;
	Eigen::Matrix3Xd      positions(3, 6000), normals(3, 6000);
	positions << sample.positions,
		sample.positions.colwise() + Eigen::Vector3d(2.0 * radius + 0.5 * spacing, 0.0, 0.0);
	normals << sample.normals, sample.normals;
	const Eigen::VectorXd longest = Eigen::VectorXd::Constant(6000, 4.0 * spacing);
	Index                 joining = 0;
	for (const Triangle& t : advancingFront(positions, normals, longest))
		joining += (t[0] < 3000) != (t[1] < 3000) || (t[0] < 3000) != (t[2] < 3000);
	EXPECT_EQ(joining, 0);
	// Without normals the front joins them: the test tests something.
	joining = 0;
	for (const Triangle& t : advancingFront(positions, Eigen::Matrix3Xd::Zero(3, 6000), longest))
		joining += (t[0] < 3000) != (t[1] < 3000) || (t[0] < 3000) != (t[2] < 3000);
	EXPECT_GT(joining, 0);
}

} // namespace
} // namespace curvature_lines
