// Lines of curvature traced on the cloud in order of confidence (A09 section 5.1; R07 section 5).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "surface_projection.h"
#include "umbilics.h"
#include "voronoi_cells.h"

namespace curvature_lines {

struct LineTracingOptions {
	double epsilon        = 1e-5; // chord error, fraction of the bounding-box diagonal (A09 prints it as kappa)
	Index  targetVertices = 0;    // > 0: epsilon is chosen so that about so many crossings result
	double minSpacing     = 0.0;  // length; 0 = automatic, a multiple of the median point spacing
	double maxSpacing     = 0.0;  // length; 0 = automatic
	double tolerance      = 0.01; // tau of the adaptive step
	ProjectionKind projection = ProjectionKind::Mixed;
	// Lines start at distance d or more from the next of their family, and end below this times d. The papers
	// have 1: every gap narrower than 2 d ends a line. Measured on a torus: of all gaps 97 % are within .7 d
	// and 2 d with .7, 88 % with .5; quads of the mesh 96 and 99 %, as fewer lines end.
	double stopFactor = 0.7;
	// d grows by no more than this times the distance. With 0.25 a small detail makes lines dense all around:
	// on a cow crossings fall 5 instead of 10 times when epsilon grows tenfold (7 with 1), but a mesh has
	// more quads.
	double gradation = 1.0;
};

// Of lines that are wanted for the mesh between them: fewer ends, instead of exact distances.
constexpr double meshStopFactor = 0.5, meshGradation = 0.25;

enum class LineEnd {
	None,    // of closed lines
	Line,    // the next line of the family is too close, or an earlier part of this one
	Rim,     // the cloud ends
	Crease,  // the surface or the field turns sharply
	Umbilic, // directions are lost, or do not go on into or out of an umbilical region
	Length,  // longer than any line should be
};

// All lines of both families. Vertices of line l: [offsets[l], offsets[l + 1]), in order along the line;
// a closed line's last vertex joins its first (not repeated).
struct LineNetwork {
	Eigen::Matrix3Xd      vertices, normals; // 3 x M
	Eigen::VectorXd       curvature;         // M, principal curvature along the line
	std::vector<Index>    offsets = {0};
	std::vector<int>      family;            // per line, 1 (along d1) or 2
	std::vector<char>     closed;            // per line
	std::vector<std::array<LineEnd, 2>> ends; // per line, before its first and after its last vertex
	double                epsilon = 0.0;     // the one used, fraction of the diagonal
	Index                 crossings = 0;     // of the two families, as LineRegistry counts them

	Index lines() const { return static_cast<Index>(family.size()); }
};

// Per vertex: its distance from the first of its line, along the line.
Eigen::VectorXd arcLengths(const LineNetwork& lines);

// Distance to keep from the next line of the same family: 2 sqrt(eps (2/|k| - eps)), the chord of sagitta
// eps, clamped to [minSpacing, maxSpacing]. k is the curvature *across* the line. All in the same length unit.
double lineSpacing(double k, double eps, double minSpacing, double maxSpacing);

LineNetwork traceLines(
	const PointCloud&           cloud,
	const CurvatureField&       field,     // directions as they should be followed (smoothed or not)
	const MinimumNeighborhoods& minimum,
	const UmbilicRegions&       umbilics,
	const VoronoiCells&         cells,
	const LineTracingOptions&   options  = {},
	const Progress&             progress = {});

} // namespace curvature_lines
