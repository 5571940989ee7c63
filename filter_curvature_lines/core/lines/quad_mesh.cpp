// From crossings to faces: the half-edge graph of the lines, its reduction, its loops, and polygons
// that form a two-manifold (A09 section 6).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "quad_mesh.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "face_loops.h"
#include "half_edge_graph.h"
#include "line_arrangement.h"
#include "line_intersections.h"
#include "line_network.h"
#include "mesh_finishing.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygon_splitting.h"
#include "polygons.h"
#include "progress.h"
#include "voronoi_cells.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;
using Face = std::vector<Index>;

// Components of fewer faces go where another one has more than ten times as many: stray lines beside a
// mesh. By experiment.
constexpr Index fewestFaces = 4;

Polygons facesOf(const HalfEdgeGraph& graph, const LoopClassifier& kindOf, QuadMeshResult& result)
{
	std::vector<std::vector<Index>> faces;
	for (std::vector<Index>& loop : graph.faceLoops()) {
		const LoopKind kind = kindOf(loop);
		result.discardedLoops += kind != LoopKind::Face;
		result.tangledLoops += kind == LoopKind::Tangled;
		if (kind == LoopKind::Face)
			faces.push_back(std::move(loop));
	}
	return Polygons(graph, faces);
}

bool isInside(const Vector3d& point, const Face& face, const Polygons& polygons)
{
	Vector3d center = Vector3d::Zero(), normal = Vector3d::Zero();
	for (Index v : face) {
		center += polygons.vertices[v] / static_cast<double>(face.size());
		normal += polygons.normals[v];
	}
	double radius = 0.0;
	for (Index v : face)
		radius = std::max(radius, (polygons.vertices[v] - center).norm());
	if ((point - center).norm() > radius)
		return false;
	// Even-odd rule along the mean normal.
	const Vector3d x = normal.unitOrthogonal(), y = normal.cross(x);
	bool           inside = false;
	for (std::size_t k = 0; k < face.size(); ++k) {
		const Vector3d a  = polygons.vertices[face[k]] - point;
		const Vector3d b  = polygons.vertices[face[(k + 1) % face.size()]] - point;
		const double   ay = a.dot(y), by = b.dot(y);
		if ((ay > 0.0) != (by > 0.0) && a.dot(x) + (b - a).dot(x) * ay / (ay - by) > 0.0)
			inside = !inside;
	}
	return inside;
}

// Lines that cross each other but none of those around them form a second layer over a face of the others:
// it goes, and so do components of very few faces beside a large one. Separate objects stay.
Index removeIslands(Polygons& polygons)
{
	std::vector<Index> component(polygons.vertices.size());
	std::iota(component.begin(), component.end(), 0);
	const auto root = [&](Index v) {
		while (component[v] != v)
			v = component[v] = component[component[v]];
		return v;
	};
	for (const Face& face : polygons.faces)
		for (Index v : face)
			component[root(v)] = root(face[0]);
	std::vector<Index> size(component.size(), 0);
	for (const Face& face : polygons.faces)
		++size[root(face[0])];

	const Index       largest = size.empty() ? 0 : *std::max_element(size.begin(), size.end());
	std::vector<char> island(component.size(), 0);
	for (Index c = 0; c < static_cast<Index>(component.size()); ++c) {
		const auto liesIn = [&](const Face& face) {
			return size[root(face[0])] > size[c] && isInside(polygons.vertices[c], face, polygons);
		};
		island[c] =
			size[c] > 0 && ((size[c] < fewestFaces && largest > 10 * fewestFaces) ||
		                    std::any_of(polygons.faces.begin(), polygons.faces.end(), liesIn));
	}
	const auto onIsland = [&](const Face& face) { return island[root(face[0])] != 0; };
	polygons.faces.erase(
		std::remove_if(polygons.faces.begin(), polygons.faces.end(), onIsland),
		polygons.faces.end());
	return static_cast<Index>(std::count(island.begin(), island.end(), 1));
}

// Faces around a vertex that do not hang together get a copy of it each; unused vertices go.
PolygonMesh separateFans(const Polygons& polygons)
{
	struct Corner {
		Index vertex, next, previous, face, place;
	};
	std::vector<Corner> corners;
	for (Index f = 0; f < static_cast<Index>(polygons.faces.size()); ++f) {
		const Face& face = polygons.faces[f];
		const Index n    = static_cast<Index>(face.size());
		for (Index k = 0; k < n; ++k)
			corners.push_back({face[k], face[(k + 1) % n], face[(k + n - 1) % n], f, k});
	}
	std::stable_sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
		return a.vertex < b.vertex;
	});

	std::vector<Face>  faces = polygons.faces;
	std::vector<Index> source; // of every vertex of the result
	for (std::size_t begin = 0, end; begin < corners.size(); begin = end) {
		for (end = begin; end < corners.size() && corners[end].vertex == corners[begin].vertex;)
			++end;
		std::vector<Index> fan(end - begin, -1);
		for (std::size_t seed = 0; seed < fan.size(); ++seed) {
			if (fan[seed] >= 0)
				continue;
			std::vector<std::size_t> front = {seed};
			fan[seed]                      = static_cast<Index>(source.size());
			source.push_back(corners[begin].vertex);
			for (std::size_t k = 0; k < front.size(); ++k) {
				const Corner& c = corners[begin + front[k]];
				for (std::size_t o = 0; o < fan.size(); ++o) {
					const Corner& other = corners[begin + o];
					if (fan[o] < 0 && (other.next == c.previous || other.previous == c.next)) {
						fan[o] = fan[seed];
						front.push_back(o);
					}
				}
			}
		}
		for (std::size_t k = 0; k < fan.size(); ++k)
			faces[corners[begin + k].face][corners[begin + k].place] = fan[k];
	}

	std::vector<Vector3d> vertices, normals;
	for (const Index v : source) {
		vertices.push_back(polygons.vertices[v]);
		normals.push_back(polygons.normals[v]);
	}
	return polygonMesh(vertices, normals, faces);
}

} // namespace

QuadMeshResult buildQuadMesh(
	const PointCloud&           cloud,
	const VoronoiCells&         cells,
	const LineNetwork&          lines,
	const MeshFinishingOptions& options,
	const Progress&             progress)
{
	QuadMeshResult          result;
	const LineIntersections found =
		intersectLines(cells, lines, progress.sub(0.0, 0.6, "Finding crossings"));
	result.crossings = static_cast<Index>(found.crossings.size());

	const LineArrangement arrangement = arrangeLines(cells, lines, found);
	result.mergedCrossings            = arrangement.merged;
	progress.report(0.7);
	const LoopClassifier kindOf(cloud, cells, arrangement.graph);
	Polygons             polygons = facesOf(arrangement.graph, kindOf, result);
	result.islands                = removeIslands(polygons);
	result.mesh                   = separateFans(polygons);
	progress.report(0.8);
	if (options.closeHoles)
		closeSmallHoles(result.mesh);

	PolygonSplitter splitter(result.mesh);
	splitter.cutLargeFaces();
	splitter.pairWithPentagons();
	result.mesh = splitter.mesh();
	std::vector<char> onFeature(result.mesh.vertexCount(), 0);
	if (options.splitConcave)
		result.mesh = withConvexFaces(result.mesh);
	onFeature.resize(result.mesh.vertexCount(), 0);
	result.mesh = withQuads(result.mesh, options.quads, onFeature);
	finish(result, {}, options); // nothing is known of creases
	progress.report(1.0);
	return result;
}

} // namespace curvature_lines
