// Robust curvature estimation (A09 section 3, eq. 1; R07 section 3), one point at a time.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "robust_curvature.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "cloud_index.h"
#include "curvature_field.h"
#include "feature_gate.h"
#include "irls.h"
#include "neighborhoods.h"
#include "operating_region.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

namespace {

// docs/method.md, "The published estimate"; values without another reason by experiment (benchmarks/paper_figures.py).
constexpr Index minPairs =
	5; // three equations each for the six entries of the variation model, with some to spare
// Points that a gated region has where twice the radius holds so many: half of them may lie beyond a crease.
constexpr Index minRegion = 20;
// Shares: of the near neighbours that support a right normal (at a corner 1/3 do); of the cost of the
// centre pairs that a better normal may leave, unless less than the third of the region agrees with n_i.
constexpr double minSupport = 0.25;
constexpr double costRatio  = 0.85;
constexpr double minConsent = 0.2;
// of the summed weight; below, the neighbours do not agree about the normal
constexpr double minAgreement = 0.2;

struct Estimate {
	bool                valid = false;
	VariationModel      model = VariationModel::Zero(); // in units of the region's radius
	double              sigma = 0.0, radius = 0.0;
	Index               iterations = 0;
	Eigen::Vector3d     normal     = Eigen::Vector3d::Zero(); // of the frame the model lives in
	Eigen::Vector3d     correctedNormal;
	std::vector<Index>  neighbors; // a row of StatisticalWeights
	std::vector<double> weights;
};

// Holds the scratch of one thread, so that the loop over the points hardly allocates.
class PointEstimator {
public:
	CentreFits centreFits(Index i, const Eigen::Vector3d& normal);
	Estimate estimate(Index i, const CentreFits& centre, double commonScale);

	static PointEstimator&
	ofThisThread(const CloudIndex& index, const RobustCurvatureOptions& options)
	{
		thread_local PointEstimator estimator;
		estimator.m_cloud   = &index.cloud();
		estimator.m_search  = &index.search();
		estimator.m_minimum = &index.minimum();
		estimator.m_options = &options;
		return estimator;
	}

private:
	IrlsOptions irlsOptions() const;
	void collectRegion(Index i, const Eigen::Vector3d& normal);
	void keepAllMembers();
	void passGate(Index i, const CentreFits& centre, double commonScale);
	VariationModel start(Index i);
	void collectWeights(const IrlsFit& fit, Estimate& estimate);
	Eigen::Vector3d correctedNormal(const IrlsFit& fit) const;

	const PointCloud*             m_cloud   = nullptr;
	const NeighborSearch*         m_search  = nullptr;
	const MinimumNeighborhoods*   m_minimum = nullptr;
	const RobustCurvatureOptions* m_options = nullptr;

