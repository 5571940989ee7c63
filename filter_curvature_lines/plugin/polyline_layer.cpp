// Lines of curvature as a layer of vertices and edges, and back.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "polyline_layer.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <common/mlexception.h>

#include "crease_curves.h"
#include "host_types.h"
#include "line_chains.h"
#include "line_network.h"
#include "point_cloud.h"

namespace curvature_lines {

namespace {

using Allocator = vcg::tri::Allocator<CMeshO>;

const char* const sourceAttribute = "curvature_lines_source";

// Vermilion and blue of the palette by Okabe and Ito (2008): colour-blind people can tell them apart, too.
vcg::Color4b familyColor(int family)
{
	return family == 1 ? vcg::Color4b(213, 94, 0, 255) : vcg::Color4b(0, 114, 178, 255);
}

// Line l has the vertices [offsets[l], offsets[l + 1]).
void writeEdges(CMeshO& mesh, const std::vector<Index>& offsets, const std::vector<char>& closed)
{
	std::vector<std::array<Index, 2>> edges;
	for (std::size_t l = 0; l < closed.size(); ++l) {
		const Index first = offsets[l], last = offsets[l + 1] - 1;
		for (Index v = first; v < last; ++v)
			edges.push_back({v, v + 1});
		if (closed[l] && last - first >= 2)
			edges.push_back({last, first});
	}
	auto edge = Allocator::AddEdges(mesh, edges.size());
	for (const auto& [from, to] : edges) {
		edge->V(0) = &mesh.vert[from];
		edge->V(1) = &mesh.vert[to];
		++edge;
	}
}

LineChains chainsOf(const CMeshO& mesh)
{
	std::vector<std::array<Index, 2>> edges;
	for (const CEdgeO& edge : mesh.edge)
		if (!edge.IsD())
			edges.push_back(
				{static_cast<Index>(vcg::tri::Index(mesh, edge.cV(0))),
			     static_cast<Index>(vcg::tri::Index(mesh, edge.cV(1)))});
	std::optional<LineChains> chains = chainEdges(static_cast<Index>(mesh.vert.size()), edges);
	if (!chains)
		throw MLException(
			"the lines of the current layer branch; 'Trace Lines of Curvature' makes lines that do "
			"not.");
	return *std::move(chains);
}

} // namespace

void writeLines(
	MeshModel& layer, const LineNetwork& lines, const PreparedCloud& frame, int sourceLayer)
{
	layer.updateDataMask(MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR);
	CMeshO& mesh = layer.cm;
	Allocator::AddVertices(mesh, lines.vertices.cols());
	auto id                   = Allocator::GetPerVertexAttribute<Scalarm>(mesh, "line_id");
	auto family               = Allocator::GetPerVertexAttribute<Scalarm>(mesh, "line_family");
	auto closed               = Allocator::GetPerVertexAttribute<Scalarm>(mesh, "line_closed");
	auto length               = Allocator::GetPerVertexAttribute<Scalarm>(mesh, "line_arc_length");
	const Eigen::VectorXd arc = arcLengths(lines);
	for (Index l = 0; l < lines.lines(); ++l) {
		for (Index v = lines.offsets[l]; v < lines.offsets[l + 1]; ++v) {
			CVertexO& vertex = mesh.vert[v];
			vertex.P()       = toPoint(frame.toModel(lines.vertices.col(v)));
			vertex.N()       = toPoint(lines.normals.col(v));
			vertex.Q()       = toScalar(lines.curvature[v] / frame.diagonal);
			vertex.C()       = familyColor(lines.family[l]);
			id[v]            = Scalarm(l);
			family[v]        = Scalarm(lines.family[l]);
			closed[v]        = Scalarm(lines.closed[l]);
			length[v]        = toScalar(arc[v] * frame.diagonal);
		}
	}
	writeEdges(mesh, lines.offsets, lines.closed);
	Allocator::GetPerMeshAttribute<int>(mesh, sourceAttribute)() = sourceLayer;
	vcg::tri::UpdateBounding<CMeshO>::Box(mesh);
}

void writeCreases(MeshModel& layer, const Creases& creases, const PreparedCloud& frame)
{
	layer.updateDataMask(MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR);
	std::vector<Index> offsets = {0};
	std::vector<char>  closed;
	for (const CreaseCurve& curve : creases.curves) {
		offsets.push_back(offsets.back() + curve.size());
		closed.push_back(curve.closed);
	}
	CMeshO& mesh = layer.cm;
	Allocator::AddVertices(mesh, offsets.back());
	auto id = Allocator::GetPerVertexAttribute<Scalarm>(mesh, "line_id");
	for (std::size_t l = 0; l < closed.size(); ++l) {
		const CreaseCurve& curve = creases.curves[l];
		for (Index k = 0; k < curve.size(); ++k) {
			const Index v      = offsets[l] + k;
			CVertexO&   vertex = mesh.vert[v];
			vertex.P()         = toPoint(frame.toModel(curve.positions.col(k)));
			vertex.N()         = toPoint(curve.normal(k));
			vertex.Q()         = toScalar(curve.angle[k] * 180.0 / EIGEN_PI);
			vertex.C()         = familyColor(curve.angle[k] > 0.0 ? 1 : 2);
			id[v]              = Scalarm(l);
		}
	}
	writeEdges(mesh, offsets, closed);
	vcg::tri::UpdateBounding<CMeshO>::Box(mesh);
}

LineNetwork readLines(const MeshModel& layer, const PreparedCloud& frame)
{
	const CMeshO& mesh   = layer.cm;
	const auto    id     = Allocator::FindPerVertexAttribute<Scalarm>(mesh, "line_id");
	const auto    family = Allocator::FindPerVertexAttribute<Scalarm>(mesh, "line_family");
	if (mesh.en == 0 || !Allocator::IsValidHandle(mesh, id) ||
	    !Allocator::IsValidHandle(mesh, family))
		throw MLException(
			"the current layer '" + layer.label() +
			"' holds no lines of curvature (edges with the vertex attributes line_id and "
			"line_family, which files do not keep). Run 'Trace Lines of Curvature' "
			"(generate_curvature_lines) on the point cloud first and leave its layer current.");

	const LineChains chains = chainsOf(mesh); // in the order they were traced: by confidence
	LineNetwork      lines;
	lines.vertices.resize(3, mesh.vn);
	lines.normals.resize(3, mesh.vn);
	lines.curvature.resize(mesh.vn);
	Index written = 0;
	for (Index l = 0; l < chains.size(); ++l) {
		const int lineFamily = int(std::lround(double(family[chains.vertices[l][0]])));
		if (lineFamily != 1 && lineFamily != 2)
			throw MLException("the attribute line_family of the current layer must be 1 or 2.");
		for (const Index v : chains.vertices[l]) {
			const CVertexO& vertex      = mesh.vert[v];
			lines.vertices.col(written) = frame.toUnit(toEigen(vertex.cP()));
			lines.normals.col(written)  = toEigen(vertex.cN()).stableNormalized();
			lines.curvature[written++]  = double(vertex.cQ()) * frame.diagonal;
		}
		lines.offsets.push_back(written);
		lines.family.push_back(lineFamily);
		lines.closed.push_back(chains.closed[l]);
	}
	lines.vertices.conservativeResize(3, written);
	lines.normals.conservativeResize(3, written);
	lines.curvature.conservativeResize(written);
	// Comparisons with NaN are false: a normal is good only if it is known to be long enough.
	if (!lines.vertices.allFinite() || !lines.normals.allFinite() || !lines.curvature.allFinite() ||
	    !(lines.normals.colwise().norm().array() >= 0.5).all())
		throw MLException(
			"the current layer has vertices without a finite position, normal or quality; trace "
			"the lines again.");
	return lines;
}

int sourceLayerOf(const MeshModel& layer)
{
	const auto source = Allocator::FindPerMeshAttribute<int>(layer.cm, sourceAttribute);
	return Allocator::IsValidHandle(layer.cm, source) ? source() : -1;
}

} // namespace curvature_lines
