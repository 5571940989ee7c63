// Curves between corners: traced, joined over gaps, cut and extended at the corners, evenly resampled.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "creases.h"

#include <algorithm>
#include <vector>

#include <Eigen/Dense>

#include "cloud_index.h"
#include "crease_curves.h"
#include "crease_network.h"
#include "crease_points.h"
#include "crease_tracing.h"
#include "local_surface.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

namespace {

constexpr const char* progressLabel = "Finding creases";

// By experiment (benchmarks/creases.py).
// Of the smallest angle: how far a crease is followed as it fades.
constexpr double followShare = 0.6;
constexpr double autoSpacing = 0.7;  // median point spacings: of steps, and of vertices by default
constexpr double finest      = 0.05; // median point spacings: least distance of vertices
// The shape operator at a point comes from those of so many neighbours whose normals differ from what the round before
// predicts by less than a length: 29 degrees in the first round, halved down to 14 degrees.
constexpr Index  shapeNeighbors  = 28;
constexpr int    shapeIterations = 3;
constexpr double firstDifference = 0.5;
constexpr double lastDifference  = 0.25;

// The points with their shape operators, fitted to the normals around that vary linearly with the place, as they do on
// one side of a crease.
std::vector<SurfaceElement>
elementsOf(const PointCloud& cloud, const NeighborSearch& search, const Progress& progress)
{
	std::vector<SurfaceElement> elements(cloud.size());
	for (Index i = 0; i < cloud.size(); ++i) {
		elements[i].position = cloud.positions.col(i);
		elements[i].normal   = cloud.normals.col(i);
		elements[i].valid    = true;
	}
	std::vector<Eigen::Matrix3d> shapes(cloud.size(), Eigen::Matrix3d::Zero());
	parallelForPoints(search, progress, [&](Index i) {
		const SurfaceElement&    own  = elements[i];
		const std::vector<Index> near = search.nearest(own.position, shapeNeighbors);
		const double radius = 1.05 * (elements[near.back()].position - own.position).norm();
		thread_local std::vector<Index> same;
		LocalSurfaceFitter&             fitter        = LocalSurfaceFitter::ofThisThread();
		SurfaceElement                  fit           = own;
		double                          maxDifference = firstDifference;
		for (int it = 0; it < shapeIterations;
		     ++it, maxDifference = std::max(lastDifference, 0.5 * maxDifference)) {
			same.clear();
			for (const Index j : near) {
				const Eigen::Vector3d predicted =
					fit.normal + fit.shape * (elements[j].position - own.position);
				if ((elements[j].normal - predicted).norm() < maxDifference)
					same.push_back(j);
			}
			SurfaceElement start = own;
			start.normal         = fit.normal;
			fitter.takeBall(cloud, same, own.position, radius);
			const SurfaceElement next = fitter.fitNormals(start, 1, false);
			if (!next.valid)
				break;
			fit = next;
		}
		shapes[i] = fit.shape;
	});
	for (Index i = 0; i < cloud.size(); ++i)
		elements[i].shape = shapes[i];
	return elements;
}

} // namespace

Creases findCreases(const CloudIndex& index, const CreaseOptions& options, const Progress& progress)
{
	if (index.size() == 0 || !(index.minimum().medianSpacing > 0.0))
		return {};
	const double medianSpacing = index.minimum().medianSpacing;
	const double minAngle      = options.minAngle * EIGEN_PI / 180.0;
	const double step          = autoSpacing * medianSpacing;
	const double spacing =
		options.spacing > 0.0 ? std::max(options.spacing, finest * medianSpacing) : step;
	const PointCloud      shuffled = columnsOf(index.cloud(), index.shuffled());
	const NeighborSearch& search   = index.shuffledSearch();
	const auto elements       = elementsOf(shuffled, search, progress.sub(0.0, 0.3, progressLabel));
	const CreasePoints points = findCreasePoints(
		elements, search, followShare * minAngle, progress.sub(0.3, 0.9, progressLabel));
	CreaseTracing tracing(points);
	return creaseNetwork(tracing, tracing.traceAll(step, minAngle), step, spacing);
}

} // namespace curvature_lines