	OperatingRegion     m_region;
	std::vector<Index>  m_members, m_startMembers; // of the region, those that form pairs
	VariationSamples    m_samples, m_startSamples;
	FeatureGate         m_gate;
	IrlsSolver          m_solver;
	std::vector<double> m_ones;
	std::vector<double> m_weightSum, m_pairCount, m_totalWeight; // per point of the region
};

IrlsOptions PointEstimator::irlsOptions() const
{
	IrlsOptions irls;
	irls.maxIterations = m_options->maxIterations;
	irls.tolerance     = m_options->tolerance;
	irls.sigmaFactor   = m_options->sigmaFactor;
	irls.cut           = m_options->cut;
	irls.robust        = m_options->robust;
	return irls;
}

void PointEstimator::collectRegion(Index i, const Eigen::Vector3d& normal)
{
	m_region.collect(
		*m_cloud,
		*m_search,
		i,
		normal,
		m_minimum->spacing[i],
		m_options->regionScale,
		m_options->featureGate ? minRegion : 0,
		m_options->maxPoints);
	keepAllMembers();
}

void PointEstimator::keepAllMembers()
{
	m_members.resize(m_region.size());
	std::iota(m_members.begin(), m_members.end(), 0);
}

// The published start: least squares over all pairs of the minimum neighbourhood, here of its members.
VariationModel PointEstimator::start(Index i)
{
	const NeighborLists::Row row = m_minimum->neighbors[i];
	m_startMembers.assign(1, 0);
	for (const Index m : m_members)
		if (m != 0 && std::find(row.begin(), row.end(), m_region.points[m]) != row.end())
			m_startMembers.push_back(m);
	collectPairs(m_region, m_startMembers, m_options->maxPairs, m_startSamples);
	if (!m_startSamples.spanPlane())
		collectPairs(m_region, m_members, m_options->maxPairs, m_startSamples);
	m_ones.assign(m_startSamples.size(), 1.0);
	return weightedLeastSquares(m_startSamples, m_ones);
}

CentreFits PointEstimator::centreFits(Index i, const Eigen::Vector3d& normal)
{
	collectRegion(i, normal);
	return m_gate.fitCentre(m_region, start(i), irlsOptions());
}

void PointEstimator::passGate(Index i, const CentreFits& centre, double commonScale)
{
	if (!m_options->featureGate || !m_options->robust || m_region.size() <= minPairs)
		return;
	GateResult own = m_gate.select(m_region, centre, commonScale);
	if (own.consent < 0.75) {
		const NormalConsensus consensus = normalConsensus(m_region);
		if (consensus.ownSupport < minSupport) {
			// No crease: n_i itself is wrong, if with a better one most of the disagreement is gone.
			const CentreFits again = centreFits(i, consensus.normal);
			GateResult       other = m_gate.select(m_region, again, commonScale);
			const double     ratio = own.consent < minConsent ? 1.0 : costRatio;
			if (other.cost < ratio * own.cost)
				own = std::move(other);
			else
				collectRegion(i, m_cloud->normals.col(i));
		}
	}
	m_members = std::move(own.members);
}

// W_i[j]: the weights of p_j's pairs (A09 section 4.1), per pair and with w(0) = 2 brought to 1.
void PointEstimator::collectWeights(const IrlsFit& fit, Estimate& estimate)
{
	for (auto* perPoint : {&m_weightSum, &m_pairCount, &m_totalWeight})
		perPoint->assign(m_region.size(), 0.0);
	for (Index s = 0; s < m_samples.size(); ++s) {
		for (const Index p : {m_samples.first[s], m_samples.second[s]}) {
			m_weightSum[p] += fit.weights[s];
			m_pairCount[p] += 1.0;
			m_totalWeight[p] += fit.weights[s] * m_samples.geometric[s];
		}
	}
	std::vector<std::pair<Index, double>> row;
	for (Index p = 1; p < m_region.size(); ++p)
		if (m_weightSum[p] > 0.0)
			row.emplace_back(
				m_region.points[p], std::min(0.5 * m_weightSum[p] / m_pairCount[p], 1.0));
	std::sort(row.begin(), row.end());
	for (const auto& [j, weight] : row) {
		estimate.neighbors.push_back(j);
		estimate.weights.push_back(weight);
	}
}

// n_i' = unit(sum_j W_j (n_j - X d_j)) (A09 end of section 3): what the neighbours' normals say about n_i.
Eigen::Vector3d PointEstimator::correctedNormal(const IrlsFit& fit) const
{
	Eigen::Vector3d sum   = Eigen::Vector3d::Zero();
	double          total = 0.0;
	for (Index p = 0; p < m_region.size(); ++p) {
		sum += m_totalWeight[p] * (m_region.normals[p] - fit.model * m_region.positions[p]);
		total += m_totalWeight[p];
	}
	const TangentFrame& frame = m_region.frame;
	if (sum.norm() < minAgreement * total || sum.z() <= 0.0)
		return frame.n;
	return (sum.x() * frame.u + sum.y() * frame.v + sum.z() * frame.n).normalized();
}

Estimate PointEstimator::estimate(Index i, const CentreFits& centre, double commonScale)
{
	collectRegion(i, m_cloud->normals.col(i));
	passGate(i, centre, commonScale);
	Estimate result;
	result.radius = m_region.radius;
	result.normal = result.correctedNormal = m_region.frame.n;
	collectPairs(m_region, m_members, m_options->maxPairs, m_samples);
	result.valid = m_samples.size() >= minPairs && m_samples.spanPlane();
	if (!result.valid)
		return result;

	const IrlsFit& fit = m_solver.fit(m_samples, start(i), irlsOptions());
	result.model       = fit.model;
	result.sigma       = fit.sigma;
	result.iterations  = fit.iterations;
	collectWeights(fit, result);
	result.correctedNormal = correctedNormal(fit);
	return result;
}

Eigen::Vector3d tangential(const Eigen::Vector3d& direction, const TangentFrame& frame)
{
	const Eigen::Vector2d projected = frame.toPlane(direction);
	return projected.norm() > 1e-9 ? frame.toSpace(projected.normalized()) : frame.u;
}

void setPrincipalCurvatures(
	const Estimate& estimate, const Eigen::Vector3d& normal, Index i, CurvatureField& field)
{
	const Eigen::Matrix2d x      = estimate.model.topRows<2>() / estimate.radius;
	const Eigen::Matrix2d tensor = 0.5 * (x + x.transpose());
	Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen;
	eigen.computeDirect(tensor);
	const bool finite = eigen.eigenvalues().allFinite() && eigen.eigenvectors().allFinite();
	const Eigen::Vector2d axis =
		finite ? Eigen::Vector2d(eigen.eigenvectors().col(1)) : Eigen::Vector2d::UnitX();
	field.k1[i] = finite ? eigen.eigenvalues()[1] : 0.0;
	field.k2[i] = finite ? eigen.eigenvalues()[0] : 0.0;

	// Tangent at the normal the cloud carries, even where the model was fitted at a better one.
	field.d1.col(i) = tangential(TangentFrame(estimate.normal).toSpace(axis), TangentFrame(normal));
	field.d2.col(i) = normal.cross(field.d1.col(i)).normalized();
	// The error of a normal is sigma; half of the points determine each direction, over the radius of the region.
	const double supporters = std::max<double>(estimate.neighbors.size(), 1.0);
	field.error[i]          = estimate.sigma / (estimate.radius * std::sqrt(0.5 * supporters));
}

} // namespace

