// Denoise Point Cloud by Robust Curvature: core/denoising on a layer.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "filter_table.h"
#include "help_text.h"

#include "core/denoising.h"

namespace curvature_lines {

namespace {

RichParameterList parameters(const MeshDocument&)
{
	const DenoisingOptions defaults;
	RichParameterList      list;
	list.addParam(RichEnum(
		"method",
		0,
		QStringList() << "Paper",
		"Method",
		"How the points are moved.<ul>"
		"<li><b>Paper</b>: all at once, so that the triangles of each point with its neighbours "
		"agree with the corrected normals (a global energy)</li></ul>"));
	list.addParam(RichInt(
		"iterations",
		defaults.iterations,
		"Iterations",
		"Largest number of iterations of the optimiser (1 to 10000)."));
	list.addParam(RichEnum(
		"energy",
		static_cast<int>(defaults.energy),
		QStringList() << "Square Root"
					  << "Squared",
		"Energy",
		"Power of the disagreement between triangle and normal.<ul>"
		"<li><b>Square Root</b>: as published in 2009, respects edges</li>"
		"<li><b>Squared</b>: smoother, removes more noise on smooth surfaces</li></ul>"));
	list.addParam(RichEnum(
		"optimizer",
		static_cast<int>(defaults.optimizer),
		QStringList() << "L-BFGS-B"
					  << "Polak-Ribiere",
		"Optimiser",
		"L-BFGS-B (2009), or Polak-Ribiere conjugate gradients (2007).",
		true));
	list.addParam(RichEnum(
		"neighbors",
		static_cast<int>(defaults.neighbors),
		QStringList() << "Six Sectors"
					  << "Nearest",
		"Neighbours",
		"The six neighbours of each point: the closest in each sixth of the tangent plane, or the "
		"six nearest.",
		true));
	return list;
}

struct Movement {
	double rms = 0.0, largest = 0.0; // model units
};

Movement movementOf(const PreparedCloud& prepared, const Eigen::Matrix3Xd& positions)
{
	const Eigen::VectorXd lengths = (positions - prepared.cloud.positions).colwise().norm();
	return {
		prepared.diagonal * std::sqrt(lengths.squaredNorm() / double(lengths.size())),
		prepared.diagonal * lengths.maxCoeff()};
}

FilterResults apply(const FilterContext& context)
{
	const Parameters& parameters = context.parameters;
	DenoisingOptions  options;
	parameters.choice("method");
	options.iterations = parameters.integer("iterations", 1, 10000);
	options.energy     = static_cast<DenoisingOptions::Energy>(parameters.choice("energy"));
	options.optimizer  = static_cast<DenoisingOptions::Optimizer>(parameters.choice("optimizer"));
	options.neighbors  = static_cast<DenoisingOptions::Neighbors>(parameters.choice("neighbors"));

	MeshModel&           layer  = currentLayer(context.document);
	const LayerPoints    points = readOrientedPoints(layer);
	Stopwatch            total, stage;
	FilterResults        results;
	const LayerCurvature curvature =
		context.cache.ofLayer(layer, points, context.progress.sub(0.0, 0.5, ""));
	const CurvatureEstimate& estimate = *curvature.estimate;
	results.seconds("curvature", stage.lap());

	const PointCloud corrected{estimate.prepared.cloud.positions, estimate.field.correctedNormals};
	const DenoisingResult denoised = denoise(
		corrected,
		estimate.search,
		estimate.minimum,
		options,
		context.progress.sub(0.5, 1.0, "Denoising"));
	results.seconds("denoising", stage.lap());

	const Movement moved = movementOf(estimate.prepared, denoised.positions);
	writePositions(layer, points, estimate.prepared, denoised.positions);
	writeNormals(layer, points, estimate.prepared, estimate.field.correctedNormals);

	results.count("points", points.size());
	results.count("invalid", estimate.prepared.nonFinite + estimate.prepared.zeroNormals);
	results.count("duplicates", estimate.prepared.duplicates);
	results.count("iterations", denoised.iterations);
	results.real("energy_initial", denoised.initialEnergy);
	results.real("energy_final", denoised.finalEnergy);
	results.real("moved_rms", moved.rms);
	results.real("moved_max", moved.largest);
	results.flag("curvature_reused", curvature.reused);
	results.seconds("total", total.seconds());
	return results;
}

} // namespace

FilterSpec denoiseFilter()
{
	return {
		"Denoise Point Cloud by Robust Curvature",
		"apply_coord_point_cloud_robust_denoising",
		"Removes noise from a point cloud. The normals are corrected by the robust curvature "
		"estimate, which does not average across sharp edges; then the points move until the "
		"surface they form agrees with the corrected normals." +
			helpInput +
			"<br><br><b>Writes</b> coordinates and normals. Curvature on the layer then belongs to "
			"the former points: compute it again. The points also slide along the surface by about "
			"the size of the noise: do not use this filter on clouds whose colours matter in "
			"detail. "
			"Outliers should be removed before (<i>Select Outliers by Robust Curvature</i>)." +
			helpChaining + helpReference,
		FilterPlugin::PointSet + FilterPlugin::Smoothing,
		FilterPlugin::SINGLE_MESH,
		MeshModel::MM_NONE,
		MeshModel::MM_VERTCOORD | MeshModel::MM_VERTNORMAL,
		parameters,
		apply};
}

} // namespace curvature_lines
