// Selection of scales, estimates at anchors and their interpolation at the points.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "adaptive_curvature.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "adaptive_scale.h"
#include "anchor_fits.h"
#include "cloud_index.h"
#include "curvature_field.h"
#include "local_polynomial.h"
#include "local_surface.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "point_subsets.h"
#include "progress.h"
#include "quantile.h"
#include "robust_curvature.h"
#include "robust_kernel.h"
#include "scale_mixture.h"
#include "surface_anchors.h"

namespace curvature_lines {

namespace {

constexpr const char* progressLabel = "Estimating curvature";

// docs/method.md, "Scale"; values without another reason by experiment (benchmarks/curvature.py).
constexpr Index minPoints = 8; // a quadratic height polynomial has six coefficients
// Radius over which anchors are interpolated, in height radii: anchors are thinned to a fraction of it.
constexpr double blendRadius = 0.5;
// Cosine of 37 degrees: scales whose normals differ further took different faces of an edge.
constexpr double sameFace = 0.8;
// Length of the difference of unit normals whose cosine is 0.2: beyond, they belong to opposite sheets.
constexpr double oppositeNormals = 1.265;

// Anchors of one scale with their shape operators, ready to be interpolated.
class ScaleField {
public:
	// Right at the points `users` name.
	ScaleField(
		const PointSample&                           sample,
		const CurvatureScale&                        scale,
		const std::vector<std::pair<Index, double>>& users,
		double                                       quadricResidual,
		double                                       directBelow) :
			m_scale(scale), m_subsets(sample, scale.height.radius),
			m_users(positionsOf(sample.cloud, users)), m_userSearch(m_users),
			m_anchors(
				fitAnchors(
					sample,
					m_subsets,
					scale.height.radius,
					Degrees::only(scale.height.degree),
					AnchorDetail::Full,
					Vicinity{&m_userSearch, 1.05 * scale.radius() + 2.5 * scale.height.radius}),
				m_subsets,
				scale,
				quadricResidual),
			m_direct(scale.normalRadius == 0.0 || scale.height.radius < directBelow),
			m_search(m_anchors.origins())
	{
		if (m_direct && !m_anchors.hasEdges())
			return;
		m_elements = m_anchors.elements();
		if (scale.normalRadius == 0.0)
			return;
		parallelFor(m_anchors.size(), {}, [&](Index a) {
			if (Vicinity{&m_userSearch, blendRadius * m_scale.height.radius}.contains(
					m_anchors.origins().col(a)))
				if (m_elements[a].valid)
					m_elements[a] = m_anchors.normalField(m_anchors.elements()[a]);
		});
	}

	// `edge` is told where one is near.
	SurfaceElement
	at(Index                  place,
	   const Eigen::Vector3d& position,
	   const Eigen::Vector3d& gate,
	   EdgeNearby&            edge) const
	{
		SurfaceElement element;
		if (m_anchors.nearEdge(position)) {
			const SurfaceElement face = m_anchors.faceAt(position, &edge);
			if (face.valid)
				element = interpolate(position, face.normal, m_anchors.jump());
		}
		else if (!m_direct) {
			element = interpolate(position, gate, oppositeNormals);
		}
		if (!element.valid) {
			element = surfaceAt(m_subsets, place, position, gate, m_scale.height, 2);
			if (element.valid && m_scale.normalRadius > 0.0)
				element = m_anchors.normalField(element);
		}
		return element;
	}

private:
	// From a quadratic fit over the anchors around: an average would flatten the field.
	static Eigen::Matrix<double, 10, 1> valueAtOrigin(LocalSamples<10>& samples)
	{
		if (samples.size() >= 9)
			if (const auto fit = fitPolynomial<2, 10>(samples); fit.valid)
				return fit.coefficients.row(0);
		Eigen::Matrix<double, 10, 1> mean  = Eigen::Matrix<double, 10, 1>::Zero();
		double                       total = 0.0;
		for (int s = 0; s < samples.size(); ++s) {
			for (int c = 0; c < 10; ++c)
				mean[c] += samples.weight[s] * samples.value[c][s];
			total += samples.weight[s];
		}
		return mean / total;
	}

