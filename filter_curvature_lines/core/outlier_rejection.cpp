// Votes of A09 section 4.1, and votes by height above the voters' fitted surfaces.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "outlier_rejection.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include <Eigen/Dense>

namespace curvature_lines {

namespace {

constexpr int    fitIterations  = 5;
constexpr Index  minSupporters  = 6;    // of a voter's surface, which has three unknowns
constexpr Index  minVoters      = 3;    // a point that fewer see is isolated
constexpr double minNoise       = 0.02; // of the spacing: what a quadric misses on a noise-free surface
constexpr double vouchingShare  = 0.25; // of the voters, see Tally
constexpr Index  refitNeighbors = 20;
constexpr double planeFitCosine = 0.98; // 11 degrees: what the number of neighbours changes at most

double median(std::vector<double>& values)
{
	const auto middle = values.begin() + values.size() / 2;
	std::nth_element(values.begin(), middle, values.end());
	return *middle;
}

// The surface b sees: its curvature, at an offset and a tilt that fit the points it supports, because
// neither p_b nor its normal is exact.
class VoterSurface {
public:
	VoterSurface(const PointCloud& cloud, const CurvatureField& field, Index b) :
			m_origin(cloud.positions.col(b)), m_frame(field.correctedNormals.col(b))
	{
		const Eigen::Vector2d d1 = m_frame.toPlane(field.d1.col(b));
		const Eigen::Vector2d d2 = m_frame.toPlane(field.d2.col(b));
		m_tensor = field.k1[b] * d1 * d1.transpose() + field.k2[b] * d2 * d2.transpose();
		fit(cloud, field, b);
	}

	// Signed distance along the normal; the surface bends away from it by d^T T d / 2.
	double height(const Eigen::Vector3d& p) const
	{
		const Eigen::Vector3d d = p - m_origin;
		const Eigen::Vector2d t = m_frame.toPlane(d);
		return d.dot(m_frame.n) + 0.5 * t.dot(m_tensor * t) - m_plane[0] - m_plane.tail<2>().dot(t);
	}
	double scale() const { return m_scale; } // 1.4826 median |height| of the supporters

private:
	void fit(const PointCloud& cloud, const CurvatureField& field, Index b)
	{
		thread_local std::vector<double> residuals;
		const NeighborLists::Row         row = field.weights.neighbors[b];
		for (int iteration = 0; iteration <= fitIterations; ++iteration) {
			residuals.assign(1, std::abs(height(m_origin)));
			for (const Index j : row)
				residuals.push_back(std::abs(height(cloud.positions.col(j))));
			m_scale = 1.4826 * median(residuals);
			if (m_scale <= 0.0 || iteration == fitIterations)
				return;
			Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
			Eigen::Vector3d r = Eigen::Vector3d::Zero();
			const auto      add = [&](const Eigen::Vector3d& p) {
				const double          h = height(p);
				const double          w = gemanMcClureWeight(h / (2.0 * m_scale));
				const Eigen::Vector2d t = m_frame.toPlane(p - m_origin) / field.radius[b];
				const Eigen::Vector3d basis(1.0, t.x(), t.y());
				a += w * basis * basis.transpose();
				r += w * h * basis;
			};
			add(m_origin);
			for (const Index j : row)
				add(cloud.positions.col(j));
			a.diagonal() += Eigen::Vector3d::Constant(1e-9 * a.trace());
			Eigen::Vector3d step = a.ldlt().solve(r);
			step.tail<2>() /= field.radius[b];
			m_plane += step;
		}
	}

