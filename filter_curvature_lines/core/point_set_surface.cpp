// Neighbourhoods of control points, and points projected until they stay.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "point_set_surface.h"

#include <algorithm>
#include <cmath>

namespace curvature_lines {

namespace {

constexpr double isolated = 3.0; // spacings

} // namespace

bool ControlNeighborhood::gather(
	const ControlPoints& control, const Eigen::Vector3d& position, Index count)
{
	points.clear();
	if (position.allFinite())
		points = control.search.nearest(position, count);
	if (points.empty())
		return false;
	const auto squaredDistance = [&](Index j) {
		return (control.cloud.positions.col(j) - position).squaredNorm();
	};
	const double farthest = squaredDistance(points.back());
	double       total    = 0.0;
	spacing               = 0.0;
	for (const Index j : points) {
		const double w = 1.0 + 1e-9 - squaredDistance(j) / farthest;
		spacing += w * control.spacing[j];
		total += w;
	}
	spacing /= total;
	const Index closest = points.front();
	if (!(spacing > 0.0) || squaredDistance(closest) > isolated * isolated * spacing * spacing)
		return false;
	const Eigen::Vector3d side = control.cloud.normals.col(closest);
	points.erase(
		std::remove_if(
			points.begin(),
			points.end(),
			[&](Index j) { return control.cloud.normals.col(j).dot(side) <= 0.0; }),
		points.end());
	return true;
}

ProjectedPoints projectPoints(
	const PointSetSurface&   surface,
	const Eigen::Matrix3Xd&  positions,
	const ProjectionOptions& options,
	const Progress&          progress)
{
	const auto      n = static_cast<Index>(positions.cols());
	ProjectedPoints result;
	result.positions = positions;
	result.normals.setZero(3, n);
	result.projected.assign(n, 0);
	std::vector<Index> iterations(n, 0);
	parallelFor(n, progress, [&](Index i) {
		Eigen::Vector3d point = positions.col(i);
		for (Index it = 1; it <= options.iterations; ++it) {
			const auto quadric = surface.near(point);
			if (!quadric)
				return;
			const Eigen::Vector3d moved   = quadric->foot(point);
			const bool     settled = (moved - point).norm() < options.tolerance * quadric->spacing;
			point                  = moved;
			iterations[i]          = it;
			if (!settled && it < options.iterations)
				continue;
			result.positions.col(i) = point;
			result.normals.col(i)   = quadric->normalAt(point);
			result.projected[i]     = 1;
			return;
		}
	});
	if (n > 0)
		result.iterations = *std::max_element(iterations.begin(), iterations.end());
	return result;
}

Eigen::Matrix3Xd
scatterAround(const ControlPoints& control, const Eigen::Matrix3Xd& positions, Index count)
{
	constexpr Index    spacingNeighbors = 16;
	constexpr double   goldenAngle      = 2.399963229728653;
	const auto         n                = static_cast<Index>(positions.cols());
	Eigen::Matrix3Xd   scattered(3, std::int64_t(n) * count);
	parallelFor(n, {}, [&](Index i) {
		thread_local ControlNeighborhood around;
		const Eigen::Vector3d            center = positions.col(i);
		const bool known = around.gather(control, center, spacingNeighbors);
		for (Index k = 0; k < count; ++k) {
			Eigen::Vector3d offset = Eigen::Vector3d::Zero();
			if (known && k > 0) {
				// A disk as large as the square of one spacing, along a sunflower spiral turned from vertex to
				// vertex.
				const TangentFrame frame(control.cloud.normals.col(around.points.front()));
				const double       radius = around.spacing * std::sqrt((k + 0.5) / (count * double(EIGEN_PI)));
				const double       angle  = goldenAngle * (k + double(count) * i);
				offset = radius * (std::cos(angle) * frame.u + std::sin(angle) * frame.v);
			}
			scattered.col(std::int64_t(i) * count + k) = center + offset;
		}
	});
	return scattered;
}

} // namespace curvature_lines
