// Edits tried on copies of a patch of the mesh.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "quad_repair.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "cloud_index.h"
#include "curvature_field.h"
#include "face_untangling.h"
#include "mesh_distance.h"
#include "mesh_quality.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "progress.h"
#include "quad_edits.h"
#include "surface_projection.h"

namespace curvature_lines {

namespace {

constexpr int rounds = 10;
// Rings of faces around a bad one that may change; the vertices around them stay.
constexpr int rings = 2;
// Of the edits of a patch, those that look best before vertices move are tried.
constexpr std::size_t mostTried = 12;
// Scaled Jacobian that faces should have, and what an edit must better the sum of what they lack by.
constexpr double wanted = 0.2, leastGain = 0.05;
// In units of that lack: of a face that is not convex, of an edge at which the mesh turns back, and of one that a vertex has
// too many or too few.
constexpr double unsoundCost = 1.0, foldCost = 1.0, irregularCost = 0.02;
// Cosine between the normals of two faces at an edge: beyond, the mesh turns back there.
constexpr double fold = -0.866;
// In mean edges: what was a vertex is no farther from the faces than that. At a tip more would cut it off.
constexpr double farthestLoss = 0.25;
// In mean edges: projections go no farther.
constexpr double farthestProjection = 0.3;

Eigen::Vector3d normalOf(const PolygonMesh& mesh, NeighborLists::Row face)
{
	Eigen::Vector3d sum = Eigen::Vector3d::Zero();
	for (Index k = 1; k + 1 < face.size(); ++k)
		sum += (mesh.vertices.col(face[k]) - mesh.vertices.col(face[0]))
		           .cross(mesh.vertices.col(face[k + 1]) - mesh.vertices.col(face[0]));
	return sum.normalized();
}

// Pairs of faces at edges at which the mesh turns back, but for features: those are as sharp as the surface is.
std::vector<std::pair<Index, Index>>
foldsOf(const PolygonMesh& mesh, const std::vector<char>& onFeature)
{
	struct Side {
		Index from, to, face;
	};
	std::vector<Side>                    sides;
	std::vector<std::pair<Index, Index>> folds;
	for (Index f = 0; f < mesh.faceCount(); ++f) {
		const NeighborLists::Row face = mesh.faces[f];
		for (Index k = 0; k < face.size(); ++k) {
			const Index a = face[k], b = face[(k + 1) % face.size()];
			if (!onFeature[a] || !onFeature[b])
				sides.push_back({std::min(a, b), std::max(a, b), f});
		}
	}
	std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
		return std::tie(a.from, a.to, a.face) < std::tie(b.from, b.to, b.face);
	});
	for (std::size_t i = 1; i < sides.size(); ++i) {
		const Side &a = sides[i - 1], &b = sides[i];
		if (a.from == b.from && a.to == b.to &&
		    normalOf(mesh, mesh.faces[a.face]).dot(normalOf(mesh, mesh.faces[b.face])) < fold)
			folds.emplace_back(a.face, b.face);
	}
	return folds;
}

struct Patch {
	PolygonMesh        mesh;         // vertices: those of the faces, in the order of `vertex`
	std::vector<Index> vertex, face; // in the whole
	std::vector<char>  onFeature;
	std::vector<char>  fixed;       // features and the outer ring
	Index              center = -1; // the bad face
	std::vector<Index> edges;       // of every vertex within the patch, before
};

class Repair {
public:
	Repair(
		const CloudIndex&        index,
		const CurvatureField&    curvature,
		const std::vector<char>& onFeature,
		PolygonMesh&             mesh) :
			m_index(index), m_curvature(curvature), m_onFeature(onFeature), m_mesh(mesh),
			m_loops(faceLoopsOf(mesh)), m_faces(mesh.vertexCount())
	{
		for (std::size_t f = 0; f < m_loops.size(); ++f)
			for (const Index v : m_loops[f])
				m_faces[v].push_back(static_cast<Index>(f));
	}

	void run(const Progress& progress)
	{
		std::vector<char> hopeless(m_loops.size(), 0);
		for (int round = 0; round < rounds; ++round) {
			progress.report(double(round) / rounds);
			bool              mended = false;
			std::vector<char> changed(
				m_loops.size(), 0); // in this round; they are looked at again in the next
			for (const Index f : badFaces()) {
				if (hopeless[f] || changed[f])
					continue;
				const Patch patch = patchAround(f);
				if (!mend(patch)) {
					hopeless[f] = 1;
					continue;
				}
				mended = true;
				for (const Index face : patch.face) {
					changed[face]  = 1;
					hopeless[face] = 0;
				}
			}
			if (!mended)
				break;
		}
	}

	const std::vector<std::vector<Index>>& loops() const { return m_loops; }

private:
	double jacobianOf(Index f) const
	{
		const std::vector<Index>& loop = m_loops[f];
		return scaledJacobian(
			m_mesh.vertices, m_mesh.normals, {loop.data(), loop.data() + loop.size()});
	}

