// Each stage: call what does the work, book its time.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "stages.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "cloud_index.h"
#include "crease_curves.h"
#include "creases.h"
#include "curvature_estimate.h"
#include "curvature_field.h"
#include "denoising.h"
#include "direction_smoothing.h"
#include "even_sample.h"
#include "line_network.h"
#include "line_spacing.h"
#include "line_tracing.h"
#include "neighborhoods.h"
#include "outlier_rejection.h"
#include "outlier_result.h"
#include "point_cloud.h"
#include "position_field_mesh.h"
#include "progress.h"
#include "scaffold_sites.h"
#include "umbilics.h"
#include "voronoi_cells.h"

namespace curvature_lines {

namespace {

constexpr Index  fewestPoints   = 20;  // as prepareCloud()
constexpr double shortestCrease = 5.0; // of those that fade out, in edges of the mesh

CurvatureField estimate(
	const CloudIndex&       index,
	const CurvatureOptions& options,
	StageClock&             clock,
	const Progress&         progress)
{
	index.minimum(progress.sub(0.0, 0.1, "Finding neighborhoods"));
	clock.book("neighborhoods");
	CurvatureField field =
		estimateCurvature(index, options, progress.sub(0.1, 1.0, "Estimating curvature"));
	clock.book("curvature");
	return field;
}

// Of the surface a point stands for: six neighbours around make a hexagon of area sqrt(3) / 2 h^2.
double areaOf(const MinimumNeighborhoods& minimum, Index i)
{
	return 0.5 * std::sqrt(3.0) * minimum.spacing[i] * minimum.spacing[i];
}

double areaOf(const MinimumNeighborhoods& minimum)
{
	double sum = 0.0;
	for (Index i = 0; i < static_cast<Index>(minimum.spacing.size()); ++i)
		sum += areaOf(minimum, i);
	return sum;
}

// Crossings of lines that keep the published distances for epsilon.
double crossingsFor(
	const CloudIndex& index, const CurvatureField& field, const LineTracingOptions& tracing)
{
	const MinimumNeighborhoods& minimum = index.minimum();
	const LineSpacing spacing = chooseLineSpacing(index.cloud(), field, minimum, tracing, 0.0);
	double            sum     = 0.0;
	for (Index i = 0; i < index.size(); ++i)
		sum += areaOf(minimum, i) / (spacing.distance[0][i] * spacing.distance[1][i]);
	return sum;
}

double targetVertices(
	const CloudIndex& index, const CurvatureField& field, const LineTracingOptions& tracing)
{
	if (tracing.targetVertices > 0)
		return tracing.targetVertices;
	if (tracing.epsilon > 0.0)
		return std::max(8.0, crossingsFor(index, field, tracing));
	return automaticTargetVertices(index.size());
}

// Creases that a mesh with edges of this length follows. Short wrinkles of a scan would only disturb the faces
// around.
std::vector<FeatureLine> featuresOf(const Creases& creases, double edge)
{
	std::vector<FeatureLine> features;
	for (const CreaseCurve& curve : creases.curves) {
		const bool fades = curve.start < 0 || curve.end < 0;
		if (fades && !curve.closed && curve.length() < shortestCrease * edge)
			continue;
		features.push_back({curve.positions, curve.closed});
		if (curve.start >= 0)
			features.back().points.leftCols<1>() = creases.corners[curve.start].position;
		if (curve.end >= 0)
			features.back().points.rightCols<1>() = creases.corners[curve.end].position;
	}
	return features;
}

} // namespace

void StageClock::book(const char* stage)
{
	const auto now = Clock::now();
	m_seconds[stage] += std::chrono::duration<double>(now - m_last).count();
	m_last = now;
}

NoisyPoints allPoints(const CloudIndex& given)
{
	NoisyPoints points;
	points.index = given;
	points.outlier.assign(given.size(), 0);
	points.kept.resize(given.size());
	std::iota(points.kept.begin(), points.kept.end(), 0);
	return points;
}

NoisyPoints
withoutOutliers(const CloudIndex& given, const OutlierOptions& options, const Progress& progress)
{
	OutlierResult rejected = rejectOutliers(given, options, progress);
	NoisyPoints   points;
	points.outlier           = std::move(rejected.outlier);
	points.heightDeviation   = rejected.heightDeviation;
	points.unstructuredShare = rejected.unstructuredShare;
	for (Index i = 0; i < given.size(); ++i)
		if (!points.outlier[i])
			points.kept.push_back(i);
	const auto left = static_cast<Index>(points.kept.size());
	if (left < fewestPoints)
		throw InputError(
			"Only " + std::to_string(left) +
			" points are left after outlier rejection; switch it off or reject less.");
	points.index = left == given.size() ? given : given.part(points.kept);
	return points;
}

NoisyPoints thinned(NoisyPoints points, double most, const Progress& progress)
{
	if (points.index.size() <= most)
		return points;
	const std::vector<Index> sample = evenSample(points.index, static_cast<Index>(most), progress);
	std::vector<Index>       kept;
	kept.reserve(sample.size());
	for (const Index k : sample)
		kept.push_back(points.kept[k]);
	points.kept  = std::move(kept);
	points.index = points.index.part(sample);
	return points;
}

CleanSurface adoptEstimate(const CloudIndex& index, CurvatureField field)
{
	CleanSurface surface;
	surface.index = index.withNormals(field.correctedNormals);
	surface.moves = Eigen::VectorXd::Zero(index.size());
	surface.field = std::move(field);
	makeTangent(surface.index.cloud().normals, surface.field);
	return surface;
}

CleanSurface estimateThenDenoise(
	const NoisyPoints&     noisy,
	const CleaningOptions& options,
	StageClock&            clock,
	const Progress&        progress)
{
	CurvatureField ofNoisyPoints =
		estimate(noisy.index, options.curvature, clock, progress.sub(0.0, 0.4, ""));
	if (!options.denoise) {
		CleanSurface surface = adoptEstimate(noisy.index, std::move(ofNoisyPoints));
		surface.noise        = noisy.heightDeviation;
		return surface;
	}
	DenoisingResult moved = denoiseByProjection(
		noisy.index, options.denoising.robust, progress.sub(0.4, 0.9, "Denoising"));
	clock.book("denoising");
	CleanSurface surface;
	surface.index   = noisy.index.moved(std::move(moved.positions), std::move(moved.normals));
	surface.field   = std::move(ofNoisyPoints);
	surface.noise   = moved.pointDeviation > 0.0 ? moved.pointDeviation : noisy.heightDeviation;
	surface.moves   = std::move(moved.moves);
	surface.rmsMove = moved.rmsMove;
	surface.doubledShare = moved.doubledShare;
	surface.field.height.resize(0); // above the points as they were
	makeTangent(surface.index.cloud().normals, surface.field);
	surface.index.minimum(progress.sub(0.9, 1.0, "Finding neighborhoods"));
	clock.book("neighborhoods");
	return surface;
}

CleanSurface denoiseThenEstimate(
	const NoisyPoints&     noisy,
	const CleaningOptions& options,
	StageClock&            clock,
	const Progress&        progress)
{
	CloudIndex      cleaned = noisy.index;
	double          noise = noisy.heightDeviation, rmsMove = 0.0, doubledShare = 0.0;
	Eigen::VectorXd moves = Eigen::VectorXd::Zero(noisy.index.size());
	if (options.denoise) {
		DenoisingResult moved;
		if (options.denoising.method == DenoisingOptions::Method::Paper) {
			const CurvatureField ofNoisyPoints =
				estimate(noisy.index, options.curvature, clock, progress.sub(0.0, 0.3, ""));
			moved = denoiseAsPublished(
				noisy.index,
				ofNoisyPoints.correctedNormals,
				options.denoising.paper,
				progress.sub(0.3, 0.6, "Denoising"));
		}
		else {
			moved = denoiseByProjection(
				noisy.index, options.denoising.robust, progress.sub(0.0, 0.6, "Denoising"));
		}
		clock.book("denoising");
		if (moved.pointDeviation > 0.0)
			noise = moved.pointDeviation;
		moves        = std::move(moved.moves);
		rmsMove      = moved.rmsMove;
		doubledShare = moved.doubledShare;
		cleaned      = noisy.index.moved(std::move(moved.positions), std::move(moved.normals));
	}
	CurvatureField field = estimate(cleaned, options.curvature, clock, progress.sub(0.6, 1.0, ""));
	CleanSurface   surface;
	if (options.curvature.scaleMode == ScaleMode::Adaptive) {
		surface = adoptEstimate(cleaned, std::move(field));
	}
	else {
		surface.index = cleaned;
		surface.field = std::move(field);
	}
	surface.noise        = noise;
	surface.moves        = std::move(moves);
	surface.rmsMove      = rmsMove;
	surface.doubledShare = doubledShare;
	return surface;
}

TracedLines followDirections(
	const CloudIndex&  index,
	CurvatureField     field,
	const LineOptions& options,
	StageClock&        clock,
	const Progress&    progress)
{
	const PointCloud&           cloud   = index.cloud();
	const MinimumNeighborhoods& minimum = index.minimum();
	if (options.smoothDirections) {
		DirectionSmoothingResult smoothed = smoothDirections(
			cloud, field, options.directions, progress.sub(0.0, 0.2, "Smoothing directions"));
		field.d1 = std::move(smoothed.d1);
		field.d2 = std::move(smoothed.d2);
		clock.book("directions");
	}
	UmbilicRegions umbilics = findUmbilics(cloud, field, minimum, options.umbilics);
	clock.book("umbilics");
	VoronoiCells cells(cloud.positions, progress.sub(0.2, 0.35, "Finding Voronoi cells"));
	clock.book("voronoi");
	LineTracingOptions tracing = options.tracing;
	if (tracing.targetVertices == 0 && tracing.epsilon <= 0.0)
		tracing.targetVertices = automaticTargetVertices(index.size());
	tracing.targetVertices = std::min(tracing.targetVertices, mostTargetVertices(index.size()));
	LineNetwork lines      = traceLines(
        cloud, field, minimum, umbilics, cells, tracing, progress.sub(0.35, 1.0, "Tracing lines"));
	clock.book("tracing");
	return {std::move(field), std::move(umbilics), std::move(cells), std::move(lines)};
}

FieldMesh meshOfPositionField(
	const CleanSurface&     surface,
	const FieldMeshOptions& options,
	StageClock&             clock,
	const Progress&         progress)
{
	const CloudIndex& index = surface.index;
	FieldMesh         result;
	result.creases = findCreases(index, options.creases, progress.sub(0.0, 0.2, "Finding creases"));
	clock.book("creases");
	PositionFieldMeshOptions meshing;
	const double             most  = double(mostTargetVertices(index.size()));
	const double             asked = targetVertices(index, surface.field, options.tracing);
	result.bounded                 = asked > most;
	meshing.targetVertices         = std::min(asked, most);
	meshing.automatic  = options.tracing.targetVertices == 0 && options.tracing.epsilon <= 0.0;
	meshing.anisotropy = options.anisotropy;
	meshing.noise      = surface.noise;
	meshing.mesh       = options.mesh;
	meshing.keepLines  = options.keepLines;
	meshing.scaffold.holeSize = options.holeSize;
	const double edge         = std::sqrt(areaOf(index.minimum()) / meshing.targetVertices);
	result.mesh               = buildPositionFieldMesh(
        index,
        surface.field,
        featuresOf(result.creases, edge),
        meshing,
        progress.sub(0.2, 1.0, "Building the mesh"));
	clock.book("mesh");
	return result;
}

Index mostTargetVertices(Index n)
{
	constexpr Index perPoint = 4;
	return perPoint * n;
}

Index automaticTargetVertices(Index n)
{
	constexpr Index fewFaces = 500;
	return std::max(n / 16, std::min(n / 4, fewFaces));
}

} // namespace curvature_lines
