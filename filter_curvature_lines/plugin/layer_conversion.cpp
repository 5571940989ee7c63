// Layers to point clouds and back.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "layer_conversion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <common/mlexception.h>
#include <vcg/complex/algorithms/update/color.h>

#include "curvature_cache.h"

namespace curvature_lines {

namespace {

Eigen::Vector3d toEigen(const Point3m& p)
{
	return {double(p[0]), double(p[1]), double(p[2])};
}

// A layer may be in single precision, and no host survives a NaN in its histogram.
Scalarm toScalar(double value)
{
	constexpr double largest = std::numeric_limits<Scalarm>::max();
	return std::isfinite(value) ? Scalarm(std::clamp(value, -largest, largest)) : Scalarm(0);
}

Point3m toPoint(const Eigen::Vector3d& v)
{
	return {toScalar(v.x()), toScalar(v.y()), toScalar(v.z())};
}

Eigen::Vector3d unitNormal(const LayerPoints& points, Index i)
{
	const Eigen::Vector3d n      = points.normals.col(i);
	const double          length = n.stableNorm();
	return std::isfinite(length) && length > 0.0 ? Eigen::Vector3d(n / length)
	                                             : Eigen::Vector3d::UnitZ();
}

// From the vertex its prepared point was taken from.
bool facesAway(const LayerPoints& points, const PreparedCloud& prepared, Index i)
{
	const Index source = prepared.source[prepared.representative[i]];
	return source != i && points.normals.col(i).dot(points.normals.col(source)) < 0.0;
}

// A right-handed tangent pair at n, as near to d as possible.
void tangentPair(
	const Eigen::Vector3d& d, const Eigen::Vector3d& n, Eigen::Vector3d& d1, Eigen::Vector3d& d2)
{
	const Eigen::Vector3d tangent = d - n * n.dot(d);
	d1 = tangent.norm() > 1e-6 ? Eigen::Vector3d(tangent.normalized()) : TangentFrame(n).u;
	d2 = n.cross(d1);
}

constexpr double agreementCosine = 0.99985; // of one degree

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
	for (int r = 0; r < 4; ++r)
		for (int c = 0; c < 4; ++c)
			if (!(std::abs(a.cm.Tr[r][c] - b.cm.Tr[r][c]) <=
			      1e-5 * (1.0 + std::abs(double(b.cm.Tr[r][c])))))
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

LayerPoints readOrientedPoints(const MeshModel& layer)
{
	LayerPoints points = readPoints(layer);
	if ((points.normals.array() == 0.0).all())
		throw MLException(
			"the points of layer '" + layer.label() +
			"' have no normals. Run 'Compute normals for point sets' "
			"(compute_normal_for_point_clouds) first, and check that they point outward.");
	return points;
}

VertexCurvatures perVertex(
	const LayerPoints&       points,
	const PreparedCloud&     prepared,
	const CurvatureField&    field,
	const std::vector<char>& umbilic)
{
	const Index      n = points.size();
	VertexCurvatures values;
	for (Eigen::VectorXd* v :
	     {&values.k1,
	      &values.k2,
	      &values.error,
	      &values.radius,
	      &values.confidence,
	      &values.feature})
		v->setZero(n);
	values.d1.resize(3, n);
	values.d2.resize(3, n);
	values.status.assign(n, PointStatus::Invalid);

	for (Index i = 0; i < n; ++i) {
		const Eigen::Vector3d normal = unitNormal(points, i);
		const Index           r      = prepared.representative[i];
		Eigen::Vector3d       d1, d2;
		if (r < 0) {
			tangentPair(Eigen::Vector3d::Zero(), normal, d1, d2);
		}
		else {
			// A duplicate seen from the other side: its curvatures change sign and so trade places.
			const bool            flipped = facesAway(points, prepared, i);
			const Eigen::Vector3d surface =
				forVertex(prepared.cloud.normals.col(r), points, prepared, i);
			const bool accurate = normal.dot(surface) > agreementCosine;
			tangentPair(
				flipped ? field.d2.col(r) : field.d1.col(r), accurate ? normal : surface, d1, d2);
			values.k1[i]         = (flipped ? -field.k2[r] : field.k1[r]) / prepared.diagonal;
			values.k2[i]         = (flipped ? -field.k1[r] : field.k2[r]) / prepared.diagonal;
			values.error[i]      = field.error[r] / prepared.diagonal;
			values.radius[i]     = field.radius[r] * prepared.diagonal;
			values.confidence[i] = field.confidence[r];
			values.feature[i]    = field.feature[r];
			values.status[i]     = field.status[r] == PointStatus::Ok && umbilic[r]
			                           ? PointStatus::Umbilic
			                           : field.status[r];
		}
		values.d1.col(i) = d1;
		values.d2.col(i) = d2;
	}
	return values;
}

void writeCurvature(MeshModel& layer, const LayerPoints& points, const VertexCurvatures& values)
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

void writeColorRamp(
	MeshModel& layer, const LayerPoints& points, const std::vector<PointStatus>& status)
{
	std::vector<Scalarm> estimates;
	for (Index i = 0; i < points.size(); ++i)
		if (status[i] != PointStatus::Invalid && status[i] != PointStatus::TooFewNeighbors)
			estimates.push_back(layer.cm.vert[points.vertex[i]].Q());
	std::sort(estimates.begin(), estimates.end());
	if (estimates.empty())
		estimates.push_back(0);
	layer.updateDataMask(MeshModel::MM_VERTCOLOR);
	const std::size_t last = estimates.size() - 1;
	vcg::tri::UpdateColor<CMeshO>::PerVertexQualityRamp(
		layer.cm, estimates[last / 10], estimates[last - last / 10]);
}

Eigen::Vector3d forVertex(
	const Eigen::Vector3d& normal,
	const LayerPoints&     points,
	const PreparedCloud&   prepared,
	Index                  vertex)
{
	return facesAway(points, prepared, vertex) ? Eigen::Vector3d(-normal) : normal;
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
				toPoint(forVertex(normals.col(r), points, prepared, i));
}

bool carriesCurvature(
	const MeshModel& layer, const LayerPoints& points, const CurvatureEstimate& estimate)
{
	if (!layer.hasDataMask(MeshModel::MM_VERTCURVDIR))
		return false;
	const VertexCurvatures values = perVertex(
		points, estimate.prepared, estimate.field, std::vector<char>(estimate.field.size()));
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
	const MeshModel& layer, const LayerPoints& points, const CurvatureEstimate& estimate)
{
	const VertexCurvatures values = perVertex(
		points, estimate.prepared, estimate.field, std::vector<char>(estimate.field.size()));
	for (Index i = 0; i < points.size(); ++i)
		if (layer.cm.vert[points.vertex[i]].cPD1() != toPoint(values.d1.col(i)))
			return false;
	return true;
}

CurvatureField withLayerDirections(
	const MeshModel& layer, const LayerPoints& points, const CurvatureEstimate& estimate)
{
	CurvatureField field = estimate.field;
	for (Index r = 0; r < field.size(); ++r) {
		const std::size_t v = points.vertex[estimate.prepared.source[r]];
		Eigen::Vector3d   d = toEigen(layer.cm.vert[v].cPD1());
		if (!d.allFinite() || d.norm() < 1e-6)
			d = field.d1.col(r);
		Eigen::Vector3d d1, d2;
		tangentPair(d, estimate.prepared.cloud.normals.col(r), d1, d2);
		field.d1.col(r) = d1;
		field.d2.col(r) = d2;
	}
	return field;
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
