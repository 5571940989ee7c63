// Which rims are lines of curvature, and the constraints rims and creases put on the field and the phases.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "feature_alignment.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "cross_field.h"
#include "phase_pins.h"
#include "point_cloud.h"
#include "rims.h"
#include "scaffold.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// A rim is taken for a line of curvature, and the crosses are turned along it, if at this share of the
// vertices of a side its tangent is within 25 degrees (cosine) of an arm. By experiment on cylinders, whose
// rims are, and helicoids, whose are not.
constexpr double snapCosine = 0.906;
constexpr double snapShare  = 0.7;
// Weight of the direction along a rim or crease; the others are at most about 1: it is held.
constexpr double featureWeight = 1e3;
// Cosine of a crease's turn at a vertex, 53 degrees: beyond, the vertex is a corner; as of rims (rims.cpp).
constexpr double creaseCorner = 0.6;
// Cosine of a tangent with the arm that runs along it, 25 degrees: where neither does, no phase is pinned.
constexpr double armCosine = 0.9;

bool isAlongArm(const Vector3d& tangent, const DirectionGuide& guide, Index v)
{
	const Vector3d d = guide.directions.col(v), e = guide.normals.col(v).cross(d);
	return std::max(std::abs(d.dot(tangent)), std::abs(e.dot(tangent))) > snapCosine;
}

void alignSide(
	const TriangleMesh& mesh,
	const Rim&          rim,
	Index               begin,
	Index               end, // of the side; both are corners unless the rim has none
	DirectionGuide&     guide,
	FeatureAlignment&   alignment)
{
	Index along = 0, known = 0;
	for (Index k = begin; k <= end; ++k) {
		const Index v = rim.at(k);
		if (!(guide.weights[v] > 0.0) || guide.onCrease[v])
			continue;
		++known;
		along += isAlongArm(rim.tangent(k, mesh.vertices), guide, v);
	}
	if (along < snapShare * known)
		return;
	for (Index k = begin; k <= end; ++k) {
		const Index v        = rim.at(k);
		const bool  isCorner = rim.corner[k % rim.size()] != 0;
		if (isCorner || guide.onCrease[v]) {
			guide.weights[v] = 0.0;
			alignment.meeting[v] += 1;
			continue;
		}
		Vector3d t = rim.tangent(k, mesh.vertices);
		t -= t.dot(guide.normals.col(v)) * guide.normals.col(v);
		if (!(t.norm() > 0.1))
			continue;
		guide.directions.col(v)   = t.normalized();
		guide.weights[v]          = featureWeight;
		alignment.tangents.col(v) = t.normalized();
	}
}

} // namespace

FeatureAlignment
alignWithFeatures(const Scaffold& scaffold, const std::vector<Rim>& rims, DirectionGuide& guide)
{
	const TriangleMesh& mesh = scaffold.mesh;
	const Index         n    = mesh.vertexCount();
	FeatureAlignment    result;
	result.tangents.setZero(3, n);
	result.meeting.assign(n, 0);
	result.features = {scaffold.creaseEdge, std::vector<char>(n, 0)};

	std::vector<std::vector<Vector3d>> leaving(n); // directions of creases
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		if (!scaffold.creaseEdge[e])
			continue;
		const Vector3d d = mesh.along(e).normalized();
		leaving[mesh.edges()[e].from].push_back(d);
		leaving[mesh.edges()[e].to].push_back(-d);
	}
	for (Index v = 0; v < n; ++v) {
		const auto& d = leaving[v];
		if (d.empty())
			continue;
		const bool turns = d.size() == 2 && -d[0].dot(d[1]) < creaseCorner;
		if (d.size() > 2 || turns) {
			result.meeting[v]         = 2;
			result.features.corner[v] = 1;
			guide.weights[v]          = 0.0;
			continue;
		}
		const Vector3d t       = d.size() == 1 ? d[0] : Vector3d(d[0] - d[1]);
		const Vector3d inPlane = t - t.dot(guide.normals.col(v)) * guide.normals.col(v);
		if (!(inPlane.norm() > 0.0))
			continue;
		result.tangents.col(v)  = inPlane.normalized();
		guide.directions.col(v) = result.tangents.col(v);
		guide.weights[v]        = featureWeight;
	}

	for (const Rim& rim : rims) {
		Index first = 0;
		while (first < rim.size() && !rim.corner[first])
			++first;
		for (Index k = 0; k < rim.size(); ++k)
			if (rim.corner[k])
				result.features.corner[rim.at(k)] = 1;
		if (first == rim.size()) {
			alignSide(mesh, rim, 0, rim.size() - 1, guide, result);
			continue;
		}
		for (Index begin = first, k = first + 1; k <= first + rim.size(); ++k) {
			if (!rim.corner[k % rim.size()])
				continue;
			alignSide(mesh, rim, begin, k, guide, result);
			begin = k;
		}
	}
	return result;
}

PhasePins featurePins(const FeatureAlignment& alignment, const CrossField& field)
{
	const auto n = static_cast<Index>(alignment.meeting.size());
	PhasePins  pins(n);
	pins.crease = alignment.features.edge;
	for (Index v = 0; v < n; ++v) {
		if (alignment.meeting[v] >= 2) {
			pins.fixed[0][v] = pins.fixed[1][v] = 1;
			continue;
		}
		const Vector3d t  = alignment.tangents.col(v);
		const double   c0 = std::abs(t.dot(field.d1.col(v))), c1 = std::abs(t.dot(field.d2.col(v)));
		if (std::max(c0, c1) > armCosine)
			pins.fixed[c0 > c1 ? 1 : 0][v] = 1;
	}
	return pins;
}

} // namespace curvature_lines
