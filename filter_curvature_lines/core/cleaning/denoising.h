// Denoising: the projection onto overlapping quadrics of a size found from the data, or the published
// energy of corrected normals (A09 section 4.2).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "cloud_index.h"
#include "energy_denoising.h"
#include "point_cloud.h"
#include "progress.h"
#include "robust_denoising.h"

namespace curvature_lines {

struct DenoisingOptions {
	enum class Method { Robust, Paper };
	Method                 method = Method::Robust;
	RobustDenoisingOptions robust;
	EnergyDenoisingOptions paper;
};

// These options with a noise in model units, for the cloud in its unit frame. Throws InputError where the noise is more
// than half the cloud's diagonal: more than the shape itself.
RobustDenoisingOptions
inUnitFrame(const RobustDenoisingOptions& options, const PreparedCloud& prepared);

struct DenoisingResult {
	Eigen::Matrix3Xd positions, normals;           // 3 x N
	Eigen::VectorXd  moves;                        // N, lengths
	double           rmsMove = 0.0, maxMove = 0.0; // of these
	// Robust: what was used.
	double pointDeviation = 0.0; // RobustDenoisingResult::pointDeviation, a length
	double radius         = 0.0; // in local spacings
	double doubledShare   = 0.0; // RobustDenoisingResult::doubledShare
	// Paper
	Index  iterations    = 0;
	double initialEnergy = 0.0, finalEnergy = 0.0;
};

// Looks at positions, and at the cloud's normals for the side of the surface they are on.
DenoisingResult denoiseByProjection(
	const CloudIndex&             index,
	const RobustDenoisingOptions& options  = {},
	const Progress&               progress = {});

// The published energy. Its normals are those of the robust curvature estimate of the same points.
DenoisingResult denoiseAsPublished(
	const CloudIndex&             index,
	const Eigen::Matrix3Xd&       correctedNormals, // 3 x N unit
	const EnergyDenoisingOptions& options  = {},
	const Progress&               progress = {});

} // namespace curvature_lines
