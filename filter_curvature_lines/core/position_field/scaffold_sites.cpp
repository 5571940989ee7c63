// Thinning, and samples of creases at even distances.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "scaffold_sites.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "neighborhoods.h"
#include "point_cloud.h"
#include "point_subsets.h"
#include "polygon_mesh.h"
#include "progress.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// Distance of crease samples over the clearance: further apart, the front crosses between them; nearer, it
// cuts off the corners where creases meet. By experiment on cubes (.7 over .75).
constexpr double creaseStep = 0.93;
// Mean distance to so many neighbours of points thinned to distance 1 at random. Measured.
constexpr Index  neighborsAround = 6;
constexpr double evenSites       = 1.5;

// Creases as vertices and the edges between them.
struct CreaseSamples {
	std::vector<Vector3d>                points;
	std::vector<std::pair<Index, Index>> edges;
};

// `stepAt`: wanted between samples, of a position.
template<class Step>
CreaseSamples sampleCreases(const std::vector<FeatureLine>& creases, const Step& stepAt)
{
	CreaseSamples                          samples;
	std::map<std::array<double, 3>, Index> ends; // lines that meet share the vertex
	const auto                             endVertex = [&](const Vector3d& p) {
        const auto found =
            ends.try_emplace({p.x(), p.y(), p.z()}, static_cast<Index>(samples.points.size()));
        if (found.second)
            samples.points.push_back(p);
        return found.first->second;
	};
	for (const FeatureLine& crease : creases) {
		std::vector<Vector3d> corners;
		for (Eigen::Index k = 0; k < crease.points.cols(); ++k)
			if (corners.empty() || corners.back() != Vector3d(crease.points.col(k)))
				corners.push_back(crease.points.col(k));
		if (crease.closed && corners.size() > 2 && corners.front() != corners.back())
			corners.push_back(corners.front());
		if (corners.size() < 2)
			continue;
		std::vector<double> arc = {0.0}; // in steps
		for (std::size_t k = 1; k < corners.size(); ++k) {
			const Vector3d middle = 0.5 * (corners[k] + corners[k - 1]);
			arc.push_back(arc.back() + (corners[k] - corners[k - 1]).norm() / stepAt(middle));
		}
		const Index least  = crease.closed ? 3 : 1;
		const Index pieces = std::max(least, static_cast<Index>(std::ceil(arc.back())));
		Index       last   = endVertex(corners.front());
		for (Index k = 1; k <= pieces; ++k) {
			Index next = -1;
			if (k == pieces) {
				next = endVertex(corners.back());
			}
			else {
				const double s = arc.back() * k / pieces;
				const auto   i = std::clamp<std::ptrdiff_t>(
                    std::upper_bound(arc.begin(), arc.end(), s) - arc.begin(), 1, arc.size() - 1);
				const double t = (s - arc[i - 1]) / (arc[i] - arc[i - 1]);
				next           = static_cast<Index>(samples.points.size());
				samples.points.push_back(corners[i - 1] + t * (corners[i] - corners[i - 1]));
			}
			if (next != last)
				samples.edges.emplace_back(last, next);
			last = next;
		}
	}
	return samples;
}

Eigen::VectorXd distancesAround(const ScaffoldSites& sites)
{
	const NeighborSearch search(sites.points);
	Eigen::VectorXd      around(sites.size());
	parallelFor(sites.size(), {}, [&](Index i) {
		const Vector3d p   = sites.points.col(i);
		double         sum = 0.0;
		for (const Index j : search.nearest(p, neighborsAround + 1))
			sum += (sites.points.col(j) - p).norm() / neighborsAround;
		around[i] = std::max(sites.distance[i], sum / evenSites);
	});
	return around;
}

} // namespace

void ScaffoldSites::appendCopies(const std::vector<Index>& which)
{
	const Index before = size(), total = before + static_cast<Index>(which.size());
	points.conservativeResize(3, total);
	normals.conservativeResize(3, total);
	distance.conservativeResize(total);
	around.conservativeResize(total);
	for (Index k = before; k < total; ++k) {
		const Index from = which[k - before];
		points.col(k)    = points.col(from);
		normals.col(k)   = normals.col(from);
		distance[k]      = distance[from];
		around[k]        = around[from];
		source.push_back(source[from]);
		place.push_back(place[from]);
	}
}

ScaffoldSites chooseSites(
	const PointSample&              sample,
	const std::vector<Index>&       order,
	const std::vector<FeatureLine>& creases,
	const Eigen::VectorXd&          distance,
	const Eigen::VectorXd&          clearance)
{
	const auto          nearest = [&](const Vector3d& p) { return sample.search.nearest(p, 1)[0]; };
	const CreaseSamples samples = sampleCreases(
		creases, [&](const Vector3d& p) { return creaseStep * clearance[nearest(p)]; });
	const Eigen::Matrix3Xd onCreases = asColumns(samples.points);

	std::vector<Index> chosen = thin(sample, distance);
	if (onCreases.cols() > 0) {
		const NeighborSearch search(onCreases);
		chosen.erase(
			std::remove_if(
				chosen.begin(),
				chosen.end(),
				[&](Index i) {
					return search.anyWithin(sample.cloud.positions.col(i), clearance[i]);
				}),
			chosen.end());
	}
	ScaffoldSites sites;
	const Index   fromCloud = static_cast<Index>(chosen.size());
	const Index   count     = fromCloud + static_cast<Index>(onCreases.cols());
	sites.points.resize(3, count);
	sites.normals.setZero(3, count);
	sites.source.assign(count, -1);
	sites.distance.resize(count);
	sites.place = chosen;
	for (Index k = 0; k < fromCloud; ++k) {
		sites.points.col(k)  = sample.cloud.positions.col(chosen[k]);
		sites.normals.col(k) = sample.cloud.normals.col(chosen[k]);
		sites.source[k]      = order[chosen[k]];
	}
	sites.points.rightCols(onCreases.cols()) = onCreases;
	for (Index k = fromCloud; k < count; ++k)
		sites.place.push_back(nearest(sites.points.col(k)));
	for (Index k = 0; k < count; ++k)
		sites.distance[k] = distance[sites.place[k]];
	sites.around = distancesAround(sites);
	sites.creaseEdges.reserve(samples.edges.size());
	for (const auto& [a, b] : samples.edges)
		sites.creaseEdges.emplace_back(fromCloud + a, fromCloud + b);
	return sites;
}

} // namespace curvature_lines
