// Points projected until they stay, and places to project.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "point_set_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "control_neighborhood.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

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
		thread_local ControlNeighborhood around;
		Eigen::Vector3d                  point = positions.col(i);
		for (Index it = 1; it <= options.iterations; ++it) {
			if (!surface.gather(point, around))
				return;
			const auto quadric = surface.near(around, point);
			if (!quadric)
				return;
			const Eigen::Vector3d moved = quadric->foot(point);
			const bool settled = (moved - point).norm() < options.tolerance * around.spacing();
			point              = moved;
			iterations[i]      = it;
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

ProjectionMoves movesOf(const ProjectedPoints& points, const Eigen::Matrix3Xd& from, double unit)
{
	ProjectionMoves moves;
	double          squares = 0.0;
	for (Eigen::Index i = 0; i < from.cols(); ++i) {
		if (!points.projected[i])
			continue;
		const double step = unit * (points.positions.col(i) - from.col(i)).norm();
		squares += step * step;
		moves.largest = std::max(moves.largest, step);
		++moves.projected;
	}
	if (moves.projected > 0)
		moves.rms = std::sqrt(squares / moves.projected);
	return moves;
}

Eigen::Matrix3Xd
scatterAround(const ControlPoints& control, const Eigen::Matrix3Xd& positions, Index count)
{
	constexpr double reach       = 2.5; // spacings
	constexpr double goldenAngle = 2.399963229728653;
	const auto       n           = static_cast<Index>(positions.cols());
	Eigen::Matrix3Xd scattered(3, std::int64_t(n) * count);
	parallelFor(n, {}, [&](Index i) {
		thread_local ControlNeighborhood around;
		const Eigen::Vector3d            center = positions.col(i);
		const bool                       known  = around.gather(control, center, reach);
		for (Index k = 0; k < count; ++k) {
			Eigen::Vector3d offset = Eigen::Vector3d::Zero();
			if (known && k > 0) {
				// A disk as large as the square of one spacing, along a sunflower spiral turned from vertex to
				// vertex.
				const TangentFrame frame(around.side());
				const double       radius =
					around.spacing() * std::sqrt((k + 0.5) / (count * double(EIGEN_PI)));
				const double angle = goldenAngle * (k + double(count) * i);
				offset = radius * (std::cos(angle) * frame.u + std::sin(angle) * frame.v);
			}
			scattered.col(std::int64_t(i) * count + k) = center + offset;
		}
	});
	return scattered;
}

} // namespace curvature_lines
