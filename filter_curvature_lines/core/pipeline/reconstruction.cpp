// Two recipes, stage by stage: each stage takes the value of the one before.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruction.h"

#include <algorithm>
#include <utility>

#include "cloud_index.h"
#include "curvature_estimate.h"
#include "denoising.h"
#include "mesh_finishing.h"
#include "mesh_quality.h"
#include "progress.h"
#include "quad_mesh.h"
#include "stages.h"
#include "umbilics.h"

namespace curvature_lines {

namespace {

constexpr double leastSample = 20000.0; // points that thinning leaves, at least

NoisyPoints inliersOf(
	const CloudIndex&            given,
	const ReconstructionOptions& options,
	StageClock&                  clock,
	const Progress&              progress)
{
	if (!options.rejectOutliers)
		return allPoints(given);
	NoisyPoints inliers =
		withoutOutliers(given, options.outliers, progress.sub(0.0, 1.0, "Rejecting outliers"));
	clock.book("outliers");
	return inliers;
}

// Those of the cleaned cloud are what is left of the values of both recipes.
ReconstructionResult resultOf(NoisyPoints noisy, CleanSurface surface)
{
	ReconstructionResult result;
	result.outlier           = std::move(noisy.outlier);
	result.unstructuredShare = noisy.unstructuredShare;
	result.kept              = std::move(noisy.kept);
	result.cloud             = surface.index.cloud();
	result.field             = std::move(surface.field);
	result.noise             = surface.noise;
	result.moves             = std::move(surface.moves);
	result.rmsMove           = surface.rmsMove;
	result.doubledShare      = surface.doubledShare;
	return result;
}

// What the mesh does not show of the cloud, and its folds.
void judgeMesh(ReconstructionResult& result, StageClock& clock, const Progress& progress)
{
	result.coverage    = coverageOf(result.mesh.mesh, result.cloud.positions, progress);
	result.foldedFaces = foldedFaces(result.mesh.mesh);
	clock.book("coverage");
	result.seconds = clock.seconds();
}

} // namespace

ReconstructionResult
adaptiveRecipe(CloudIndex given, const ReconstructionOptions& options, const Progress& progress)
{
	StageClock            clock;
	const CleaningOptions cleaning{options.denoise, options.curvature, options.denoising};

	NoisyPoints noisy   = inliersOf(given, options, clock, progress.sub(0.0, 0.2, ""));
	given               = {}; // not needed any more
	const double useful = options.pointsPerVertex * options.tracing.targetVertices;
	if (useful > 0.0 && noisy.index.size() > std::max(useful, leastSample)) {
		noisy = thinned(
			std::move(noisy),
			std::max(useful, leastSample),
			progress.sub(0.2, 0.2, "Thinning the cloud"));
		clock.book("sampling");
	}
	const bool published = options.curvature.scaleMode == ScaleMode::Paper ||
	                       options.denoising.method == DenoisingOptions::Method::Paper;
	CleanSurface surface =
		published ? denoiseThenEstimate(noisy, cleaning, clock, progress.sub(0.2, 0.65, ""))
				  : estimateThenDenoise(noisy, cleaning, clock, progress.sub(0.2, 0.65, ""));
	noisy.index             = {}; // not needed any more
	UmbilicRegions umbilics = findUmbilics(
		surface.index.cloud(), surface.field, surface.index.minimum(), options.umbilics);
	clock.book("umbilics");
	FieldMesh mesh = meshOfPositionField(
		surface,
		{options.creases,
	     options.tracing,
	     options.anisotropy,
	     options.mesh,
	     options.keepLines,
	     options.holeSize},
		clock,
		progress.sub(0.65, 0.98, ""));

	ReconstructionResult result = resultOf(std::move(noisy), std::move(surface));
	result.umbilics             = std::move(umbilics);
	result.creases              = std::move(mesh.creases);
	result.mesh                 = std::move(mesh.mesh);
	result.lines                = std::move(result.mesh.lines);
	result.boundedTarget        = mesh.bounded ? mostTargetVertices(result.cloud.size()) : 0;
	judgeMesh(result, clock, progress.sub(0.98, 1.0, "Comparing the mesh with the cloud"));
	return result;
}

ReconstructionResult
publishedRecipe(CloudIndex given, const ReconstructionOptions& options, const Progress& progress)
{
	StageClock            clock;
	const CleaningOptions cleaning{options.denoise, options.curvature, options.denoising};
	LineOptions           following{
        options.smoothDirections, options.directions, options.umbilics, options.tracing};
	following.umbilics.smoothed = options.smoothDirections;

	NoisyPoints noisy    = inliersOf(given, options, clock, progress.sub(0.0, 0.2, ""));
	given                = {}; // not needed any more
	CleanSurface surface = denoiseThenEstimate(noisy, cleaning, clock, progress.sub(0.2, 0.65, ""));
	noisy.index          = {}; // not needed any more
	TracedLines traced   = followDirections(
        surface.index, std::move(surface.field), following, clock, progress.sub(0.65, 0.93, ""));
	QuadMeshResult mesh = buildQuadMesh(
		surface.index.cloud(),
		traced.cells,
		traced.lines,
		options.mesh,
		progress.sub(0.93, 0.98, "Building the mesh"));
	clock.book("mesh");

	surface.field                           = std::move(traced.field);
	ReconstructionResult result             = resultOf(std::move(noisy), std::move(surface));
	result.umbilics                         = std::move(traced.umbilics);
	result.lines                            = std::move(traced.lines);
	const Index most                        = mostTargetVertices(result.cloud.size());
	result.boundedTarget                    = options.tracing.targetVertices > most ? most : 0;
	static_cast<FinishedMesh&>(result.mesh) = std::move(mesh);
	judgeMesh(result, clock, progress.sub(0.98, 1.0, "Comparing the mesh with the cloud"));
	return result;
}

ReconstructionResult
reconstruct(CloudIndex given, const ReconstructionOptions& options, const Progress& progress)
{
	return options.method == ReconstructionOptions::Method::PositionField
	           ? adaptiveRecipe(std::move(given), options, progress)
	           : publishedRecipe(std::move(given), options, progress);
}

} // namespace curvature_lines
