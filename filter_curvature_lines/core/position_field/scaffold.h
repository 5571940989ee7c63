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
#include "triangle_mesh.h"

namespace curvature_lines {

struct ScaffoldOptions {
	// of the quad mesh: triangles get about half as large as its faces; 0: any
	double targetVertices = 0.0;
	// Least distance of vertices, in spacings of the cloud: with 1.2 the front had the right topology on 62
	// of 62 noisy clouds of a prototype, with .7 on 60.
	double thinning = 1.2;
	// In least distances of vertices. Without a bound on edges the front closes open surfaces (helicoids in
	// 28 of 30 clouds).
	double longestEdge     = 5.0;
	double smallHole       = 10.0; // rims this short are filled; by experiment
	double creaseClearance = 0.75; // cloud points so near a crease are left out
	double closedRim = 0.0; // rims up to this length are closed as well, in edges of the quad mesh
	double leastArea =
		6.0;            // smaller components are dropped, in faces of the quad mesh; by experiment
	double noise = 0.0; // left in the cloud, a length: rounds the points beside a crease
};

struct Scaffold {
	TriangleMesh       mesh;
	std::vector<Index> source;        // of every vertex: its point of the cloud; -1: there is none
	std::vector<char>  creaseEdge;    // of every edge
	double             spacing = 0.0; // of the vertices, a length
	double             cell = 0.0; // edge of a face of the quad mesh, a length; 0 without a target
	Index              components = 0, droppedComponents = 0;
	Index filledHoles = 0, defects = 0; // places where the front did not close by itself
	Index lostCreaseEdges = 0;

	bool hasCreases() const;
};

// Vertices are points of the cloud, then samples of the creases and centres of filled holes. The
// orientation is that of the normals. Same result for any order of the points.
Scaffold buildScaffold(
	const CloudIndex&               index,
	const std::vector<FeatureLine>& creases  = {},
	const ScaffoldOptions&          options  = {},
	const Progress&                 progress = {});

} // namespace curvature_lines
