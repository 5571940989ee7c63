// The scaffold: a manifold triangulation of a cleaned cloud, thinned to the density its quad mesh needs.
// Everything after it is combinatorial on the scaffold, so it decides about the topology of the mesh.
// Beyond the papers: A09 section 6 takes its topology from Voronoi cells alone.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "cloud_index.h"
#include "point_cloud.h"
#include "progress.h"
#include "scaffold_sites.h"
#include "sizing_field.h"
#include "triangle_mesh.h"

namespace curvature_lines {

constexpr double usualHoleSize = 8.0; // in spacings of the cloud

struct ScaffoldOptions {
	// Least distance of vertices, in spacings of the cloud around (MinimumNeighborhoods::spacing): with .95 the front had the
	// right topology on 62 of 62 noisy clouds of a prototype, with .55 on 60. On limbs less, so that enough lie around.
	double thinning = 0.95, limbThinning = 0.3;
	// Holes of the cloud no wider than so many of its spacings are closed, and wider ones where vertices are too far apart
	// to show them. The front bridges them up to usualHoleSize; a longer bound on its edges would close open surfaces and
	// join sheets. Wider ones are filled from their rims, not a sheet's outer one.
	double holeSize = usualHoleSize;
	// By experiment, with usualHoleSize. Edges of the front are no longer than so many distances of the vertices around or
	// holeSize, the longer (without a bound helicoids are closed in 28 of 30 clouds); rims are filled up to so many
	// distances of the vertices around.
	double longestEdge = 5.0, smallHole = 10.0;
	double creaseClearance = 0.75; // cloud points so near a crease are left out
	double closedRim = 0.0; // rims up to this length are closed as well, in edges of the quad mesh
	double leastArea =
		6.0;            // smaller components are dropped, in faces of the quad mesh; by experiment
	double noise = 0.0; // left in the cloud, a length: rounds the points beside a crease
};

struct Scaffold {
	TriangleMesh       mesh;
	std::vector<Index> source;     // of every vertex: its point of the cloud; -1: there is none
	std::vector<Index> place;      // of every vertex: the point of the cloud that is nearest
	std::vector<char>  creaseEdge; // of every edge
	std::vector<char>
		onLimb; // of every vertex: SizingField::limb bounds its size; empty: nothing is known
	Eigen::VectorXd spacing; // of every vertex, a length: wanted to its neighbours
	Eigen::VectorXd size;    // of every vertex, a length: edge of the quad mesh; empty: any
	Index           components = 0, droppedComponents = 0;
	Index           filledHoles = 0, defects = 0; // places where the front did not close by itself
	Index           lostCreaseEdges = 0;
	Index           turnedTriangles = 0; // of parts that look against the normals of their corners
	Index unusedSites = 0; // points that were to be vertices and are in no triangle that was kept

	bool hasCreases() const;
};

// Vertices are points of the cloud, then samples of the creases and centres of filled holes. The
// orientation is that of the normals. `sizing`: of the quad mesh, whose faces are about twice as large as the triangles;
// none: any. Same result for any order of the points.
Scaffold buildScaffold(
	const CloudIndex&               index,
	const std::vector<FeatureLine>& creases  = {},
	const SizingField&              sizing   = {},
	const ScaffoldOptions&          options  = {},
	const Progress&                 progress = {});

} // namespace curvature_lines
