// Polygon meshes as MeshLab holds them.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "polygon_layer.h"

#include <algorithm>
#include <map>

#include "polygon_splitting.h"

namespace curvature_lines {

namespace {

Point3m toPoint(const Eigen::Vector3d& v)
{
	return {Scalarm(v.x()), Scalarm(v.y()), Scalarm(v.z())};
}

// A triangulated polygon mesh that remembers its polygons.
struct Triangulation {
	PolygonMesh        mesh; // triangles; vertices beyond those of the polygons are hubs of stars
	std::vector<Index> polygon; // of each triangle
	std::vector<char>  inner;   // per triangle corner: the side that starts there is a diagonal
};

// Triangulated as a whole, because a diagonal that is an edge elsewhere makes a non-manifold mesh,
// and hosts hang on saving polygons of such.
Triangulation triangulate(const PolygonMesh& polygons)
{
	using Side = std::pair<Index, Index>; // directed
	std::map<Side, Index> polygonOf;
	for (Index f = 0; f < polygons.faceCount(); ++f) {
		const NeighborLists::Row face = polygons.faces[f];
		for (Index c = 0; c < face.size(); ++c)
			polygonOf[{face[c], face[(c + 1) % face.size()]}] = f;
	}
	PolygonSplitter splitter(polygons);
	splitter.triangulate();
	Triangulation result;
	result.mesh = splitter.mesh();

	const NeighborLists&  triangles = result.mesh.faces;
	std::map<Side, Index> acrossDiagonal; // the triangle left of a directed diagonal
	result.polygon.assign(triangles.size(), -1);
	result.inner.assign(3 * triangles.size(), 0);
	std::vector<Index> front;
	for (Index t = 0; t < triangles.size(); ++t)
		for (int c = 0; c < 3; ++c) {
			const Side side{triangles[t][c], triangles[t][(c + 1) % 3]};
			const auto found = polygonOf.find(side);
			if (found == polygonOf.end()) {
				result.inner[3 * t + c] = 1;
				acrossDiagonal[side]    = t;
			}
			else if (result.polygon[t] < 0) {
				result.polygon[t] = found->second;
				front.push_back(t);
			}
		}
	// Triangles with diagonals only belong where their neighbours do.
	for (std::size_t k = 0; k < front.size(); ++k) {
		const Index t = front[k];
		for (int c = 0; c < 3; ++c) {
			if (!result.inner[3 * t + c])
				continue;
			const auto other = acrossDiagonal.find({triangles[t][(c + 1) % 3], triangles[t][c]});
			if (other != acrossDiagonal.end() && result.polygon[other->second] < 0) {
				result.polygon[other->second] = result.polygon[t];
				front.push_back(other->second);
			}
		}
	}
	return result;
}

// A host's polygon has no vertex inside: the triangles of a star become faces of their own.
PolygonMesh dissolveStars(const PolygonMesh& polygons, Triangulation& triangles)
{
	std::vector<char> starred(polygons.faceCount(), 0);
	for (Index t = 0; t < triangles.mesh.faceCount(); ++t)
		for (const Index v : triangles.mesh.faces[t])
			if (v >= polygons.vertexCount())
				starred[triangles.polygon[t]] = 1;

	std::vector<std::vector<Index>> faces;
	for (Index f = 0; f < polygons.faceCount(); ++f)
		if (!starred[f])
			faces.emplace_back(polygons.faces[f].begin(), polygons.faces[f].end());
	for (Index t = 0; t < triangles.mesh.faceCount(); ++t)
		if (starred[triangles.polygon[t]]) {
			faces.emplace_back(triangles.mesh.faces[t].begin(), triangles.mesh.faces[t].end());
			std::fill_n(triangles.inner.begin() + 3 * t, 3, char(0));
		}
	return {triangles.mesh.vertices, triangles.mesh.normals, NeighborLists::fromRows(faces)};
}

// One normal per polygon, or its diagonals would show in flat shading.
void writeFaceNormals(CMeshO& mesh, const Triangulation& triangles, Index polygons)
{
	vcg::tri::UpdateNormal<CMeshO>::PerFace(mesh);
	std::vector<Point3m> sums(polygons, Point3m(0, 0, 0));
	for (std::size_t t = 0; t < mesh.face.size(); ++t)
		sums[triangles.polygon[t]] += mesh.face[t].N();
	for (std::size_t t = 0; t < mesh.face.size(); ++t)
		mesh.face[t].N() = sums[triangles.polygon[t]].Normalize();
}

} // namespace

MeshTopology
writePolygons(MeshModel& layer, const PolygonMesh& polygons, const PreparedCloud& frame)
{
	Triangulation     triangles = triangulate(polygons);
	const PolygonMesh written   = dissolveStars(polygons, triangles);

	CMeshO& mesh = layer.cm;
	vcg::tri::Allocator<CMeshO>::AddVertices(mesh, written.vertexCount());
	for (Index v = 0; v < written.vertexCount(); ++v) {
		mesh.vert[v].P() = toPoint(frame.toModel(written.vertices.col(v)));
		mesh.vert[v].N() = toPoint(written.normals.col(v));
	}
	auto face = vcg::tri::Allocator<CMeshO>::AddFaces(mesh, triangles.mesh.faceCount());
	for (Index t = 0; t < triangles.mesh.faceCount(); ++t, ++face)
		for (int c = 0; c < 3; ++c) {
			face->V(c) = &mesh.vert[triangles.mesh.faces[t][c]];
			if (triangles.inner[3 * t + c])
				face->SetF(c);
		}
	writeFaceNormals(mesh, triangles, polygons.faceCount());
	vcg::tri::UpdateBounding<CMeshO>::Box(mesh);
	if (std::count(triangles.inner.begin(), triangles.inner.end(), char(1)) > 0)
		layer.updateDataMask(MeshModel::MM_POLYGONAL);
	return topologyOf(written);
}

void reportMesh(FilterResults& results, const MeshTopology& t)
{
	results.count("vertices", t.vertices);
	results.count("faces", t.faces);
	results.count("quads", t.quads);
	results.count("triangles", t.triangles);
	results.count("largest_face", t.largestFace);
	results.count("euler_characteristic", t.eulerCharacteristic);
	results.count("boundary_edges", t.boundaryEdges);
	results.count("boundary_loops", t.boundaryLoops);
	results.count("nonmanifold_edges", t.nonmanifoldEdges);
	results.count("nonmanifold_vertices", t.nonmanifoldVertices);
	results.count("components", t.components);
}

} // namespace curvature_lines
