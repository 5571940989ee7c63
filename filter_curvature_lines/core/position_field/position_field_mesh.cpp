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
#include "field_meshing.h"
#include "mesh_finishing.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "position_field_lines.h"
#include "progress.h"
#include "quad_collapse.h"
#include "quad_repair.h"
#include "rim_fit.h"
#include "rims.h"
#include "scaffold.h"
#include "scaffold_refinement.h"
#include "scaffold_sites.h"
#include "sizing_field.h"
#include "surface_arrangement.h"
#include "surface_projection.h"
#include "thin_creases.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

constexpr Index fewestPoints = 4;
// A subdivided mesh has as many vertices, edges and faces as the coarse one together: one, two and one.
constexpr double verticesPerDivided = 4.0;
// Relative, of a number of vertices that nobody has asked for. Lines that close come in whole numbers: of a torus of 29 by 16
// one more around the tube is 6 % more vertices.
constexpr double automaticTolerance = 0.07;
// LineDensityOptions::evenness where lines are closed: the flow takes the ends away, and what keeps the spacing even keeps
// the mesh near to the surface.
constexpr double closedEvenness = 10.0;
// Over the distance from the closest point, which the surface is not farther than, but for noise.
constexpr double farthestProjection = 2.0;
// Projections of a vertex on a rim.
constexpr int rimSteps = 2;
// Rounds of unsound faces that go.
constexpr int mostCollapses = 3;
// Faces that are farther below the surface, in mean edges, although sizes have shrunk there, get a cap.
constexpr double tallBulge = 0.7;

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
		// The surface of a few points is known near them only.
		const double most = farthestProjection * (cloud.positions.col(closest) - p).norm();
		if (!rim[v]) {
			const SurfaceSample sample =
				projectToSurface(cloud, curvature, p, closest, ProjectionKind::Mixed);
			if (!((sample.position - p).norm() <= most)) // nor where there is none, NaN
				return;
			mesh.vertices.col(v) = sample.position;
			mesh.normals.col(v)  = sample.normal;
			return;
		}
		// Beside its rim the surface is known on one side only: along the normal, where the rim already is.
		for (int step = 0; step < rimSteps; ++step) {
			const SurfaceSample sample =
				projectToSurface(cloud, curvature, p, closest, ProjectionKind::Mixed);
			const double along = (sample.position - p).dot(sample.normal);
			if (!(std::abs(along) <= most))
				break;
			p += along * sample.normal;
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
	const bool    divided      = options.mesh.quads == QuadKind::Subdivided;
	forSizes.targetVertices    = options.targetVertices / (divided ? verticesPerDivided : 1.0);
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

	std::vector<Rim> rims = findRims(mesh);
	fitRims(
		rims, fitted.cloud(), directionGuide(scaffold, curvature).normals, options.noise, scaffold);
	FieldMeshingOptions forMeshing;
	forMeshing.density.targetVertices = resized(scaffold, sizing, forSizes);
	forMeshing.density.anisotropy     = options.anisotropy;
	forMeshing.phases                 = options.phases;
	forMeshing.closed                 = options.mesh.quads != QuadKind::Dominant;
	if (forMeshing.closed)
		forMeshing.density.evenness = closedEvenness;
	forMeshing.holdTarget = !options.automatic;
	if (options.automatic)
		forMeshing.countTolerance = automaticTolerance;
	result.expectedVertices =
		forMeshing.density.targetVertices * (divided ? verticesPerDivided : 1.0);
	progress.report(0.4);
	MeshedField meshed =
		meshOfField(scaffold, rims, curvature, forMeshing, progress.sub(0.4, 0.9, "Laying lines"));
	result.singularTriangles = meshed.singularTriangles;
	result.lineEnds          = meshed.lineEnds;
	result.turnedOver        = meshed.turnedOver;
	result.otherFaces        = meshed.otherFaces;
	result.lostCreaseEdges += meshed.droppedCreaseEdges; // the mesh does not show them either
	result.crossings          = meshed.arrangement.crossings;
	result.repairedComponents = meshed.arrangement.repairedComponents;
	result.droppedComponents += meshed.arrangement.lostComponents;
	progress.report(0.9);
	if (options.keepLines) {
		result.lines =
			linesOf(meshed.curves, meshed.surface.scaffold, meshed.surface.field, index, curvature);
		result.lines.crossings = result.crossings;
	}

	std::vector<char> onFeature = std::move(meshed.arrangement.onFeature);
	result.mesh                 = std::move(meshed.arrangement.mesh);
	if (options.mesh.splitConcave)
		result.mesh = withConvexFaces(result.mesh);
	if (divided)
		result.mesh = withQuads(result.mesh, options.mesh.quads, onFeature);
	projectVertices(
		index, curvature, onFeature, result.mesh, progress.sub(0.95, 1.0, "Projecting vertices"));
	result.caps         = capBulgingFaces(fitted, curvature, tallBulge, result.mesh, onFeature);
	result.unsoundFaces = untangleFaces(fitted, curvature, onFeature, result.mesh);
	// What no move mends goes, and its neighbours move again.
	for (int k = 0; k < mostCollapses && result.unsoundFaces > 0; ++k) {
		if (collapseUnsoundQuads(onFeature, result.mesh) == 0)
			break;
		result.unsoundFaces = untangleFaces(fitted, curvature, onFeature, result.mesh);
	}
	result.unsoundFaces = repairQuads(fitted, curvature, onFeature, result.mesh);
	finish(result, std::move(onFeature), options.mesh);
	return result;
}

} // namespace curvature_lines
