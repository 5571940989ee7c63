// Steps of second order, rims told from voids, and umbilical regions (A09 section 5.1).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_flow.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "curvature_field.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "surface_projection.h"
#include "umbilics.h"
#include "voronoi_cells.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// Lengths of steps, in local spacings. A09 starts with half the distance to the nearest point; in random
// clouds that is often next to nothing, and what a change of the support moves a projected point weighs
// more than the step: at least a quarter.
constexpr double leastStart = 0.25, mostStep = 0.5;
// No step is made shorter than this by the tolerance (A09 has no bound).
constexpr double shortestStep = 0.05;
// A step has to lead on by this share of its length after projection, or the line ends.
constexpr double leastProgress = 0.2;
// Cosines of angles between successive points of a line, and of neighbours: 60 degrees in one step is a
// crease.
constexpr double sharpTurn = 0.5;
// 20 degrees: at the border of an umbilical region a line goes on whose direction turns by less.
constexpr double bridgedTurn = 0.94;
// Rims and voids of the cloud, in local spacings; by experiment on random clouds of closed surfaces, where
// no line may end at a rim, and of helicoids, cylinders and half tori, where no line may leave the surface.
// From the closest point: so far is within the cloud or in a void of it, and so far is outside even of
// voids.
constexpr double cloudReach = 1.5, voidReach = 2.5;
// From within a void to behind it. Among ten thousand random points one or two voids are wider.
constexpr double voidWidths[] = {2.5, 3.5};
// From the place behind a void to the closest point there.
constexpr double voidSlack = 1.5;
// A crease: normals of points at most so far apart differ by more than 37 degrees. By experiment.
constexpr double creaseCosine = 0.8;
constexpr double creaseReach  = 2.5; // local spacings

// The axes of an umbilical region come in arbitrary order; that of most of its border keeps the families
// apart.
std::vector<char> swappedRegions(
	const PointCloud&           cloud,
	const CurvatureField&       field,
	const MinimumNeighborhoods& minimum,
	const UmbilicRegions&       umbilics)
{
	std::vector<double> votes(umbilics.regions, 0.0);
	for (Index i = 0; i < cloud.size(); ++i) {
		const Index region = umbilics.region[i];
		if (region < 0)
			continue;
		for (Index j : minimum.neighbors[i])
			if (!umbilics.umbilic[j] && cloud.normals.col(i).dot(cloud.normals.col(j)) > sharpTurn)
				votes[region] += std::abs(umbilics.d1.col(i).dot(field.d1.col(j))) -
				                 std::abs(umbilics.d1.col(i).dot(field.d2.col(j)));
	}
	std::vector<char> swapped(votes.size());
	for (std::size_t r = 0; r < votes.size(); ++r)
		swapped[r] = votes[r] < 0.0;
	return swapped;
}

} // namespace

SurfaceFlow::SurfaceFlow(
	const PointCloud&           cloud,
	const CurvatureField&       field,
	const MinimumNeighborhoods& minimum,
	const UmbilicRegions&       umbilics,
	const VoronoiCells&         cells,
	const SurfaceFlowOptions&   options) :
		m_cloud(cloud), m_field(field), m_minimum(minimum), m_umbilics(umbilics), m_cells(cells),
		m_options(options), m_step(cloud.size()),
		m_swapped(swappedRegions(cloud, field, minimum, umbilics))
{
	for (Index i = 0; i < cloud.size(); ++i) {
		double nearest2 = HUGE_VAL;
		for (Index j : cells.neighbors(i))
			nearest2 = std::min(nearest2, (cells.site(j) - cells.site(i)).squaredNorm());
		const double local = minimum.spacing[i] > 0.0 ? minimum.spacing[i] : minimum.medianSpacing;
		m_step[i] = std::clamp(0.5 * std::sqrt(nearest2), leastStart * local, mostStep * local);
	}
}

double SurfaceFlow::leastStep(Index cell) const
{
	return shortestStep * m_minimum.spacing[cell];
}

Vector3d SurfaceFlow::directionAt(Index cell, int family) const
{
	if (m_umbilics.region[cell] >= 0)
		return regionDirection(cell, family);
	return (family == 1 ? m_field.d1 : m_field.d2).col(cell);
}

Vector3d SurfaceFlow::regionDirection(Index cell, int family) const
{
	const bool first = (family == 1) != bool(m_swapped[m_umbilics.region[cell]]);
	return (first ? m_umbilics.d1 : m_umbilics.d2).col(cell);
}

