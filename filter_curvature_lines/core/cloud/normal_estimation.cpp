// Plane-fit normals (Hoppe 1992) oriented along a minimum spanning tree of the neighbour graph (CGAL).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "normal_estimation.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <tuple>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/mst_orient_normals.h>
#include <CGAL/property_map.h>
#include <Eigen/Dense>

#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

namespace {

using Kernel      = CGAL::Exact_predicates_inexact_constructions_kernel;
using OrientPoint = std::tuple<Kernel::Point_3, Kernel::Vector_3, Index>;

// enough to connect one sheet, too few to bridge to the next
constexpr unsigned orientNeighbors = 12;
constexpr int      maxParts        = 64; // pieces of a cloud that are oriented one after another

Eigen::Vector3d planeNormal(const Eigen::Matrix3Xd& positions, const std::vector<Index>& points)
{
	Eigen::Vector3d mean = Eigen::Vector3d::Zero();
	for (Index j : points)
		mean += positions.col(j);
	mean /= static_cast<double>(points.size());
	Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
	for (Index j : points) {
		const Eigen::Vector3d d = positions.col(j) - mean;
		covariance += d * d.transpose();
	}
	// Eigenvalues come in increasing order; a unit vector results even where all are zero.
	return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors().col(0);
}

// Each call orients the connected piece that holds the topmost point, its normal there upward, which is
// outward for a closed shape; what the graph does not reach goes into the next call.
void orient(const Eigen::Matrix3Xd& positions, Eigen::Matrix3Xd& normals, const Progress& progress)
{
	std::vector<OrientPoint> rest;
	rest.reserve(positions.cols());
	for (Index i = 0; i < static_cast<Index>(positions.cols()); ++i) {
		const Eigen::Vector3d p = positions.col(i), n = normals.col(i);
		rest.emplace_back(
			Kernel::Point_3(p.x(), p.y(), p.z()), Kernel::Vector_3(n.x(), n.y(), n.z()), i);
	}
	const auto maps = CGAL::parameters::point_map(CGAL::Nth_of_tuple_property_map<0, OrientPoint>())
	                      .normal_map(CGAL::Nth_of_tuple_property_map<1, OrientPoint>());
	for (int part = 0; part < maxParts && rest.size() > orientNeighbors; ++part) {
		const auto unreached = CGAL::mst_orient_normals(rest, orientNeighbors, maps);
		for (auto point = rest.begin(); point != unreached; ++point) {
			const Kernel::Vector_3& n        = std::get<1>(*point);
			normals.col(std::get<2>(*point)) = Eigen::Vector3d(n.x(), n.y(), n.z());
		}
		rest.erase(rest.begin(), unreached);
		progress.report(1.0 - double(rest.size()) / double(positions.cols()));
	}
}

} // namespace

Eigen::Matrix3Xd estimateNormals(
	const Eigen::Matrix3Xd&        positions,
	const NormalEstimationOptions& options,
	const Progress&                progress)
{
	const auto n = static_cast<Index>(positions.cols());
	if (n < 3)
		throw InputError(
			"Normals need at least 3 points, the layer has " + std::to_string(n) +
			"; load a point cloud first.");
	const NeighborSearch search(positions);
	const Index          count = std::clamp<Index>(options.neighbors, 3, n);

	Eigen::Matrix3Xd normals(3, n);
	parallelFor(n, progress.sub(0.0, 0.5, "Fitting planes"), [&](Index i) {
		normals.col(i) = planeNormal(positions, search.nearest(positions.col(i), count));
	});
	if (options.orient)
		orient(positions, normals, progress.sub(0.5, 1.0, "Orienting normals"));
	return normals;
}

bool mustEstimate(EstimateNormals when, const Eigen::Matrix3Xd& normals)
{
	if (when != EstimateNormals::IfMissing)
		return when == EstimateNormals::Always;
	Eigen::Index usable = 0;
	for (Eigen::Index i = 0; i < normals.cols(); ++i)
		usable += normals.col(i).allFinite() && (normals.col(i).array() != 0.0).any();
	return 2 * usable < normals.cols();
}

Eigen::Matrix3Xd estimateNormalsWhereFinite(
	const Eigen::Matrix3Xd&        positions,
	Eigen::Matrix3Xd               normals,
	const NormalEstimationOptions& options,
	const Progress&                progress)
{
	std::vector<Index> finite;
	for (Index i = 0; i < static_cast<Index>(positions.cols()); ++i)
		if (positions.col(i).allFinite())
			finite.push_back(i);
	Eigen::Matrix3Xd kept(3, finite.size());
	for (std::size_t k = 0; k < finite.size(); ++k)
		kept.col(k) = positions.col(finite[k]);
	const Eigen::Matrix3Xd estimated = estimateNormals(kept, options, progress);
	for (std::size_t k = 0; k < finite.size(); ++k)
		normals.col(finite[k]) = estimated.col(k);
	return normals;
}

} // namespace curvature_lines
