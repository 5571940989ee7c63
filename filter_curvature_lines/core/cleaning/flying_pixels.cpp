// Sheets between two surfaces are told by the jump in density at both ends, single points by the raster around them.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "flying_pixels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "neighborhoods.h"
#include "outlier_voter.h"
#include "point_cloud.h"
#include "progress.h"
#include "quantile.h"

namespace curvature_lines {

namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// By experiment on scenes of a depth camera and of a terrestrial scanner, and on solids and scans without flying pixels.

// Fair samples of the cloud, each that many times thinner than the one before, down to so many points: they show what is
// around a point at all distances in little time.
constexpr Index thinning     = 8;
constexpr Index fewestSample = 20;
constexpr Index nearestSeen  = 100; // points of each sample
constexpr Index nearestAsked = 24;  // points of a sample that tell how dense it is around
// Distance to the 6th neighbour over its median in the cloud: no flying pixel has less. Without this, points of a surface
// between dense clusters of outliers would be pixels.
constexpr double sparser = 2.5;

// Distance to the 6th neighbour over that of the surfaces at both ends: of seeds, and of points linked to them.
constexpr double seedSparseness = 8.0;
constexpr double linkSparseness = 6.5;
// Two ends are opposite when the cosine between the directions to them is below this: they are on one ray.
constexpr double opposite = -0.97;
// A sheet of one pixel per row has one point per h L (h: distance of rows, L: length along the ray). Its 6th neighbour
// is at c = sqrt(6 h L / pi), that of the surface at its end at e = sqrt(6 / pi) h: L = .72 c^2 / e. Sheets of several
// pixels are longer at the same c, those of which pixels are missing are shorter.
constexpr double longestSheet = 0.5;
constexpr double farthestEnd  = 1.0; // as longestSheet, of one end of a sheet with missing pixels
constexpr double linkReach    = 2.0; // times the distance to the 6th neighbour

// Lone pixels: neighbours looked at, those whose nearest point is at the median distance within the tolerance; distance to
// the 6th nearest point over the least around.
constexpr Index  rasterNeighbors = 24;
constexpr Index  regularOnes     = 12;
constexpr double regular         = 0.1;
constexpr double loneSparseness  = 1.3;
constexpr double loneOpposite    = -0.95;
// A cloud is a raster when this share of a sample of so many points has nearly all neighbours at the median distance.
constexpr double rasterShare        = 0.85;
constexpr Index  rasterSample       = 2000;
constexpr Index  regularOnesOfCloud = 18;

struct End {
	Vector3d direction; // unit
	double   distance, crowding;
};

class Surroundings {
public:
	explicit Surroundings(const VoterCloud& cloud);
	bool empty() const { return m_samples.empty(); }
	bool isSparse(Index i) const { return m_cloud.crowding[i] > m_sparse; }
	double leastCrowding(Index i) const;
	// Points of all samples around point i up to a distance with crowding below a limit.
	void ends(Index i, double crowdingBelow, double within, std::vector<End>& found) const;

private:
	struct Sample {
		std::vector<Index> points;
		Matrix3Xd          positions;
	};