	SurfaceElement
	interpolate(const Eigen::Vector3d& position, const Eigen::Vector3d& gate, double jump) const
	{
		thread_local std::vector<Index> nearScratch;
		thread_local LocalSamples<10>   samplesScratch;
		std::vector<Index>&             near    = nearScratch;
		LocalSamples<10>&               samples = samplesScratch;
		SurfaceElement                  result;
		const double                    radius = blendRadius * m_scale.height.radius;
		m_search.within(position, radius, near);
		Eigen::Vector3d normal = gate;
		for (int it = 0; it < 2; ++it) {
			const TangentFrame frame(normal);
			samples.reserve(near.size());
			for (const Index a : near) {
				const SurfaceElement& e = m_elements[a];
				if (!e.valid || (e.normal - normal).norm() > jump)
					continue;
				const Eigen::Vector3d        d = (m_anchors.origins().col(a) - position) / radius;
				Eigen::Matrix<double, 10, 1> y;
				y << e.shape(0, 0), e.shape(0, 1), e.shape(0, 2), e.shape(1, 1), e.shape(1, 2),
					e.shape(2, 2), e.normal, (e.position - position).dot(frame.n);
				samples.add(d.dot(frame.u), d.dot(frame.v), ballKernel(d.squaredNorm()) + 1e-9, y);
			}
			const auto v = valueAtOrigin(samples);
			if (!v.allFinite())
				return result;
			normal = v.segment<3>(6).normalized();
			result.shape << v[0], v[1], v[2], v[1], v[3], v[4], v[2], v[4], v[5];
			result.position = position + v[9] * frame.n;
		}
		result.normal = normal;
		result.valid  = normal.allFinite() && result.shape.allFinite();
		return result;
	}

	static Eigen::Matrix3Xd
	positionsOf(const PointCloud& cloud, const std::vector<std::pair<Index, double>>& users)
	{
		Eigen::Matrix3Xd positions(3, users.size());
		for (std::size_t u = 0; u < users.size(); ++u)
			positions.col(u) = cloud.positions.col(users[u].first);
		return positions;
	}