	Eigen::Vector3d m_origin;
	TangentFrame    m_frame;
	Eigen::Matrix2d m_tensor;
	Eigen::Vector3d m_plane = Eigen::Vector3d::Zero(); // offset and tilt
	double          m_scale = 0.0;
};

bool canVote(const CurvatureField& field, Index b)
{
	return field.status[b] != PointStatus::TooFewNeighbors &&
		   field.status[b] != PointStatus::Isolated && field.weights.neighbors[b].size() >= minSupporters;
}

double heightNoise(const PointCloud& cloud, const CurvatureField& field, const Progress& progress)
{
	std::vector<double> scales(cloud.size(), -1.0), voters;
	parallelFor(cloud.size(), progress, [&](Index b) {
		if (canVote(field, b))
			scales[b] = VoterSurface(cloud, field, b).scale();
	});
	std::copy_if(scales.begin(), scales.end(), std::back_inserter(voters), [](double s) {
		return s >= 0.0;
	});
	return voters.empty() ? 0.0 : median(voters);
}

// Counters are integers: their sums do not depend on the order in which threads add.
struct Tally {
	std::vector<std::atomic<Index>> voters, against;
	// At a corner of three faces two thirds of the voters see a point off their own face. Those on its own
	// face find that its normal fits as well as its height: W_b[a] > 0.
	std::vector<std::atomic<Index>> vouching;

