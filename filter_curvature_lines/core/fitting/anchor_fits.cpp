// Fits to the balls around thinned points, and which of them are on no surface.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "anchor_fits.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "local_surface.h"
#include "point_cloud.h"
#include "point_subsets.h"
#include "progress.h"

namespace curvature_lines {

namespace {

// By experiment (benchmarks/curvature.py). Distances of anchors, in radii: .12 and .25 chose worse scales on a small
// helicoid; a sketch, to judge a scale by, may be coarser.
constexpr double anchorSpacing    = 0.18;
constexpr double sketchSpacing    = 0.22;
constexpr int    anchorIterations = 2; // of a height fit, each in the frame of the one before
// Radii between the plane through a ball and its centre, beyond which the ball is moved onto the surface.
constexpr double largestHeight = 0.4;
// A point is an outlier when it lies this many residuals and radii off the surface fitted around it.
constexpr double outlierRatio = 4.5;
constexpr double outlierFloor = 0.02;
// And when the points of its ball have a mean weight below leastSupport. The mean of the kernel over a disc around the
// centre is a third (derived); of a finite number of points it varies by supportScatter over its root, which is five
// standard deviations.
constexpr double fullSupport    = 1.0 / 3.0;
constexpr double leastSupport   = 0.2;
constexpr double supportScatter = 1.5;

} // namespace

bool isOutlier(const SurfaceElement& element, const Eigen::Vector3d& position, double radius)
{
	// The ball of a point off the surface holds points near its rim only; in a sparse place there are some inside.
	const double scatter = supportScatter / std::sqrt(element.samples + 1.0);
	return element.support < std::min(leastSupport, fullSupport - scatter) ||
	       (element.position - position).norm() >
	           outlierRatio * element.residual + outlierFloor * radius;
}

HeightFits surfacesAt(
	const PointSubsets&    subsets,
	Index                  place,
	const Eigen::Vector3d& position,
	const Eigen::Vector3d& gateNormal,
	double                 radius,
	Degrees                degrees,
	int                    iterations)
{
	const PointSample&              sample = subsets[place];
	thread_local std::vector<Index> scratch;
	std::vector<Index>&             near    = scratch;
	LocalSurfaceFitter&             fitter  = LocalSurfaceFitter::ofThisThread();
	const auto                      planeAt = [&](const Eigen::Vector3d& center, double r) {
        sample.search.within(center, r, near);
        fitter.takeBall(sample.cloud, near, center, r);
        return fitter.plane(gateNormal);
	};
	BallPlane plane = planeAt(position, radius);
	// The ball of a point off the surface holds a slanted cut of it.
	if (std::abs(plane.height) > largestHeight * radius)
		plane = planeAt(position + plane.height * plane.normal, radius);
	HeightFits fits;
	if (degrees.quartic)
		fits.quartic = fitter.fitHeights(plane.normal, 4, iterations);
	const bool lacksQuartic = degrees.quartic && !fits.quartic.valid;
	if (!degrees.quadric && !lacksQuartic)
		return fits;
	SurfaceElement quadric = fitter.fitHeights(plane.normal, 2, iterations);
	if (!quadric.valid)
		quadric = fitter.fitHeights(planeAt(position, 1.5 * radius).normal, 2, iterations);
	if (lacksQuartic)
		fits.quartic = quadric;
	if (degrees.quadric)
		fits.quadric = quadric;
	return fits;
}

SurfaceElement surfaceAt(
	const PointSubsets&    subsets,
	Index                  place,
	const Eigen::Vector3d& position,
	const Eigen::Vector3d& gateNormal,
	const HeightScale&     scale,
	int                    iterations)
{
	return surfacesAt(
			   subsets,
			   place,
			   position,
			   gateNormal,
			   scale.radius,
			   Degrees::only(scale.degree),
			   iterations)
	    .of(scale.degree);
}

bool Vicinity::contains(const Eigen::Vector3d& position) const
{
	return !points || points->anyWithin(position, reach);
}

AnchorFits fitAnchors(
	const PointSample&  sample,
	const PointSubsets& subsets,
	double              radius,
	Degrees             degrees,
	AnchorDetail        detail,
	const Vicinity&     vicinity)
{
	const double spacing          = detail == AnchorDetail::Sketch ? sketchSpacing : anchorSpacing;
	const std::vector<Index> kept = thin(sample, spacing * radius);
	std::vector<Index>       placeOf(sample.cloud.size(), -1);
	for (std::size_t place = 0; place < kept.size(); ++place)
		placeOf[kept[place]] = static_cast<Index>(place);
	std::vector<Index> visited;
	visited.reserve(kept.size());
	for (const Index i : sample.search.spatialOrder())
		if (placeOf[i] >= 0 && vicinity.contains(sample.cloud.positions.col(i)))
			visited.push_back(i);
	AnchorFits result;
	result.points.resize(3, visited.size());
	result.places.resize(visited.size());
	result.fits.resize(visited.size());
	std::vector<char> outlier(visited.size(), 0);
	parallelFor(static_cast<Index>(visited.size()), {}, [&](Index a) {
		const Index           i        = visited[a];
		const Eigen::Vector3d position = sample.cloud.positions.col(i);
		HeightFits            fits     = surfacesAt(
            subsets,
            placeOf[i],
            position,
            sample.cloud.normals.col(i),
            radius,
            degrees,
            anchorIterations);
		for (SurfaceElement* element : {&fits.quadric, &fits.quartic})
			if (element->valid && isOutlier(*element, position, radius)) {
				element->valid = false;
				outlier[a]     = 1;
			}
		result.points.col(a) = position;
		result.places[a]     = placeOf[i];
		result.fits[a]       = fits;
	});
	result.hasOutliers = std::count(outlier.begin(), outlier.end(), 1) > 0;
	return result;
}

} // namespace curvature_lines
