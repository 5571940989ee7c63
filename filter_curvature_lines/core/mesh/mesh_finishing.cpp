// Holes from their rims; concave faces by the splitter.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_finishing.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygon_splitting.h"
#include "polygon_triangulation.h"
#include "quad_completion.h"
#include "quad_subdivision.h"
#include "texture_charts.h"

namespace curvature_lines {

void closeSmallHoles(PolygonMesh& mesh)
{
	std::vector<Index> ahead(mesh.vertexCount(), -1); // along the rim, hole on the left
	std::vector<std::pair<Index, Index>> sides;
	std::vector<double>                  lengths;
	for (Index f = 0; f < mesh.faceCount(); ++f) {
		const NeighborLists::Row face = mesh.faces[f];
		for (Index k = 0; k < face.size(); ++k) {
			sides.emplace_back(face[k], face[(k + 1) % face.size()]);
			lengths.push_back(
				(mesh.vertices.col(sides.back().first) - mesh.vertices.col(sides.back().second))
					.norm());
		}
	}
	if (sides.empty())
		return;
	std::nth_element(lengths.begin(), lengths.begin() + lengths.size() / 2, lengths.end());
	const double longest = longestClosedHole * lengths[lengths.size() / 2];
	std::sort(sides.begin(), sides.end());
	for (const auto& [a, b] : sides)
		if (!std::binary_search(sides.begin(), sides.end(), std::make_pair(b, a)))
			ahead[b] = a;

	std::vector<char> visited(mesh.vertexCount(), 0);
	for (Index start = 0; start < mesh.vertexCount(); ++start) {
		std::vector<Index> rim;
		double             perimeter = 0.0;
		for (Index v = start; ahead[v] >= 0 && !visited[v]; v = ahead[v]) {
			visited[v] = 1;
			rim.push_back(v);
			perimeter += (mesh.vertices.col(v) - mesh.vertices.col(ahead[v])).norm();
		}
		if (rim.size() < 3 || perimeter > longest)
			continue;
		mesh.faces.indices.insert(mesh.faces.indices.end(), rim.begin(), rim.end());
		mesh.faces.offsets.push_back(static_cast<Index>(mesh.faces.indices.size()));
	}
}

PolygonMesh withConvexFaces(const PolygonMesh& mesh)
{
	PolygonSplitter splitter(mesh);
	splitter.splitConcaveFaces();
	return splitter.mesh();
}

PolygonMesh withQuads(const PolygonMesh& mesh, QuadKind kind, std::vector<char>& onFeature)
{
	switch (kind) {
	case QuadKind::Pure:
		return completeQuads(mesh, onFeature).mesh;
	case QuadKind::Subdivided:
		return subdivided(mesh, onFeature).mesh;
	default:
		return mesh;
	}
}

void finish(FinishedMesh& result, std::vector<char> onFeature, const MeshFinishingOptions& options)
{
	TextureCoordinates& texture = result.texture;
	if (options.textureCoordinates) {
		onFeature.resize(result.mesh.vertexCount(), 0);
		texture = textureCoordinates(result.mesh, bentEdgesBetween(result.mesh, onFeature));
	}
	if (options.triangulate) {
		PolygonTriangulation cut = triangulatePolygons(result.mesh);
		if (options.textureCoordinates) {
			texture.corners = cornersOfTriangles(result.mesh, texture.corners, cut);
			std::vector<Index> chart;
			for (const Index polygon : cut.polygon)
				chart.push_back(texture.chart[polygon]);
			texture.chart = std::move(chart);
		}
		result.mesh = std::move(cut.triangles);
	}
	result.topology = topologyOf(result.mesh);
}

} // namespace curvature_lines
