// Denoising: the projection onto overlapping quadrics of a size found from the data, or the published
// energy of corrected normals (A09 section 4.2).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "energy_denoising.h"
#include "robust_denoising.h"

namespace curvature_lines {

struct DenoisingOptions {
	enum class Method { Robust, Paper };
	Method                 method = Method::Robust;
	RobustDenoisingOptions robust;
	EnergyDenoisingOptions paper;
};

struct DenoisingResult {
	Eigen::Matrix3Xd positions, normals;           // 3 x N
	double           rmsMove = 0.0, maxMove = 0.0; // lengths
	// Robust: what was used.
	double pointDeviation = 0.0; // RobustDenoisingResult::pointDeviation, a length
	double radius         = 0.0; // in local spacings
	// Paper
	Index  iterations    = 0;
	double initialEnergy = 0.0, finalEnergy = 0.0;
};

// What the energy is made of.
struct CorrectedNormals {
	const Eigen::Matrix3Xd&     normals; // of the robust curvature estimate
	const NeighborSearch&       search;
	const MinimumNeighborhoods& minimum;
};

// Estimates curvature. Only Method::Paper asks for it: the robust method looks at positions, and at the
// cloud's normals for the side of the surface they are on.
using NormalCorrection = std::function<CorrectedNormals(const Progress&)>;

DenoisingResult denoise(
	const PointCloud&       cloud,
	const NormalCorrection& correction,
	const DenoisingOptions& options  = {},
	const Progress&         progress = {});

} // namespace curvature_lines
