// Meshes whose faces are joined badly: mended on the surface, with what must stay as it was.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "quad_repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "exact_field.h"
#include "mesh_distance.h"
#include "mesh_quality.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygon_meshes.h"
#include "quad_edits.h"

namespace curvature_lines::test {
namespace {

ExactCloud cloudOf(const char* surface)
{
	samples::SampleRequest request;
	request.surface = surface;
	request.points  = 5000;
	request.seed    = 2;
	return exactCloud(request);
}

// The six sides of a cube, so many quads wide each, blown up to a ball.
PolygonMesh cubeOnSphere(Index wide)
{
	std::vector<Eigen::Vector3d>          vertices, normals;
	std::vector<VertexLoop>               loops;
	std::map<std::array<Index, 3>, Index> named;
	const auto                            at = [&](std::array<Index, 3> place) {
        const auto [entry, isNew] = named.emplace(place, static_cast<Index>(vertices.size()));
        if (isNew) {
            Eigen::Vector3d p;
            for (int c = 0; c < 3; ++c)
                p[c] = std::tan(0.25 * EIGEN_PI * (2.0 * double(place[c]) / double(wide) - 1.0));
            vertices.push_back(p.normalized());
            normals.push_back(p.normalized());
        }
        return entry->second;
	};
	for (std::size_t axis = 0; axis < 3; ++axis)
		for (const bool upper : {false, true})
			for (Index i = 0; i < wide; ++i)
				for (Index j = 0; j < wide; ++j) {
					VertexLoop loop;
					for (const auto& [di, dj] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
						std::array<Index, 3> place{};
						place[axis]           = upper ? wide : 0;
						place[(axis + 1) % 3] = i + di;
						place[(axis + 2) % 3] = j + dj;
						loop.push_back(at(place));
					}
					if (!upper)
						std::reverse(loop.begin(), loop.end());
					loops.push_back(loop);
				}
	return polygonMesh(vertices, normals, loops);
}

// Edits at random, as a field that is wrong in places makes them: edges turned, corners merged.
void spoil(int count, std::uint64_t seed, const char* surface, PolygonMesh& mesh)
{
	samples::Random   random(seed, 0);
	std::vector<char> none(mesh.vertexCount(), 0);
	QuadEdits         edits(none, mesh);
	const auto        pick = [&](std::size_t n) {
        return std::min(n - 1, static_cast<std::size_t>(random.uniform(0.0, double(n))));
	};
	for (int done = 0; done < count;) {
		const auto                         face = static_cast<Index>(pick(edits.loops().size()));
		const std::vector<QuadEdits::Edit> some =
			done % 2 == 0 ? edits.turnsOf(face) : edits.mergesOf(face);
		if (some.empty())
			continue;
		QuadEdits::Undo undo;
		if (edits.apply(some[pick(some.size())], undo))
			++done;
		else
			edits.restore(undo);
	}
	replaceFaces(edits.loops(), none, mesh);
	for (Index v = 0; v < mesh.vertexCount(); ++v)
		mesh.vertices.col(v) = samples::surface(surface).project(mesh.vertices.col(v));
}

TEST(QuadRepair, FacesJoinedBadlyAreMendedOnTheSurface)
{
	for (const char* name : {"torus", "sphere"}) {
		SCOPED_TRACE(name);
		const bool                      torus   = std::string(name) == "torus";
		const ExactCloud                exact   = cloudOf(name);
		const samples::AnalyticSurface& surface = samples::surface(name);
		PolygonMesh                     mesh    = torus ? torusOfQuads(40, 20) : cubeOnSphere(10);
		const Index                     sound   = unsoundOf(mesh);
		spoil(torus ? 60 : 100, 3, name, mesh);
		const PolygonMesh before = mesh;
		ASSERT_EQ(sound, 0);
		ASSERT_GT(unsoundOf(before), 15);
		std::vector<char> onFeature(mesh.vertexCount(), 0);
		repairQuads(exact.cloud, exact.field, onFeature, mesh);
		const MeshTopology topology = topologyOf(mesh);
		EXPECT_LE(unsoundOf(mesh), 1);
		EXPECT_EQ(topology.eulerCharacteristic, torus ? 0 : 2);
		EXPECT_EQ(topology.quads, topology.faces);
		EXPECT_EQ(
			topology.nonmanifoldEdges + topology.nonmanifoldVertices + topology.boundaryEdges, 0);
		EXPECT_EQ(static_cast<Index>(onFeature.size()), mesh.vertexCount());
		EXPECT_EQ(foldedFaces(mesh), 0);
		for (Index v = 0; v < mesh.vertexCount(); ++v)
			EXPECT_LT((mesh.vertices.col(v) - surface.project(mesh.vertices.col(v))).norm(), 2e-3);
		// Nothing is cut off: every vertex of before lies under a face.
		EXPECT_LT(distanceToMesh(mesh, before.vertices).distance.maxCoeff(), 0.1);
	}
}

TEST(QuadRepair, SoundMeshesAndFeaturesStay)
{
	const ExactCloud  exact  = cloudOf("sphere");
	PolygonMesh       mesh   = cubeOnSphere(10);
	const PolygonMesh before = mesh;
	std::vector<char> onFeature(mesh.vertexCount(), 0);
	EXPECT_EQ(repairQuads(exact.cloud, exact.field, onFeature, mesh), 0);
	EXPECT_EQ(mesh.vertices, before.vertices);
	EXPECT_EQ(mesh.faces.indices, before.faces.indices);

	spoil(60, 5, "sphere", mesh);
	onFeature.assign(mesh.vertexCount(), 0);
	for (std::size_t v = 0; v < onFeature.size(); v += 3)
		onFeature[v] = 1;
	const PolygonMesh spoilt = mesh;
	const auto        marks  = onFeature;
	repairQuads(exact.cloud, exact.field, onFeature, mesh);
	std::size_t at = 0;
	for (std::size_t v = 0; v < marks.size(); ++v) {
		if (!marks[v])
			continue;
		while (at < onFeature.size() && !onFeature[at])
			++at;
		ASSERT_LT(at, onFeature.size());
		EXPECT_EQ(mesh.vertices.col(at), spoilt.vertices.col(v));
		++at;
	}
	EXPECT_LT(unsoundOf(mesh), unsoundOf(spoilt));
	EXPECT_EQ(topologyOf(mesh).eulerCharacteristic, 2);
}

} // namespace
} // namespace curvature_lines::test
