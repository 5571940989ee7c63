// Layers to point clouds and back.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "layer_conversion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <Eigen/Core>

#include <common/mlexception.h>
#include <vcg/complex/algorithms/update/color.h>

#include "host_types.h"
#include "normal_check.h"
#include "normal_estimation.h"
#include "point_cloud.h"
#include "progress.h"
#include "raw_curvatures.h"

namespace curvature_lines {

namespace {

void setColor(vcg::Color4b& color, const Eigen::Vector3d& rgb)
{
	for (int c = 0; c < 3; ++c)
		color[c] = static_cast<unsigned char>(std::lround(255.0 * std::clamp(rgb[c], 0.0, 1.0)));
	color[3] = 255;
}

} // namespace

MeshModel& currentLayer(MeshDocument& document)
{
	if (document.mm() == nullptr)
		throw MLException("there is no current layer; open or select a point cloud.");
	return *document.mm();
}

int currentLayerId(const MeshDocument& document)
{
	return document.mm() == nullptr ? -1 : document.mm()->id();
}

const MeshModel& layerWithId(const MeshDocument& document, int id, const QString& parameter)
{
	const MeshModel* layer = document.getMesh(id);
	if (layer == nullptr)
		throw MLException(
			"parameter '" + parameter + "' is " + QString::number(id) +
			", and there is no such layer.");
	return *layer;
}

void requireSameMatrix(const MeshModel& a, const MeshModel& b, const QString& names)
{
	constexpr double rounding =
		1e-5; // some hundred times that of single precision, in which hosts may hold matrices
	for (int r = 0; r < 4; ++r)
		for (int c = 0; c < 4; ++c)
			if (!(std::abs(a.cm.Tr[r][c] - b.cm.Tr[r][c]) <=
			      rounding * (1.0 + std::abs(double(b.cm.Tr[r][c])))))
				throw MLException(
					names +
					" have different matrices; freeze or reset the matrices of both layers the "
					"same way.");
}

LayerPoints readPoints(const MeshModel& layer)
{
	const CMeshO& mesh = layer.cm;
	if (mesh.vn == 0)
		throw MLException("the layer '" + layer.label() + "' is empty; a point cloud is needed.");
	LayerPoints points;
	points.positions.resize(3, mesh.vn);
	points.normals.resize(3, mesh.vn);
	points.vertex.reserve(mesh.vn);
	for (std::size_t v = 0; v < mesh.vert.size(); ++v) {
		if (mesh.vert[v].IsD())
			continue;
		points.positions.col(points.size()) = toEigen(mesh.vert[v].cP());
		points.normals.col(points.size())   = toEigen(mesh.vert[v].cN());
		points.vertex.push_back(v);
	}
	return points;
}

LayerPoints
readOrientedPoints(const MeshModel& layer, const Progress& progress, EstimateNormals when)
{
	LayerPoints points = readPoints(layer);
	if (mustEstimate(when, points.normals)) {
		points.estimated = estimateNormalsOfAll(
			withoutNormals(points.positions),
			points.normals,
			{},
			progress.sub(0.0, 1.0, "Estimating normals"));
		points.normals.swap(points.estimated->normals);
		points.estimated->normals.resize(3, 0);
		return points;
	}
	if ((points.normals.array() == 0.0).all())
		throw MLException(
			"the points of layer '" + layer.label() +
			"' have no normals. Set 'estimate_normals' to If Missing, or first run 'Estimate and "
			"Orient Normals' (compute_normals_robust_point_cloud) or MeshLab's "
			"'Compute normals for point sets'.");
	points.normalCheck = checkNormals(points.positions, points.normals);
	return points;
}

void writeAttribute(
	MeshModel&             layer,
	const LayerPoints&     points,
	const std::string&     name,
	const Eigen::VectorXd& values)
{
	auto attribute = vcg::tri::Allocator<CMeshO>::GetPerVertexAttribute<Scalarm>(layer.cm, name);
	for (Index i = 0; i < points.size(); ++i)
		attribute[points.vertex[i]] = toScalar(values[i]);
}

void writeQuality(MeshModel& layer, const LayerPoints& points, const Eigen::VectorXd& values)
{
	layer.updateDataMask(MeshModel::MM_VERTQUALITY);
	for (Index i = 0; i < points.size(); ++i)
		layer.cm.vert[points.vertex[i]].Q() = toScalar(values[i]);
}

void writeColors(MeshModel& layer, const LayerPoints& points, const Eigen::Matrix3Xd& colors)
{
	layer.updateDataMask(MeshModel::MM_VERTCOLOR);
	for (Index i = 0; i < points.size(); ++i)
		setColor(layer.cm.vert[points.vertex[i]].C(), colors.col(i));
}

void writeColorRamp(MeshModel& layer, double from, double to)
{
	layer.updateDataMask(MeshModel::MM_VERTCOLOR);
	vcg::tri::UpdateColor<CMeshO>::PerVertexQualityRamp(layer.cm, toScalar(from), toScalar(to));
}

void writePositions(
	MeshModel&              layer,
	const LayerPoints&      points,
	const PreparedCloud&    prepared,
	const Eigen::Matrix3Xd& unitPositions)
{
	for (Index i = 0; i < points.size(); ++i)
		if (const Index r = prepared.representative[i]; r >= 0)
			layer.cm.vert[points.vertex[i]].P() = toPoint(prepared.toModel(unitPositions.col(r)));
	vcg::tri::UpdateBounding<CMeshO>::Box(layer.cm);
	if (layer.cm.fn > 0)
		vcg::tri::UpdateNormal<CMeshO>::PerFaceNormalized(layer.cm);
}

void writeNormals(
	MeshModel&              layer,
	const LayerPoints&      points,
	const PreparedCloud&    prepared,
	const Eigen::Matrix3Xd& normals)
{
	for (Index i = 0; i < points.size(); ++i)
		if (const Index r = prepared.representative[i]; r >= 0)
			layer.cm.vert[points.vertex[i]].N() =
				toPoint(normalForRaw(normals.col(r), points.normals, prepared, i));
}

NewLayers::NewLayers(MeshDocument& document) :
		m_document(document), m_current(currentLayerId(document))
{
}

NewLayers::~NewLayers()
{
	for (const int id : m_ids)
		m_document.delMesh(id);
	if (!m_ids.empty() && m_current >= 0)
		m_document.setCurrentMesh(m_current);
}

MeshModel& NewLayers::add(const QString& label, const MeshModel& source)
{
	m_ids.reserve(m_ids.size() + 1);
	MeshModel* layer = m_document.addNewMesh("", label, false);
	m_ids.push_back(layer->id());
	layer->cm.Tr = source.cm.Tr;
	return *layer;
}

void NewLayers::keep(const MeshModel& current)
{
	m_document.setCurrentMesh(current.id());
	m_ids.clear();
}

} // namespace curvature_lines
