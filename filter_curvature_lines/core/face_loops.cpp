// Loops of the graph told apart by their total turning (Gauss-Bonnet) and by the points inside.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "face_loops.h"

#include <cmath>

#include <Eigen/Geometry>

#include "line_intersections.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

constexpr double Pi = 3.14159265358979323846;
// A sample is covered when the nearest point of the cloud is at most this many spacings aside ...
constexpr double CoverDistance = 2.5;
// ... and its height above that point's tangent plane at most this share of the loop's size: a face is
// flatter than that, a cap over an open end is not.
constexpr double CoverHeight = 0.3;

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
		return 2.0 * Pi;
	const double angle =
		signedAngle(graph.tangent(out), graph.tangent(back), graph.normals().col(graph.origin(out)));
	return angle < 0.0 ? angle + 2.0 * Pi : angle;
}

// How far an edge turns to the left between its two end tangents. By way of its middle, because a long edge
// may turn more than half a turn; but a short one may lie the wrong way round for its tangents.
double bend(const HalfEdgeGraph& graph, Index h)
{
	const Index    back = HalfEdgeGraph::twin(h), from = graph.origin(h), to = graph.origin(back);
	const auto&    edge   = graph.edge(h >> 1);
	const Vector3d first  = edge.middle - graph.positions().col(from);
	const Vector3d second = graph.positions().col(to) - edge.middle;
	const Vector3d start = graph.tangent(h), end = -graph.tangent(back);
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
		turning += Pi - cornerAngle(graph, loop[k], out) + bend(graph, loop[k]);
	}
	return turning / (2.0 * Pi);
}

LoopClassifier::LoopClassifier(
	const PointCloud& cloud, const VoronoiCells& cells, const HalfEdgeGraph& graph) :
		m_cloud(cloud), m_cells(cells), m_graph(graph)
{
}

LoopKind LoopClassifier::operator()(const std::vector<Index>& loop) const
{
	const double turning = turningNumber(m_graph, loop);
	if (turning < 0.5)
		return LoopKind::Rim;
	if (turning > 1.5)
		return LoopKind::Tangled;
	return covered(loop) ? LoopKind::Face : LoopKind::Hole;
}

bool LoopClassifier::covered(const std::vector<Index>& loop) const
{
	Vector3d center = Vector3d::Zero();
	for (Index h : loop)
		center += m_graph.positions().col(m_graph.origin(h));
	center /= static_cast<double>(loop.size());

	Index site = 0, samples = 0, bare = 0;
	for (Index h : loop) {
		const Vector3d corner = m_graph.positions().col(m_graph.origin(h));
		const double   size   = (corner - center).norm();
		for (const double inward : {0.35, 0.6, 0.85}) {
			const Vector3d sample = corner + inward * (center - corner);
			site                  = m_cells.locate(sample, site);
			const Vector3d offset = sample - m_cells.site(site);
			const Vector3d normal = m_cloud.normals.col(site);
			const double   height = std::abs(offset.dot(normal));
			const double   aside  = (offset - offset.dot(normal) * normal).norm();
			const double   reach  = CoverDistance * siteSpacing(m_cells, site);
			++samples;
			bare += aside > reach || height > std::max(reach, CoverHeight * size);
		}
	}
	return 2 * bare <= samples;
}

} // namespace curvature_lines