	const VoterCloud&           m_cloud;
	std::vector<Sample>         m_samples;
	std::vector<NeighborSearch> m_searches;
	double                      m_sparse = 0.0; // crowding
};

Surroundings::Surroundings(const VoterCloud& cloud) : m_cloud(cloud)
{
	const auto size = static_cast<Index>(cloud.positions.cols());
	for (Index step = thinning; size / step >= fewestSample; step *= thinning) {
		Sample sample;
		for (Index i = 0; i < size; ++i)
			if (cloud.rank[i] % step == 0)
				sample.points.push_back(i);
		sample.positions = columnsOf(cloud.positions, sample.points);
		m_samples.push_back(std::move(sample));
	}
	for (const Sample& sample : m_samples)
		m_searches.emplace_back(sample.positions);
	std::vector<double> crowding = cloud.crowding;
	m_sparse                     = crowding.empty() ? 0.0 : sparser * medianInPlace(crowding);
}

// Ends of a sheet through the point are no farther than the sheet is long. In the middle of one the nearest points of the
// densest sample are all on the sheet.
double Surroundings::leastCrowding(Index i) const
{
	const Vector3d p     = m_cloud.positions.col(i);
	const double   own   = m_cloud.crowding[i];
	double         least = own;
	for (std::size_t s = 0; s < m_samples.size(); ++s)
		for (const Index k : m_searches[s].nearest(p, nearestAsked)) {
			const double crowding = m_cloud.crowding[m_samples[s].points[k]];
			if (crowding < least &&
			    (m_samples[s].positions.col(k) - p).norm() * crowding < farthestEnd * own * own)
				least = crowding;
		}
	return least;
}

void Surroundings::ends(Index i, double crowdingBelow, double within, std::vector<End>& found) const
{
	const Vector3d p = m_cloud.positions.col(i);
	for (std::size_t s = 0; s < m_samples.size(); ++s)
		for (const Index k : m_searches[s].nearest(p, nearestSeen)) {
			const Vector3d d        = m_samples[s].positions.col(k) - p;
			const double   distance = d.norm();
			const double   crowding = m_cloud.crowding[m_samples[s].points[k]];
			if (distance > within)
				return; // the thinner samples are parts of this one
			if (crowding < crowdingBelow && distance > 0.0)
				found.push_back({d / distance, distance, crowding});
		}
}

bool isSeed(const std::vector<End>& ends, double crowding)
{
	for (std::size_t a = 0; a < ends.size(); ++a)
		for (std::size_t b = 0; b < a; ++b)
			if (ends[a].direction.dot(ends[b].direction) < opposite &&
			    (ends[a].distance + ends[b].distance) *
			            std::min(ends[a].crowding, ends[b].crowding) <
			        longestSheet * crowding * crowding)
				return true;
	return false;
}

bool anyOpposite(const std::vector<End>& ends, double cosine)
{
	for (std::size_t a = 0; a < ends.size(); ++a)
		for (std::size_t b = 0; b < a; ++b)
			if (ends[a].direction.dot(ends[b].direction) < cosine)
				return true;
	return false;
}

// Distances to the nearest and to the second nearest point.
struct NearestTwo {
	double first = 0.0, second = 0.0;
};

NearestTwo nearestTwo(const VoterCloud& cloud, Index i)
{
	const Vector3d p       = cloud.positions.col(i);
	const auto     nearest = cloud.all.nearest(p, 3);
	return {
		(cloud.positions.col(nearest[1]) - p).norm(), (cloud.positions.col(nearest[2]) - p).norm()};
}

struct Raster {
	double second      = 0.0; // nearestTwo, median over the neighbours
	Index  regularOnes = 0;
};

Raster rasterAround(const VoterCloud& cloud, Index i)
{
	std::vector<double> first, second;
	for (const Index j : cloud.all.nearest(cloud.positions.col(i), rasterNeighbors + 1))
		if (j != i) {
			const NearestTwo two = nearestTwo(cloud, j);
			first.push_back(two.first);
			second.push_back(two.second);
		}
	Raster       raster;
	const double usual = medianInPlace(first);
	raster.second      = medianInPlace(second);
	raster.regularOnes =
		static_cast<Index>(std::count_if(first.begin(), first.end(), [&](double d) {
			return std::abs(d - usual) <= regular * usual;
		}));
	return raster;
}

bool isRaster(const VoterCloud& cloud, const Progress& progress)
{
	std::vector<Index> sample;
	for (std::size_t i = 0; i < cloud.rank.size(); ++i)
		if (cloud.rank[i] < rasterSample)
			sample.push_back(static_cast<Index>(i));
	std::vector<char> regularOnes(sample.size());
	parallelFor(static_cast<Index>(sample.size()), progress, [&](Index k) {
		regularOnes[k] = rasterAround(cloud, sample[k]).regularOnes >= regularOnesOfCloud;
	});
	return double(std::count(regularOnes.begin(), regularOnes.end(), char(1))) >=
	       rasterShare * double(sample.size());
}

} // namespace

std::vector<char> findFlyingPixels(const VoterCloud& cloud, const Progress& progress)
{
	const auto         size = static_cast<Index>(cloud.positions.cols());
	std::vector<char>  flagged(size, 0), sparse(size, 0);
	const Surroundings around(cloud);
	if (around.empty())
		return flagged;
	parallelFor(size, progress, [&](Index i) {
		if (!around.isSparse(i))
			return;
		const double crowding = cloud.crowding[i];
		const double least    = around.leastCrowding(i);
		sparse[i]             = least * linkSparseness < crowding;
		if (!(least > 0.0) || least * seedSparseness >= crowding)
			return;
		thread_local std::vector<End> ends;
		ends.clear();
		around.ends(i, crowding / seedSparseness, longestSheet * crowding * crowding / least, ends);
		flagged[i] = isSeed(ends, crowding);
	});
	std::vector<Index> front, near;
	for (Index i = 0; i < size; ++i)
		if (flagged[i])
			front.push_back(i);
	for (std::size_t f = 0; f < front.size(); ++f) {
		const Index i = front[f];
		cloud.all.within(cloud.positions.col(i), linkReach * cloud.crowding[i], near);
		for (const Index j : near)
			if (sparse[j] && !flagged[j]) {
				flagged[j] = 1;
				front.push_back(j);
			}
	}
	return flagged;
}

std::vector<char> findLoneMixedPixels(
	const VoterCloud&        cloud,
	const std::vector<char>& candidates,
	double                   isolation,
	const Progress&          progress)
{
	std::vector<char>  flagged(candidates.size(), 0);
	std::vector<Index> judged;
	for (std::size_t i = 0; i < candidates.size(); ++i)
		if (candidates[i])
			judged.push_back(static_cast<Index>(i));
	if (static_cast<Index>(candidates.size()) < thinning * fewestSample || judged.empty() ||
	    !isRaster(cloud, progress.sub(0.0, 0.5, "Finding flying pixels")))
		return flagged;
	const Surroundings around(cloud);
	parallelFor(
		static_cast<Index>(judged.size()),
		progress.sub(0.5, 1.0, "Finding flying pixels"),
		[&](Index k) {
			const Index  i     = judged[k];
			const double least = around.leastCrowding(i);
			if (!(cloud.crowding[i] > loneSparseness * least))
				return;
			const Raster raster = rasterAround(cloud, i);
			if (raster.regularOnes < regularOnes ||
		        !(nearestTwo(cloud, i).second > isolation * raster.second))
				return;
			std::vector<End> ends;
			around.ends(i, cloud.crowding[i], std::numeric_limits<double>::infinity(), ends);
			flagged[i] = anyOpposite(ends, loneOpposite);
		});
	return flagged;
}

} // namespace curvature_lines
