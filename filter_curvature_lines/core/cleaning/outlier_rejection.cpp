// Votes of A09 section 4.1, and the choice between them and the robust ones.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "outlier_rejection.h"

#include <vector>

#include "cloud_index.h"
#include "curvature_field.h"
#include "outlier_result.h"
#include "point_cloud.h"
#include "progress.h"
#include "robust_curvature.h"
#include "robust_outliers.h"

namespace curvature_lines {

namespace {

OutlierResult rejectByPublishedVotes(
	const CloudIndex& index, const OutlierOptions& options, const Progress& progress)
{
	index.minimum(progress.sub(0.0, 0.1, "Finding neighbors"));
	const CurvatureField field =
		robustCurvature(index, options.curvature, progress.sub(0.1, 0.9, "Estimating curvature"));
	OutlierResult result = voteOutliers(field, options.voteThreshold);
	result.heightDeviation =
		voterHeightDeviation(index, progress.sub(0.9, 1.0, "Measuring the noise"));
	return result;
}

} // namespace

OutlierResult voteOutliers(const CurvatureField& field, double voteThreshold)
{
	const Index        n = field.size();
	std::vector<Index> against(n, 0), votes(n, 0);
	for (Index a = 0; a < n; ++a) {
		for (const Index b : field.weights.neighbors[a]) {
			++votes[a];
			if (field.weights(b, a) == 0.0)
				++against[a];
		}
	}
	OutlierResult result;
	result.outlier.assign(n, 0);
	result.score.assign(n, 0.0);
	result.roundsUsed = 1;
	for (Index a = 0; a < n; ++a) {
		const bool isolated = field.status[a] == PointStatus::Isolated || votes[a] == 0;
		result.score[a]     = isolated ? 1.0 : double(against[a]) / double(votes[a]);
		result.outlier[a]   = isolated || result.score[a] > voteThreshold;
		result.isolated += isolated;
	}
	return result;
}

OutlierResult
rejectOutliers(const CloudIndex& index, const OutlierOptions& options, const Progress& progress)
{
	OutlierResult result =
		options.mode == OutlierOptions::Mode::Paper
			? rejectByPublishedVotes(index, options, progress)
			: rejectByRobustVotes(
				  index, options.sensitivity, options.rounds, progress, options.rejectUnstructured);
	progress.report(1.0);
	return result;
}

} // namespace curvature_lines
