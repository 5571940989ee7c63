// Heights of two kinds around a place, and points of the same side straight above it.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "doubled_layers.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "cloud_index.h"
#include "coordinate_steps.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "quantile.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

constexpr Index  places   = 500;
constexpr Index  around   = 100; // points whose heights are looked at
constexpr double sameSide = 0.7; // cosine
// E z^4 / (E z^2)^2 of heights: 1 of two equal values, 1.5 of two that are five deviations apart, 1.8 of any between two
// bounds, 3 of noise. Of a hundred normal heights none in a million has less than 1.7.
constexpr double twoKinds = 1.5;
// Less is no layer of its own, but the last digit of a file, in spacings (deviation of the heights).
constexpr double thinnest = 0.05;
// A second layer, in spacings. The cone around the normal holds about t^2 of its points at a distance of t.
constexpr double nearest = 1.0, farthest = 4.0;
constexpr double straight  = 0.87; // cosine of 30 degrees
constexpr Index  ofALayer  = 2;    // points in the cone
constexpr double rareShare = 0.01; // nothing is said of less

class Layers {
public:
	Layers(const PointCloud& given, const PointCloud& denoised) :
			m_given(given), m_denoised(denoised), m_search(denoised.positions)
	{
	}

	bool twoKindsOfHeights(Index i, double spacing) const
	{
		const Vector3d n      = m_denoised.normals.col(i);
		double         second = 0.0, fourth = 0.0, count = 0.0;
		for (const Index j : m_search.nearest(m_denoised.positions.col(i), around)) {
			const Vector3d normal = m_denoised.normals.col(j);
			if (normal.dot(n) < sameSide)
				continue;
			const double z = (m_given.positions.col(j) - m_denoised.positions.col(j)).dot(normal);
			second += z * z;
			fourth += z * z * z * z;
			count += 1.0;
		}
		return count >= 0.5 * around && second > count * std::pow(thinnest * spacing, 2) &&
		       fourth * count < twoKinds * second * second;
	}

	bool anotherLayer(Index i, double spacing) const
	{
		const Vector3d n = m_denoised.normals.col(i), p = m_denoised.positions.col(i);
		thread_local std::vector<Index> near;
		m_search.within(p, farthest * spacing, near);
		Index count = 0;
		for (const Index j : near) {
			const Vector3d d      = m_denoised.positions.col(j) - p;
			const double   length = d.norm();
			count += length > nearest * spacing && std::abs(d.dot(n)) > straight * length &&
			         m_denoised.normals.col(j).dot(n) > sameSide;
		}
		return count >= ofALayer;
	}

private:
	const PointCloud&    m_given;
	const PointCloud&    m_denoised;
	const NeighborSearch m_search;
};

} // namespace

double doubledShare(const CloudIndex& given, const PointCloud& denoised, const Progress& progress)
{
	const Index n = given.size();
	if (n < around)
		return 0.0;
	const std::vector<double>& spacing = given.spacing();
	const Layers               layers(given.cloud(), denoised);
	const std::vector<Index>   sample = given.order().sample(places);
	std::vector<char>          doubled(sample.size());
	parallelFor(static_cast<Index>(sample.size()), progress, [&](Index k) {
		const Index  i = given.order().source[sample[k]];
		const double h = spacing[sample[k]];
		doubled[k]     = layers.twoKindsOfHeights(i, h) || layers.anotherLayer(i, h);
	});
	const double share =
		double(std::count(doubled.begin(), doubled.end(), char(1))) / double(sample.size());
	std::vector<double> spacings = spacing;
	if (share < rareShare ||
	    spreadOverSteps(given.cloud().positions, medianInPlace(spacings)).any())
		return 0.0;
	return share;
}

} // namespace curvature_lines
