// Point positions from corrected normals by global energy minimisation (A09 section 4.2; R07 section 4.2).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

struct EnergyDenoisingOptions {
	enum class Energy { SquareRoot, Squared };     // A09's sqrt of the norm, or its square
	enum class Optimizer { LBFGSB, PolakRibiere }; // A09, R07
	enum class Neighbors { SixSectors, Nearest };  // the two readings of A09's "K = 6 nearest"
	Energy    energy     = Energy::SquareRoot;
	Optimizer optimizer  = Optimizer::LBFGSB;
	Neighbors neighbors  = Neighbors::SixSectors;
	Index     iterations = 100;
	// smooths the square root at 0: (e^2 + delta^2)^(1/4), e = |n - s nhat|
	double delta   = 0.1;
	double maxMove = 2.0; // trust box per coordinate, in median spacings
};

struct EnergyDenoisingResult {
	Eigen::Matrix3Xd positions; // 3 x N
	Index            iterations    = 0;
	double           initialEnergy = 0.0, finalEnergy = 0.0;
};

// Normals are held constant: pass the corrected ones in cloud.normals.
EnergyDenoisingResult denoiseByEnergy(
	const PointCloud&             cloud,
	const NeighborSearch&         search,
	const MinimumNeighborhoods&   minimum,
	const EnergyDenoisingOptions& options  = {},
	const Progress&               progress = {});

// The energy and its analytic gradient, exposed so that tests can difference it. Degenerate
// triangles (sine of the angle at p below 0.05 at the start) take no part; orientation signs s are
// those of `start`.
class DenoisingEnergy {
public:
	DenoisingEnergy(
		const PointCloud&             start,
		const NeighborLists&          neighbors,
		const EnergyDenoisingOptions& options);

	// x: 3N stacked positions; gradient: resized to 3N. Returns E. Same result for any number of
	// threads. Not const: the work space is kept between calls.
	double operator()(const Eigen::VectorXd& x, Eigen::VectorXd& gradient);

private:
	double evaluateFan(Index i, const Eigen::VectorXd& x);

	EnergyDenoisingOptions m_options;
	Eigen::Matrix3Xd       m_normals;
	// the neighbours q of each point p; every two make a triangle
	NeighborLists            m_fans;
	std::vector<std::size_t> m_firstSign; // fan -> where its triangles begin in m_signs
	std::vector<signed char> m_signs;     // s of each triangle, 0 if it is degenerate
	Eigen::VectorXd          m_minCross;  // fan -> floor of |(q - p) x (r - p)|
	// point -> its places in m_fans.indices, for a race-free gradient
	NeighborLists    m_uses;
	Eigen::Matrix3Xd m_pulls; // gradient of a fan by each of its neighbours
	Eigen::VectorXd  m_fanEnergies;
};

} // namespace curvature_lines
