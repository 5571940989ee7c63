// Select Outliers by Robust Curvature: core/outlier_rejection on a layer.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstddef>
#include <vector>

#include "cleaning_report.h"
#include "filter_results.h"
#include "filter_table.h"
#include "help_text.h"
#include "layer_conversion.h"
#include "normals_report.h"
#include "outlier_rejection.h"
#include "outlier_result.h"
#include "parameter_table.h"
#include "point_cloud.h"

namespace curvature_lines {

namespace {

struct Options {
	OutlierOptions rejection;
	bool           deleteSelected = false;
};

void parameters(ParameterTable& table, Options& options)
{
	table.row(
		"mode",
		options.rejection.mode,
		Choice{{"Robust", "Paper"}},
		"Mode",
		"What counts as a vote against a point.<ul>"
		"<li><b>Robust</b>: its height above the surfaces its neighbours fitted</li>"
		"<li><b>Paper</b>: it relies on neighbours that do not rely on it (published rule; it sees "
		"wrong normals only)</li></ul>");
	table.row(
		"sensitivity",
		options.rejection.sensitivity,
		Real{0.5, 100.0},
		"Sensitivity (noise units)",
		"Robust mode: heights above this many noise units are votes against the point (0.5 to "
		"100). "
		"Smaller values reject more.");
	table.row(
		"vote_threshold",
		options.rejection.voteThreshold,
		Real{0.0, 1.0},
		"Vote threshold (0 to 1)",
		"A point is an outlier when more than this share of the votes is against it (0 to 1).");
	table.row(
		"rounds",
		options.rejection.rounds,
		Integer{1, 20},
		"Rounds",
		"How often at most the estimate is repeated without the outliers found so far (1 to 20).",
		advancedParameter);
	table.row(
		"reject_unstructured",
		options.rejection.rejectUnstructured,
		Flag(),
		"Reject hair, grass and foliage",
		"Robust mode: select also points that form no surface which the cloud could resolve. "
		"Otherwise they stay, and the report says how many there are.");
	table.row(
		"delete_selected",
		options.deleteSelected,
		Flag(),
		"Delete the outliers",
		"Delete the selected points (and faces that use them) at once.");
}

// Faces must not point to deleted vertices.
Index deleteVertices(CMeshO& mesh, const std::vector<std::size_t>& doomed)
{
	std::vector<char> dead(mesh.vert.size(), 0);
	for (const std::size_t v : doomed)
		dead[v] = 1;
	using Allocator = vcg::tri::Allocator<CMeshO>;
	for (CFaceO& face : mesh.face) {
		if (face.IsD())
			continue;
		for (int c = 0; c < 3; ++c)
			if (dead[vcg::tri::Index(mesh, face.V(c))]) {
				Allocator::DeleteFace(mesh, face);
				break;
			}
	}
	for (CEdgeO& edge : mesh.edge)
		if (!edge.IsD() &&
		    (dead[vcg::tri::Index(mesh, edge.V(0))] || dead[vcg::tri::Index(mesh, edge.V(1))]))
			Allocator::DeleteEdge(mesh, edge);
	for (const std::size_t v : doomed)
		Allocator::DeleteVertex(mesh, mesh.vert[v]);
	vcg::tri::UpdateBounding<CMeshO>::Box(mesh);
	return static_cast<Index>(doomed.size());
}

FilterResults apply(const FilterContext& context, const Options& options)
{
	MeshModel&          layer  = currentLayer(context.document);
	const LayerPoints   points = readOrientedPoints(layer, context.progress);
	Stopwatch           total;
	const PreparedCloud prepared = prepareCloud(points.positions, points.normals);
	const OutlierResult rejected =
		rejectOutliers(prepared.cloud, options.rejection, context.progress);

	// A point nowhere is no part of the surface; one that only lacks its normal cannot be judged.
	std::vector<std::size_t> selected;
	std::vector<char>        isSelected(layer.cm.vert.size(), 0);
	for (Index i = 0; i < points.size(); ++i) {
		const Index r = prepared.representative[i];
		if (r >= 0 ? rejected.outlier[r] != 0 : !points.positions.col(i).allFinite()) {
			selected.push_back(points.vertex[i]);
			isSelected[points.vertex[i]] = 1;
		}
	}
	for (const std::size_t v : points.vertex) {
		if (isSelected[v])
			layer.cm.vert[v].SetS();
		else
			layer.cm.vert[v].ClearS();
	}

	FilterResults results;
	results.count("points", points.size());
	results.count("warnings", 0);
	results.count("outliers", static_cast<Index>(selected.size()));
	results.count("isolated", rejected.isolated);
	results.count("invalid", prepared.nonFinite + prepared.zeroNormals);
	results.count("duplicates", prepared.duplicates);
	results.count("rounds", rejected.roundsUsed);
	results.count("deleted", options.deleteSelected ? deleteVertices(layer.cm, selected) : 0);
	results.real("noise", rejected.heightDeviation * prepared.diagonal);
	reportUnstructured(results, rejected.unstructuredShare, options.rejection.rejectUnstructured);
	reportNormals(results, points);
	results.seconds("total", total.seconds());
	return results;
}

} // namespace

FilterSpec selectOutliersFilter()
{
	return {
		"Select Outliers by Robust Curvature",
		"compute_selection_point_cloud_outliers_by_curvature",
		"Selects the points that do not lie on the surface",
		"Selects the points of a cloud that do not lie on the surface the others agree on. Every "
		"point's robust curvature estimate votes on the points around it; a point with more votes "
		"against it than the threshold allows, or with nothing around it, is an outlier. The "
		"estimate is then repeated without them." +
			helpInput +
			"<br><br><b>Writes</b> the vertex selection (the former one is replaced), or deletes "
			"the "
			"outliers on request. Points with non-finite coordinates are selected, too. The noise "
			"it reports is the standard deviation of heights, in the layer's units." +
			helpReference,
		FilterPlugin::Selection + FilterPlugin::Cleaning + FilterPlugin::PointSet,
		FilterPlugin::SINGLE_MESH,
		MeshModel::MM_NONE,
		MeshModel::MM_VERTFLAGSELECT | MeshModel::MM_VERTNUMBER | MeshModel::MM_FACENUMBER,
		{parameters, apply}};
}

} // namespace curvature_lines
