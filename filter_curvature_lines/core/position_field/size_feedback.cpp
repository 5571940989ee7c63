// Distances, and shortest ways over the edges of the scaffold.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "size_feedback.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "mesh_distance.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "quantile.h"
#include "scaffold.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

// Of the distance that is accepted, from try to try.
constexpr double acceptedStep = 1.3;

// Sizes no larger than those of the neighbours and the growth along the edge between.
void grade(const TriangleMesh& mesh, double gradation, Eigen::VectorXd& size)
{
	std::vector<std::vector<Index>> edgesAt(mesh.vertexCount());
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		edgesAt[mesh.edges()[e].from].push_back(e);
		edgesAt[mesh.edges()[e].to].push_back(e);
	}
	using Item = std::pair<double, Index>;
	std::priority_queue<Item, std::vector<Item>, std::greater<>> open;
	for (Index v = 0; v < mesh.vertexCount(); ++v)
		open.emplace(size[v], v);
	while (!open.empty()) {
		const auto [known, v] = open.top();
		open.pop();
		if (known > size[v])
			continue;
		for (const Index e : edgesAt[v]) {
			const auto&  edge  = mesh.edges()[e];
			const Index  other = edge.from == v ? edge.to : edge.from;
			const double most  = known + gradation * mesh.along(e).norm();
			if (most < size[other]) {
				size[other] = most;
				open.emplace(most, other);
			}
		}
	}
}

} // namespace

double acceptedDistance(const Scaffold& scaffold, const SizeFeedbackOptions& options)
{
	if (options.acceptedLength > 0.0 || scaffold.size.size() == 0)
		return options.acceptedLength;
	return options.accepted *
	       quantile(std::vector<double>(scaffold.size.begin(), scaffold.size.end()), 0.5);
}

LeftOut
shrinkSizesWhereFar(const PolygonMesh& mesh, Scaffold& scaffold, const SizeFeedbackOptions& options)
{
	if (scaffold.size.size() == 0 || mesh.faceCount() == 0)
		return {};
	const Eigen::VectorXd distance = distanceToMesh(mesh, scaffold.mesh.vertices).distance;
	const Eigen::VectorXd areas = scaffold.mesh.vertexAreas(), before = scaffold.size;
	const auto            vertices = [&](const Eigen::VectorXd& size) {
        return (areas.array() / size.array().square()).sum();
	};
	double  accepted = acceptedDistance(scaffold, options);
	LeftOut far;
	for (const double d : distance) {
		if (!(d > accepted))
			continue;
		++far.vertices;
		far.weight += (d / accepted) * (d / accepted);
		far.worst = std::max(far.worst, d / accepted);
	}
	for (; (distance.array() > accepted).any(); accepted *= acceptedStep) {
		scaffold.size = before;
		for (Index v = 0; v < scaffold.mesh.vertexCount(); ++v)
			if (distance[v] > accepted)
				scaffold.size[v] *= std::max(options.leastFactor, accepted / distance[v]);
		grade(scaffold.mesh, options.gradation, scaffold.size);
		if (vertices(scaffold.size) <= options.mostGrowth * vertices(before))
			return far;
	}
	scaffold.size = before;
	return far;
}

} // namespace curvature_lines
