// Meshes from scaffolds and exact curvature: quads, topology, few irregular vertices, and nothing that depends on numbers.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "field_meshing.h"

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "closed_surfaces.h"
#include "constant_crosses.h"
#include "curvature_field.h"
#include "mesh_distance.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygon_meshes.h"
#include "rims.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

MeshedField meshOf(const test::CrossedSurface& surface, double target, bool closed = true)
{
	FieldMeshingOptions options;
	options.density.targetVertices = target;
	options.closed                 = closed;
	return meshOfField(
		surface.scaffold, findRims(surface.scaffold.mesh), surface.curvature, options);
}

void expectQuads(const PolygonMesh& mesh, int euler, int rims)
{
	const MeshTopology topology = topologyOf(mesh);
	EXPECT_EQ(topology.quads, topology.faces);
	EXPECT_EQ(topology.eulerCharacteristic, euler);
	EXPECT_EQ(topology.components, 1);
	EXPECT_EQ(topology.boundaryLoops, rims);
	EXPECT_EQ(topology.nonmanifoldEdges, 0);
	EXPECT_EQ(topology.nonmanifoldVertices, 0);
}

TEST(FieldMeshing, ATorusHasNoIrregularVertex)
{
	for (const double target : {250.0, 600.0}) {
		const MeshedField  result = meshOf(test::crossed(test::triangulatedTorus(64, 28)), target);
		const PolygonMesh& mesh   = result.arrangement.mesh;
		expectQuads(mesh, 0, 0);
		EXPECT_EQ(test::irregularVertices(mesh), 0);
		EXPECT_EQ(test::foldedCorners("torus", mesh), 0);
		EXPECT_EQ(result.lineEnds + result.otherFaces + result.turnedOver, 0);
		EXPECT_NEAR(mesh.vertexCount(), target, 0.06 * target);
	}
}

TEST(FieldMeshing, SpheresAndEllipsoidsHaveEight)
{
	for (const char* name : {"sphere", "ellipsoid"}) {
		const test::CrossedSurface surface = test::crossed(
			name == std::string("sphere") ? test::triangulatedSphere(4)
										  : test::triangulatedEllipsoid(4));
		const MeshedField  result = meshOf(surface, 500);
		const PolygonMesh& mesh   = result.arrangement.mesh;
		expectQuads(mesh, 2, 0);
		EXPECT_EQ(result.singularTriangles, 8) << name;
		EXPECT_EQ(result.lineEnds, 0);
		EXPECT_EQ(result.curves.ends, 0);
		EXPECT_LE(test::irregularVertices(mesh), 8) << name;
		EXPECT_EQ(test::foldedCorners(name, mesh), 0) << name;
		EXPECT_NEAR(mesh.vertexCount(), 500, 40) << name;
	}
}

TEST(FieldMeshing, OpenSurfacesKeepTheirRims)
{
	const MeshedField cylinder = meshOf(test::crossed(test::triangulatedCylinder(48, 32)), 400);
	expectQuads(cylinder.arrangement.mesh, 0, 2);
	EXPECT_EQ(test::irregularVertices(cylinder.arrangement.mesh), 0);
	EXPECT_EQ(test::foldedCorners("cylinder", cylinder.arrangement.mesh), 0);
	const MeshedField plane = meshOf(test::crossed(test::triangulatedPlane(24, 0.2)), 150);
	expectQuads(plane.arrangement.mesh, 1, 1);
	EXPECT_EQ(test::irregularVertices(plane.arrangement.mesh), 0);
	EXPECT_EQ(test::foldedCorners("plane", plane.arrangement.mesh), 0);
}

// Without closing lines end where the density falls, and faces there are no quads; the topology is the same.
TEST(FieldMeshing, OpenFieldsAreAsBefore)
{
	const test::CrossedSurface ellipsoid = test::crossed(test::triangulatedEllipsoid(4));
	const MeshedField          result    = meshOf(ellipsoid, 500, false);
	const MeshTopology         topology  = topologyOf(result.arrangement.mesh);
	EXPECT_EQ(topology.eulerCharacteristic, 2);
	EXPECT_EQ(topology.nonmanifoldEdges + topology.nonmanifoldVertices, 0);
	EXPECT_EQ(
		result.turnedOver + result.otherFaces + result.far.vertices + result.droppedCreaseEdges, 0);
	EXPECT_GT(result.lineEnds, 0);
	EXPECT_LT(topology.quads, topology.faces);
	EXPECT_EQ(result.surface.scaffold.mesh.vertexCount(), ellipsoid.scaffold.mesh.vertexCount());
}

