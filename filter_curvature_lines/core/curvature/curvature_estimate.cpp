// The choice between the two estimates, and directions in other tangent planes.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature_estimate.h"

#include <Eigen/Geometry>

#include "adaptive_curvature.h"
#include "cloud_index.h"
#include "curvature_field.h"
#include "members.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "robust_curvature.h"

namespace curvature_lines {

namespace {

// The options of the mode that is not chosen at their defaults.
CurvatureOptions effective(CurvatureOptions options)
{
	if (options.scaleMode == ScaleMode::Adaptive)
		options.paper = {};
	else
		options.adaptive = {};
	return options;
}

} // namespace

bool operator==(const CurvatureOptions& a, const CurvatureOptions& b)
{
	const CurvatureOptions x = effective(a), y = effective(b);
	return members<3>(x) == members<3>(y);
}

CurvatureField estimateCurvature(
	const CloudIndex& index, const CurvatureOptions& options, const Progress& progress)
{
	index.minimum(progress.sub(0.0, 0.1, "Finding neighborhoods"));
	const Progress rest = progress.sub(0.1, 1.0, "Estimating curvature");
	return options.scaleMode == ScaleMode::Adaptive
	           ? adaptiveCurvature(index, options.adaptive, rest)
	           : robustCurvature(index, options.paper, rest);
}

Eigen::Matrix3Xd surfaceNormals(const CurvatureField& field)
{
	Eigen::Matrix3Xd normals(3, field.size());
	for (Index i = 0; i < field.size(); ++i) {
		const Eigen::Vector3d d1 = field.d1.col(i), d2 = field.d2.col(i);
		normals.col(i) = d1.cross(d2).normalized();
	}
	return normals;
}

void makeTangent(const Eigen::Matrix3Xd& normals, CurvatureField& field)
{
	for (Index i = 0; i < field.size(); ++i) {
		const Eigen::Vector3d n = normals.col(i);
		field.d1.col(i)         = tangentNear(field.d1.col(i), n);
		field.d2.col(i)         = n.cross(field.d1.col(i));
	}
}

void adoptDirections(
	const Eigen::Matrix3Xd& directions, const Eigen::Matrix3Xd& normals, CurvatureField& field)
{
	for (Index i = 0; i < field.size(); ++i) {
		const Eigen::Vector3d d = directions.col(i);
		if (d.allFinite() && d.norm() >= 1e-6)
			field.d1.col(i) = d;
	}
	makeTangent(normals, field);
}

} // namespace curvature_lines
