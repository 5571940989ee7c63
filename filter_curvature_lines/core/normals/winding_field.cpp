// Steepest descent on the winding number with a kernel that narrows, and the choice of its width.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "winding_field.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "dipole_sums.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

namespace {

// Measured on the twenty PU-Net shapes, from which also the share below comes: fewer iterations leave whole parts
// inside out, more change nothing, and a geometric sequence of widths beats a linear one.
constexpr int                   iterations = 32;
constexpr double                widest     = 8.0; // spacings; the narrowest is 1
constexpr std::array<double, 4> keptWidths = {1.0, 1.4, 2.0, 2.8};
// A field is too narrow for the noise when more than this share of near pairs face each other with their fronts.
// Chosen on the same shapes.
constexpr double allowedNoisyPairs = 0.008;
constexpr Index  pairNeighbors     = 8;
constexpr double opposed           = -0.3; // cosine

double widthAt(int iteration)
{
	return widest * std::pow(1.0 / widest, double(iteration) / double(iterations - 1));
}

int iterationNearest(double width)
{
	int best = 0;
	for (int t = 1; t < iterations; ++t)
		if (std::abs(widthAt(t) - width) <= std::abs(widthAt(best) - width))
			best = t;
	return best;
}

// Backs that face each other are the two sides of a thin wall, fronts that face each other are noise.
double noisyPairShare(
	const Eigen::Matrix3Xd&                positions,
	const std::vector<std::vector<Index>>& neighbors,
	const Eigen::Matrix3Xd&                field)
{
	std::size_t noisy = 0, pairs = 0;
	for (Index i = 0; i < static_cast<Index>(neighbors.size()); ++i)
		for (Index j : neighbors[i]) {
			++pairs;
			noisy += field.col(i).dot(field.col(j)) < opposed &&
			         (field.col(i) - field.col(j)).dot(positions.col(j) - positions.col(i)) > 0.0;
		}
	return pairs == 0 ? 0.0 : double(noisy) / double(pairs);
}

} // namespace

WindingField windingField(
	const Eigen::Matrix3Xd& positions,
	const NeighborSearch&   search,
	const DipoleSums&       sums,
	double                  spacing,
	const Progress&         progress)
{
	const auto                      n = static_cast<Index>(positions.cols());
	std::vector<std::vector<Index>> neighbors(n);
	parallelFor(n, {}, [&](Index i) {
		for (Index j : search.nearest(positions.col(i), pairNeighbors + 1))
			if (j != i)
				neighbors[i].push_back(j);
	});

	DipoleSums::Vectors                             dipoles = DipoleSums::Vectors::Zero(3, n);
	std::array<Eigen::Matrix3Xd, keptWidths.size()> kept;
	for (int t = 0; t < iterations; ++t) {
		const Progress step = progress.sub(
			double(t) / iterations, double(t + 1) / iterations, "Finding the sides of normals");
		const auto      width = static_cast<float>(widthAt(t) * spacing);
		Eigen::VectorXf lack  = Eigen::VectorXf::Constant(n, 0.5f);
		if (t > 0)
			lack -= sums.winding(dipoles, width, {});
		const DipoleSums::Vectors descent = sums.adjoint(lack, width, {});
		const double change = sums.winding(descent, width, {}).cast<double>().squaredNorm();
		if (change > 0.0)
			dipoles += static_cast<float>(descent.cast<double>().squaredNorm() / change) * descent;
		const DipoleSums::Vectors gradient = sums.gradient(dipoles, width, {});
		for (Index i = 0; i < n; ++i) {
			const float length = gradient.col(i).norm();
			if (length > 0.0f)
				dipoles.col(i) = gradient.col(i) * (dipoles.col(i).norm() / length);
		}
		step.report(1.0);
		for (std::size_t k = 0; k < kept.size(); ++k)
			if (iterationNearest(keptWidths[k]) == t) {
				kept[k] = Eigen::Matrix3Xd::Zero(3, n);
				for (Index i = 0; i < n; ++i) {
					const Eigen::Vector3d d = dipoles.col(i).cast<double>();
					if (d.allFinite() && d.norm() > 0.0)
						kept[k].col(i) = d / d.norm();
				}
			}
	}

	WindingField result;
	for (std::size_t k = 0; k < kept.size(); ++k) {
		result.width      = keptWidths[k];
		result.directions = kept[k];
		if (noisyPairShare(positions, neighbors, kept[k]) <= allowedNoisyPairs)
			break;
	}
	return result;
}

} // namespace curvature_lines