	// What lacks most first. Folded faces lack as much as those that are not convex.
	std::vector<Index> badFaces() const
	{
		PolygonMesh now;
		now.vertices = m_mesh.vertices;
		now.faces    = NeighborLists::fromRows(m_loops);
		std::vector<double> lack(m_loops.size(), 0.0);
		for (std::size_t f = 0; f < m_loops.size(); ++f)
			if (m_loops[f].size() == 4)
				lack[f] = std::min(0.0, jacobianOf(static_cast<Index>(f)));
		for (const auto& [a, b] : foldsOf(now, m_onFeature))
			for (const Index f : {a, b})
				if (m_loops[f].size() == 4)
					lack[f] -= foldCost;
		std::vector<std::pair<double, Index>> bad;
		for (std::size_t f = 0; f < m_loops.size(); ++f)
			if (lack[f] < 0.0)
				bad.emplace_back(lack[f], static_cast<Index>(f));
		std::sort(bad.begin(), bad.end());
		std::vector<Index> faces;
		faces.reserve(bad.size());
		for (const auto& entry : bad)
			faces.push_back(entry.second);
		return faces;
	}

	Patch patchAround(Index f) const
	{
		std::vector<Index> faces = {f}, vertices;
		for (int ring = 0; ring <= rings; ++ring) {
			vertices.clear();
			for (const Index face : faces)
				vertices.insert(vertices.end(), m_loops[face].begin(), m_loops[face].end());
			std::sort(vertices.begin(), vertices.end());
			vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
			if (ring == rings)
				break;
			faces.clear();
			for (const Index v : vertices)
				faces.insert(faces.end(), m_faces[v].begin(), m_faces[v].end());
			std::sort(faces.begin(), faces.end());
			faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
		}
		Patch                           patch;
		std::vector<std::vector<Index>> loops;
		for (const Index face : faces) {
			std::vector<Index> loop = m_loops[face];
			for (Index& v : loop)
				v = static_cast<Index>(
					std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin());
			loops.push_back(std::move(loop));
		}
		patch.center =
			static_cast<Index>(std::lower_bound(faces.begin(), faces.end(), f) - faces.begin());
		patch.mesh.vertices = m_mesh.vertices(Eigen::all, vertices);
		patch.mesh.normals  = m_mesh.normals(Eigen::all, vertices);
		patch.mesh.faces    = NeighborLists::fromRows(loops);
		patch.edges         = facesOfVertices(patch.mesh);
		for (std::size_t i = 0; i < vertices.size(); ++i) {
			const Index v        = vertices[i];
			const bool  complete = patch.edges[i] == static_cast<Index>(m_faces[v].size());
			patch.onFeature.push_back(m_onFeature[v]);
			patch.fixed.push_back(m_onFeature[v] || !complete);
		}
		patch.vertex = std::move(vertices);
		patch.face   = std::move(faces);
		return patch;
	}

	static std::vector<Index> facesOfVertices(const PolygonMesh& mesh)
	{
		std::vector<Index> count(mesh.vertexCount(), 0);
		for (const Index v : mesh.faces.indices)
			++count[v];
		return count;
	}

	// What is wrong with a patch.
	static double faultsOf(const PolygonMesh& mesh, const Patch& patch)
	{
		double faults = 0.0;
		for (Index f = 0; f < mesh.faceCount(); ++f) {
			if (mesh.faces[f].size() == 0)
				continue;
			const double jacobian = scaledJacobian(mesh, f);
			faults += std::max(0.0, wanted - jacobian) + (jacobian < 0.0 ? unsoundCost : 0.0);
		}
		faults += foldCost * double(foldsOf(mesh, patch.onFeature).size());
		const std::vector<Index> count = facesOfVertices(mesh);
		for (std::size_t v = 0; v < count.size(); ++v)
			if (count[v] > 0 && !patch.fixed[v])
				faults += irregularCost * std::abs(double(count[v]) - 4.0);
		return faults;
	}

