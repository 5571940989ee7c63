// Bends from the estimate, limbs from the largest balls inside the surface, components from links between neighbours;
// graded along these links.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "sizing_field.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>

#include "cloud_index.h"
#include "curvature_field.h"
#include "disjoint_sets.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "quantile.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

constexpr double fullCircle = 2.0 * EIGEN_PI;
// Area a point stands for over its squared spacing (mean distance to neighbours in six directions): between .67, random
// points, and .87, a hexagonal grid. The scaffold, whose area is known, corrects it.
constexpr double areaPerSpacing = 0.75;
// A curvature counts as far as it is sure: less so many standard errors.
constexpr double sureErrors = 2.0;
// Shrinking ball (Ma, Bae and Choi 2012): steps at most, and the cosine of the angle between its two points seen from its
// centre above which the second is a neighbour of the first that noise put inside.
constexpr int    ballSteps      = 30;
constexpr double sameSideCosine = 0.7;
// A limb: within so many radii of the ball's centre some normal opposes (cosine) that of the point, and the normals within
// so many radii point all around: the second eigenvalue of their mean square, 1/2 of a cylinder, 1/3 of a sphere, 0 of a
// plate.
constexpr double opposedReach = 1.6, opposedCosine = -0.6;
constexpr double limbReach = 3.0, limbEigenvalue = 0.25;
// Of denser clouds a random part is asked for these normals that has about so many points there.
constexpr double limbPoints = 96.0;
// Edges are no shorter than the spacing of the points, on limbs than this share of it.
constexpr double shortestOnLimb = 0.5;
// Points of a component are linked to so many around them, whatever their normals, which may be wrong. Links are shorter
// than so many spacings; components have at least so many points.
constexpr Index  linked            = 6;
constexpr double longestLink       = 3.0;
constexpr Index  fewestInComponent = 12;
// Vertices over the target beyond which features get coarser: one that nobody asked for, and one that somebody did.
constexpr double mostAutomatic = 2.0, mostAsked = 1.02;
// So much coarser at most; limbs keep SizingOptions::fewestAroundLimb.
constexpr double mostCoarsening  = 4.0;
constexpr int    coarseningSteps = 6, bodySteps = 40;

// Random parts of a cloud, each a quarter of the one before.
class RandomParts {
public:
	explicit RandomParts(const CloudIndex& index) : m_all(index.cloud())
	{
		const std::vector<Index>& order = index.shuffled();
		for (std::size_t size = order.size() / 4; size > 200; size /= 4) {
			m_parts.push_back(columnsOf(index.cloud(), {order.begin(), order.begin() + size}));
		}
		m_searches.push_back(index.search());
		for (const PointCloud& part : m_parts)
			m_searches.emplace_back(part.positions);
	}
	RandomParts(const RandomParts&) = delete;

	// Where about `expected` points of the whole are, the part that has about limbPoints of them.
	std::size_t levelFor(double expected) const
	{
		std::size_t level = 0;
		for (; level + 1 < m_searches.size() && expected > limbPoints; ++level)
			expected /= 4.0;
		return level;
	}
	const PointCloud& cloud(std::size_t level) const
	{
		return level == 0 ? m_all : m_parts[level - 1];
	}
	const NeighborSearch& search(std::size_t level) const { return m_searches[level]; }

private:
	const PointCloud&           m_all;
	std::vector<PointCloud>     m_parts;
	std::vector<NeighborSearch> m_searches;
};

class Sizing {
public:
	Sizing(const CloudIndex& index, const CurvatureField& curvature, const SizingOptions& options) :
			m_cloud(index.cloud()), m_search(index.search()), m_minimum(index.minimum()),
			m_count(index.size()), m_options(options), m_spacing(index.size()),
			m_area(index.size()), m_component(index.size())
	{
		for (Index i = 0; i < m_count; ++i) {
			double sum = m_minimum.spacing[i];
			for (const Index j : m_minimum.neighbors[i])
				sum += m_minimum.spacing[j];
			m_spacing[i] = sum / (m_minimum.neighbors[i].size() + 1.0);
			m_area[i]    = areaPerSpacing * m_spacing[i] * m_spacing[i];
		}
		m_uniform = std::sqrt(m_area.sum() / options.targetVertices);
		findComponents();
		findBends(curvature);
		findLimbs(RandomParts(index));
	}

