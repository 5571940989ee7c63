// Red-green splits of triangles, round by round.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "scaffold_refinement.h"

#include <array>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "point_cloud.h"
#include "scaffold.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// Edges are split whose normals turn more than that (cosine, 37 degrees). Among 37, 50 and 66 degrees.
constexpr double mostTurn = 0.8;
// Rounds: a tube of three vertices around gets twelve.
constexpr int rounds = 2;

// Half-way between two points of a smooth surface: of the cubic that is tangent to it at both.
Vector3d
curvedMiddle(const Vector3d& a, const Vector3d& normalA, const Vector3d& b, const Vector3d& normalB)
{
	const Vector3d side = b - a;
	return 0.5 * (a + b) + 0.125 * (side.dot(normalB) * normalB - side.dot(normalA) * normalA);
}

// The triangles of one whose sides have a middle, or -1.
void addSplit(
	const Triangle&             corners,
	const std::array<Index, 3>& middle,
	const Eigen::Matrix3Xd&     points,
	std::vector<Triangle>&      triangles)
{
	const int split = (middle[0] >= 0) + (middle[1] >= 0) + (middle[2] >= 0);
	if (split == 0) {
		triangles.push_back(corners);
		return;
	}
	if (split == 3) {
		for (int c = 0; c < 3; ++c)
			triangles.push_back({corners[c], middle[c], middle[(c + 2) % 3]});
		triangles.push_back({middle[0], middle[1], middle[2]});
		return;
	}
	// With the one side first that is split, or the one that is not.
	int first = 0;
	while ((middle[first] >= 0) != (split == 1))
		++first;
	const Index a = corners[first], b = corners[(first + 1) % 3], c = corners[(first + 2) % 3];
	if (split == 1) {
		triangles.push_back({a, middle[first], c});
		triangles.push_back({middle[first], b, c});
		return;
	}
	const Index bc = middle[(first + 1) % 3], ca = middle[(first + 2) % 3];
	triangles.push_back({bc, c, ca});
	if ((points.col(a) - points.col(bc)).squaredNorm() <
	    (points.col(b) - points.col(ca)).squaredNorm()) {
		triangles.push_back({a, b, bc});
		triangles.push_back({a, bc, ca});
	}
	else {
		triangles.push_back({a, b, ca});
		triangles.push_back({b, bc, ca});
	}
}

} // namespace

Index refineBends(Scaffold& scaffold)
{
	Index added = 0;
	for (int round = 0; round < rounds; ++round) {
		const TriangleMesh     coarse  = std::move(scaffold.mesh);
		const Eigen::Matrix3Xd normals = coarse.vertexNormals();
		const Index            count   = coarse.vertexCount();
		std::vector<Index>     middle(coarse.edgeCount(), -1), split;
		std::vector<char>      onFeature(count, 0);
		for (Index e = 0; e < coarse.edgeCount(); ++e)
			if (coarse.edges()[e].isRim() || scaffold.creaseEdge[e])
				onFeature[coarse.edges()[e].from] = onFeature[coarse.edges()[e].to] = 1;
		for (Index e = 0; e < coarse.edgeCount(); ++e) {
			const TriangleMesh::Edge& edge = coarse.edges()[e];
			if (onFeature[edge.from] || onFeature[edge.to] ||
			    normals.col(edge.from).dot(normals.col(edge.to)) > mostTurn)
				continue;
			middle[e] = count + static_cast<Index>(split.size());
			split.push_back(e);
		}
		const Index      total = count + static_cast<Index>(split.size());
		Eigen::Matrix3Xd points(3, total);
		points.leftCols(count) = coarse.vertices;
		scaffold.spacing.conservativeResize(total);
		const bool isSized = scaffold.size.size() > 0;
		if (isSized)
			scaffold.size.conservativeResize(total);
		for (Index v = count; v < total; ++v) {
			const TriangleMesh::Edge& edge = coarse.edges()[split[v - count]];
			points.col(v)                  = curvedMiddle(
                coarse.vertices.col(edge.from),
                normals.col(edge.from),
                coarse.vertices.col(edge.to),
                normals.col(edge.to));
			scaffold.source.push_back(-1);
			scaffold.place.push_back(scaffold.place[edge.from]);
			if (!scaffold.onLimb.empty())
				scaffold.onLimb.push_back(scaffold.onLimb[edge.from]);
			scaffold.spacing[v] = scaffold.spacing[edge.from];
			if (isSized)
				scaffold.size[v] = scaffold.size[edge.from];
		}
		std::vector<Triangle> triangles;
		triangles.reserve(coarse.triangleCount() + 2 * split.size());
		for (Index t = 0; t < coarse.triangleCount(); ++t)
			addSplit(
				coarse.triangles()[t],
				{middle[coarse.edgeOf(t, 0)],
			     middle[coarse.edgeOf(t, 1)],
			     middle[coarse.edgeOf(t, 2)]},
				points,
				triangles);
		const std::vector<char> wasCrease = std::move(scaffold.creaseEdge);
		scaffold.mesh                     = TriangleMesh(std::move(points), std::move(triangles));
		scaffold.creaseEdge.assign(scaffold.mesh.edgeCount(), 0);
		for (Index e = 0; e < coarse.edgeCount(); ++e)
			if (wasCrease[e])
				scaffold.creaseEdge[scaffold.mesh.edgeBetween(
					coarse.edges()[e].from, coarse.edges()[e].to)] = 1;
		added += static_cast<Index>(split.size());
		if (split.empty())
			break;
	}
	return added;
}

} // namespace curvature_lines