	explicit Tally(Index n) : voters(n), against(n), vouching(n) {}
};

Tally voteByHeight(
	const PointCloud&     cloud,
	const NeighborSearch& search,
	const CurvatureField& field,
	double                spacing,
	double                noise,
	double                sensitivity,
	const Progress&       progress)
{
	Tally        tally(cloud.size());
	const double floor = std::max(noise, minNoise * spacing);
	parallelFor(cloud.size(), progress, [&](Index b) {
		if (!canVote(field, b))
			return;
		const VoterSurface surface(cloud, field, b);
		const double       tolerance = sensitivity * std::max(surface.scale(), floor);
		for (const Index a : search.within(cloud.positions.col(b), field.radius[b])) {
			if (a == b)
				continue;
			const bool accepted = std::abs(surface.height(cloud.positions.col(a))) <= tolerance;
			tally.voters[a].fetch_add(1, std::memory_order_relaxed);
			if (!accepted)
				tally.against[a].fetch_add(1, std::memory_order_relaxed);
			else if (field.weights(b, a) > 0.0)
				tally.vouching[a].fetch_add(1, std::memory_order_relaxed);
		}
	});
	return tally;
}

OutlierResult judge(const Tally& tally, double voteThreshold)
{
	OutlierResult result;
	const Index   n = static_cast<Index>(tally.voters.size());
	result.outlier.assign(n, 0);
	result.score.assign(n, 0.0);
	for (Index a = 0; a < n; ++a) {
		const double voters = tally.voters[a];
		if (voters < minVoters) {
			result.outlier[a] = 1;
			result.score[a]   = 1.0;
			++result.isolated;
			continue;
		}
		result.score[a] = tally.against[a] / voters;
		result.outlier[a] =
			result.score[a] > voteThreshold && tally.vouching[a] < vouchingShare * voters;
	}
	return result;
}

// The part of the cloud still in the game, and what it needs.
struct Remaining {
	PointCloud         cloud;
	std::vector<Index> source; // index in the whole cloud
};

Eigen::Vector3d planeNormal(const PointCloud& cloud, const std::vector<Index>& points)
{
	Eigen::Vector3d mean = Eigen::Vector3d::Zero();
	for (const Index j : points)
		mean += cloud.positions.col(j) / double(points.size());
	Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
	for (const Index j : points) {
		const Eigen::Vector3d d = cloud.positions.col(j) - mean;
		covariance += d * d.transpose();
	}
	return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors().col(0);
}

// A plane fit next to an outlier was pulled towards it, so where the normal is that of a plane fit, it is
// fitted again without, keeping its sign. Normals that came from elsewhere stay: they know edges better.
void refitNormals(const PointCloud& before, const std::vector<char>& removed, Remaining& after)
{
	const NeighborSearch searchBefore(before.positions), searchAfter(after.cloud.positions);
	parallelFor(after.cloud.size(), {}, [&](Index i) {
		const Eigen::Vector3d p      = after.cloud.positions.col(i);
		const auto            around = searchBefore.nearest(p, refitNeighbors);
		if (std::none_of(around.begin(), around.end(), [&](Index j) { return removed[j]; }))
			return;
		const Eigen::Vector3d own = after.cloud.normals.col(i);
		if (std::abs(planeNormal(before, around).dot(own)) < planeFitCosine)
			return;
		const Eigen::Vector3d fitted =
			planeNormal(after.cloud, searchAfter.nearest(p, refitNeighbors));
		after.cloud.normals.col(i) = fitted.dot(own) < 0.0 ? -fitted : fitted;
	});
}

Remaining remove(const Remaining& remaining, const std::vector<char>& outlier)
{
	Remaining  next;
	const auto count =
		static_cast<Index>(std::count(outlier.begin(), outlier.end(), char(0)));
	next.cloud.positions.resize(3, count);
	next.cloud.normals.resize(3, count);
	for (Index i = 0; i < remaining.cloud.size(); ++i) {
		if (outlier[i])
			continue;
		const auto k                = static_cast<Index>(next.source.size());
		next.cloud.positions.col(k) = remaining.cloud.positions.col(i);
		next.cloud.normals.col(k)   = remaining.cloud.normals.col(i);
		next.source.push_back(remaining.source[i]);
	}
	refitNormals(remaining.cloud, outlier, next);
	return next;
}

OutlierResult
oneRound(const PointCloud& cloud, const OutlierOptions& options, const Progress& progress)
{
	const NeighborSearch       search(cloud.positions);
	const MinimumNeighborhoods minimum = minimumNeighborhoods(
		cloud, search, options.neighborhood, progress.sub(0.0, 0.1, "Finding neighbors"));
	const CurvatureField field = robustCurvature(
		cloud, search, minimum, options.curvature, progress.sub(0.1, 0.8, "Estimating curvature"));
	const double noise =
		heightNoise(cloud, field, progress.sub(0.8, 0.9, "Measuring the noise"));
	OutlierResult result = options.mode == OutlierOptions::Mode::Paper ?
							   voteOutliers(field, options.voteThreshold) :
							   judge(
								   voteByHeight(
									   cloud,
									   search,
									   field,
									   minimum.medianSpacing,
									   noise,
									   options.sensitivity,
									   progress.sub(0.9, 1.0, "Voting")),
								   options.voteThreshold);
	result.noise = noise;
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
rejectOutliers(const PointCloud& cloud, const OutlierOptions& options, const Progress& progress)
{
	const bool    paper  = options.mode == OutlierOptions::Mode::Paper;
	const Index   rounds = paper ? 1 : std::max<Index>(options.rounds, 1);
	OutlierResult result;
	result.outlier.assign(cloud.size(), 0);
	result.score.assign(cloud.size(), 0.0);

	Remaining remaining;
	remaining.cloud = cloud;
	for (Index i = 0; i < cloud.size(); ++i)
		remaining.source.push_back(i);
	while (result.roundsUsed < rounds && remaining.cloud.size() > 0) {
		const double        from  = double(result.roundsUsed) / rounds;
		const OutlierResult round = oneRound(
			remaining.cloud, options, progress.sub(from, from + 1.0 / rounds, "Rejecting outliers"));
		++result.roundsUsed;
		result.noise    = round.noise;
		result.isolated += round.isolated;
		for (Index i = 0; i < remaining.cloud.size(); ++i) {
			result.outlier[remaining.source[i]] = round.outlier[i];
			result.score[remaining.source[i]]   = round.score[i];
		}
		if (std::count(round.outlier.begin(), round.outlier.end(), char(1)) == 0)
			break;
		if (result.roundsUsed < rounds)
			remaining = remove(remaining, round.outlier);
	}
	progress.report(1.0);
	return result;
}

} // namespace curvature_lines