	SizingField field() const
	{
		const double longest = (m_options.automatic ? 1.0 : m_options.mostBody) * m_uniform;
		const double limit =
			(m_options.automatic ? mostAutomatic : mostAsked) * m_options.targetVertices;
		SizingField result;
		result.spacing = m_spacing;
		result.limb    = m_limb * (m_options.aroundLimb / fullCircle);
		result.feature = graded(1.0, longest);
		if (countOf(result.feature, longest) > limit) {
			double low = 1.0, high = mostCoarsening;
			for (int k = 0; k < coarseningSteps; ++k) {
				const double middle = 0.5 * (low + high);
				(countOf(graded(middle, longest), longest) > limit ? low : high) = middle;
			}
			result.feature = graded(high, longest);
		}
		result.body     = m_options.automatic
		                      ? m_uniform
		                      : bodyFor(m_area, result.feature, m_options.targetVertices, longest);
		result.expected = countOf(result.feature, result.body);
		return result;
	}

private:
	double countOf(const Eigen::VectorXd& feature, double body) const
	{
		return (m_area.array() / feature.array().min(body).square()).sum();
	}

	// Of a point and its neighbours: an estimate in seven may be wrong.
	double medianAround(const Eigen::VectorXd& values, Index i) const
	{
		std::vector<double> near = {values[i]};
		for (const Index j : m_minimum.neighbors[i])
			near.push_back(values[j]);
		return medianInPlace(near);
	}

	// The longest edge that gives each component its faces; INFINITY for specks.
	void findComponents()
	{
		DisjointSets sets(m_count);
		for (Index i = 0; i < m_count; ++i)
			for (const Index j : m_search.nearest(m_cloud.positions.col(i), linked + 1))
				if ((m_cloud.positions.col(i) - m_cloud.positions.col(j)).norm() <
				    longestLink * m_spacing[i])
					sets.join(i, j);
		std::vector<Index>  count(m_count, 0);
		std::vector<double> area(m_count, 0.0);
		for (Index i = 0; i < m_count; ++i) {
			++count[sets.find(i)];
			area[sets.find(i)] += m_area[i];
		}
		for (Index i = 0; i < m_count; ++i) {
			const Index set = sets.find(i);
			m_component[i]  = count[set] < fewestInComponent
			                      ? double(INFINITY)
			                      : std::sqrt(area[set] / m_options.componentFaces);
		}
	}

	void findBends(const CurvatureField& curvature)
	{
		Eigen::VectorXd bend(m_count);
		for (Index i = 0; i < m_count; ++i) {
			const double largest = std::max(std::abs(curvature.k1[i]), std::abs(curvature.k2[i]));
			bend[i]              = std::max(0.0, largest - sureErrors * curvature.error[i]);
		}
		m_bend.resize(m_count);
		for (Index i = 0; i < m_count; ++i)
			m_bend[i] = m_options.longestAcrossBend / (medianAround(bend, i) + 1e-9);
	}

	// Radius of the largest ball inside the surface that touches it at point i, up to `largest`.
	double insideBall(Index i, double largest) const
	{
		const Vector3d p = m_cloud.positions.col(i), n = m_cloud.normals.col(i);
		double         radius = largest;
		for (int k = 0; k < ballSteps; ++k) {
			const Vector3d center = p - radius * n;
			const auto     near   = m_search.nearest(center, 2);
			const Vector3d q      = m_cloud.positions.col(near[0] == i ? near.back() : near[0]);
			const double   depth  = n.dot(p - q);
			if ((q - center).norm() >= radius * (1.0 - 1e-6) || !(depth > 0.0))
				break;
			const double   next = (p - q).squaredNorm() / (2.0 * depth);
			const Vector3d from = p - next * n; // the next centre
			if (!(next < radius) || (q - from).normalized().dot(n) > sameSideCosine)
				break;
			radius = next;
		}
		return radius;
	}

