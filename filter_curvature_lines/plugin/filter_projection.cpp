// Curvature-Driven Projection: core/curvature_driven_projection on two layers.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include <Eigen/Core>

#include "cloud_index.h"
#include "control_neighborhood.h"
#include "curvature_driven_projection.h"
#include "filter_results.h"
#include "filter_table.h"
#include "help_text.h"
#include "host_types.h"
#include "layer_conversion.h"
#include "normals_report.h"
#include "parameter_table.h"
#include "point_cloud.h"
#include "point_set_surface.h"

namespace curvature_lines {

namespace {

struct Options {
	int                    controlLayer = -1, proxyLayer = -1;
	CurvatureDrivenOptions surface;
	Index                  perPoint = 1; // points made of each; 1: it moves
};

void parameters(ParameterTable& table, Options& options)
{
	options.controlLayer = options.proxyLayer = currentLayerId(table.document());
	table.row(
		"control_mesh",
		options.controlLayer,
		Layer{table.document()},
		"Cloud that is the surface",
		"The cloud that defines the surface; it needs oriented normals and stays as it is, unless "
		"it is "
		"projected onto its own surface.");
	table.row(
		"proxy_mesh",
		options.proxyLayer,
		Layer{table.document()},
		"Layer to project",
		"The layer whose vertices move onto the surface.");
	table.row(
		"bandwidth",
		options.surface.bandwidth,
		Real{0.5, 20.0},
		"Bandwidth (spacings)",
		"Of the Gaussian weights, in local spacings of the control points (0.5 to 20). Larger "
		"removes "
		"more noise and blurs more detail.");
	table.row(
		"diffusion_steps",
		options.surface.diffusionSteps,
		Integer{1, 1000},
		"Diffusion steps",
		"Largest number of steps that move a point onto the surface along the normal (1 to 1000); "
		"it "
		"stops when nothing moves.",
		advancedParameter);
	table.row(
		"diffusion_function",
		options.surface.diffusion,
		Choice{{"Hermite", "Cutoff", "Rational"}},
		"Diffusion",
		"What a control point says about where the surface is.<ul>"
		"<li><b>Hermite</b>: the mean of its own height and that of its tangent plane, which does "
		"not "
		"shrink the surface</li>"
		"<li><b>Cutoff</b>, <b>Rational</b>: its height, none or less of it where the surface "
		"bends much "
		"towards it, as published: shrinks bends by a share of the spacing</li></ul>");
	table.row(
		"resample",
		options.perPoint,
		Integer{1, 100},
		"Points per vertex (1: move)",
		"1: the vertices move. More (up to 100): so many points around each vertex, projected, as "
		"a new "
		"layer: a denser cloud on the same surface.");
}

void place(CVertexO& vertex, const PreparedCloud& frame, const ProjectedPoints& projected, Index i)
{
	vertex.P() = toPoint(frame.toModel(projected.positions.col(i)));
	vertex.N() = toPoint(projected.normals.col(i));
}

void writeProjected(
	MeshModel&             layer,
	const LayerPoints&     points,
	const PreparedCloud&   frame,
	const ProjectedPoints& projected)
{
	for (Index i = 0; i < points.size(); ++i)
		if (projected.projected[i])
			place(layer.cm.vert[points.vertex[i]], frame, projected, i);
	vcg::tri::UpdateBounding<CMeshO>::Box(layer.cm);
	if (layer.cm.fn > 0)
		vcg::tri::UpdateNormal<CMeshO>::PerFaceNormalized(layer.cm);
}

void appendProjected(MeshModel& layer, const PreparedCloud& frame, const ProjectedPoints& projected)
{
	const auto count  = std::count(projected.projected.begin(), projected.projected.end(), 1);
	auto       vertex = vcg::tri::Allocator<CMeshO>::AddVertices(layer.cm, count);
	for (Index i = 0; i < static_cast<Index>(projected.projected.size()); ++i)
		if (projected.projected[i])
			place(*vertex++, frame, projected, i);
	vcg::tri::UpdateBounding<CMeshO>::Box(layer.cm);
}

FilterResults apply(const FilterContext& context, const Options& options)
{
	const MeshModel& control = layerWithId(context.document, options.controlLayer, "control_mesh");
	const MeshModel& proxy   = layerWithId(context.document, options.proxyLayer, "proxy_mesh");
	requireSameMatrix(control, proxy, "'control_mesh' and 'proxy_mesh'");

	const LayerPoints   points = readOrientedPoints(control, context.progress);
	const LayerPoints   moving = readPoints(proxy);
	FilterResults       results;
	Stopwatch           total;
	const PreparedCloud prepared = prepareCloud(points.positions, points.normals);
	const CloudIndex    index(prepared.cloud);
	index.minimum(context.progress.sub(0.0, 0.3, "Finding neighborhoods"));
	const ControlPoints          controlPoints(index);
	const CurvatureDrivenSurface surface(controlPoints, options.surface);

	Eigen::Matrix3Xd unit = moving.positions;
	for (Index i = 0; i < moving.size(); ++i)
		unit.col(i) = prepared.toUnit(moving.positions.col(i));
	if (options.perPoint > 1)
		unit = scatterAround(controlPoints, unit, options.perPoint);
	const ProjectedPoints projected =
		projectPoints(surface, unit, {}, context.progress.sub(0.3, 1.0, "Projecting"));

	const ProjectionMoves moves = movesOf(projected, unit, prepared.diagonal);
	if (moves.projected == 0)
		throw MLException(
			"no point of 'proxy_mesh' is near the surface of 'control_mesh' (within three of its "
			"point "
			"spacings); check that both layers show the same thing at the same place.");

	if (options.perPoint == 1) {
		MeshModel& target = *context.document.getMesh(proxy.id());
		target.updateDataMask(MeshModel::MM_VERTNORMAL);
		writeProjected(target, moving, prepared, projected);
	}
	else {
		NewLayers  layers(context.document);
		MeshModel& layer = layers.add("resampled surface", proxy);
		appendProjected(layer, prepared, projected);
		layers.keep(layer);
	}
	results.count("points", unit.cols());
	results.count("projected", moves.projected);
	results.count("not_projected", unit.cols() - moves.projected);
	results.count("iterations", projected.iterations);
	results.real("moved_rms", moves.rms);
	results.real("moved_max", moves.largest);
	reportNormals(results, points);
	results.seconds("total", total.seconds());
	return results;
}

} // namespace

FilterSpec projectionFilter()
{
	return {
		"Curvature-Driven Projection",
		"compute_curvature_driven_projection",
		"Moves vertices onto the smooth surface a cloud defines, or makes a cloud denser",
		"Moves the vertices of a layer onto the smooth surface that a point cloud defines: near "
		"every "
		"vertex, the quadric of the surface's principal curvatures and directions. Also makes a "
		"cloud "
		"denser on its own surface."
		"<br><br><b>Input.</b> A control cloud with oriented normals, and the layer to project (it "
		"may be "
		"the same). Vertices farther than three spacings from the control points, and those whose "
		"neighbours do not tell a surface, stay and are counted. Points already on the surface "
		"stay."
		"<br><br><b>Writes</b> coordinates and normals of the projected vertices; with more than "
		"one "
		"point per point, a new layer '<i>resampled surface</i>' instead. For noisy scans, denoise "
		"first "
		"(<i>Denoise Point Cloud by Robust Curvature</i>): the bandwidth here is fixed, in "
		"spacings." +
			helpReferenceTejada,
		FilterPlugin::PointSet + FilterPlugin::Sampling,
		FilterPlugin::VARIABLE,
		MeshModel::MM_NONE,
		MeshModel::MM_VERTCOORD | MeshModel::MM_VERTNORMAL,
		{parameters, apply}};
}

} // namespace curvature_lines