	CurvatureScale              m_scale;
	PointSubsets                m_subsets;
	Eigen::Matrix3Xd            m_users;
	NeighborSearch              m_userSearch;
	SurfaceAnchors              m_anchors;
	bool                        m_direct;
	NeighborSearch              m_search;
	std::vector<SurfaceElement> m_elements;
};

// 1 on a right-angled edge, falling to 0 within the smallest ball's radius.
double featureStrength(const EdgeNearby& edge, double reach)
{
	const double sharpness = std::min(1.0, 2.0 * edge.angle / double(EIGEN_PI));
	return sharpness * ballKernel(edge.distance * edge.distance / (reach * reach));
}

// From the probes around each point, so that scales change gradually.
std::vector<ScaleMixture> mixturesAtPoints(const PointCloud& cloud, const ScaleSelection& selection)
{
	const NeighborSearch      probes(selection.positions);
	std::vector<ScaleMixture> mixtures(cloud.size());
	parallelFor(cloud.size(), {}, [&](Index i) {
		thread_local std::vector<double> share;
		share.assign(selection.scales.size(), 0.0);
		const Eigen::Vector3d position = cloud.positions.col(i);
		const auto            near     = probes.nearest(position, 5);
		const double reach = (selection.positions.col(near.back()) - position).squaredNorm();
		double       total = 0.0;
		for (const Index p : near) {
			const double w =
				ballKernel((selection.positions.col(p) - position).squaredNorm() / reach) + 1e-9;
			for (const auto& [scale, weight] : selection.mixtures[p].weights)
				share[scale] += w * weight;
			mixtures[i].variance += w * selection.mixtures[p].variance;
			total += w;
		}
		mixtures[i].variance /= total;
		const double largest = *std::max_element(share.begin(), share.end());
		for (std::size_t s = 0; s < share.size(); ++s)
			if (share[s] > 0.1 * largest)
				mixtures[i].weights.emplace_back(int(s), share[s]);
	});
	return mixtures;
}

} // namespace

AdaptiveSurface adaptiveSurface(
	const CloudIndex& index, const AdaptiveScaleOptions& options, const Progress& progress)
{
	const PointCloud& cloud = index.cloud();
	AdaptiveSurface   surface;
	surface.elements.resize(cloud.size());
	for (SurfaceElement& element : surface.elements)
		element.normal.setZero();
	for (auto* values : {&surface.radius, &surface.variance, &surface.feature})
		values->setZero(cloud.size());
	if (cloud.size() < minPoints)
		return surface;
	const std::vector<Index>& order = index.shuffled();
	const Eigen::Matrix3Xd&   gate  = index.gateNormals(progress.sub(0.0, 0.05, progressLabel));
	const PointSample         sample(
        {columnsOf(cloud.positions, order), columnsOf(gate, order)}, index.shuffledSearch());
	const ScaleSelection selection =
		selectScales(sample, options, progress.sub(0.05, 0.7, progressLabel));
	const Index n = cloud.size();

	const auto          mixtures = mixturesAtPoints(sample.cloud, selection);
	std::vector<double> shares(n, 0.0);
	for (int s = 0; s < int(selection.scales.size()); ++s) {
		std::vector<std::pair<Index, double>> users;
		for (const Index i : sample.search.spatialOrder())
			for (const auto& [scale, share] : mixtures[i].weights)
				if (scale == s)
					users.emplace_back(i, share);
		if (users.empty())
			continue;
		const CurvatureScale& scale = selection.scales[s];
		progress.report(0.7 + 0.3 * s / double(selection.scales.size()));
		const ScaleField field(
			sample, scale, users, selection.quadricResidual, 1.5 * selection.usualRadius);
		parallelFor(static_cast<Index>(users.size()), {}, [&](Index u) {
			const auto [i, share] = users[u];
			EdgeNearby           edge;
			const SurfaceElement element =
				field.at(i, sample.cloud.positions.col(i), sample.cloud.normals.col(i), edge);
			if (!element.valid)
				return;
			SurfaceElement& mixed = surface.elements[order[i]];
			if (shares[i] > 0.0 && mixed.normal.normalized().dot(element.normal) < sameFace) {
				if (share < shares[i]) // scales that take different faces at an edge do not mix
					return;
				mixed                     = SurfaceElement();
				mixed.normal              = Eigen::Vector3d::Zero();
				surface.radius[order[i]]  = 0.0;
				surface.feature[order[i]] = 0.0;
				shares[i]                 = 0.0;
			}
			surface.feature[order[i]] += share * featureStrength(edge, selection.usualRadius);
			mixed.position += share * element.position;
			mixed.normal += share * element.normal;
			mixed.shape += share * element.shape;
			surface.radius[order[i]] += share * scale.radius();
			shares[i] += share;
		});
	}
	parallelFor(n, {}, [&](Index i) {
		SurfaceElement& mixed = surface.elements[order[i]];
		if (!(shares[i] > 0.0))
			return;
		mixed.position /= shares[i];
		mixed.normal.normalize();
		mixed.shape /= shares[i];
		mixed.valid = mixed.normal.allFinite();
		surface.radius[order[i]] /= shares[i];
		surface.feature[order[i]] /= shares[i];
		surface.variance[order[i]] = mixtures[i].variance;
	});
	return surface;
}

namespace {

constexpr double weightReach = 3.0; // local spacings, as the published operating region
// Points whose residuals give the median: its standard error among so many is below one percent.
constexpr Index  medianPoints    = 32768;
constexpr double agreementCosine = 0.99985; // of one degree
// Radians. On exact clouds the residuals are only what the curvature itself changes over the region.
constexpr double smallestSigma = 3e-3;
// Factor on the published sigma (A09 after eq. 1). The estimate smooths its normals, so the median is small, and the
// published cut would cut smooth parts. By experiment (benchmarks/lines.py).
constexpr double looseness = 3.0;

// Principal curvatures and directions of one element.
void setPrincipal(
	const SurfaceElement& element, const Eigen::Vector3d& given, Index i, CurvatureField& field)
{
	const TangentFrame          frame(element.normal);
	Eigen::Matrix<double, 3, 2> tangents;
	tangents << frame.u, frame.v;
	Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen;
	eigen.computeDirect(Eigen::Matrix2d(tangents.transpose() * element.shape * tangents));
	const Eigen::Vector3d normal =
		element.normal.dot(given) > agreementCosine ? given : element.normal;
	Eigen::Vector3d d1 = tangents * eigen.eigenvectors().col(1);
	d1 -= d1.dot(normal) * normal;
	field.k1[i]     = eigen.eigenvalues()[1];
	field.k2[i]     = eigen.eigenvalues()[0];
	field.d1.col(i) = d1.normalized();
	field.d2.col(i) = normal.cross(field.d1.col(i)).normalized();
}

void setWeights(
	const CloudIndex&      index,
	const AdaptiveSurface& surface,
	CurvatureField&        field,
	const Progress&        progress)
{
	const PointCloud&                cloud   = index.cloud();
	const NeighborSearch&            search  = index.search();
	const std::vector<double>&       spacing = index.minimum().spacing;
	const Index                      n       = cloud.size();
	const RobustCurvatureOptions     published;
	std::vector<std::vector<Index>>  rows(n);
	std::vector<std::vector<double>> residuals(n);
	parallelForPoints(search, progress, [&](Index i) {
		thread_local std::vector<Index>                    foundScratch;
		thread_local std::vector<std::pair<double, Index>> nearScratch;
		auto&                                              found = foundScratch;
		auto&                                              near  = nearScratch;
		const SurfaceElement&                              own   = surface.elements[i];
		if (!own.valid)
			return;
		search.within(cloud.positions.col(i), weightReach * spacing[i], found);
		near.clear();
		for (const Index j : found)
			if (j != i && surface.elements[j].valid)
				near.emplace_back(
					(cloud.positions.col(j) - cloud.positions.col(i)).squaredNorm(), j);
		if (near.size() > static_cast<std::size_t>(published.maxPoints)) {
			std::nth_element(near.begin(), near.begin() + published.maxPoints, near.end());
			near.resize(published.maxPoints);
		}
		std::sort(near.begin(), near.end(), [](const auto& a, const auto& b) {
			return a.second < b.second;
		});
		rows[i].reserve(near.size());
		residuals[i].reserve(near.size());
		for (const auto& [squared, j] : near) {
			const SurfaceElement& other = surface.elements[j];
			const Eigen::Vector3d predicted =
				own.normal + own.shape * (other.position - own.position);
			rows[i].push_back(j);
			residuals[i].push_back((other.normal - predicted).norm());
		}
	});
	// A median of millions needs not all of them.
	std::vector<double> some;
	const Index         stride = 1 + n / medianPoints;
	for (Index i = 0; i < n; i += stride)
		some.insert(some.end(), residuals[i].begin(), residuals[i].end());
	const double median = some.empty() ? 0.0 : medianInPlace(some);
	const double sigma  = std::max(smallestSigma, looseness * published.sigmaFactor * median);
	for (Index i = 0; i < n; ++i) {
		std::size_t kept = 0;
		for (std::size_t k = 0; k < rows[i].size(); ++k) {
			const double t = residuals[i][k] / sigma;
			if (t > published.cut)
				continue;
			rows[i][kept]      = rows[i][k];
			residuals[i][kept] = relativeGemanMcClureWeight(t * t);
			++kept;
		}
		rows[i].resize(kept);
		residuals[i].resize(kept);
	}
	adoptWeights(rows, residuals, field);
}

} // namespace

CurvatureField adaptiveCurvature(
	const CloudIndex& index, const AdaptiveScaleOptions& options, const Progress& progress)
{
	const PointCloud&     cloud = index.cloud();
	const Index           n     = cloud.size();
	const AdaptiveSurface surface =
		adaptiveSurface(index, options, progress.sub(0.0, 0.95, progressLabel));
	CurvatureField field;
	for (auto* values : {&field.k1, &field.k2, &field.error, &field.confidence, &field.height})
		values->setZero(n);
	for (auto* vectors : {&field.d1, &field.d2})
		vectors->resize(3, n);
	field.radius           = surface.radius;
	field.feature          = surface.feature;
	field.correctedNormals = cloud.normals;
	field.status           = index.minimum().status;
	for (Index i = 0; i < n; ++i) {
		const SurfaceElement& element = surface.elements[i];
		const Eigen::Vector3d given   = cloud.normals.col(i);
		if (!element.valid) {
			const TangentFrame frame(given);
			field.d1.col(i) = frame.u;
			field.d2.col(i) = frame.v;
			if (field.status[i] != PointStatus::Isolated)
				field.status[i] = PointStatus::TooFewNeighbors;
			continue;
		}
		setPrincipal(element, given, i, field);
		field.correctedNormals.col(i) = element.normal;
		field.height[i] = element.normal.dot(element.position - cloud.positions.col(i));
		// Of a symmetric 2 x 2 matrix with independent errors of the same size in every direction, k1 - k2
		// has two thirds of the variance.
		field.error[i] = std::sqrt(2.0 / 3.0 * surface.variance[i]);
		if (field.status[i] == PointStatus::TooFewNeighbors)
			field.status[i] = PointStatus::Boundary;
	}
	setWeights(index, surface, field, progress.sub(0.95, 1.0, "Weighing neighbors"));
	return field;
}

} // namespace curvature_lines
