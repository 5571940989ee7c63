// The direction field as lines follow it: one step at a time on the surface, and where it cannot be
// followed any further (A09 section 5.1 steps 1-5; R07 section 5).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "curvature_field.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "surface_projection.h"
#include "umbilics.h"
#include "voronoi_cells.h"

namespace curvature_lines {

struct SurfaceFlowOptions {
	double         tolerance  = 0.01; // tau of the adaptive step
	ProjectionKind projection = ProjectionKind::Mixed;
};

struct FlowPoint {
	Eigen::Vector3d position, normal, direction; // direction of travel
	int             family    = 1;               // 1 along d1, 2 along d2
	double          curvature = 0.0;             // along the line
	Index           cell      = -1;
	double          arc       = 0.0;
	Eigen::Vector3d inwards   = Eigen::Vector3d::Zero(); // as SurfaceSample
};

// All arguments must outlive it.
class SurfaceFlow {
public:
	SurfaceFlow(
		const PointCloud&           cloud,
		const CurvatureField&       field,
		const MinimumNeighborhoods& minimum,
		const UmbilicRegions&       umbilics,
		const VoronoiCells&         cells,
		const SurfaceFlowOptions&   options);

	double step(Index cell) const { return m_step[cell]; } // before adaptation, a length
	double leastStep(Index cell) const;

	// The direction lines of a family start with at a point of the cloud.
	Eigen::Vector3d directionAt(Index cell, int family) const;

	// On the surface near `position`, direction and family of `previous` continued. False where surface or
	// direction turn by more than 60 degrees.
	bool
	sampleAt(const Eigen::Vector3d& position, const FlowPoint& previous, FlowPoint& result) const;

	// One step; its length is added to the arc, times `side`. False where there is none to take.
	bool advance(const FlowPoint& from, double side, FlowPoint& to) const;

	bool leftCloud(const FlowPoint& point) const; // beyond a rim or crease
	bool isCrease(Index cell) const;              // of the two, by the normals around
	bool endsAtUmbilic(const FlowPoint& from, const FlowPoint& to) const;

private:
	Eigen::Vector3d regionDirection(Index cell, int family) const;
	Eigen::Vector3d directionOf(const SurfaceSample& sample, Index cell, int family) const;

	const PointCloud&           m_cloud;
	const CurvatureField&       m_field;
	const MinimumNeighborhoods& m_minimum;
	const UmbilicRegions&       m_umbilics;
	const VoronoiCells&         m_cells;
	SurfaceFlowOptions          m_options;
	std::vector<double>         m_step; // N
	// per umbilical region: its d1 continues the d2 around it
	std::vector<char> m_swapped;
};

} // namespace curvature_lines
