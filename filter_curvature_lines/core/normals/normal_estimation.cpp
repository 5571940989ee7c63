// Plane fits whose side the winding field tells, of all points or of a sample of them.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "normal_estimation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "dipole_sums.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "quantile.h"
#include "side_domains.h"
#include "spatial_order.h"
#include "winding_field.h"

namespace curvature_lines {

namespace {

constexpr Index  fewNeighbors  = 25; // of a plane fit without noise (Hoppe 1992 has similar ones)
constexpr Index  manyNeighbors = 160;
constexpr double widthPower =
	1.5; // neighbours grow with the width of the kernel, noise and detail in balance
constexpr Index fewestOnSide = 8;     // fewer neighbours of one side: the field itself
constexpr Index largeSample  = 25000; // points of a larger cloud that the field is found on
constexpr Index nearSamples  = 3;
// Share of neighbours on the side of a point, itself included. This, and a second fit of the planes, were chosen on a torus of
// 2000 points with 1 % noise that a test holds.
constexpr double dissent  = 0.25;
constexpr double doubtful = 0.4;

double medianSpacing(const Eigen::Matrix3Xd& positions, const NeighborSearch& search)
{
	constexpr Index     k = 16;
	const auto          n = static_cast<Index>(positions.cols());
	std::vector<double> spacing(n);
	parallelFor(n, {}, [&](Index i) {
		const Index last = search.nearest(positions.col(i), k + 1).back();
		spacing[i] =
			(positions.col(last) - positions.col(i)).norm() * std::sqrt(double(EIGEN_PI) / k);
	});
	return medianInPlace(spacing);
}

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

// Planes through the neighbours of the same side, which is that of their field; doubt: by how much they disagree.
EstimatedNormals planesOnSides(
	const Eigen::Matrix3Xd& positions,
	const NeighborSearch&   search,
	const Eigen::Matrix3Xd& field, // 3 x N, unit or zero
	Index                   neighbors,
	const Progress&         progress)
{
	const auto       n = static_cast<Index>(positions.cols());
	EstimatedNormals result{Eigen::Matrix3Xd(3, n), Eigen::VectorXd::Zero(n)};
	parallelFor(n, progress, [&](Index i) {
		const std::vector<Index> near = search.nearest(positions.col(i), neighbors + 1);
		std::vector<Index>       side;
		Eigen::Vector3d          sum = Eigen::Vector3d::Zero();
		for (Index j : near)
			if (field.col(i).dot(field.col(j)) > 0.0) {
				side.push_back(j);
				sum += field.col(j);
			}
		const bool decided = !field.col(i).isZero(0.0);
		if (decided && static_cast<Index>(side.size()) < fewestOnSide) {
			result.normals.col(i) = field.col(i);
			result.doubt[i]       = 1.0 - double(side.size()) / double(near.size());
			return;
		}
		Eigen::Vector3d normal = planeNormal(positions, decided ? side : near);
		const double    along  = normal.dot(sum);
		if (along < 0.0)
			normal = -normal;
		result.normals.col(i) = normal;
		result.doubt[i] =
			decided ? std::clamp(1.0 - std::abs(along) / double(side.size()), 0.0, 1.0) : 1.0;
	});
	return result;
}

// Where the normal of a point opposes nearly all of its neighbours', it is the point that is wrong: noise has put it
// behind the others. Both sides of a thin wall have many points, also among the neighbours of each.
void turnDissenters(
	const Eigen::Matrix3Xd& positions, const NeighborSearch& search, Eigen::Matrix3Xd& normals)
{
	std::vector<char> turn(normals.cols(), 0);
	parallelFor(static_cast<Index>(normals.cols()), {}, [&](Index i) {
		const std::vector<Index> near = search.nearest(positions.col(i), fewNeighbors + 1);
		Index                    same = 0;
		for (Index j : near)
			same += normals.col(i).dot(normals.col(j)) > 0.0;
		turn[i] = double(same) < dissent * double(near.size());
	});
	for (Eigen::Index i = 0; i < normals.cols(); ++i)
		if (turn[i])
			normals.col(i) *= -1.0;
}

// The first planes choose the neighbours of the second: they are far less noisy than the field. The doubt is that of
// the field.
EstimatedNormals agreedPlanes(
	const Eigen::Matrix3Xd& positions,
	const NeighborSearch&   search,
	const Eigen::Matrix3Xd& field,
	Index                   neighbors,
	const Progress&         progress)
{
	EstimatedNormals result = planesOnSides(
		positions, search, field, neighbors, progress.sub(0.0, 0.5, "Fitting planes"));
	turnDissenters(positions, search, result.normals);
	result.normals =
		planesOnSides(
			positions, search, result.normals, neighbors, progress.sub(0.5, 1.0, "Fitting planes"))
			.normals;
	return result;
}

struct Sides {
	EstimatedNormals estimate;
	double           width = 0.0; // of the kernel, a length
};

Index planeNeighbors(const NormalEstimationOptions& options, double widthInSpacings)
{
	if (options.neighbors > 0)
		return options.neighbors;
	return std::min<Index>(
		manyNeighbors,
		static_cast<Index>(
			std::lround(fewNeighbors * std::pow(std::max(1.0, widthInSpacings), widthPower))));
}

Sides sidesOfAll(
	const Eigen::Matrix3Xd&        positions,
	const NeighborSearch&          search,
	double                         spacing,
	const NormalEstimationOptions& options, // in the frame of the positions
	const Progress&                progress)
{
	if (spacing <= 0.0) // more than half of the points lie on one place
		return {planesOnSides(
			positions,
			search,
			Eigen::Matrix3Xd::Zero(3, positions.cols()),
			fewNeighbors,
			progress)};
	const DipoleSums   sums(positions);
	const WindingField field =
		windingField(positions, search, sums, spacing, progress.sub(0.0, 0.9, ""));
	Sides result;
	result.width = field.width * spacing;
	result.estimate =
		agreedPlanes(positions, search, field.directions, planeNeighbors(options, field.width), {});
	std::function<Eigen::Vector3d(Index)> preferred;
	if (options.openSides == OpenSides::Viewpoint)
		preferred = [&](Index i) -> Eigen::Vector3d {
			return (options.viewpoint - positions.col(i)).stableNormalized();
		};
	else if (options.openSides == OpenSides::Up)
		preferred = [](Index) -> Eigen::Vector3d { return Eigen::Vector3d::UnitZ(); };
	SideDomains aligned = alignSideDomains(
		positions,
		std::move(result.estimate.normals),
		search,
		sums,
		result.width,
		preferred,
		progress.sub(0.9, 1.0, "Aligning open parts"));
	result.estimate.normals        = std::move(aligned.normals);
	result.estimate.undecidedShare = aligned.undecidedShare;
	return result;
}

// The field of a large cloud is that of a sample, blended from the nearest points of it.
EstimatedNormals sidesBySample(
	const Eigen::Matrix3Xd&        positions,
	const NeighborSearch&          search,
	const std::vector<Index>&      chosen,
	const NormalEstimationOptions& options,
	const Progress&                progress)
{
	const Eigen::Matrix3Xd sample = columnsOf(positions, chosen);
	const NeighborSearch   sampleSearch(sample);
	const double           sampleSpacing = medianSpacing(sample, sampleSearch);
	const Sides            sides =
		sidesOfAll(sample, sampleSearch, sampleSpacing, options, progress.sub(0.0, 0.7, ""));
	const double     softening = 0.25 * sampleSpacing * sampleSpacing + 1e-30;
	Eigen::Matrix3Xd field(3, positions.cols());
	parallelFor(static_cast<Index>(positions.cols()), {}, [&](Index i) {
		Eigen::Vector3d sum = Eigen::Vector3d::Zero();
		for (Index j : sampleSearch.nearest(positions.col(i), nearSamples))
			sum += sides.estimate.normals.col(j) /
			       ((sample.col(j) - positions.col(i)).squaredNorm() + softening);
		field.col(i) = sum.stableNormalized();
	});
	const double     spacing = medianSpacing(positions, search);
	EstimatedNormals result  = agreedPlanes(
        positions,
        search,
        field,
        planeNeighbors(options, spacing > 0.0 ? sides.width / spacing : 1.0),
        progress.sub(0.7, 1.0, "Fitting planes"));
	result.undecidedShare = sides.estimate.undecidedShare;
	return result;
}

} // namespace

EstimatedNormals estimateNormals(
	const Eigen::Matrix3Xd&        positions,
	const NormalEstimationOptions& options,
	const Progress&                progress)
{
	const auto n = static_cast<Index>(positions.cols());
	if (n < 3)
		throw InputError(
			"Normals need at least 3 points, the layer has " + std::to_string(n) +
			"; load a point cloud first.");
	const Eigen::Vector3d low     = positions.rowwise().minCoeff(),
						  high    = positions.rowwise().maxCoeff();
	const Eigen::Vector3d  center = 0.5 * low + 0.5 * high;
	const double           extent = std::max((high - low).maxCoeff(), 1e-300);
	const SpatialOrder     order(positions);
	const Eigen::Matrix3Xd ordered = (order.arrange(positions).colwise() - center).array() / extent;
	const NeighborSearch   search(ordered);
	NormalEstimationOptions own = options;
	own.viewpoint               = (options.viewpoint - center) / extent;

	EstimatedNormals result;
	if (n > largeSample + largeSample / 2)
		result = sidesBySample(ordered, search, order.sample(largeSample), own, progress);
	else
		result =
			sidesOfAll(ordered, search, medianSpacing(ordered, search), own, progress).estimate;
	result.normals = order.restore(result.normals);
	Eigen::VectorXd doubt(n);
	for (Index k = 0; k < n; ++k)
		doubt[order.source[k]] = result.doubt[k];
	result.doubt         = doubt;
	result.doubtfulShare = double((doubt.array() > doubtful).count()) / double(n);
	return result;
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

PreparedCloud withoutNormals(const Eigen::Matrix3Xd& positions)
{
	const Eigen::Vector3d up = Eigen::Vector3d::UnitZ(); // any normals do
	return prepareCloud(positions, up.replicate(1, positions.cols()));
}

EstimatedNormals estimateNormalsOfAll(
	const PreparedCloud&    prepared,
	Eigen::Matrix3Xd        normals,
	NormalEstimationOptions options,
	const Progress&         progress)
{
	options.viewpoint          = prepared.toUnit(options.viewpoint);
	EstimatedNormals estimated = estimateNormals(prepared.cloud.positions, options, progress);
	Eigen::VectorXd  doubt     = Eigen::VectorXd::Zero(normals.cols());
	for (Index i = 0; i < static_cast<Index>(normals.cols()); ++i)
		if (const Index kept = prepared.representative[i]; kept >= 0) {
			normals.col(i) = estimated.normals.col(kept);
			doubt[i]       = estimated.doubt[kept];
		}
	estimated.doubt   = std::move(doubt);
	estimated.normals = std::move(normals);
	return estimated;
}

} // namespace curvature_lines
