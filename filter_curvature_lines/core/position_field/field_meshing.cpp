// One pass, and as many more as correct its number of vertices and its creases.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "field_meshing.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "closed_position_field.h"
#include "crease_selection.h"
#include "cross_field.h"
#include "curvature_field.h"
#include "feature_alignment.h"
#include "line_density.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "position_field.h"
#include "progress.h"
#include "quad_cleanup.h"
#include "quad_completion.h"
#include "rims.h"
#include "scaffold.h"
#include "singular_pairs.h"
#include "singular_vertices.h"
#include "size_feedback.h"
#include "surface_arrangement.h"
#include "surface_curves.h"
#include "surface_graph.h"

namespace curvature_lines {

namespace {

constexpr int mostPasses = 3;
// Times creases are given up in a pass: those near them may turn over next.
constexpr int mostReleases = 2;
// Vertices of a first pass over those asked for, below which its lines have gone astray.
constexpr double leastRatio = 0.75;
// In cells, of paths of the flow: after that, and what it does not join remains a line that ends.
constexpr double shortPath = 4.0;
// Over the accepted distance: what is so far from the mesh is worth a third pass.
constexpr double wellFar = 4.0;
// Relative, of the number of vertices: what users are promised where limbs need no more.
constexpr double promisedCount = 0.05;
// Of a face that overlaps others, over a vertex of the scaffold at the accepted distance.
constexpr double foldWeight = 10.0;

// What a pass starts from.
struct Directions {
	DirectionGuide   guide;
	FeatureAlignment alignment;
	CrossField       field;
	LineDensity      density;
};

Directions directionsOf(
	const Scaffold&            scaffold,
	const std::vector<Rim>&    rims,
	const CurvatureField&      curvature,
	const FieldMeshingOptions& options)
{
	Directions result;
	result.guide     = directionGuide(scaffold, curvature);
	result.alignment = alignWithFeatures(scaffold, rims, result.guide);
	if (options.closed) {
		result.field        = calmCrossField(scaffold, result.guide, options.pairs);
		const Index changed = joinSingularPairs(scaffold, result.field, options.pairs) +
		                      spreadSingularPoints(scaffold, result.field, options.pairs);
		if (changed > 0)
			smoothWithTurns(scaffold.mesh, result.guide, result.field);
	}
	else
		result.field = smoothCrossField(scaffold.mesh, result.guide);
	result.density = lineDensity(scaffold, result.field, curvature, options.density);
	return result;
}

// Closed lines, and creases given up at which they turn over.
MeshedField layClosedLines(
	Scaffold&                  scaffold,
	const std::vector<Rim>&    rims,
	const Directions&          directions,
	const LineDensity&         density,
	PositionField              positions,
	const FieldMeshingOptions& options)
{
	ClosingOptions closing   = options.closing;
	closing.flow.onLimb      = scaffold.onLimb;
	ClosedPositionField laid = closePositionField(
		scaffold.mesh,
		directions.guide,
		directions.field,
		density,
		featurePins(directions.alignment, directions.field),
		std::move(positions),
		closing);
	MeshedField     result;
	SurfaceFeatures features = directions.alignment.features;
	for (int k = 0; k < mostReleases && !laid.turnedOver.empty(); ++k) {
		const Index dropped = dropCreasesAt(laid.turnedOver, scaffold);
		if (dropped == 0)
			break;
		result.droppedCreaseEdges += dropped + dropShortCreases(scaffold);
		DirectionGuide         guide     = directions.guide;
		const FeatureAlignment alignment = alignWithFeatures(scaffold, rims, guide);
		layPhases(scaffold.mesh, density, featurePins(alignment, laid.field), closing, laid);
		features = alignment.features;
	}
	result.turnedOver = static_cast<Index>(laid.turnedOver.size());
	result.surface    = splitSingularTriangles(scaffold, laid.field, laid.positions, features);
	return result;
}

// `closed`: FieldMeshingOptions::closed. Creases at which closed lines turn over are creases of the scaffold no more.
MeshedField meshOnce(
	Scaffold&                  scaffold,
	const std::vector<Rim>&    rims,
	const Directions&          directions,
	double                     denser,
	const FieldMeshingOptions& options,
	bool                       closed)
{
	MeshedField       result;
	const LineDensity density   = denser * directions.density;
	PositionField     positions = positionField(
        scaffold.mesh,
        directions.field,
        density,
        featurePins(directions.alignment, directions.field),
        options.phases);
	if (closed)
		result = layClosedLines(scaffold, rims, directions, density, std::move(positions), options);
	else
		result.surface = {
			scaffold, directions.field, std::move(positions), directions.alignment.features, {}};
	const SingularVertices& on = result.surface;
	result.singularTriangles   = static_cast<Index>(singularTriangles(directions.field).size());
	result.lineEnds            = on.positions.lineEnds;
	result.curves = integerLines(on.scaffold.mesh, on.field, on.positions, on.singular);
	result.arrangement =
		arrangeOnSurface(on.scaffold.mesh, on.field.normals, on.features, result.curves);
	PolygonMesh& mesh = result.arrangement.mesh;
	mesh              = cleanUpQuads(mesh, result.arrangement.onFeature);
	if (options.closed) {
		for (Index f = 0; f < mesh.faceCount(); ++f)
			result.otherFaces += mesh.faces[f].size() != 4;
		mesh = completeQuads(mesh, result.arrangement.onFeature).mesh;
	}
	return result;
}

// That the sizes ask for.
double neededVertices(const Scaffold& scaffold)
{
	return scaffold.size.size() == 0
	           ? 0.0
	           : (scaffold.mesh.vertexAreas().array() / scaffold.size.array().square()).sum();
}

// Of faces that overlap or were no quads by themselves, and of what is left out.
double flawsOf(const MeshedField& mesh)
{
	return foldWeight * double(mesh.turnedOver + mesh.otherFaces) + mesh.far.weight;
}

// What is lost first, then the number of vertices, as far as it is promised; then the flaws.
bool isBetter(
	const MeshedField&         next,
	double                     miss,
	const MeshedField&         best,
	double                     bestMiss,
	const FieldMeshingOptions& options)
{
	if (next.arrangement.lostComponents != best.arrangement.lostComponents)
		return next.arrangement.lostComponents < best.arrangement.lostComponents;
	const double tolerance  = std::max(promisedCount, options.countTolerance);
	const double nextExcess = std::max(0.0, miss - tolerance),
				 bestExcess = std::max(0.0, bestMiss - tolerance);
	if (nextExcess != bestExcess)
		return nextExcess < bestExcess;
	return flawsOf(next) <= flawsOf(best);
}

} // namespace

MeshedField meshOfField(
	Scaffold                   scaffold,
	const std::vector<Rim>&    rims,
	const CurvatureField&      curvature,
	const FieldMeshingOptions& options,
	const Progress&            progress)
{
	FieldMeshingOptions forPass    = options;
	double&             target     = forPass.density.targetVertices;
	Index               dropped    = options.closed ? dropShortCreases(scaffold) : 0;
	Directions          directions = directionsOf(scaffold, rims, curvature, forPass);
	// The same in all passes, so that they can be compared.
	SizeFeedbackOptions feedback;
	feedback.acceptedLength = acceptedDistance(scaffold);
	MeshedField best;
	double      bestMiss = INFINITY, denser = 1.0;
	bool        astray = false;
	for (int pass = 0; pass < mostPasses; ++pass) {
		progress.report(double(pass) / mostPasses);
		MeshedField  next  = meshOnce(scaffold, rims, directions, denser, forPass, options.closed);
		const double ratio = next.arrangement.mesh.vertexCount() / target;
		const double miss  = ratio > 0.0 ? std::max(ratio, 1.0 / ratio) - 1.0 : INFINITY;
		const bool   released = next.droppedCreaseEdges > 0;
		const double before   = neededVertices(scaffold);
		if (options.closed)
			next.far = shrinkSizesWhereFar(next.arrangement.mesh, scaffold, feedback);
		const LeftOut far       = next.far;
		next.droppedCreaseEdges = dropped += next.droppedCreaseEdges;
		if (pass == 0 || isBetter(next, miss, best, bestMiss, options)) {
			best     = std::move(next);
			bestMiss = miss;
		}
		const bool again =
			pass == 0 ? released || far.vertices > 0 || miss > options.countTolerance
					  : best.far.worst > wellFar || (astray && miss > options.countTolerance);
		if (!(ratio > 0.0) || !again)
			break;
		// Closed lines run on to where they meet others: on a cone, which has fewer and fewer around, there may be no others
		// but those on its far side, and most lines go. Then some have to end.
		if (options.closed && ratio < leastRatio) {
			astray                       = true;
			forPass.closing.flow.longest = shortPath;
		}
		else
			denser /= std::sqrt(ratio);
		if (!options.holdTarget)
			target += neededVertices(scaffold) - before;
		if (released)
			directions = directionsOf(scaffold, rims, curvature, forPass);
		else
			directions.density =
				lineDensity(scaffold, directions.field, curvature, forPass.density);
	}
	// Lines that may end go where closed ones found no room.
	if (options.closed && best.arrangement.lostComponents > 0) {
		MeshedField open        = meshOnce(scaffold, rims, directions, denser, forPass, false);
		open.droppedCreaseEdges = dropped;
		if (open.arrangement.lostComponents < best.arrangement.lostComponents)
			return open;
	}
	return best;
}

} // namespace curvature_lines
