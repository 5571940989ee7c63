// The stages of A09 fig. 1 in order, each timed.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruction.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "even_sample.h"
#include "line_spacing.h"
#include "quad_mesh.h"
#include "spatial_order.h"

namespace curvature_lines {

namespace {

constexpr Index  fewestPoints   = 20; // as prepareCloud()
constexpr Index  leastSample    = 20000;
constexpr double shortestCrease = 5.0; // of those that fade out, in edges of the mesh

class StageClock {
public:
	explicit StageClock(std::map<std::string, double>& seconds) : m_seconds(seconds) {}
	// Books the time since the last call to a stage; stages that run twice add up.
	void book(const char* stage)
	{
		const auto now = Clock::now();
		m_seconds[stage] += std::chrono::duration<double>(now - m_last).count();
		m_last = now;
	}

private:
	using Clock = std::chrono::steady_clock;
	std::map<std::string, double>& m_seconds;
	Clock::time_point              m_last = Clock::now();
};

// The search tree refers to the positions it was built on: made anew whenever they move.
struct Neighborhoods {
	NeighborSearch       search;
	MinimumNeighborhoods minimum;

	Neighborhoods(
		const PointCloud&                 cloud,
		const MinimumNeighborhoodOptions& options,
		const Progress&                   progress) :
			search(cloud.positions), minimum(minimumNeighborhoods(cloud, search, options, progress))
	{
	}
};

PointCloud part(const PointCloud& cloud, const std::vector<Index>& which)
{
	return {columnsOf(cloud.positions, which), columnsOf(cloud.normals, which)};
}

void keepInliers(const PointCloud& cloud, ReconstructionResult& result)
{
	for (Index i = 0; i < cloud.size(); ++i)
		if (!result.outlier[i])
			result.kept.push_back(i);
	if (static_cast<Index>(result.kept.size()) < fewestPoints)
		throw InputError(
			"Only " + std::to_string(result.kept.size()) +
			" points are left after outlier rejection; switch it off or reject less.");
	result.cloud = part(cloud, result.kept);
}

// What a mesh of so few vertices has no use for.
void thinDenseCloud(
	const ReconstructionOptions& options,
	ReconstructionResult&        result,
	StageClock&                  clock,
	const Progress&              progress)
{
	const double most = options.pointsPerVertex * options.tracing.targetVertices;
	if (options.method != ReconstructionOptions::Method::PositionField || !(most > 0.0) ||
	    result.cloud.size() <= std::max(most, double(leastSample)))
		return;
	const std::vector<Index> sample =
		evenSample(result.cloud, std::max(static_cast<Index>(most), leastSample), progress);
	std::vector<Index> kept;
	for (const Index k : sample)
		kept.push_back(result.kept[k]);
	result.cloud = part(result.cloud, sample);
	result.kept  = std::move(kept);
	clock.book("sampling");
}

void traceAndFill(
	const ReconstructionOptions& options,
	const MinimumNeighborhoods&  minimum,
	ReconstructionResult&        result,
	StageClock&                  clock,
	const Progress&              progress)
{
	if (options.smoothDirections) {
		DirectionSmoothingResult smoothed = smoothDirections(
			result.cloud,
			result.field,
			options.directions,
			progress.sub(0.0, 0.2, "Smoothing directions"));
		result.field.d1 = std::move(smoothed.d1);
		result.field.d2 = std::move(smoothed.d2);
		clock.book("directions");
	}
	UmbilicOptions umbilics = options.umbilics;
	umbilics.smoothed       = options.smoothDirections;
	result.umbilics         = findUmbilics(result.cloud, result.field, minimum, umbilics);
	clock.book("umbilics");
	const VoronoiCells cells(
		result.cloud.positions, progress.sub(0.2, 0.3, "Finding Voronoi cells"));
	clock.book("voronoi");

	LineTracingOptions tracing = options.tracing;
	if (tracing.targetVertices == 0 && tracing.epsilon <= 0.0)
		tracing.targetVertices = automaticTargetVertices(result.cloud.size());
	result.lines = traceLines(
		result.cloud,
		result.field,
		minimum,
		result.umbilics,
		cells,
		tracing,
		progress.sub(0.3, 0.8, "Tracing lines"));
	clock.book("tracing");
	static_cast<FinishedMesh&>(result.mesh) = buildQuadMesh(
		result.cloud,
		cells,
		result.lines,
		options.mesh,
		progress.sub(0.8, 1.0, "Building the mesh"));
	clock.book("mesh");
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
	const PointCloud&           cloud,
	const CurvatureField&       field,
	const MinimumNeighborhoods& minimum,
	const LineTracingOptions&   tracing)
{
	const LineSpacing spacing = chooseLineSpacing(cloud, field, minimum, tracing, 0.0);
	double            sum     = 0.0;
	for (Index i = 0; i < cloud.size(); ++i)
		sum += areaOf(minimum, i) / (spacing.distance[0][i] * spacing.distance[1][i]);
	return sum;
}

void fillPositionField(
	const ReconstructionOptions& options,
	const MinimumNeighborhoods&  minimum,
	ReconstructionResult&        result,
	StageClock&                  clock,
	const Progress&              progress)
{
	result.umbilics = findUmbilics(result.cloud, result.field, minimum, options.umbilics);
	clock.book("umbilics");
	result.creases = findCreases(
		result.cloud, minimum, options.creases, progress.sub(0.0, 0.2, "Finding creases"));
	clock.book("creases");
	PositionFieldMeshOptions meshing;
	meshing.targetVertices = options.tracing.targetVertices;
	if (meshing.targetVertices <= 0.0)
		meshing.targetVertices =
			options.tracing.epsilon > 0.0
				? std::max(8.0, crossingsFor(result.cloud, result.field, minimum, options.tracing))
				: double(automaticTargetVertices(result.cloud.size()));
	const double edge = std::sqrt(areaOf(minimum) / meshing.targetVertices);

	std::vector<FeatureLine> lines;
	for (const CreaseCurve& curve : result.creases.curves) {
		// Short wrinkles of a scan would only disturb the faces around.
		const bool fades = curve.start < 0 || curve.end < 0;
		if (fades && !curve.closed && curve.length() < shortestCrease * edge)
			continue;
		lines.push_back({curve.positions, curve.closed});
		if (curve.start >= 0)
			lines.back().points.leftCols<1>() = result.creases.corners[curve.start].position;
		if (curve.end >= 0)
			lines.back().points.rightCols<1>() = result.creases.corners[curve.end].position;
	}

	meshing.anisotropy = options.anisotropy;
	meshing.noise      = result.noise;
	meshing.mesh       = options.mesh;
	meshing.keepLines  = options.keepLines;
	result.mesh        = buildPositionFieldMesh(
        result.cloud, result.field, lines, meshing, progress.sub(0.2, 1.0, "Building the mesh"));
	result.lines = std::move(result.mesh.lines);
	clock.book("mesh");
}

} // namespace

Index automaticTargetVertices(Index n)
{
	constexpr Index fewFaces = 500;
	return std::max(n / 16, std::min(n / 4, fewFaces));
}

ReconstructionResult
reconstruct(const PointCloud& cloud, const ReconstructionOptions& options, const Progress& progress)
{
	ReconstructionResult result;
	StageClock           clock(result.seconds);

	result.outlier.assign(cloud.size(), 0);
	if (options.rejectOutliers) {
		OutlierResult rejected =
			rejectOutliers(cloud, options.outliers, progress.sub(0.0, 0.2, "Rejecting outliers"));
		result.outlier = std::move(rejected.outlier);
		result.noise   = rejected.heightDeviation;
		clock.book("outliers");
	}
	keepInliers(cloud, result);
	thinDenseCloud(options, result, clock, progress.sub(0.2, 0.2, "Thinning the cloud"));

	std::optional<Neighborhoods> around;
	const auto                   estimate = [&](const Progress& part) {
        around.emplace(
            result.cloud, options.neighborhood, part.sub(0.0, 0.1, "Finding neighborhoods"));
        clock.book("neighborhoods");
        result.field = estimateCurvature(
            result.cloud,
            around->search,
            around->minimum,
            options.curvature,
            part.sub(0.1, 1.0, "Estimating curvature"));
        clock.book("curvature");
	};
	// Denoised points lie on a smooth surface of its own small waves, which an estimate on them follows and
	// cannot tell from shape: with directions from the noisy points a mesh is two to four times better aligned.
	const bool first = options.method == ReconstructionOptions::Method::PositionField &&
	                   options.denoising.method == DenoisingOptions::Method::Robust &&
	                   options.curvature.scaleMode == ScaleMode::Adaptive;
	if (first)
		estimate(progress.sub(0.2, 0.35, ""));
	if (options.denoise) {
		DenoisingResult cleaned = denoise(
			result.cloud,
			[&](const Progress& part) {
				estimate(part);
				return CorrectedNormals{
					result.field.correctedNormals, around->search, around->minimum};
			},
			options.denoising,
			progress.sub(first ? 0.35 : 0.2, 0.5, "Denoising"));
		around.reset();
		result.cloud   = {std::move(cleaned.positions), std::move(cleaned.normals)};
		result.rmsMove = cleaned.rmsMove;
		result.field.height.resize(0); // of the points as they were
		if (cleaned.pointDeviation > 0.0)
			result.noise = cleaned.pointDeviation;
		clock.book("denoising");
	}
	if (!first)
		estimate(progress.sub(0.5, 0.65, ""));
	else if (options.denoise)
		around.emplace(
			result.cloud, options.neighborhood, progress.sub(0.5, 0.65, "Finding neighborhoods"));
	if (options.curvature.scaleMode == ScaleMode::Adaptive) {
		if (!first || !options.denoise)
			result.cloud.normals = result.field.correctedNormals;
		makeTangent(result.cloud.normals, result.field);
	}

	if (options.method == ReconstructionOptions::Method::PositionField)
		fillPositionField(options, around->minimum, result, clock, progress.sub(0.65, 1.0, ""));
	else
		traceAndFill(options, around->minimum, result, clock, progress.sub(0.65, 1.0, ""));
	return result;
}

} // namespace curvature_lines
