// Surface Reconstruction: Curvature-Aligned Quads: core/reconstruction (A09 fig. 1) on a layer.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <Eigen/Core>

#include "cleaning_report.h"
#include "filter_results.h"
#include "filter_table.h"
#include "help_text.h"
#include "layer_conversion.h"
#include "layer_curvature.h"
#include "normal_estimation.h"
#include "normals_report.h"
#include "parameter_table.h"
#include "point_cloud.h"
#include "polygon_layer.h"
#include "polygon_mesh.h"
#include "polyline_layer.h"
#include "raw_curvatures.h"
#include "reconstruction.h"
#include "shared_parameters.h"

namespace curvature_lines {

namespace {

struct Options {
	ReconstructionOptions pipeline;
	EstimateNormals       estimateNormals        = EstimateNormals::IfMissing;
	bool                  keepIntermediateLayers = false;
};

void positionFieldParameters(ParameterTable& table, ReconstructionOptions& pipeline)
{
	table.row(
		"anisotropy",
		pipeline.anisotropy,
		Real{1.0, 10.0},
		"Anisotropy (1: square faces)",
		"Position Field: by how much lines may run closer across strong bends than along (1 to 10; "
		"1 = "
		"not at all).");
	table.row(
		"points_per_vertex",
		pipeline.pointsPerVertex,
		Real{0.0, 1e6},
		"Points used per vertex (0: all)",
		"Position Field with a target number of vertices: a cloud with more points per vertex is "
		"thinned to so "
		"many, evenly and not below 20000 points, once its outliers are out (0 = use all points, "
		"which takes "
		"longer). Keep all to have all in the cleaned cloud.",
		advancedParameter);
	table.row(
		"hole_size",
		pipeline.holeSize,
		Real{1.0, 1000.0},
		"Size of closed holes (spacings)",
		"Position Field: gaps of the cloud up to so many point spacings across are closed (1 to "
		"1000); wider ones get a rim. Less than 8 may open sparse parts; holes smaller than about "
		"two edges of the mesh cannot be seen in it.",
		advancedParameter);
}

void parameters(ParameterTable& table, Options& options)
{
	ReconstructionOptions& pipeline = options.pipeline;
	table.row(
		"method",
		pipeline.method,
		Choice{{"Position Field", "Traced Lines"}},
		"Method",
		"How the mesh is found.<ul>"
		"<li><b>Position Field</b>: on a triangulation of the cleaned points, by two phases that "
		"follow "
		"the principal directions; rims and sharp creases become edges, and every face is "
		"certified to be "
		"a disk</li>"
		"<li><b>Traced Lines</b>: between traced lines of curvature, as published</li></ul>");
	table.row(
		"target_vertices",
		pipeline.tracing.targetVertices,
		Integer{0, 10000000},
		"Target number of vertices (0: automatic)",
		"About how many vertices the mesh gets (at most 10000000, and four per point); 0 = "
		"automatic: from Chord error if that is set, else from the size of the cloud.");
	table.row(
		"epsilon",
		pipeline.tracing.epsilon,
		Real{0.0, 0.5},
		"Chord error (of diagonal; 0: automatic)",
		"Sets the density of the lines if no target number is given: how far the chord between two "
		"lines leaves the surface, as a fraction of the bounding-box diagonal (0 = automatic, at "
		"most 0.5).");
	positionFieldParameters(table, pipeline);
	meshParameters(table, pipeline.mesh);
	table.row(
		"reject_outliers",
		pipeline.rejectOutliers,
		Flag(),
		"Reject outliers",
		"Leave outliers out.");
	table.row(
		"reject_unstructured",
		pipeline.outliers.rejectUnstructured,
		Flag(),
		"Reject hair, grass and foliage",
		"With Reject outliers: leave out also points that form no surface which the cloud could "
		"resolve. Otherwise they stay, and the report says how many there are.");
	table.row(
		"denoise",
		pipeline.denoise,
		Flag(),
		"Denoise",
		"Move the points onto the surface. Switch it off for exact data.");
	table.row(
		"smooth_directions",
		pipeline.smoothDirections,
		Flag(),
		"Smooth the directions",
		"Traced Lines: smooth the field of principal directions before tracing. A position field "
		"always "
		"is, as far as the directions are uncertain.");
	table.row(
		"estimate_normals",
		options.estimateNormals,
		Choice{{"If Missing", "Never", "Always"}},
		"Estimate normals",
		"Whether to compute normals from the positions (plane fits, their sides by winding "
		"numbers).<ul>"
		"<li><b>If Missing</b>: when most points have none</li>"
		"<li><b>Never</b>: use those of the layer</li>"
		"<li><b>Always</b>: replace those of the layer</li></ul>");
	scaleModeParameter(table, pipeline.curvature.scaleMode, advancedParameter);
	table.row(
		"keep_intermediate_layers",
		options.keepIntermediateLayers,
		Flag(),
		"Keep intermediate layers",
		"Add the cleaned cloud, with its curvature and how far each point moved, and the lines as "
		"layers of their "
		"own.");
}

void writeCleanedCloud(
	MeshModel& layer, const ReconstructionResult& result, const PreparedCloud& frame)
{
	const Index n = result.cloud.size();
	vcg::tri::Allocator<CMeshO>::AddVertices(layer.cm, n);
	// The cleaned points are all there is: each stands for itself.
	LayerPoints   points;
	PreparedCloud own;
	own.cloud    = result.cloud;
	own.center   = frame.center;
	own.diagonal = frame.diagonal;
	for (Index i = 0; i < n; ++i) {
		points.vertex.push_back(i);
		own.source.push_back(i);
		own.representative.push_back(i);
	}
	points.normals = result.cloud.normals;
	writePositions(layer, points, own, result.cloud.positions);
	writeNormals(layer, points, own, result.cloud.normals);
	const RawCurvatures values =
		rawCurvatures(points.normals, own, result.field, result.umbilics.umbilic);
	writeCurvature(layer, points, values);
	writeQuality(layer, points, scalarsOf(values, CurvatureScalar::Mean));
	writeAttribute(layer, points, "moved", frame.diagonal * result.moves);
}

// Share of the points that must be missing for a warning.
constexpr double toldUncovered = 0.001;

void reportStages(FilterResults& results, const ReconstructionResult& result)
{
	results.count("outliers", std::count(result.outlier.begin(), result.outlier.end(), char(1)));
	results.count("used_points", result.cloud.size());
	results.count("creases", static_cast<Index>(result.creases.curves.size()));
	results.count("cones", result.mesh.singularTriangles);
	results.count("line_ends", result.mesh.lineEnds);
	results.count("inverted_repaired", result.mesh.turnedOver);
	results.real(
		"quad_share",
		double(result.mesh.topology.quads) /
			std::max<double>(1.0, double(result.mesh.topology.faces)));
	results.count("scaffold_vertices", result.mesh.scaffoldVertices);
	results.count("lost_crease_edges", result.mesh.lostCreaseEdges);
	results.count("filled_holes", result.mesh.filledHoles);
	results.count("dropped_components", result.mesh.droppedComponents);
	results.count("repaired_components", result.mesh.repairedComponents);
	results.count("caps", result.mesh.caps);
	results.count("unsound_faces", result.mesh.unsoundFaces);
	results.count(
		"umbilic",
		std::count(result.umbilics.umbilic.begin(), result.umbilics.umbilic.end(), char(1)));
	results.count("lines", result.lines.lines());
	results.count(
		"closed_lines",
		std::count(result.lines.closed.begin(), result.lines.closed.end(), char(1)));
	results.real("epsilon", result.lines.epsilon);
	for (const auto& [stage, seconds] : result.seconds)
		results.seconds(stage, seconds);
}

// What the mesh does not show, and what is wrong with it, in numbers and where it matters in words.
void reportLosses(
	FilterResults& results, const ReconstructionResult& result, Index target, double diagonal)
{
	const double points    = std::max<double>(1.0, double(result.cloud.size()));
	const double uncovered = double(result.coverage.uncovered) / points;
	results.count("warnings", 0);
	results.real("uncovered_share", uncovered);
	results.real("largest_gap", result.coverage.largestGap * diagonal);
	results.count("folded_faces", result.foldedFaces);
	results.count("bounded_target", result.boundedTarget);
	if (result.boundedTarget > 0)
		results.warn(
			"More vertices were asked for than the cloud can carry, four per point: " +
			std::to_string(result.boundedTarget) +
			" were aimed at instead (bounded_target). A denser cloud can have more.");
	const double aimed = result.boundedTarget > 0 ? result.boundedTarget : target;
	const double extra = target > 0 ? result.mesh.expectedVertices - aimed : 0.0;
	results.count("limb_vertices", extra > 0.02 * aimed ? std::lround(extra) : 0);
	if (uncovered > toldUncovered)
		results.warn(
			std::to_string(result.coverage.uncovered) +
			" points that were kept are farther than two edges from the mesh (uncovered_share). "
			"Raise 'target_vertices', or check the cloud there: it may be too sparse for a "
			"surface.");
	if (result.foldedFaces > 0)
		results.warn(
			std::to_string(result.foldedFaces) +
			" faces are folded over (folded_faces). Raise 'target_vertices', or clean the cloud.");
	if (result.mesh.droppedComponents > 0)
		results.warn(
			std::to_string(result.mesh.droppedComponents) +
			" pieces were too small for faces and are left out (dropped_components). Raise "
			"'target_vertices' to keep them.");
}

FilterResults apply(const FilterContext& context, const Options& options)
{
	ReconstructionOptions pipeline = options.pipeline;
	pipeline.keepLines             = options.keepIntermediateLayers;

	const MeshModel&  source = currentLayer(context.document);
	Stopwatch         total;
	FilterResults     results;
	const LayerPoints points =
		readOrientedPoints(source, context.progress.sub(0.0, 0.1, ""), options.estimateNormals);
	if (points.estimated)
		results.seconds("normals", total.seconds());

	PreparedCloud              prepared = prepareCloud(points.positions, points.normals);
	const ReconstructionResult result =
		reconstruct(std::move(prepared.cloud), pipeline, context.progress.sub(0.1, 1.0, ""));
	if (result.mesh.mesh.faceCount() == 0)
		throw MLException(
			"no face was found: the cloud is too sparse for the chosen density, or (Traced Lines) "
			"flat or "
			"umbilic everywhere. Raise 'target_vertices', or check that the normals are right.");

	NewLayers layers(context.document);
	if (options.keepIntermediateLayers) {
		MeshModel& cleaned = layers.add("cleaned cloud", source);
		writeCleanedCloud(cleaned, result, prepared);
		if (result.lines.lines() > 0)
			writeLines(
				layers.add("lines of curvature", source), result.lines, prepared, cleaned.id());
	}
	MeshModel&         layer    = layers.add("curvature-aligned mesh", source);
	const MeshTopology topology = writePolygons(layer, result.mesh, prepared);
	layers.keep(layer);

	results.count("points", points.size());
	results.count("invalid", prepared.nonFinite + prepared.zeroNormals);
	results.count("duplicates", prepared.duplicates);
	results.real("noise", result.noise * prepared.diagonal);
	results.real("moved_rms", result.rmsMove * prepared.diagonal);
	reportStages(results, result);
	results.count("crossings", result.mesh.crossings);
	reportMesh(results, topology, result.mesh.texture);
	reportLosses(results, result, options.pipeline.tracing.targetVertices, prepared.diagonal);
	reportDoubledLayers(results, result.doubledShare);
	reportUnstructured(
		results, result.unstructuredShare, options.pipeline.outliers.rejectUnstructured);
	reportNormals(results, points);
	results.seconds("total", total.seconds());
	return results;
}

} // namespace

FilterSpec reconstructionFilter()
{
	return {
		"Surface Reconstruction: Curvature-Aligned Quads",
		"generate_surface_reconstruction_curvature_aligned",
		"From a cloud to a curvature-aligned quad mesh, in one step",
		"Makes a quad-dominant mesh from a point cloud, its edges aligned with the principal "
		"directions of curvature. In one step: outliers are left out, normals and positions "
		"denoised, curvature and directions estimated, creases and rims found, and the faces "
		"between "
		"lines along the directions built." +
			helpInput +
			"<br><br><b>Writes</b> a new layer '<i>curvature-aligned mesh</i>' of polygons (in "
			"MeshLab: "
			"triangles whose inner edges are hidden) and makes it current; the input stays as it "
			"is. Save the mesh as OBJ: PLY drops polygons." +
			helpConventions + helpReference,
		FilterPlugin::Remeshing + FilterPlugin::PointSet + FilterPlugin::Polygonal +
			FilterPlugin::MeshCreation,
		FilterPlugin::SINGLE_MESH,
		MeshModel::MM_NONE,
		MeshModel::MM_NONE,
		{parameters, apply}};
}

} // namespace curvature_lines
