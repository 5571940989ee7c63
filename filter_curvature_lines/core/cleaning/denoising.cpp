// Both methods, and how far they move the points.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "denoising.h"

#include <cmath>
#include <sstream>
#include <utility>

#include <Eigen/Core>

#include "cloud_index.h"
#include "energy_denoising.h"
#include "point_cloud.h"
#include "progress.h"
#include "robust_denoising.h"

namespace curvature_lines {

namespace {

constexpr double largestNoise = 0.5; // diagonals

void measureMoves(const PointCloud& cloud, DenoisingResult& result)
{
	result.moves = (result.positions - cloud.positions).colwise().norm();
	if (cloud.size() == 0)
		return;
	result.rmsMove = std::sqrt(result.moves.squaredNorm() / double(cloud.size()));
	result.maxMove = result.moves.maxCoeff();
}

} // namespace

RobustDenoisingOptions
inUnitFrame(const RobustDenoisingOptions& options, const PreparedCloud& prepared)
{
	RobustDenoisingOptions unit = options;
	unit.noise /= prepared.diagonal;
	if (unit.noise > largestNoise) {
		std::ostringstream message;
		message << "parameter 'noise' is more than half the cloud's diagonal (" << prepared.diagonal
				<< ").";
		throw InputError(message.str());
	}
	return unit;
}

DenoisingResult denoiseByProjection(
	const CloudIndex& index, const RobustDenoisingOptions& options, const Progress& progress)
{
	RobustDenoisingResult moved = denoiseRobustly(index, options, progress);
	DenoisingResult       result;
	result.positions      = std::move(moved.positions);
	result.normals        = std::move(moved.normals);
	result.pointDeviation = moved.pointDeviation;
	result.radius         = moved.radius;
	result.doubledShare   = moved.doubledShare;
	measureMoves(index.cloud(), result);
	progress.report(1.0);
	return result;
}

DenoisingResult denoiseAsPublished(
	const CloudIndex&             index,
	const Eigen::Matrix3Xd&       correctedNormals,
	const EnergyDenoisingOptions& options,
	const Progress&               progress)
{
	EnergyDenoisingResult moved = denoiseByEnergy(
		{index.cloud().positions, correctedNormals},
		index.search(),
		index.minimum(),
		options,
		progress);
	DenoisingResult result;
	result.positions     = std::move(moved.positions);
	result.normals       = correctedNormals;
	result.iterations    = moved.iterations;
	result.initialEnergy = moved.initialEnergy;
	result.finalEnergy   = moved.finalEnergy;
	measureMoves(index.cloud(), result);
	progress.report(1.0);
	return result;
}

} // namespace curvature_lines
