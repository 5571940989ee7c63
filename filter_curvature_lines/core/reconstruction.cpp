// The stages of A09 fig. 1 in order, each timed.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruction.h"

#include <algorithm>
#include <chrono>
#include <optional>

namespace curvature_lines {

namespace {

constexpr Index fewestPoints = 20; // as prepareCloud()

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

void keepInliers(const PointCloud& cloud, ReconstructionResult& result)
{
	for (Index i = 0; i < cloud.size(); ++i)
		if (!result.outlier[i])
			result.kept.push_back(i);
	const auto n = static_cast<Index>(result.kept.size());
	if (n < fewestPoints)
		throw InputError(
			"Only " + std::to_string(n) +
			" points are left after outlier rejection; switch it off or reject less.");
	result.cloud.positions.resize(3, n);
	result.cloud.normals.resize(3, n);
	for (Index i = 0; i < n; ++i) {
		result.cloud.positions.col(i) = cloud.positions.col(result.kept[i]);
		result.cloud.normals.col(i)   = cloud.normals.col(result.kept[i]);
	}
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
		result.noise   = rejected.noise;
		clock.book("outliers");
	}
	keepInliers(cloud, result);

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
	if (options.denoise) {
		DenoisingResult cleaned = denoise(
			result.cloud,
			[&](const Progress& part) {
				estimate(part);
				return CorrectedNormals{
					result.field.correctedNormals, around->search, around->minimum};
			},
			options.denoising,
			progress.sub(0.2, 0.5, "Denoising"));
		around.reset();
		result.cloud   = {std::move(cleaned.positions), std::move(cleaned.normals)};
		result.rmsMove = cleaned.rmsMove;
		if (cleaned.noise > 0.0)
			result.noise = cleaned.noise;
		clock.book("denoising");
	}
	estimate(progress.sub(0.5, 0.65, ""));
	if (options.curvature.scaleMode == ScaleMode::Adaptive) {
		result.cloud.normals = result.field.correctedNormals;
		makeTangent(result.cloud.normals, result.field);
	}

	if (options.smoothDirections) {
		DirectionSmoothingResult smoothed = smoothDirections(
			result.cloud,
			result.field,
			options.directions,
			progress.sub(0.65, 0.72, "Smoothing directions"));
		result.field.d1 = std::move(smoothed.d1);
		result.field.d2 = std::move(smoothed.d2);
		clock.book("directions");
	}
	result.umbilics = findUmbilics(result.cloud, result.field, around->minimum, options.umbilics);
	clock.book("umbilics");
	const VoronoiCells cells(
		result.cloud.positions, progress.sub(0.72, 0.76, "Finding Voronoi cells"));
	clock.book("voronoi");

	LineTracingOptions tracing = options.tracing;
	if (tracing.targetVertices == 0 && tracing.epsilon <= 0.0)
		tracing.targetVertices = automaticTargetVertices(result.cloud.size());
	result.lines = traceLines(
		result.cloud,
		result.field,
		around->minimum,
		result.umbilics,
		cells,
		tracing,
		progress.sub(0.76, 0.92, "Tracing lines"));
	clock.book("tracing");
	result.mesh = buildQuadMesh(
		result.cloud,
		cells,
		result.lines,
		options.mesh,
		progress.sub(0.92, 1.0, "Building the mesh"));
	clock.book("mesh");
	return result;
}

} // namespace curvature_lines