	// Edits of the bad face and of those that share a corner with it, by what is wrong after them before vertices move.
	static std::vector<PolygonMesh> editsOf(const Patch& patch)
	{
		PolygonMesh                  mesh = patch.mesh;
		QuadEdits                    edits(patch.onFeature, mesh);
		std::vector<QuadEdits::Edit> all;
		const std::vector<Index>     near = edits.facesAround(edits.loops()[patch.center]);
		for (const Index face : near) {
			for (const QuadEdits::Edit& edit : edits.mergesOf(face))
				all.push_back(edit);
			for (const QuadEdits::Edit& edit : edits.turnsOf(face))
				all.push_back(edit);
		}
		std::vector<std::pair<double, PolygonMesh>> found;
		for (const QuadEdits::Edit& edit : all) {
			QuadEdits::Undo undo;
			if (edits.apply(edit, undo)) {
				PolygonMesh changed;
				changed.vertices = mesh.vertices;
				changed.normals  = mesh.normals;
				changed.faces    = NeighborLists::fromRows(edits.loops());
				found.emplace_back(faultsOf(changed, patch), std::move(changed));
			}
			edits.restore(undo);
		}
		std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
			return a.first < b.first;
		});
		std::vector<PolygonMesh> result;
		for (std::size_t i = 0; i < std::min(found.size(), mostTried); ++i)
			result.push_back(std::move(found[i].second));
		return result;
	}

	bool mend(const Patch& patch)
	{
		const double             before = faultsOf(patch.mesh, patch);
		std::vector<PolygonMesh> tried  = editsOf(patch);
		std::vector<double>      faults(tried.size());
		parallelFor(static_cast<Index>(tried.size()), {}, [&](Index i) {
			// Faces that are gone have no corner to move.
			PolygonMesh kept = withoutEmpty(tried[i]);
			projectMoved(patch, kept);
			untangleFaces(m_index, m_curvature, patch.fixed, kept);
			tried[i].vertices = kept.vertices;
			tried[i].normals  = kept.normals;
			faults[i]         = faultsOf(kept, patch);
			if (faults[i] < before - leastGain && isLoss(patch, kept))
				faults[i] = INFINITY;
		});
		const auto best = std::min_element(faults.begin(), faults.end());
		if (best == faults.end() || *best > before - leastGain)
			return false;
		adopt(patch, tried[best - faults.begin()]);
		return true;
	}

	// What a merge has moved is between its two corners, off the surface.
	void projectMoved(const Patch& patch, PolygonMesh& mesh) const
	{
		const double edge = meanEdgeOf(patch.mesh);
		for (Index v = 0; v < mesh.vertexCount(); ++v) {
			const Eigen::Vector3d p = mesh.vertices.col(v);
			if (patch.fixed[v] || p == patch.mesh.vertices.col(v))
				continue;
			const Index         closest = closestOnSide(m_index, p, mesh.normals.col(v));
			const SurfaceSample sample =
				projectToSurface(m_index.cloud(), m_curvature, p, closest, ProjectionKind::Mixed);
			if (!((sample.position - p).norm() <= farthestProjection * edge))
				continue;
			mesh.vertices.col(v) = sample.position;
			mesh.normals.col(v)  = sample.normal;
		}
	}

	static double meanEdgeOf(const PolygonMesh& mesh)
	{
		double sum = 0.0;
		for (Index f = 0; f < mesh.faceCount(); ++f) {
			const NeighborLists::Row face = mesh.faces[f];
			for (Index k = 0; k < face.size(); ++k)
				sum += (mesh.vertices.col(face[k]) - mesh.vertices.col(face[(k + 1) % face.size()]))
				           .norm();
		}
		return sum / double(mesh.faces.indices.size());
	}

	// Whether a vertex was where there is no face any more.
	static bool isLoss(const Patch& patch, const PolygonMesh& changed)
	{
		return distanceToMesh(changed, patch.mesh.vertices).distance.maxCoeff() >
		       farthestLoss * meanEdgeOf(patch.mesh);
	}

	static PolygonMesh withoutEmpty(const PolygonMesh& mesh)
	{
		std::vector<std::vector<Index>> loops;
		for (std::vector<Index>& loop : faceLoopsOf(mesh))
			if (!loop.empty())
				loops.push_back(std::move(loop));
		PolygonMesh kept;
		kept.vertices = mesh.vertices;
		kept.normals  = mesh.normals;
		kept.faces    = NeighborLists::fromRows(loops);
		return kept;
	}

	void adopt(const Patch& patch, const PolygonMesh& changed)
	{
		for (const Index v : patch.vertex) {
			auto& faces = m_faces[v];
			faces.erase(
				std::remove_if(
					faces.begin(),
					faces.end(),
					[&](Index f) {
						return std::binary_search(patch.face.begin(), patch.face.end(), f);
					}),
				faces.end());
		}
		for (std::size_t k = 0; k < patch.face.size(); ++k) {
			const Index face = patch.face[k];
			m_loops[face].clear();
			for (const Index v : changed.faces[static_cast<Index>(k)]) {
				m_loops[face].push_back(patch.vertex[v]);
				m_faces[patch.vertex[v]].push_back(face);
			}
		}
		for (std::size_t i = 0; i < patch.vertex.size(); ++i)
			if (!patch.fixed[i]) {
				m_mesh.vertices.col(patch.vertex[i]) = changed.vertices.col(static_cast<Index>(i));
				m_mesh.normals.col(patch.vertex[i])  = changed.normals.col(static_cast<Index>(i));
			}
	}

	const CloudIndex&               m_index;
	const CurvatureField&           m_curvature;
	const std::vector<char>&        m_onFeature;
	PolygonMesh&                    m_mesh;
	std::vector<std::vector<Index>> m_loops; // of every face; empty: gone
	std::vector<std::vector<Index>> m_faces; // of every vertex
};

} // namespace

Index repairQuads(
	const CloudIndex&     index,
	const CurvatureField& curvature,
	std::vector<char>&    onFeature,
	PolygonMesh&          mesh,
	const Progress&       progress)
{
	{
		Repair repair(index, curvature, onFeature, mesh);
		repair.run(progress);
		const auto loops = repair.loops();
		replaceFaces(loops, onFeature, mesh);
	}
	return untangleFaces(index, curvature, onFeature, mesh);
}

} // namespace curvature_lines
