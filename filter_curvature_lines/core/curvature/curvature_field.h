// Principal curvatures and directions of every point of a cloud, with what the stages need to know about how far to
// trust them: the vocabulary of everything that follows an estimate.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"

namespace curvature_lines {

// Conventions, everywhere in this project: outward normals; convex is positive (unit sphere:
// k1 = k2 = +1); k1 >= k2 by signed value; d1, d2, n orthonormal and right-handed up to the sign of d1.

// Row i: the points p_j that take part in the final fit at p_i, with W_i[j] > 0 (A09 section 4.1):
// the sum of Geman-McClure weights of p_j's pairs, divided by twice the number of its pairs, in (0, 1].
struct StatisticalWeights {
	NeighborLists       neighbors; // sorted by index in each row; never contains i itself
	std::vector<double> values;    // parallel to neighbors.indices

	// W_i[j], 0 when absent.
	double operator()(Index i, Index j) const;
};

struct CurvatureField {
	Eigen::VectorXd          k1, k2;     // N, 1/length, k1 >= k2
	Eigen::Matrix3Xd         d1, d2;     // 3 x N, unit, tangent at cloud.normals
	Eigen::VectorXd          error;      // N, standard error of k1 - k2 (1/length)
	Eigen::VectorXd          radius;     // N, radius of the operating region (length)
	Eigen::VectorXd          confidence; // N, C_j = sum_i W_i[j] (A09 section 5.1)
	Eigen::VectorXd          feature;    // N, strength of the sharp edge or corner nearby, 0..1
	std::vector<PointStatus> status;
	StatisticalWeights       weights;
	// The affine model's normal at p_i: unit(sum_j W_j (n_j - X d_j)) (A09 end of section 3; R07).
	// Kept beside the input normals; the caller decides whether to adopt it. Replaces wrong input normals.
	Eigen::Matrix3Xd correctedNormals; // 3 x N unit
	// N, height of the surface fitted around p_i above it, along correctedNormals (length): far less noisy than
	// the point. Empty where none was fitted, or after the points moved.
	Eigen::VectorXd height;
	Index           iterations = 0; // largest number of IRLS iterations any point needed

	Index size() const { return static_cast<Index>(k1.size()); }
};

// Rows of statistical weights built in parallel, and the confidence they add up to,
// C_j = sum_i W_i[j] (A09 section 5.1), into a field whose confidence is 0.
void adoptWeights(
	const std::vector<std::vector<Index>>&  rows,
	const std::vector<std::vector<double>>& weights,
	CurvatureField&                         field);

// The scalars users ask for by name. Zero-safe: plane gives 0 everywhere.
// Koenderink: (2/pi) atan2(k1 + k2, k1 - k2), +1 convex cap, 0 saddle
double shapeIndex(double k1, double k2);
double curvedness(double k1, double k2); // sqrt((k1^2 + k2^2) / 2)

} // namespace curvature_lines
