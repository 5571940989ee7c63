// Corners from chords along a rim.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rims.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "point_cloud.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// Vertices to both sides over which a tangent is taken, and those of the chords whose turn is that of the
// rim; a corner is the sharpest turn within so many vertices, if its cosine is below 0.6: 53 degrees. By
// experiment.
constexpr Index  tangentReach = 4;
constexpr Index  chordReach   = 5;
constexpr Index  cornerReach  = 6;
constexpr double cornerCosine = 0.6;

// Of the vertices around a corner the one farthest from the chord across it: on a front that cuts the corner
// the turn is about as sharp at several.
Index outermost(const Rim& rim, Index k, const Eigen::Matrix3Xd& positions)
{
	const Vector3d a      = positions.col(rim.at(k - chordReach));
	const Vector3d d      = (positions.col(rim.at(k + chordReach)) - a).normalized();
	Index          best   = k;
	double         height = 0.0;
	for (Index m = k - chordReach + 1; m < k + chordReach; ++m) {
		const Vector3d p = positions.col(rim.at(m)) - a;
		const double   h = (p - p.dot(d) * d).norm();
		if (h > height) {
			height = h;
			best   = m;
		}
	}
	return (best % rim.size() + rim.size()) % rim.size();
}

} // namespace

Vector3d Rim::tangent(Index k, const Eigen::Matrix3Xd& positions) const
{
	const Index reach = std::max<Index>(1, std::min(tangentReach, size() / 6));
	Index       ahead = k, behind = k;
	while (ahead < k + reach && (ahead == k || !isCorner(ahead)))
		++ahead;
	while (behind > k - reach && (behind == k || !isCorner(behind)))
		--behind;
	return (positions.col(at(ahead)) - positions.col(at(behind))).normalized();
}

std::vector<Rim> findRims(const TriangleMesh& mesh)
{
	std::vector<Rim> rims;
	for (std::vector<Index>& loop : mesh.rims()) {
		Rim rim{std::move(loop), {}};
		rim.corner.assign(rim.size(), 0);
		if (rim.size() > 4 * chordReach) {
			std::vector<double> cosines;
			for (Index k = 0; k < rim.size(); ++k) {
				const Vector3d p = mesh.vertices.col(rim.at(k));
				const Vector3d a = p - mesh.vertices.col(rim.at(k - chordReach));
				const Vector3d b = mesh.vertices.col(rim.at(k + chordReach)) - p;
				cosines.push_back(a.normalized().dot(b.normalized()));
			}
			for (Index k = 0; k < rim.size(); ++k) {
				bool sharpest = cosines[k] < cornerCosine;
				for (Index m = -cornerReach; m <= cornerReach && sharpest; ++m) {
					const double other = cosines[(k + m + rim.size()) % rim.size()];
					sharpest           = m < 0 ? cosines[k] < other : cosines[k] <= other;
				}
				if (sharpest)
					rim.corner[outermost(rim, k, mesh.vertices)] = 1;
			}
		}
		rims.push_back(std::move(rim));
	}
	return rims;
}

} // namespace curvature_lines
