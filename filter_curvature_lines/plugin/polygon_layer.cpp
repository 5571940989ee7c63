// Polygon meshes as MeshLab holds them.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "polygon_layer.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "filter_results.h"
#include "host_types.h"
#include "mesh_finishing.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygon_triangulation.h"
#include "texture_charts.h"

namespace curvature_lines {

namespace {

// One normal per polygon, or its diagonals would show in flat shading.
void writeFaceNormals(CMeshO& mesh, const std::vector<Index>& polygon, Index polygons)
{
	vcg::tri::UpdateNormal<CMeshO>::PerFace(mesh);
	std::vector<Point3m> sums(polygons, Point3m(0, 0, 0));
	for (std::size_t t = 0; t < mesh.face.size(); ++t)
		sums[polygon[t]] += mesh.face[t].N();
	for (std::size_t t = 0; t < mesh.face.size(); ++t)
		mesh.face[t].N() = sums[polygon[t]].Normalize();
}

// `corners`: 2 x three per face.
void writeTexture(MeshModel& layer, const Eigen::Matrix2Xd& corners)
{
	layer.updateDataMask(MeshModel::MM_WEDGTEXCOORD);
	for (std::size_t t = 0; t < layer.cm.face.size(); ++t)
		for (int c = 0; c < 3; ++c) {
			const auto column = corners.col(static_cast<Index>(3 * t + c));
			auto&      wedge  = layer.cm.face[t].WT(c);
			wedge.U()         = toScalar(column.x());
			wedge.V()         = toScalar(column.y());
			wedge.N()         = 0; // of the only texture there may be
		}
}

} // namespace

MeshTopology
writePolygons(MeshModel& layer, const FinishedMesh& finished, const PreparedCloud& frame)
{
	const PolygonMesh&         polygons = finished.mesh;
	const PolygonTriangulation cut      = triangulatePolygons(polygons);
	const PolygonMesh&         written  = cut.polygons;

	CMeshO& mesh = layer.cm;
	vcg::tri::Allocator<CMeshO>::AddVertices(mesh, written.vertexCount());
	for (Index v = 0; v < written.vertexCount(); ++v) {
		mesh.vert[v].P() = toPoint(frame.toModel(written.vertices.col(v)));
		mesh.vert[v].N() = toPoint(written.normals.col(v));
	}
	auto face = vcg::tri::Allocator<CMeshO>::AddFaces(mesh, cut.triangles.faceCount());
	for (Index t = 0; t < cut.triangles.faceCount(); ++t, ++face)
		for (int c = 0; c < 3; ++c) {
			face->V(c) = &mesh.vert[cut.triangles.faces[t][c]];
			if (cut.inner[3 * t + c])
				face->SetF(c);
		}
	writeFaceNormals(mesh, cut.polygon, polygons.faceCount());
	vcg::tri::UpdateBounding<CMeshO>::Box(mesh);
	if (std::count(cut.inner.begin(), cut.inner.end(), char(1)) > 0)
		layer.updateDataMask(MeshModel::MM_POLYGONAL);
	if (finished.texture.charts > 0)
		writeTexture(layer, cornersOfTriangles(polygons, finished.texture.corners, cut));
	return topologyOf(written);
}

void reportMesh(FilterResults& results, const MeshTopology& t, const TextureCoordinates& texture)
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
	if (texture.charts > 0) {
		results.count("texture_charts", texture.charts);
		results.count("texture_cells", texture.cells);
	}
}

} // namespace curvature_lines
