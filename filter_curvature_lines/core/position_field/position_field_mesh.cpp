// The stages in their order, and one correction of the number of vertices.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "position_field_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "cloud_index.h"
#include "cross_field.h"
#include "curvature_field.h"
#include "face_caps.h"
#include "face_untangling.h"
#include "feature_alignment.h"
#include "line_density.h"
#include "mesh_finishing.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "position_field.h"
#include "position_field_lines.h"
#include "progress.h"
#include "quad_cleanup.h"
#include "rim_fit.h"
#include "rims.h"
#include "scaffold.h"
#include "scaffold_refinement.h"
#include "scaffold_sites.h"
#include "sizing_field.h"
#include "surface_arrangement.h"
#include "surface_curves.h"
#include "surface_graph.h"
#include "surface_projection.h"
#include "thin_creases.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

// Error of the number of vertices beyond which the density is corrected, once: the accuracy that is
// promised for it.
constexpr double countTolerance = 0.03;

constexpr Index fewestPoints = 4;
// Projections of a vertex on a rim.
constexpr int rimSteps = 2;
// A limb whose end the mesh misses by far may need a cap on a cap.
constexpr int capRounds = 2;
// Faces get a cap that are farther below the surface, in mean edges; in the first round and the second. .25 brings the cow
// down by a fiftieth for a third more irregular vertices, .5 a rod's end up by a tenth.
constexpr double lowBulge = 0.35, tallBulge = 0.7;

struct FieldMesh {
	SurfaceCurves      curves;
	SurfaceArrangement arrangement; // its mesh cleaned up
	Index              lineEnds = 0;
};

// The mesh whose lines have this density: phases, their whole numbers as curves, faces between them, clean-up.
FieldMesh meshOfDensity(
	const Scaffold&                 scaffold,
	const CrossField&               field,
	const LineDensity&              density,
	const PhasePins&                pins,
	const SurfaceFeatures&          features,
	const PositionFieldMeshOptions& options)
{
	const PositionField positions =
		positionField(scaffold.mesh, field, density, pins, options.phases);
	FieldMesh result;
	result.curves      = integerLines(scaffold.mesh, field, positions);
	result.arrangement = arrangeOnSurface(scaffold.mesh, field.normals, features, result.curves);
	result.lineEnds    = positions.lineEnds;
	result.arrangement.mesh = cleanUpQuads(result.arrangement.mesh, result.arrangement.onFeature);
	return result;
}

// Another try with the density corrected by the number of vertices of the first, where that misses the
// target: the better one.
FieldMesh meshOfTargetSize(
	const Scaffold&                 scaffold,
	const CrossField&               field,
	LineDensity                     density,
	double                          target,
	const PhasePins&                pins,
	const SurfaceFeatures&          features,
	const PositionFieldMeshOptions& options,
	const Progress&                 progress)
{
	FieldMesh    first = meshOfDensity(scaffold, field, density, pins, features, options);
	const double ratio = first.arrangement.mesh.vertexCount() / target;
	progress.report(0.7);
	if (!(ratio > 0.0) || std::abs(ratio - 1.0) <= countTolerance)
		return first;
	density /= std::sqrt(ratio);
	FieldMesh    second = meshOfDensity(scaffold, field, density, pins, features, options);
	const double next   = second.arrangement.mesh.vertexCount() / target;
	if (std::abs(next - 1.0) < std::abs(ratio - 1.0))
		return second;
	return first;
}

// The sizes anew, now that the area is known. Returns how many vertices they ask for.
double resized(Scaffold& scaffold, const SizingField& sizing, const SizingOptions& options)
{
	const Eigen::VectorXd areas   = scaffold.mesh.vertexAreas();
	const Eigen::VectorXd feature = sizing.feature(scaffold.place);
	const double          uniform = std::sqrt(areas.sum() / options.targetVertices);
	const double          body =
        options.automatic
					 ? uniform
					 : bodyFor(areas, feature, options.targetVertices, options.mostBody * uniform);
	scaffold.size = feature.cwiseMin(body);
	scaffold.onLimb.resize(scaffold.place.size());
	for (std::size_t v = 0; v < scaffold.place.size(); ++v)
		scaffold.onLimb[v] = std::isfinite(sizing.limb[scaffold.place[v]]);
	return (areas.array() / scaffold.size.array().square()).sum();
}

// Of every vertex: it lies on an edge of one face.
std::vector<char> onRim(const PolygonMesh& mesh)
{
	std::vector<std::pair<Index, Index>> sides;
	for (Index f = 0; f < mesh.faceCount(); ++f) {
		const NeighborLists::Row face = mesh.faces[f];
		for (Index k = 0; k < face.size(); ++k)
			sides.emplace_back(face[k], face[(k + 1) % face.size()]);
	}
	std::sort(sides.begin(), sides.end());
	std::vector<char> rim(mesh.vertexCount(), 0);
	for (const auto& [a, b] : sides)
		if (!std::binary_search(sides.begin(), sides.end(), std::make_pair(b, a)))
			rim[a] = rim[b] = 1;
	return rim;
}

