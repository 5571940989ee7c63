// The choice between the two estimates, and directions in other tangent planes.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature_estimate.h"

#include <Eigen/Geometry>

namespace curvature_lines {

CurvatureField estimateCurvature(
	const PointCloud&           cloud,
	const NeighborSearch&       search,
	const MinimumNeighborhoods& minimum,
	const CurvatureOptions&     options,
	const Progress&             progress)
{
	return options.scaleMode == ScaleMode::Adaptive
	           ? adaptiveCurvature(cloud, search, minimum, options.adaptive, progress)
	           : robustCurvature(cloud, search, minimum, options.paper, progress);
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
		const Eigen::Vector3d n = normals.col(i), d = field.d1.col(i);
		const Eigen::Vector3d tangent = d - n * n.dot(d);
		const double          length  = tangent.norm();
		field.d1.col(i) = length > 1e-6 ? Eigen::Vector3d(tangent / length) : TangentFrame(n).u;
		field.d2.col(i) = n.cross(field.d1.col(i));
	}
}

} // namespace curvature_lines
