// Sums over all points of the kernels of a winding-number field, by a treecode (Barnes and Hut 1986; kernels as in
// Lin et al. 2024, "Fast and globally consistent normal orientation based on the winding number normal consistency").
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

// Single precision, which the sides of normals do not need more than. Kernels are zero at distances up to `width`.
// Each sum is made by one thread in a fixed order: results do not depend on the number of threads.
class DipoleSums {
public:
	using Vectors = Eigen::Matrix3Xf;

	// 3 x N; a lasting copy is kept. Lengths should be of the order of 1.
	explicit DipoleSums(const Eigen::Matrix3Xd& positions);

	// N: A m (x) = sum (y - x) . m / d^3, the winding number of the dipoles m (3 x N) times 4 pi.
	Eigen::VectorXf winding(const Vectors& dipoles, float width, const Progress& progress) const;
	// 3 x N: A' s (x) = sum (x - y) s / d^3, the transpose of the above.
	Vectors adjoint(const Eigen::VectorXf& strengths, float width, const Progress& progress) const;
	// 3 x N: G m (x) = sum m / d^3 - 3 d (d . m) / d^5, the gradient of the winding number.
	Vectors gradient(const Vectors& dipoles, float width, const Progress& progress) const;

private:
	struct Node {
		Index           begin = 0, end = 0, left = -1, right = -1;
		Eigen::Vector3f center;
		float           radius = 0.0f;
	};
	struct Sources;

	Index build(const Eigen::Matrix3Xd& positions, Index begin, Index end);
	void interactions(std::size_t leaf, Index node);
	template<class Kernel>
	Vectors sum(const Vectors& values, const Progress& progress, const Kernel& kernel) const;

	std::vector<Index>              m_order; // place in the tree -> point
	std::vector<Node>               m_nodes; // children come after their parents
	std::vector<Index>              m_leaves;
	std::vector<std::vector<Index>> m_far,
		m_near;       // per leaf: nodes taken as one dipole, leaves taken by points
	Vectors m_points; // in the order of the tree
};

} // namespace curvature_lines
