// Curvature of vertices.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "layer_curvature.h"

#include <Eigen/Core>

#include "host_types.h"
#include "layer_conversion.h"
#include "point_cloud.h"
#include "raw_curvatures.h"

namespace curvature_lines {

void writeCurvature(MeshModel& layer, const LayerPoints& points, const RawCurvatures& values)
{
	layer.updateDataMask(MeshModel::MM_VERTCURVDIR);
	for (Index i = 0; i < points.size(); ++i) {
		CVertexO& vertex = layer.cm.vert[points.vertex[i]];
		vertex.K1()      = toScalar(values.k1[i]);
		vertex.K2()      = toScalar(values.k2[i]);
		vertex.PD1()     = toPoint(values.d1.col(i));
		vertex.PD2()     = toPoint(values.d2.col(i));
	}
	Eigen::VectorXd status(points.size());
	for (Index i = 0; i < points.size(); ++i)
		status[i] = static_cast<double>(values.status[i]);
	writeAttribute(layer, points, "curv_k1", values.k1);
	writeAttribute(layer, points, "curv_k2", values.k2);
	writeAttribute(layer, points, "curv_confidence", values.confidence);
	writeAttribute(layer, points, "curv_error", values.error);
	writeAttribute(layer, points, "curv_scale", values.radius);
	writeAttribute(layer, points, "curv_feature", values.feature);
	writeAttribute(layer, points, "curv_status", status);
}

bool carriesCurvature(
	const MeshModel& layer, const LayerPoints& points, const RawCurvatures& values)
{
	if (!layer.hasDataMask(MeshModel::MM_VERTCURVDIR))
		return false;
	// Estimates whose options differ may have the same curvatures and other statistical weights.
	const auto confidence =
		vcg::tri::Allocator<CMeshO>::FindPerVertexAttribute<Scalarm>(layer.cm, "curv_confidence");
	const bool known = vcg::tri::Allocator<CMeshO>::IsValidHandle(layer.cm, confidence);
	for (Index i = 0; i < points.size(); ++i) {
		const CVertexO& vertex = layer.cm.vert[points.vertex[i]];
		if (vertex.cK1() != toScalar(values.k1[i]) || vertex.cK2() != toScalar(values.k2[i]))
			return false;
		if (known && confidence[points.vertex[i]] != toScalar(values.confidence[i]))
			return false;
	}
	return true;
}

bool carriesDirections(
	const MeshModel& layer, const LayerPoints& points, const RawCurvatures& values)
{
	for (Index i = 0; i < points.size(); ++i)
		if (layer.cm.vert[points.vertex[i]].cPD1() != toPoint(values.d1.col(i)))
			return false;
	return true;
}

Eigen::Matrix3Xd
readDirections(const MeshModel& layer, const LayerPoints& points, const PreparedCloud& prepared)
{
	Eigen::Matrix3Xd directions(3, prepared.cloud.size());
	for (Index r = 0; r < prepared.cloud.size(); ++r)
		directions.col(r) = toEigen(layer.cm.vert[points.vertex[prepared.source[r]]].cPD1());
	return directions;
}

} // namespace curvature_lines