CurvatureField robustCurvature(
	const CloudIndex& index, const RobustCurvatureOptions& options, const Progress& progress)
{
	const PointCloud&           cloud     = index.cloud();
	const NeighborSearch&       search    = index.search();
	const MinimumNeighborhoods& minimum   = index.minimum();
	const Index                 n         = cloud.size();
	const auto                  estimator = [&]() -> PointEstimator& {
        return PointEstimator::ofThisThread(index, options);
	};
	std::vector<CentreFits> centre(n);
	if (options.featureGate && options.robust)
		parallelForPoints(search, progress.sub(0.0, 0.2, "Looking for features"), [&](Index i) {
			centre[i] = estimator().centreFits(i, cloud.normals.col(i));
		});
	const double commonScale = commonCentreScale(centre);

	CurvatureField field;
	for (auto* values :
	     {&field.k1, &field.k2, &field.error, &field.radius, &field.confidence, &field.feature})
		values->setZero(n);
	for (auto* vectors : {&field.d1, &field.d2, &field.correctedNormals})
		vectors->resize(3, n);
	field.status = minimum.status;
	std::vector<std::vector<Index>>  rows(n);
	std::vector<std::vector<double>> weights(n);
	std::vector<Index>               iterations(n);
	parallelForPoints(search, progress.sub(0.2, 1.0, "Estimating curvature"), [&](Index i) {
		Estimate estimate = estimator().estimate(i, centre[i], commonScale);
		if (estimate.valid && field.status[i] == PointStatus::TooFewNeighbors)
			field.status[i] = PointStatus::Boundary;
		if (!estimate.valid && field.status[i] != PointStatus::Isolated)
			field.status[i] = PointStatus::TooFewNeighbors;
		setPrincipalCurvatures(estimate, cloud.normals.col(i), i, field);
		field.radius[i]               = estimate.radius;
		field.correctedNormals.col(i) = estimate.correctedNormal;
		rows[i]                       = std::move(estimate.neighbors);
		weights[i]                    = std::move(estimate.weights);
		iterations[i]                 = estimate.iterations;
	});

	adoptWeights(rows, weights, field);
	field.iterations = n > 0 ? *std::max_element(iterations.begin(), iterations.end()) : 0;
	return field;
}

} // namespace curvature_lines
