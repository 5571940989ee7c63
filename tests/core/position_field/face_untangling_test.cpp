// Meshes with vertices pulled over their neighbours: untangled on the surface, all the rest as it was.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "face_untangling.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "exact_field.h"
#include "mesh_quality.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygon_meshes.h"

namespace curvature_lines::test {
namespace {

using Eigen::Vector3d;

constexpr Index around = 40, tube = 20;

ExactCloud torusCloud()
{
	samples::SampleRequest request;
	request.surface = "torus";
	request.points  = 5000;
	request.seed    = 2;
	return exactCloud(request);
}

PolygonMesh torusMesh()
{
	return torusOfQuads(around, tube);
}

Index unsoundFaces(const PolygonMesh& mesh)
{
	Index count = 0;
	for (Index f = 0; f < mesh.faceCount(); ++f)
		count += scaledJacobian(mesh, f) < 0.1;
	return count;
}

// Each on the place of the vertex after the next one around, so that faces turn over.
PolygonMesh tangled(const std::vector<Index>& which)
{
	PolygonMesh mesh = torusMesh();
	for (const Index v : which) {
		const Index other    = v - v % around + (v + 1) % around;
		mesh.vertices.col(v) = mesh.vertices.col(other) +
		                       0.4 * (mesh.vertices.col(other) - torusMesh().vertices.col(v));
	}
	return mesh;
}

TEST(FaceUntangling, TurnsFacesBackOnTheSurface)
{
	const ExactCloud                exact   = torusCloud();
	const std::vector<Index>        which   = {45, 210, 333, 555, 700};
	const PolygonMesh               before  = tangled(which);
	const samples::AnalyticSurface& surface = samples::surface("torus");
	PolygonMesh                     mesh    = before;
	ASSERT_GE(unsoundFaces(mesh), 10);
	EXPECT_EQ(
		untangleFaces(exact.cloud, exact.field, std::vector<char>(mesh.vertexCount(), 0), mesh), 0);
	EXPECT_EQ(unsoundFaces(mesh), 0);
	EXPECT_EQ(foldedFaces(mesh), 0);
	EXPECT_EQ(mesh.faces.indices, before.faces.indices);
	Index moved = 0;
	for (Index v = 0; v < mesh.vertexCount(); ++v) {
		moved += mesh.vertices.col(v) != before.vertices.col(v);
		EXPECT_NEAR(mesh.normals.col(v).norm(), 1.0, 1e-9);
		EXPECT_LT((mesh.vertices.col(v) - surface.project(mesh.vertices.col(v))).norm(), 0.01);
	}
	EXPECT_GE(moved, 5);
	EXPECT_LE(moved, 8 * 5); // corners of unsound faces at most
}

// Vertices that change places at random can hardly be mended. None goes farther than an edge all the same.
TEST(FaceUntangling, NoVertexGoesFarWhereNothingHelps)
{
	const ExactCloud                exact   = torusCloud();
	const samples::AnalyticSurface& surface = samples::surface("torus");
	const PolygonMesh               sound   = torusMesh();
	PolygonMesh                     mesh    = sound;
	samples::Random                 random(7, 0);
	for (Index v = 300; v < 420; ++v) {
		const Index other    = 300 + static_cast<Index>(random.index(120));
		mesh.vertices.col(v) = sound.vertices.col(other);
		mesh.normals.col(v) =
			random.index(2) == 0 ? sound.normals.col(other) : Vector3d(-sound.normals.col(other));
	}
	const PolygonMesh before = mesh;
	EXPECT_GT(
		untangleFaces(exact.cloud, exact.field, std::vector<char>(mesh.vertexCount(), 0), mesh),
		20);
	std::vector<double> edge(mesh.vertexCount(), 0.0); // mean at first; every vertex has four faces
	for (Index f = 0; f < before.faceCount(); ++f)
		for (Index k = 0; k < 4; ++k) {
			const Index a = before.faces[f][k], b = before.faces[f][(k + 1) % 4];
			edge[a] += (before.vertices.col(a) - before.vertices.col(b)).norm() / 4.0;
		}
	Index moved = 0;
	for (Index v = 0; v < mesh.vertexCount(); ++v) {
		const double step = (mesh.vertices.col(v) - before.vertices.col(v)).norm();
		moved += step > 0.0;
		EXPECT_LT((mesh.vertices.col(v) - surface.project(mesh.vertices.col(v))).norm(), 0.02);
		EXPECT_LE(step, edge[v]);
	}
	EXPECT_GT(moved, 20);
}

TEST(FaceUntangling, SoundMeshesAndFixedVerticesStay)
{
	const ExactCloud  exact = torusCloud();
	const PolygonMesh sound = torusMesh();
	PolygonMesh       mesh  = sound;
	std::vector<char> fixed(mesh.vertexCount(), 0);
	EXPECT_EQ(untangleFaces(exact.cloud, exact.field, fixed, mesh), 0);
	EXPECT_EQ(mesh.vertices, sound.vertices);
	EXPECT_EQ(mesh.normals, sound.normals);

	const PolygonMesh before = tangled({210, 555});
	mesh                     = before;
	fixed.assign(mesh.vertexCount(), 1);
	EXPECT_EQ(untangleFaces(exact.cloud, exact.field, fixed, mesh), unsoundFaces(before));
	EXPECT_EQ(mesh.vertices, before.vertices);
	// One of the two may move, or its neighbours.
	fixed.assign(mesh.vertexCount(), 0);
	fixed[210] = 1;
	untangleFaces(exact.cloud, exact.field, fixed, mesh);
	EXPECT_EQ(mesh.vertices.col(210), before.vertices.col(210));
	EXPECT_NE(mesh.vertices.col(555), before.vertices.col(555));
}

// It never makes a face unsound that was not, and counts what it leaves.
TEST(FaceUntangling, MakesNothingWorse)
{
	const ExactCloud exact = torusCloud();
	for (const int seed : {1, 2, 3}) {
		samples::Random random(seed, 0);
		PolygonMesh     mesh = torusMesh();
		for (Index v = 0; v < mesh.vertexCount(); ++v)
			if (random.uniform() < 0.2) {
				const Vector3d step = random.normal3();
				mesh.vertices.col(v) +=
					0.15 * (step - step.dot(mesh.normals.col(v)) * mesh.normals.col(v));
			}
		const Index before = unsoundFaces(mesh);
		const Index left =
			untangleFaces(exact.cloud, exact.field, std::vector<char>(mesh.vertexCount(), 0), mesh);
		EXPECT_GT(before, 50);
		EXPECT_EQ(left, unsoundFaces(mesh));
		EXPECT_LT(left, before / 10);
		EXPECT_TRUE(mesh.vertices.allFinite());
	}
}

// Between vertices that may not move, the mean of the neighbours can be a worse place.
TEST(FaceUntangling, VerticesMoveToBetterPlacesOnly)
{
	const ExactCloud exact = torusCloud();
	const auto       worst = [](const PolygonMesh& mesh) {
        double least = 1.0;
        for (Index f = 0; f < mesh.faceCount(); ++f)
            least = std::min(least, scaledJacobian(mesh, f));
        return least;
	};
	Index moved = 0;
	for (int seed = 1; seed <= 20; ++seed) {
		samples::Random random(seed, 1);
		PolygonMesh     mesh = torusMesh();
		// One vertex is free, all around it are anywhere.
		std::vector<char> fixed(mesh.vertexCount(), 1);
		const Index       v = 205;
		fixed[v]            = 0;
		for (const Index w : {164, 165, 166, 204, 206, 244, 245, 246}) {
			const Vector3d step = random.normal3();
			mesh.vertices.col(w) +=
				0.08 * (step - step.dot(mesh.normals.col(w)) * mesh.normals.col(w));
		}
		const PolygonMesh before = mesh;
		untangleFaces(exact.cloud, exact.field, fixed, mesh);
		if (mesh.vertices == before.vertices)
			continue;
		++moved;
		double least = 1.0, was = 1.0;
		for (Index f = 0; f < mesh.faceCount(); ++f)
			for (const Index w : mesh.faces[f])
				if (w == v) {
					least = std::min(least, scaledJacobian(mesh, f));
					was   = std::min(was, scaledJacobian(before, f));
				}
		EXPECT_GT(least, was) << seed;
		EXPECT_GE(worst(mesh), worst(before)) << seed;
	}
	EXPECT_GE(moved, 3);
}

TEST(FaceUntangling, NothingStaysNothing)
{
	const ExactCloud exact = torusCloud();
	PolygonMesh      none;
	EXPECT_EQ(untangleFaces(exact.cloud, exact.field, {}, none), 0);
	EXPECT_EQ(none.vertexCount(), 0);
}

} // namespace
} // namespace curvature_lines::test
