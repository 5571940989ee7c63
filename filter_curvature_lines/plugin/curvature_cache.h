// Curvature estimates kept in memory between filters. Each belongs to exact points and normals, for which a fingerprint
// stands, and to its options: when the layer or they have changed, nothing matches and the estimate is made anew.
// Layers are never referenced, so deleting them is harmless.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <optional>

#include <common/ml_document/mesh_model.h>

#include "cloud_index.h"
#include "curvature_estimate.h"
#include "curvature_field.h"
#include "layer_conversion.h"
#include "members.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

struct EstimateOptions {
	MinimumNeighborhoodOptions neighborhood;
	CurvatureOptions           curvature;
};

inline bool operator==(const EstimateOptions& a, const EstimateOptions& b)
{
	return members<2>(a) == members<2>(b);
}

// A cloud in the unit frame with its curvature. The cloud's normals are those the directions are tangent
// to: with ScaleMode::Adaptive, those of the fitted surface where it differs from the layer's.
struct CurvatureEstimate {
	CurvatureEstimate(
		const LayerPoints& points, const EstimateOptions& options, const Progress& progress);
	// The points get the estimate's corrected normals, as the layer's precision will hold them, and so
	// does the cloud; the directions are made tangent to them.
	void adoptNormals(LayerPoints& points);

	PreparedCloud  prepared;
	CloudIndex     index; // of the prepared points, with the layer's normals
	CurvatureField field;
};

// What the layer carries, or what was computed because it carried nothing fresh.
struct LayerCurvature {
	std::shared_ptr<const CurvatureEstimate> estimate;
	std::shared_ptr<const CurvatureField>    field;          // with the layer's directions
	bool                                     reused = false; // no estimation was needed
	bool ownDirections = false; // the layer's directions are not the estimate's: they were smoothed
};

class CurvatureCache {
public:
	// The estimate for these points and options.
	std::shared_ptr<const CurvatureEstimate>
	estimate(const LayerPoints& points, const EstimateOptions& options, const Progress& progress);

	// The estimate for points that get its corrected normals. With ScaleMode::Paper it is made with these.
	std::shared_ptr<const CurvatureEstimate> estimateAndCorrect(
		LayerPoints& points, const EstimateOptions& options, const Progress& progress);

	// The curvature the layer carries if it is an estimate of its points and normals as they are;
	// otherwise the one with default options.
	LayerCurvature
	ofLayer(const MeshModel& layer, const LayerPoints& points, const Progress& progress);

private:
	struct Entry {
		std::uint64_t                            points;  // fingerprint
		std::optional<EstimateOptions>           options; // none: made otherwise
		std::shared_ptr<const CurvatureEstimate> estimate;
	};

	std::shared_ptr<const CurvatureEstimate>
	find(std::uint64_t points, const EstimateOptions& options);
	// The estimate that wrote the curvature on the layer; null if none of these did.
	std::shared_ptr<const CurvatureEstimate>
	carriedBy(const MeshModel& layer, const LayerPoints& points, std::uint64_t print);
	void store(const Entry& entry);

	std::list<Entry> m_entries; // latest first
	std::mutex       m_mutex;   // PyMeshLab runs filters of several MeshSets in parallel
};

} // namespace curvature_lines