void projectVertices(
	const CloudIndex&        index,
	const CurvatureField&    curvature,
	const std::vector<char>& fixed,
	PolygonMesh&             mesh,
	const Progress&          progress)
{
	const PointCloud&       cloud = index.cloud();
	const std::vector<char> rim   = onRim(mesh);
	parallelFor(mesh.vertexCount(), progress, [&](Index v) {
		if (fixed[v] && !rim[v])
			return;
		Eigen::Vector3d p       = mesh.vertices.col(v);
		const Index     closest = closestOnSide(index, p, mesh.normals.col(v));
		if (!rim[v]) {
			const SurfaceSample sample =
				projectToSurface(cloud, curvature, p, closest, ProjectionKind::Mixed);
			mesh.vertices.col(v) = sample.position;
			mesh.normals.col(v)  = sample.normal;
			return;
		}
		// Beside its rim the surface is known on one side only: along the normal, where the rim already is.
		for (int step = 0; step < rimSteps; ++step) {
			const SurfaceSample sample =
				projectToSurface(cloud, curvature, p, closest, ProjectionKind::Mixed);
			p += (sample.position - p).dot(sample.normal) * sample.normal;
			mesh.normals.col(v) = sample.normal;
		}
		mesh.vertices.col(v) = p;
	});
}

} // namespace

PositionFieldMeshResult buildPositionFieldMesh(
	const CloudIndex&               index,
	const CurvatureField&           curvature,
	const std::vector<FeatureLine>& creases,
	const PositionFieldMeshOptions& options,
	const Progress&                 progress)
{
	PositionFieldMeshResult result;
	if (index.size() < fewestPoints)
		return result;
	ScaffoldOptions forScaffold = options.scaffold;
	forScaffold.noise           = options.noise;
	forScaffold.closedRim       = options.mesh.closeHoles ? longestClosedHole : 0.0;
	// A front over points that keep their noise folds, and lines on it turn back and cross.
	const CloudIndex fitted =
		curvature.height.size() > 0 ? onFittedSurface(index.cloud(), curvature) : index;
	SizingOptions forSizes;
	forSizes.targetVertices    = options.targetVertices;
	forSizes.automatic         = options.automatic;
	const SizingField sizing   = sizingField(index, curvature, forSizes);
	Scaffold          scaffold = buildScaffold(
        fitted,
        withoutThinLimbs(creases, index, sizing),
        sizing,
        forScaffold,
        progress.sub(0.0, 0.3, "Triangulating"));
	refineBends(scaffold);
	const TriangleMesh& mesh = scaffold.mesh;
	result.scaffoldVertices  = mesh.vertexCount();
	result.scaffoldEuler     = mesh.eulerCharacteristic();
	result.droppedComponents = scaffold.droppedComponents;
	result.filledHoles       = scaffold.filledHoles;
	result.lostCreaseEdges   = scaffold.lostCreaseEdges;
	if (mesh.triangleCount() == 0)
		return result;

	std::vector<Rim> rims  = findRims(mesh);
	DirectionGuide   guide = directionGuide(scaffold, curvature);
	fitRims(rims, fitted.cloud(), guide.normals, options.noise, scaffold);
	const FeatureAlignment alignment = alignWithFeatures(scaffold, rims, guide);
	const CrossField       field     = smoothCrossField(mesh, guide);
	result.singularTriangles         = field.singularTriangles();
	progress.report(0.4);
	const PhasePins        pins     = featurePins(alignment, field);
	const SurfaceFeatures& features = alignment.features;
	LineDensityOptions     wanted;
	wanted.targetVertices   = resized(scaffold, sizing, forSizes);
	wanted.anisotropy       = options.anisotropy;
	result.expectedVertices = wanted.targetVertices;
	LineDensity density     = lineDensity(scaffold, field, curvature, wanted);
	progress.report(0.5);
	FieldMesh meshed = meshOfTargetSize(
		scaffold,
		field,
		std::move(density),
		wanted.targetVertices,
		pins,
		features,
		options,
		progress);
	result.lineEnds           = meshed.lineEnds;
	result.crossings          = meshed.arrangement.crossings;
	result.repairedComponents = meshed.arrangement.repairedComponents;
	result.droppedComponents += meshed.arrangement.lostComponents;
	progress.report(0.9);
	if (options.keepLines) {
		result.lines           = linesOf(meshed.curves, scaffold, field, index, curvature);
		result.lines.crossings = result.crossings;
	}

	std::vector<char> onFeature = std::move(meshed.arrangement.onFeature);
	result.mesh                 = std::move(meshed.arrangement.mesh);
	if (options.mesh.splitConcave)
		result.mesh = withConvexFaces(result.mesh);
	projectVertices(
		index, curvature, onFeature, result.mesh, progress.sub(0.95, 1.0, "Projecting vertices"));
	for (int round = 0, caps = 1; round < capRounds && caps > 0; ++round) {
		const double bulge = round == 0 ? lowBulge : tallBulge;
		caps               = capBulgingFaces(fitted, curvature, bulge, result.mesh, onFeature);
		result.caps += caps;
	}
	result.unsoundFaces = untangleFaces(fitted, curvature, onFeature, result.mesh);
	if (options.mesh.triangulate)
		result.mesh = triangulated(result.mesh);
	result.topology = topologyOf(result.mesh);
	return result;
}

} // namespace curvature_lines
