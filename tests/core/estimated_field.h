// Sample clouds with plane-fit normals or given ones, taken through preparation and curvature estimation.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Dense>

#include "analytic_surfaces.h"
#include "cloud_index.h"
#include "curvature_estimate.h"
#include "curvature_field.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "robust_curvature.h"

namespace curvature_lines::test {

// Normals of plane fits to each point and its k nearest neighbours, with the sign of the truth.
inline Eigen::Matrix3Xd planeFitNormals(const samples::SampleCloud& sample, Index k)
{
	const NeighborSearch search(sample.positions);
	Eigen::Matrix3Xd     normals(3, sample.positions.cols());
	for (Index i = 0; i < static_cast<Index>(normals.cols()); ++i) {
		const auto       neighbors = search.nearest(sample.positions.col(i), k + 1);
		Eigen::Matrix3Xd local(3, neighbors.size());
		for (std::size_t j = 0; j < neighbors.size(); ++j)
			local.col(j) = sample.positions.col(neighbors[j]);
		local.colwise() -= local.rowwise().mean().eval();
		const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(local * local.transpose());
		const Eigen::Vector3d                                n = eigen.eigenvectors().col(0);
		normals.col(i) = n.dot(sample.normals.col(i)) < 0.0 ? Eigen::Vector3d(-n) : n;
	}
	return normals;
}

struct EstimatedField {
	PreparedCloud        prepared;
	MinimumNeighborhoods minimum;
	CurvatureField       field; // unit frame

	double k1(Index i) const { return field.k1[i] / prepared.diagonal; } // model units
	double k2(Index i) const { return field.k2[i] / prepared.diagonal; }
};

inline EstimatedField estimateField(
	const Eigen::Matrix3Xd&       positions,
	const Eigen::Matrix3Xd&       normals,
	const RobustCurvatureOptions& paper     = {},
	ScaleMode                     scaleMode = ScaleMode::Paper)
{
	CurvatureOptions options;
	options.scaleMode = scaleMode;
	options.paper     = paper;
	EstimatedField result;
	result.prepared = prepareCloud(positions, normals);
	const CloudIndex index(result.prepared.cloud);
	result.minimum = index.minimum();
	result.field   = estimateCurvature(index, options);
	return result;
}

inline EstimatedField
estimateAdaptiveField(const Eigen::Matrix3Xd& positions, const Eigen::Matrix3Xd& normals)
{
	return estimateField(positions, normals, {}, ScaleMode::Adaptive);
}

struct CurvatureErrors {
	double k1 = 0.0, k2 = 0.0;                    // RMS, 1/model length
	double direction    = 0.0;                    // mean angle, radians
	double normalBefore = 0.0, normalAfter = 0.0; // RMS, degrees
};

inline CurvatureErrors
curvatureErrors(const EstimatedField& estimated, const samples::GroundTruth& truth)
{
	const auto      angle = [](double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); };
	CurvatureErrors errors;
	const Index     n = estimated.field.size();
	for (Index i = 0; i < n; ++i) {
		const Index s = estimated.prepared.source[i];
		errors.k1 += std::pow(estimated.k1(i) - truth.k1[s], 2) / n;
		errors.k2 += std::pow(estimated.k2(i) - truth.k2[s], 2) / n;
		errors.direction += angle(std::abs(estimated.field.d1.col(i).dot(truth.d1.col(s)))) / n;
		errors.normalBefore +=
			std::pow(angle(estimated.prepared.cloud.normals.col(i).dot(truth.normals.col(s))), 2) /
			n;
		errors.normalAfter +=
			std::pow(angle(estimated.field.correctedNormals.col(i).dot(truth.normals.col(s))), 2) /
			n;
	}
	errors.k1           = std::sqrt(errors.k1);
	errors.k2           = std::sqrt(errors.k2);
	errors.normalBefore = std::sqrt(errors.normalBefore) * 180.0 / EIGEN_PI;
	errors.normalAfter  = std::sqrt(errors.normalAfter) * 180.0 / EIGEN_PI;
	return errors;
}

} // namespace curvature_lines::test
