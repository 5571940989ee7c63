// Residuals of quadrics of rising radius, pooled around every sample point.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "noise_estimate.h"

#include <algorithm>
#include <cmath>

#include "quantile.h"

namespace curvature_lines {

namespace {

constexpr double step         = 1.26;
constexpr int    maxSteps     = 12;
constexpr double fewestPatches = 6.0; // in a cloud, of n / radius^2 points
constexpr Index  fewestSites  = 2000;
constexpr Index  mostSites    = 8000;
constexpr Index  sitesPerPool = 64;
constexpr Index  sitesPerPoint = 8;
constexpr Index  fewestPools  = 20; // in fewer, every pool may reach an edge
constexpr double lowestQuarter = 0.25; // belongs to patches off the edges
constexpr double evenness     = 1.6;   // of the quantiles below: what pools differ by when the noise is even
constexpr double tail         = 0.05;
constexpr double minNoise     = 1e-10; // of exact samples, a length
constexpr double deepest      = 1e-3;  // of the median

// Of a mean of squares of `degrees` normal deviates; Wilson and Hilferty.
double lowerQuartile(double degrees)
{
	const double spread = 2.0 / (9.0 * std::max(1.0, degrees));
	return std::pow(1.0 - spread - 0.6744898 * std::sqrt(spread), 3);
}

// Evenly spread: where the density jumps, so may the noise, and the dense side must not speak for both.
std::vector<Index> sitesOf(const BlendInput& input)
{
	const Index         n      = input.cloud.size();
	std::vector<double> sorted = input.spacing;
	const double        usual  = medianInPlace(sorted);
	const double        wanted = std::clamp(n / 4, fewestSites, mostSites);
	std::vector<Index>  sites;
	for (Index i = 0; i < n; ++i) {
		const double ratio = input.spacing[i] / usual;
		if (input.order.rank[i] < wanted * ratio * ratio)
			sites.push_back(i);
	}
	return sites;
}

class NoiseLadder {
public:
	explicit NoiseLadder(BlendInput&& input) :
			m_input(std::move(input)),
			m_sites(sitesOf(m_input)),
			m_places(columnsOf(m_input.cloud.positions, m_sites)), m_siteSearch(m_places),
			m_square(m_sites.size(), -1.0), m_noise(m_sites.size(), 0.0),
			m_done(m_sites.size(), 0)
	{
		m_input.noise.assign(m_input.cloud.size(), 0.0);
	}

	void climb(const Progress& progress)
	{
		const BlendGuide     guide{m_input.cloud.positions, m_input.cloud.normals};
		const NeighborSearch search(guide.positions);
		BlendOptions         options;
		options.radius = smallestPatch;
		for (int k = 0; k < maxSteps; ++k, options.radius *= step) {
			const Progress part = progress.sub(
				double(k) / maxSteps, double(k + 1) / maxSteps, "Measuring the noise");
			parallelFor(sites(), part, [&](Index s) {
				if (!m_done[s])
					fit(s, guide, options, search);
			});
			parallelFor(sites(), {}, [&](Index s) {
				if (!m_done[s])
					m_noise[s] = noiseAround(s);
			});
			const double next = options.radius * step;
			const bool   last = next * next * fewestPatches > double(m_input.cloud.size());
			bool         all  = true;
			for (Index s = 0; s < sites(); ++s) {
				const Index i = m_sites[s];
				m_input.noise[i] = m_noise[s];
				m_done[s] = m_noise[s] * minRadiusNoise < options.radius * m_input.spacing[i];
				all &= m_done[s] != 0;
			}
			if (all || last)
				break;
		}
	}

	std::vector<double> atPoints() const
	{
		const Index         n = m_input.cloud.size();
		std::vector<double> sorted = m_noise;
		const double        low = quantileInPlace(sorted, tail);
		const double        high = quantileInPlace(sorted, 1.0 - tail);
		const double        median = std::max(minNoise, medianInPlace(sorted));
		const bool          few = sites() < fewestPools * sitesPerPool;
		if (few || high <= evenness * low || high <= minNoise)
			return std::vector<double>(n, std::max(minNoise, everywhere()));
		std::vector<double> noise(n);
		parallelFor(n, {}, [&](Index i) {
			double sum = 0.0;
			const auto near = m_siteSearch.nearest(m_input.cloud.positions.col(i), sitesPerPoint);
			for (const Index s : near)
				sum += std::log(std::max(m_noise[s], deepest * median));
			noise[i] = std::exp(sum / double(near.size()));
		});
		return noise;
	}

private:
	Index sites() const { return static_cast<Index>(m_sites.size()); }

	void fit(Index s, const BlendGuide& guide, const BlendOptions& options, const NeighborSearch& search)
	{
		const SurfacePatch patch = patchAt(m_input, guide, options, search, m_sites[s]).surface;
		if (patch.valid)
			m_square[s] = patch.scale * patch.scale /
						  lowerQuartile(patch.effectiveCount - SurfacePatch::Fit::count);
	}

	double noiseAround(Index s) const
	{
		thread_local std::vector<double> pool;
		pool.clear();
		for (const Index t : m_siteSearch.nearest(m_places.col(s), sitesPerPool))
			if (m_square[t] >= 0.0)
				pool.push_back(m_square[t]);
		return pool.empty() ? 0.0 : std::sqrt(quantileInPlace(pool, lowestQuarter));
	}

	double everywhere() const
	{
		std::vector<double> pool;
		for (const double square : m_square)
			if (square >= 0.0)
				pool.push_back(square);
		return pool.empty() ? 0.0 : std::sqrt(quantileInPlace(pool, lowestQuarter));
	}

	BlendInput             m_input;
	std::vector<Index>     m_sites;
	const Eigen::Matrix3Xd m_places; // of the sites
	const NeighborSearch   m_siteSearch;
	std::vector<double>    m_square; // per site: squared noise by its own patch; negative: unknown
	std::vector<double>    m_noise;  // per site, of its pool
	std::vector<char>      m_done;   // per site: its patch is wider than the noise
};

} // namespace

std::vector<double>
localSpacing(const PointCloud& cloud, const SpatialOrder& order, const Progress& progress)
{
	constexpr Index      k = 16, averaged = 32, thinning = 8;
	const Index          n = cloud.size();
	const NeighborSearch search(cloud.positions);
	std::vector<double>  raw(n), smooth(n);
	parallelFor(n, progress.sub(0.0, 0.5, "Finding neighbors"), [&](Index i) {
		const std::vector<Index> near = search.nearest(cloud.positions.col(i), k + 1);
		const double distance = (cloud.positions.col(near.back()) - cloud.positions.col(i)).norm();
		raw[i]                = distance * std::sqrt(EIGEN_PI / (near.size() - 1.0));
	});
	const std::vector<Index> sample =
		order.sample(std::max(std::min(n, averaged), n / thinning));
	const Eigen::Matrix3Xd places = columnsOf(cloud.positions, sample);
	const NeighborSearch   sampleSearch(places);
	parallelFor(n, progress.sub(0.5, 1.0, "Finding neighbors"), [&](Index i) {
		const std::vector<Index> near = sampleSearch.nearest(cloud.positions.col(i), averaged);
		double                   sum  = 0.0;
		for (const Index j : near)
			sum += std::log(raw[sample[j]]);
		smooth[i] = std::exp(sum / double(near.size()));
	});
	return smooth;
}

std::vector<double> estimateNoise(BlendInput input, const Progress& progress)
{
	NoiseLadder ladder(std::move(input));
	ladder.climb(progress);
	return ladder.atPoints();
}

} // namespace curvature_lines