// Directions of some vertices are wrong; their errors do not say so.
TEST(FieldMeshing, NoiseInTheDirectionsMakesFewIrregularVertices)
{
	samples::Random      random(5, 0);
	test::CrossedSurface torus = test::crossed(test::triangulatedTorus(64, 28));
	for (Index v = 0; v < torus.surface.size(); ++v) {
		const double   a  = 0.35 * random.normal();
		const Vector3d d1 = torus.curvature.d1.col(v), d2 = torus.curvature.d2.col(v);
		torus.curvature.d1.col(v) = std::cos(a) * d1 + std::sin(a) * d2;
		torus.curvature.d2.col(v) = std::cos(a) * d2 - std::sin(a) * d1;
		torus.curvature.error[v]  = 0.3;
	}
	const MeshedField result = meshOf(torus, 500);
	expectQuads(result.arrangement.mesh, 0, 0);
	EXPECT_EQ(test::irregularVertices(result.arrangement.mesh), 0);
	EXPECT_EQ(test::foldedCorners("torus", result.arrangement.mesh), 0);
}

TEST(FieldMeshing, CreasesOfACubeAreEdgesOfTheMesh)
{
	const test::CreasedCube cube(14);
	const Index             n = cube.scaffold.mesh.vertexCount();
	CurvatureField          flat;
	flat.k1.setZero(n);
	flat.k2.setZero(n);
	flat.d1 = cube.guide.directions;
	flat.d2.resize(3, n);
	for (Index v = 0; v < n; ++v)
		flat.d2.col(v) = Vector3d(cube.guide.normals.col(v)).cross(Vector3d(flat.d1.col(v)));
	flat.error.setZero(n);
	flat.status.assign(n, PointStatus::Ok);
	FieldMeshingOptions options;
	options.density.targetVertices = 300;
	const MeshedField  result      = meshOfField(cube.scaffold, {}, flat, options);
	const PolygonMesh& mesh        = result.arrangement.mesh;
	expectQuads(mesh, 2, 0);
	EXPECT_EQ(result.droppedCreaseEdges, 0);
	EXPECT_EQ(result.turnedOver, 0);
	EXPECT_EQ(test::irregularVertices(mesh), 8); // its corners
	EXPECT_LT(distanceToMesh(mesh, cube.scaffold.mesh.vertices).distance.maxCoeff(), 1e-6);
}

TEST(FieldMeshing, MovesAndGrowsWithTheSurface)
{
	const test::TriangulatedSurface surface = test::triangulatedTorus(48, 20);
	const test::TriangulatedSurface moved   = test::RigidMotion().of(surface, 3.0);
	const MeshedField               a       = meshOf(test::crossed(surface), 300),
					  b                     = meshOf(test::crossed(moved), 300);
	expectQuads(b.arrangement.mesh, 0, 0);
	EXPECT_EQ(a.arrangement.mesh.vertexCount(), b.arrangement.mesh.vertexCount());
	EXPECT_EQ(a.arrangement.mesh.faceCount(), b.arrangement.mesh.faceCount());
	EXPECT_EQ(
		test::irregularVertices(b.arrangement.mesh), test::irregularVertices(a.arrangement.mesh));
}

TEST(FieldMeshing, IsTheSameAgain)
{
	const test::CrossedSurface ellipsoid = test::crossed(test::triangulatedEllipsoid(3));
	const MeshedField          a = meshOf(ellipsoid, 300), b = meshOf(ellipsoid, 300);
	EXPECT_EQ(a.arrangement.mesh.vertices, b.arrangement.mesh.vertices);
	EXPECT_EQ(a.arrangement.mesh.faces.indices, b.arrangement.mesh.faces.indices);
}

} // namespace
} // namespace curvature_lines
