// The choice between the two methods.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "denoising.h"

#include <cmath>

namespace curvature_lines {

namespace {

DenoisingResult denoiseAsPublished(
	const PointCloud&             cloud,
	const NormalCorrection&       correction,
	const EnergyDenoisingOptions& options,
	const Progress&               progress)
{
	const CorrectedNormals corrected = correction(progress.sub(0.0, 0.5, "Estimating curvature"));
	EnergyDenoisingResult  moved     = denoiseByEnergy(
        {cloud.positions, corrected.normals},
        corrected.search,
        corrected.minimum,
        options,
        progress.sub(0.5, 1.0, "Denoising"));
	DenoisingResult result;
	result.positions     = std::move(moved.positions);
	result.normals       = corrected.normals;
	result.iterations    = moved.iterations;
	result.initialEnergy = moved.initialEnergy;
	result.finalEnergy   = moved.finalEnergy;
	return result;
}

DenoisingResult denoiseByProjection(
	const PointCloud& cloud, const RobustDenoisingOptions& options, const Progress& progress)
{
	RobustDenoisingResult moved = denoiseRobustly(cloud, options, progress);
	DenoisingResult       result;
	result.positions      = std::move(moved.positions);
	result.normals        = std::move(moved.normals);
	result.pointDeviation = moved.pointDeviation;
	result.radius         = moved.radius;
	return result;
}

} // namespace

DenoisingResult denoise(
	const PointCloud&       cloud,
	const NormalCorrection& correction,
	const DenoisingOptions& options,
	const Progress&         progress)
{
	DenoisingResult result = options.method == DenoisingOptions::Method::Paper
	                             ? denoiseAsPublished(cloud, correction, options.paper, progress)
	                             : denoiseByProjection(cloud, options.robust, progress);
	if (cloud.size() > 0) {
		const Eigen::VectorXd moves = (result.positions - cloud.positions).colwise().norm();
		result.rmsMove              = std::sqrt(moves.squaredNorm() / double(cloud.size()));
		result.maxMove              = moves.maxCoeff();
	}
	progress.report(1.0);
	return result;
}

} // namespace curvature_lines
