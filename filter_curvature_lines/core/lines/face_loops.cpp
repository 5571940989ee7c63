// Loops of the graph told apart by their total turning (Gauss-Bonnet) and by the points inside.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "face_loops.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "half_edge_graph.h"
#include "point_cloud.h"
#include "voronoi_cells.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

constexpr double pi = 3.14159265358979323846;
// A sample inside a loop is covered when there is a point of the cloud within so many spacings of it, or of
// a place above or below it along the normal: samples lie on chords of the surface, and a face may close
// the end of a finger. Only points whose normals agree (dot product above 0) count, so the far side of a
// tube's open end does not. By experiment.
constexpr double coverDistance = 2.0;
// Dot product of a point's normal and the loop's, above which the distance is measured in the tangent
// plane: 60 degrees.
constexpr double sameWay = 0.5;
// Turning numbers beyond which a loop is no face, whatever the cloud: around the outside of an open piece
// it is -1, where a crossing is missing 3 and more. Between the two the cloud decides, because strongly
// curved caps and saddles do not have the 1 of a flat disk. By experiment.
constexpr double rimTurns = -0.5, tangledTurns = 2.5;

// Signed angle from a to b about n, in (-pi, pi].
double signedAngle(const Vector3d& a, const Vector3d& b, const Vector3d& n)
{
	return std::atan2(n.dot(a.cross(b)), a.dot(b) - n.dot(a) * n.dot(b));
}

// Interior angle on the left between arriving by `in` and leaving by `out`, in [0, 2 pi].
double cornerAngle(const HalfEdgeGraph& graph, Index in, Index out)
{
	const Index back = HalfEdgeGraph::twin(in);
	if (back == out)
		return 2.0 * pi;
	const double angle = signedAngle(
		graph.tangent(out), graph.tangent(back), graph.normals().col(graph.origin(out)));
	return angle < 0.0 ? angle + 2.0 * pi : angle;
}

// How far an edge turns to the left between its two end tangents. By way of its middle, because a
// long edge may turn more than half a turn; but a short one may lie the wrong way round for its
// tangents.
double bend(const HalfEdgeGraph& graph, Index h)
{
	const Index     back = HalfEdgeGraph::twin(h), from = graph.origin(h), to = graph.origin(back);
	const auto&     edge   = graph.edge(h >> 1);
	const Vector3d  first  = edge.middle - graph.positions().col(from);
	const Vector3d  second = graph.positions().col(to) - edge.middle;
	const Vector3d& start  = graph.tangent(h);
	const Vector3d  end    = -graph.tangent(back);
	if (first.dot(start) <= 0.0 || second.dot(end) <= 0.0)
		return signedAngle(start, end, edge.middleNormal);
	return signedAngle(start, first, graph.normals().col(from)) +
	       signedAngle(first, second, edge.middleNormal) +
	       signedAngle(second, end, graph.normals().col(to));
}

} // namespace

double turningNumber(const HalfEdgeGraph& graph, const std::vector<Index>& loop)
{
	double turning = 0.0;
	for (std::size_t k = 0; k < loop.size(); ++k) {
		const Index out = loop[(k + 1) % loop.size()];
		turning += pi - cornerAngle(graph, loop[k], out) + bend(graph, loop[k]);
	}
	return turning / (2.0 * pi);
}

LoopClassifier::LoopClassifier(
	const PointCloud& cloud, const VoronoiCells& cells, const HalfEdgeGraph& graph) :
		m_cloud(cloud), m_cells(cells), m_graph(graph)
{
}

LoopKind LoopClassifier::operator()(const std::vector<Index>& loop) const
{
	const double turning = turningNumber(m_graph, loop);
	if (turning < rimTurns)
		return LoopKind::Rim;
	if (turning > tangledTurns)
		return LoopKind::Tangled;
	return isCovered(loop) ? LoopKind::Face : LoopKind::Hole;
}

bool LoopClassifier::isCovered(const std::vector<Index>& loop) const
{
	const double n      = static_cast<double>(loop.size());
	Vector3d     center = Vector3d::Zero(), normal = Vector3d::Zero();
	for (Index h : loop)
		center += m_graph.positions().col(m_graph.origin(h)) / n;
	double   size       = 0.0;
	Vector3d meanOfEnds = Vector3d::Zero();
	for (Index h : loop) {
		meanOfEnds += m_graph.normals().col(m_graph.origin(h)) / n;
		const Vector3d a = m_graph.positions().col(m_graph.origin(h)) - center;
		const Vector3d b = m_graph.positions().col(m_graph.origin(HalfEdgeGraph::twin(h))) - center;
		normal += a.cross(b);
		size += a.norm() / n;
	}
	// The vector area of a sliver may point anywhere; the normals around an opening cancel.
	normal = meanOfEnds.norm() > 0.5 ? meanOfEnds.normalized() : normal.normalized();

	Index site = 0, samples = 0, covered = 0;
	for (Index h : loop) {
		const Vector3d corner = m_graph.positions().col(m_graph.origin(h));
		for (const double inward : {0.5, 0.75, 0.95}) {
			const Vector3d sample = corner + inward * (center - corner);
			++samples;
			covered += isPointAbove(sample, normal, size, site);
		}
	}
	return 2 * covered >= samples;
}

// Searches along the normal to both sides of the sample; `site` is where the search starts and ends.
bool LoopClassifier::isPointAbove(
	const Vector3d& sample, const Vector3d& normal, double size, Index& site) const
{
	const auto isNear = [&](double height) {
		const Vector3d point  = sample + height * normal;
		site                  = m_cells.locate(point, site);
		const Vector3d n      = m_cloud.normals.col(site);
		Vector3d       offset = m_cells.site(site) - point;
		if (height == 0.0 && n.dot(normal) > sameWay)
			offset -= offset.dot(n) * n;
		return n.dot(normal) > 0.0 && offset.norm() < coverDistance * siteSpacing(m_cells, site);
	};
	if (isNear(0.0))
		return true;
	const double step = coverDistance * siteSpacing(m_cells, site);
	if (!(step > 0.0))
		return false;
	for (double height = step; height < 1.5 * size; height += step)
		if (isNear(height) || isNear(-height))
			return true;
	return false;
}

} // namespace curvature_lines
