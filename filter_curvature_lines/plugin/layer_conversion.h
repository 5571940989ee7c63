// Layers to point clouds and back. Everything is in the layer's own (local) coordinates, in double;
// deleted vertices are skipped; values go back to every vertex, duplicates included.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <common/ml_document/mesh_document.h>

#include "normal_check.h"
#include "normal_estimation.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

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
	// Of readOrientedPoints(): what is wrong with the layer's normals, or how those in their place were found.
	NormalCheck                     normalCheck;
	std::optional<EstimatedNormals> estimated; // its normals have moved to `normals`

	Index size() const { return static_cast<Index>(vertex.size()); }
};

// Throws when there is no vertex.
LayerPoints readPoints(const MeshModel& layer);
// The same with a check of the normals, or with estimated ones where the layer lacks them, which it then still does.
// Throws when no vertex has one and they are not to be estimated.
LayerPoints readOrientedPoints(
	const MeshModel& layer,
	const Progress&  progress = {},
	EstimateNormals  when     = EstimateNormals::IfMissing);

// Per vertex: one scalar as quality.
void writeQuality(MeshModel& layer, const LayerPoints& points, const Eigen::VectorXd& values);
// 3 x N, 0..1.
void writeColors(MeshModel& layer, const LayerPoints& points, const Eigen::Matrix3Xd& colors);
// Colours of MeshLab's ramp: the quality of each vertex between these two values.
void writeColorRamp(MeshModel& layer, double from, double to);
void writeAttribute(
	MeshModel&             layer,
	const LayerPoints&     points,
	const std::string&     name,
	const Eigen::VectorXd& values);

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
