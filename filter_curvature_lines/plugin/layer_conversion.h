// Layers to point clouds and back. Everything is in the layer's own (local) coordinates, in double;
// deleted vertices are skipped; values go back to every vertex, duplicates included.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <common/ml_document/mesh_document.h>

#include "robust_curvature.h"

namespace curvature_lines {

struct CurvatureEstimate;

// The current layer; throws when the document has none.
MeshModel& currentLayer(MeshDocument& document);
// Its id, -1 when the document has none. Never throws.
int currentLayerId(const MeshDocument& document);
// Throws when there is no layer of this id, which the parameter of this name has.
const MeshModel& layerWithId(const MeshDocument& document, int id, const QString& parameter);

// Throws unless the matrices of both layers are the same but for rounding: what is local to one would lie
// beside the other.
void requireSameMatrix(const MeshModel& a, const MeshModel& b, const QString& names);

struct LayerPoints {
	Eigen::Matrix3Xd         positions, normals; // 3 x N, as they are: any length, maybe not finite
	std::vector<std::size_t> vertex;             // N: index in cm.vert

	Index size() const { return static_cast<Index>(vertex.size()); }
};

// Throws when there is no vertex.
LayerPoints readPoints(const MeshModel& layer);
// The same, and throws when no vertex has a normal.
LayerPoints readOrientedPoints(const MeshModel& layer);

// Curvature of every point of a layer, in model units and with no value a host could choke on.
struct VertexCurvatures {
	Eigen::VectorXd k1, k2, error, radius, confidence, feature; // N
	// 3 x N unit, tangent to the vertex normal where it agrees with the estimate's within a degree, else
	// to the latter.
	Eigen::Matrix3Xd         d1, d2;
	std::vector<PointStatus> status; // N
};
VertexCurvatures perVertex(
	const LayerPoints&       points,
	const PreparedCloud&     prepared,
	const CurvatureField&    field,
	const std::vector<char>& umbilic); // per prepared point

// K1, K2, PD1, PD2 and the curv_* attributes.
void writeCurvature(MeshModel& layer, const LayerPoints& points, const VertexCurvatures& values);
// Per vertex: one scalar as quality.
void writeQuality(MeshModel& layer, const LayerPoints& points, const Eigen::VectorXd& values);
// 3 x N, 0..1.
void writeColors(MeshModel& layer, const LayerPoints& points, const Eigen::Matrix3Xd& colors);
// MeshLab's ramp between the 10th and the 90th percentile of the vertices with an estimate.
void writeColorRamp(
	MeshModel& layer, const LayerPoints& points, const std::vector<PointStatus>& status);
void writeAttribute(
	MeshModel&             layer,
	const LayerPoints&     points,
	const std::string&     name,
	const Eigen::VectorXd& values);

// The normal of a vertex's prepared point, as one for the vertex: of two sheets in the same place, each keeps
// its own side. A vertex's own normal may be wrong, so it does not tell the side of a point that is its own.
// `points` have the normals the cloud was prepared from.
Eigen::Vector3d forVertex(
	const Eigen::Vector3d& normal,
	const LayerPoints&     points,
	const PreparedCloud&   prepared,
	Index                  vertex);

// Coordinates or normals of the prepared points go to all their vertices; the others stay.
void writePositions(
	MeshModel&              layer,
	const LayerPoints&      points,
	const PreparedCloud&    prepared,
	const Eigen::Matrix3Xd& unitPositions);
void writeNormals(
	MeshModel&              layer,
	const LayerPoints&      points,
	const PreparedCloud&    prepared,
	const Eigen::Matrix3Xd& normals);

// Whether K1, K2 and curv_confidence (PD1 and PD2) on the layer are those the estimate would write.
bool carriesCurvature(
	const MeshModel& layer, const LayerPoints& points, const CurvatureEstimate& estimate);
bool carriesDirections(
	const MeshModel& layer, const LayerPoints& points, const CurvatureEstimate& estimate);
// The estimate's field with the layer's directions, made tangent.
CurvatureField withLayerDirections(
	const MeshModel& layer, const LayerPoints& points, const CurvatureEstimate& estimate);

// Layers a filter adds. They vanish again unless kept, so a filter that fails leaves none behind.
class NewLayers {
public:
	explicit NewLayers(MeshDocument& document);
	~NewLayers();
	NewLayers(const NewLayers&) = delete;

	// An empty layer with the matrix of `source`. Hosts take labels with dots for file names.
	MeshModel& add(const QString& label, const MeshModel& source);
	void keep(const MeshModel& current);

private:
	MeshDocument&    m_document;
	int              m_current;
	std::vector<int> m_ids;
};

} // namespace curvature_lines