// In umbilical regions the tensor has no directions; those of the region are followed there.
Vector3d SurfaceFlow::directionOf(const SurfaceSample& sample, Index cell, int family) const
{
	if (m_umbilics.region[cell] < 0)
		return family == 1 ? sample.d1 : sample.d2;
	const Vector3d axis = regionDirection(cell, family);
	return (axis - axis.dot(sample.normal) * sample.normal).normalized();
}

bool SurfaceFlow::sampleAt(
	const Vector3d& position, const FlowPoint& previous, FlowPoint& result) const
{
	const Index         closest = m_cells.locate(position, previous.cell);
	const SurfaceSample sample =
		projectToSurface(m_cloud, m_field, position, closest, m_options.projection);
	const int family = previous.family;
	result.family    = family;
	result.position  = sample.position;
	result.normal    = sample.normal;
	result.cell      = m_cells.locate(sample.position, closest);
	result.curvature = family == 1 ? sample.k1 : sample.k2;
	result.direction = directionOf(sample, closest, family);
	// Principal directions have no sign: the line keeps its own.
	if (result.direction.dot(previous.direction) < 0.0)
		result.direction = -result.direction;
	result.inwards = sample.inwards;
	return result.direction.dot(previous.direction) > sharpTurn &&
	       result.normal.dot(previous.normal) > sharpTurn;
}

// One step of the second-order scheme A09 uses for its error estimate: along the mean of the directions at
// both ends. The published backward step bends every line inwards by its own error, and closed lines miss
// their start.
bool SurfaceFlow::advance(const FlowPoint& from, double side, FlowPoint& to) const
{
	double    step = m_step[from.cell];
	FlowPoint predicted;
	if (!sampleAt(from.position + step * from.direction, from, predicted))
		return false;
	// Delta = |c' - c''| / |c' - c_{i-1}|, with c' along the new direction and c'' along the mean.
	const double delta = 0.5 * (predicted.direction - from.direction).norm();
	if (delta > m_options.tolerance) {
		const double least = leastStep(from.cell);
		step = std::min(step, std::max(least, step * std::sqrt(m_options.tolerance / delta)));
		if (!sampleAt(from.position + step * from.direction, from, predicted))
			return false;
	}
	const Vector3d chord = 0.5 * step * (from.direction + predicted.direction);
	if (!sampleAt(from.position + chord, from, to))
		return false;
	const double moved = (to.position - from.position).dot(chord) / chord.norm();
	to.arc             = from.arc + side * moved;
	return moved > leastProgress * step;
}

bool SurfaceFlow::leftCloud(const FlowPoint& point) const
{
	const double distance = (point.position - m_cloud.positions.col(point.cell)).norm();
	const double local    = m_minimum.spacing[point.cell];
	if (distance > voidReach * local)
		return true;
	const double aside = point.inwards.norm();
	if (distance < cloudReach * local &&
	    (aside < rimOffset || point.inwards.dot(point.direction) > 0.0))
		return false;
	if (aside == 0.0)
		return true;
	// All points lie behind. At a rim there are none beyond, either; a void has some on its other side.
	for (const double width : voidWidths) {
		const Vector3d beyond = point.position - width * local / aside * point.inwards;
		const Index    next   = m_cells.locate(beyond, point.cell);
		const double   around = voidSlack * std::max(local, m_minimum.spacing[next]);
		if ((beyond - m_cells.site(next)).norm() < around &&
		    m_cloud.normals.col(next).dot(point.normal) > sharpTurn)
			return false;
	}
	return true;
}

bool SurfaceFlow::isCrease(Index cell) const
{
	for (Index j : m_cells.neighbors(cell)) {
		const bool near =
			(m_cells.site(j) - m_cells.site(cell)).norm() < creaseReach * m_minimum.spacing[cell];
		const double cosine = m_cloud.normals.col(j).dot(m_cloud.normals.col(cell));
		// not the other side of a sheet
		if (near && cosine < creaseCosine && cosine > -sharpTurn)
			return true;
	}
	return false;
}

// A09 ends lines at umbilics and, from inside a region, at its border, because directions jump there. Where
// they do not (flat parts that go over into singly curved ones, patches that only noise made umbilic) the line
// goes on; ending it would tear the mesh.
bool SurfaceFlow::endsAtUmbilic(const FlowPoint& from, const FlowPoint& to) const
{
	if (m_umbilics.singular[to.cell])
		return true;
	const bool border = m_umbilics.region[from.cell] != m_umbilics.region[to.cell];
	const bool single = m_umbilics.umbilic[to.cell] && m_umbilics.region[to.cell] < 0;
	return (border || single) && to.direction.dot(from.direction) < bridgedTurn;
}

} // namespace curvature_lines
