// Ray-Trace Point-Set Surface: core/surface_picture of a layer, into a PNG file.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include <QDir>
#include <QFileInfo>
#include <QImage>
#include <QSaveFile>

#include "cloud_index.h"
#include "control_neighborhood.h"
#include "curvature_colors.h"
#include "curvature_driven_projection.h"
#include "curvature_field.h"
#include "filter_results.h"
#include "filter_table.h"
#include "help_text.h"
#include "host_types.h"
#include "layer_conversion.h"
#include "m_weighted_curvature.h"
#include "moving_least_squares.h"
#include "normals_report.h"
#include "parameter_table.h"
#include "point_cloud.h"
#include "point_set_surface.h"
#include "ray_tracing.h"
#include "spatial_order.h"
#include "surface_picture.h"

namespace curvature_lines {

namespace {

enum class SurfaceKind { CurvatureDriven, MovingLeastSquares };
enum class ColorBy { Plain, Curvature, VertexColor };
enum class CameraKind { Automatic, Given };

const Eigen::Vector3d plainColor(0.80, 0.79, 0.76); // a light, slightly warm grey, by taste

struct Options {
	QString        file;
	PictureOptions picture;
	SurfaceKind    surface    = SurfaceKind::CurvatureDriven;
	ColorBy        colorBy    = ColorBy::Plain;
	int            lineLayer  = -1;
	CameraKind     cameraKind = CameraKind::Automatic;
	Camera         camera; // Given: in model units; Automatic: only its field of view counts
};

void parameters(ParameterTable& table, Options& options)
{
	options.lineLayer = currentLayerId(table.document());
	table.row(
		"image_file",
		options.file,
		SaveFile{"*.png"},
		"Image file",
		"Where the picture goes: a PNG file, replaced if it exists.");
	table.row(
		"width", options.picture.image.width, Integer{1, 8192}, "Width (pixels)", "1 to 8192.");
	table.row(
		"height", options.picture.image.height, Integer{1, 8192}, "Height (pixels)", "1 to 8192.");
	table.row(
		"surface",
		options.surface,
		Choice{{"Curvature-Driven", "Moving Least Squares"}},
		"Surface",
		"The surface between the points.<ul>"
		"<li><b>Curvature-Driven</b>: quadrics of principal curvatures and directions</li>"
		"<li><b>Moving Least Squares</b>: complete quadrics over fitted planes; needs normals for "
		"the side only</li></ul>");
	table.row(
		"background",
		options.picture.background,
		Color(),
		"Background",
		"Colour where nothing is.");
	table.row(
		"color_by",
		options.colorBy,
		Choice{{"Plain", "Curvature", "Vertex Colour"}},
		"Colour",
		"<ul><li><b>Plain</b>: one light grey</li>"
		"<li><b>Curvature</b>: convex red, saddle green, concave blue, flat white</li>"
		"<li><b>Vertex Colour</b>: that of the layer, as other filters leave it</li></ul>");
	table.row(
		"lines",
		options.lineLayer,
		Layer{table.document()},
		"Layer of lines (the cloud's own: no lines)",
		"The layer whose lines (of curvature, or any edges) are drawn on the surface, in the "
		"colours of its vertices. "
		"Leave the cloud's own layer here, as it is at first, to draw none.");
	table.row(
		"camera",
		options.cameraKind,
		Choice{{"Automatic", "Given"}},
		"Camera",
		"<b>Automatic</b>: sees all points, from the side their normals face. <b>Given</b>: by the "
		"parameters below.",
		advancedParameter);
	table.row(
		"camera_position",
		options.camera.position,
		Position(),
		"Camera position",
		"In the layer's coordinates.",
		advancedParameter);
	table.row(
		"camera_target",
		options.camera.target,
		Position(),
		"Camera target",
		"What is in the middle of the picture.",
		advancedParameter);
	table.row(
		"camera_up",
		options.camera.up,
		Direction(),
		"Camera up",
		"What is up in the picture.",
		advancedParameter);
	table.row(
		"field_of_view",
		options.camera.fieldOfView,
		Real{1.0, 150.0},
		"Field of view (degrees)",
		"Across the shorter side of the picture, in degrees (1 to 150).",
		advancedParameter);
}

void requireImageFile(const QString& path)
{
	if (path.isEmpty())
		throw MLException(
			"parameter 'image_file' is empty; name the PNG file the picture goes to.");
	if (QFileInfo(path).suffix().toLower() != "png")
		throw MLException(
			"parameter 'image_file' is '" + path +
			"'; pictures are PNG files, the name must end in .png.");
	if (!QFileInfo(path).absoluteDir().exists())
		throw MLException("the folder of '" + path + "' does not exist; make it first.");
}

Camera cameraOf(const Options& options, const PreparedCloud& prepared)
{
	const RayTracingOptions& image = options.picture.image;
	if (options.cameraKind == CameraKind::Automatic)
		return Camera::facing(
			prepared.cloud, double(image.width) / image.height, options.camera.fieldOfView);
	Camera camera   = options.camera;
	camera.position = prepared.toUnit(camera.position);
	camera.target   = prepared.toUnit(camera.target);
	if (!camera.isUpright())
		throw MLException(
			"'camera_up' runs along the view from 'camera_position' to 'camera_target'; give "
			"another "
			"direction.");
	return camera;
}

Eigen::Vector3d colorOf(const CVertexO& vertex)
{
	return Eigen::Vector3d(vertex.cC()[0], vertex.cC()[1], vertex.cC()[2]) / 255.0;
}

Eigen::Matrix3Xd colorsOf(
	ColorBy              colorBy,
	const MeshModel&     layer,
	const LayerPoints&   points,
	const PreparedCloud& prepared,
	const CloudIndex&    index)
{
	const Index      n = prepared.cloud.size();
	Eigen::Matrix3Xd colors(3, n);
	switch (colorBy) {
	case ColorBy::Plain:
		colors.colwise() = plainColor;
		break;
	case ColorBy::Curvature: {
		const CurvatureField field = mWeightedCurvature(index);
		colors                     = curvatureColors(field.k1, field.k2, 0.5);
		break;
	}
	case ColorBy::VertexColor:
		for (Index i = 0; i < n; ++i)
			colors.col(i) = colorOf(layer.cm.vert[points.vertex[prepared.source[i]]]);
		break;
	}
	return colors;
}

PictureLines linesOf(const MeshModel& layer, const PreparedCloud& prepared)
{
	PictureLines lines;
	lines.vertices.resize(3, layer.cm.vert.size());
	for (std::size_t v = 0; v < layer.cm.vert.size(); ++v) {
		lines.vertices.col(v) = prepared.toUnit(toEigen(layer.cm.vert[v].cP()));
	}
	std::vector<Eigen::Vector3d> colors;
	for (const CEdgeO& edge : layer.cm.edge) {
		if (edge.IsD())
			continue;
		const auto from = vcg::tri::Index(layer.cm, edge.cV(0)),
				   to   = vcg::tri::Index(layer.cm, edge.cV(1));
		lines.segments.emplace_back(static_cast<Index>(from), static_cast<Index>(to));
		colors.push_back(colorOf(*edge.cV(0)));
	}
	lines.colors.resize(3, colors.size());
	for (std::size_t s = 0; s < colors.size(); ++s)
		lines.colors.col(s) = colors[s];
	return lines;
}

void savePicture(const Picture& picture, const QString& path)
{
	QImage image(picture.width, picture.height, QImage::Format_RGB888);
	for (int y = 0; y < picture.height; ++y)
		std::copy_n(
			&picture.rgb[std::size_t(3) * picture.width * y], 3 * picture.width, image.scanLine(y));
	QSaveFile file(path); // nothing half-written is left behind
	if (!file.open(QIODevice::WriteOnly) || !image.save(&file, "PNG") || !file.commit())
		throw MLException("'" + path + "' cannot be written: " + file.errorString() + ".");
}

FilterResults apply(const FilterContext& context, const Options& options)
{
	requireImageFile(options.file);
	const MeshModel& layer     = currentLayer(context.document);
	const MeshModel* lineLayer = &layerWithId(context.document, options.lineLayer, "lines");
	if (lineLayer != &layer && lineLayer->cm.en == 0)
		throw MLException(
			"the layer '" + lineLayer->label() + "' named as 'lines' holds no edges.");
	if (lineLayer != &layer)
		requireSameMatrix(layer, *lineLayer, "the cloud and the layer of 'lines'");

	const LayerPoints points = readOrientedPoints(layer, context.progress);
	FilterResults     results;
	Stopwatch         total, stage;
	// Rays next to each other read points next to each other.
	const PreparedCloud prepared = inSpatialOrder(prepareCloud(points.positions, points.normals));
	const Camera        camera   = cameraOf(options, prepared);
	const CloudIndex    index(prepared.cloud);
	index.minimum(context.progress.sub(0.0, 0.2, "Finding neighborhoods"));
	const ControlPoints    control(index);
	const Eigen::Matrix3Xd colors = colorsOf(options.colorBy, layer, points, prepared, index);
	const PictureLines lines = lineLayer == &layer ? PictureLines() : linesOf(*lineLayer, prepared);
	std::unique_ptr<const PointSetSurface> surface;
	if (options.surface == SurfaceKind::CurvatureDriven)
		surface = std::make_unique<CurvatureDrivenSurface>(control);
	else
		surface = std::make_unique<MovingLeastSquaresSurface>(control);
	const RayTracer tracer(*surface, control, options.picture.image);
	results.seconds("preparation", stage.lap());
	const Picture picture = renderPicture(
		tracer,
		control,
		colors,
		lines,
		camera,
		options.picture,
		context.progress.sub(0.2, 1.0, "Drawing"));
	results.seconds("rendering", stage.lap());
	savePicture(picture, options.file);

	results.count("points", points.size());
	results.count("pixels", std::ptrdiff_t(picture.width) * picture.height);
	results.count("hits", picture.hits);
	results.count("segments", static_cast<std::ptrdiff_t>(lines.segments.size()));
	reportNormals(results, points);
	results.seconds("total", total.seconds());
	return results;
}

} // namespace

FilterSpec rayTraceFilter()
{
	return {
		"Ray-Trace Point-Set Surface",
		"save_ray_traced_point_set_image",
		"Draws the surface between the points into a PNG file",
		"Draws the smooth surface between the points of a cloud, without a mesh and without a "
		"screen: "
		"every pixel's ray is followed onto the surface itself. Lines of another layer can be "
		"drawn on "
		"it." +
			helpInput +
			"<br><br><b>Writes</b> a PNG file. The layers stay as they are. The surface goes "
			"through the "
			"points as they are, noise and all: for noisy scans, denoise first." +
			helpReferenceTejada,
		FilterPlugin::PointSet + FilterPlugin::RangeMap,
		FilterPlugin::SINGLE_MESH,
		MeshModel::MM_NONE,
		MeshModel::MM_NONE,
		{parameters, apply}};
}

} // namespace curvature_lines