	void findLimbs(const RandomParts& parts)
	{
		const double    quads = fullCircle / m_options.aroundLimb; // edge over the radius of a limb
		const double    largest = 2.0 * m_uniform / quads;
		Eigen::VectorXd ball(m_count);
		parallelForPoints(m_search, {}, [&](Index i) { ball[i] = insideBall(i, largest); });
		m_limb.setConstant(m_count, INFINITY);
		parallelForPoints(m_search, {}, [&](Index i) {
			const double radius = medianAround(ball, i);
			if (radius < 0.999 * largest && isLimb(i, radius, parts))
				m_limb[i] = quads * radius;
		});
	}

	bool isLimb(Index i, double radius, const RandomParts& parts) const
	{
		const Vector3d normal = m_cloud.normals.col(i);
		const Vector3d center = m_cloud.positions.col(i) - radius * normal;
		const double   reach  = limbReach * radius;
		// Of a cylinder.
		const std::size_t  level = parts.levelFor(2.0 * fullCircle * radius * reach / m_area[i]);
		const PointCloud&  part  = parts.cloud(level);
		std::vector<Index> found;
		parts.search(level).within(center, reach, found);
		Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
		bool            opposed = false;
		for (const Index j : found) {
			const Vector3d other = part.normals.col(j);
			squares += other * other.transpose();
			opposed = opposed || (other.dot(normal) < opposedCosine &&
			                      (part.positions.col(j) - center).norm() < opposedReach * radius);
		}
		if (!opposed)
			return false;
		squares /= double(found.size());
		const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
			squares, Eigen::EigenvaluesOnly);
		return solver.eigenvalues()[1] >= limbEigenvalue;
	}

	// What bends and limbs allow, `coarser` times as long, and components, where it is below `longest`.
	Eigen::VectorXd graded(double coarser, double longest) const
	{
		const double mostOnLimb = std::max(1.0, m_options.aroundLimb / m_options.fewestAroundLimb);
		using Entry             = std::pair<double, Index>;
		Eigen::VectorXd    size(m_count);
		std::vector<Entry> start;
		for (Index i = 0; i < m_count; ++i) {
			const double bend = std::max(coarser * m_bend[i], m_spacing[i]);
			const double limb =
				std::max(std::min(coarser, mostOnLimb) * m_limb[i], shortestOnLimb * m_spacing[i]);
			size[i] = std::min({bend, limb, m_component[i]});
			if (size[i] < longest)
				start.emplace_back(size[i], i);
			else
				size[i] = INFINITY;
		}
		std::priority_queue queue(std::greater<Entry>(), std::move(start));
		while (!queue.empty()) {
			const auto [here, i] = queue.top();
			queue.pop();
			if (here > size[i])
				continue;
			for (const Index j : m_minimum.neighbors[i]) {
				const double step = (m_cloud.positions.col(i) - m_cloud.positions.col(j)).norm();
				const double next = here + m_options.gradation * step;
				if (next < size[j] && next < longest) {
					size[j] = next;
					queue.emplace(next, j);
				}
			}
		}
		return size;
	}

	const PointCloud&           m_cloud;
	const NeighborSearch&       m_search;
	const MinimumNeighborhoods& m_minimum;
	const Index                 m_count;
	const SizingOptions&        m_options;
	Eigen::VectorXd             m_spacing, m_area, m_component;
	Eigen::VectorXd             m_bend, m_limb;  // longest edges they allow
	double                      m_uniform = 0.0; // edge if it were the same everywhere
};

} // namespace

double bodyFor(
	const Eigen::VectorXd& areas, const Eigen::VectorXd& feature, double vertices, double longest)
{
	const auto count = [&](double body) {
		return (areas.array() / feature.array().min(body).square()).sum();
	};
	if (count(longest) >= vertices)
		return longest;
	double low = 1e-3 * longest, high = longest;
	for (int k = 0; k < bodySteps; ++k) {
		const double middle                     = std::sqrt(low * high);
		(count(middle) > vertices ? low : high) = middle;
	}
	return high;
}

SizingField sizingField(
	const CloudIndex&     index,
	const CurvatureField& curvature,
	const SizingOptions&  options,
	const Progress&       progress)
{
	index.minimum(progress);
	return Sizing(index, curvature, options).field();
}

} // namespace curvature_lines
