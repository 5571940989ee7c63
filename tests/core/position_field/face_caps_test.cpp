// Meshes that end below the tip of a cone, and others that end nowhere.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "face_caps.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "cloud_index.h"
#include "curvature_field.h"
#include "exact_field.h"
#include "mesh_distance.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double bulge = 0.35;

// Radius 1 at z = 0, the tip at z = height; its side alone, where random points lie even.
struct Cone {
	double height;

	double slant() const { return std::hypot(1.0, height); }
	double off(const Vector3d& p) const // outside is positive
	{
		return (p.head<2>().norm() - 1.0 + p.z() / height) * height / slant();
	}

	ExactCloud cloud(int points) const
	{
		samples::Random random(3, 0);
		ExactCloud      exact;
		exact.sample.positions.resize(3, points);
		exact.sample.normals.resize(3, points);
		exact.sample.d1.resize(3, points);
		exact.sample.d2.resize(3, points);
		exact.sample.k1.resize(points);
		exact.sample.k2.setZero(points);
		for (Index i = 0; i < points; ++i) {
			const double radius = std::sqrt(random.uniform(1e-6, 1.0));
			const double angle  = random.uniform(0.0, 2.0 * EIGEN_PI);
			const double x = std::cos(angle), y = std::sin(angle);
			exact.sample.positions.col(i) << radius * x, radius * y, height * (1.0 - radius);
			exact.sample.normals.col(i) = Vector3d(height * x, height * y, 1.0) / slant();
			exact.sample.d1.col(i) << -y, x, 0.0;
			exact.sample.d2.col(i) = exact.sample.normals.col(i).cross(exact.sample.d1.col(i));
			exact.sample.k1[i]     = height / (slant() * radius);
		}
		exact.cloud = {exact.sample.positions, exact.sample.normals};
		const NeighborSearch search(exact.cloud.positions);
		exact.minimum = minimumNeighborhoods(exact.cloud, search);
		exact.field   = exactField(exact.sample, exact.cloud, search, exact.minimum);
		return exact;
	}

	// Rings of so many quads up to the height `top`, then one face.
	PolygonMesh cutAt(double top, int around, int rings) const
	{
		std::vector<Vector3d>           vertices, normals;
		std::vector<std::vector<Index>> faces(1);
		for (int r = 0; r <= rings; ++r)
			for (int k = 0; k < around; ++k) {
				const double z = top * r / rings, angle = 2.0 * EIGEN_PI * k / around;
				const double radius = 1.0 - z / height;
				vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
				normals.push_back(
					Vector3d(height * std::cos(angle), height * std::sin(angle), 1.0) / slant());
			}
		for (int k = 0; k < around; ++k)
			faces[0].push_back(rings * around + k);
		for (int r = 0; r < rings; ++r)
			for (int k = 0; k < around; ++k) {
				const Index a = r * around + k, b = r * around + (k + 1) % around;
				faces.push_back({a, b, b + around, a + around});
			}
		return polygonMesh(vertices, normals, faces);
	}
};

// Of the points above a height.
double farthestAbove(double z, const Matrix3Xd& points, const PolygonMesh& mesh)
{
	const Eigen::VectorXd distance = distanceToMesh(mesh, points).distance;
	return (points.row(2).transpose().array() > z).select(distance.array(), 0.0).maxCoeff();
}

struct CutCone {
	int    around;
	double height, top;
};

TEST(FaceCaps, AMeshOfAConeGoesOnToItsTip)
{
	for (const CutCone& cut :
	     {CutCone{4, 3.0, 2.0}, CutCone{4, 6.0, 4.8}, CutCone{4, 3.0, 2.4}, CutCone{6, 3.0, 1.8}}) {
		SCOPED_TRACE(testing::Message() << cut.around << " " << cut.height << " " << cut.top);
		const Cone         cone{cut.height};
		const ExactCloud   exact  = cone.cloud(8000);
		const PolygonMesh  before = cone.cutAt(cut.top, cut.around, 6);
		const MeshTopology whole  = topologyOf(before);
		PolygonMesh        mesh   = before;
		std::vector<char>  onFeature(mesh.vertexCount(), 1);
		ASSERT_EQ(capBulgingFaces(exact.cloud, exact.field, bulge, mesh, onFeature), 1);

		const double edge = 2.0 * std::sin(EIGEN_PI / cut.around) * (1.0 - cut.top / cut.height);
		EXPECT_GT(farthestAbove(cut.top, exact.cloud.positions, before), edge);
		// The last ring leaves a tenth of a steep tip at most.
		EXPECT_LT(
			farthestAbove(cut.top, exact.cloud.positions, mesh),
			std::max(0.3 * edge, 0.1 * (cut.height - cut.top)));

		const MeshTopology capped = topologyOf(mesh);
		EXPECT_EQ(capped.eulerCharacteristic, whole.eulerCharacteristic);
		EXPECT_EQ(capped.boundaryLoops, whole.boundaryLoops);
		EXPECT_EQ(capped.components, 1);
		EXPECT_EQ(capped.nonmanifoldEdges, 0);
		EXPECT_EQ(capped.nonmanifoldVertices, 0);
		EXPECT_EQ(capped.faces - capped.quads, cut.around == 4 ? 0 : 1);

		const Index old = before.vertexCount(), added = mesh.vertexCount() - old;
		EXPECT_GT(added, 0);
		EXPECT_EQ(added % cut.around, 0);
		EXPECT_EQ(mesh.vertices.leftCols(old), before.vertices);
		EXPECT_EQ(mesh.normals.leftCols(old), before.normals);
		ASSERT_EQ(static_cast<Index>(onFeature.size()), mesh.vertexCount());
		for (Index v = 0; v < mesh.vertexCount(); ++v)
			EXPECT_EQ(onFeature[v], v < old);
		for (Index v = old; v < mesh.vertexCount(); ++v) {
			EXPECT_LT(std::abs(cone.off(mesh.vertices.col(v))), 0.02) << v;
			EXPECT_NEAR(mesh.normals.col(v).norm(), 1.0, 1e-12);
			EXPECT_GT(mesh.normals.col(v).head<2>().dot(mesh.vertices.col(v).head<2>()), 0.0);
		}
	}
}

// The way up a dome is no straight line: rings are on the sphere, not on the chords to its top.
TEST(FaceCaps, RingsLieOnTheSurface)
{
	samples::SampleRequest request;
	request.surface                       = "sphere";
	request.points                        = 4000;
	const ExactCloud                exact = exactCloud(request);
	std::vector<Vector3d>           vertices;
	std::vector<std::vector<Index>> faces(1);
	for (int k = 0; k < 12; ++k) {
		const double z = k < 6 ? 0.0 : 0.5, angle = EIGEN_PI * k / 3.0;
		const double radius = std::sqrt(1.0 - z * z);
		vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
	}
	for (Index k = 0; k < 6; ++k) {
		faces[0].push_back(6 + k);
		faces.push_back({k, (k + 1) % 6, 6 + (k + 1) % 6, 6 + k});
	}
	PolygonMesh       mesh = polygonMesh(vertices, vertices, faces);
	std::vector<char> onFeature(12, 0);
	ASSERT_EQ(capBulgingFaces(exact.cloud, exact.field, bulge, mesh, onFeature), 1);
	ASSERT_GT(mesh.vertexCount(), 12);
	for (Index v = 12; v < mesh.vertexCount(); ++v) {
		EXPECT_NEAR(mesh.vertices.col(v).norm(), 1.0, 0.005);
		EXPECT_GT(mesh.vertices.col(v).dot(mesh.normals.col(v)), 0.99);
	}
}

// Every face looks outward: away from the axis, or up at the end.
TEST(FaceCaps, RingsAreNotTwisted)
{
	const Cone        cone{3.0};
	const ExactCloud  exact = cone.cloud(8000);
	PolygonMesh       mesh  = cone.cutAt(2.0, 4, 6);
	std::vector<char> onFeature(mesh.vertexCount(), 0);
	ASSERT_EQ(capBulgingFaces(exact.cloud, exact.field, bulge, mesh, onFeature), 1);
	const FaceTriangles triangles = faceTriangles(mesh);
	for (const auto& [a, b, c] : triangles.corners) {
		const Vector3d normal = (b - a).cross(c - a).normalized();
		const Vector3d center = (a + b + c) / 3.0;
		EXPECT_GT(normal.dot(Vector3d(center.x(), center.y(), 0.2)), 0.0);
	}
}

TEST(FaceCaps, WhatDoesNotBulgeHasNone)
{
	// A plane, coarse and fine, as its points have it.
	samples::SampleRequest request;
	request.surface        = "plane";
	request.points         = 2000;
	const ExactCloud plane = exactCloud(request);
	for (const int cells : {1, 2, 10}) {
		std::vector<Vector3d>           vertices;
		std::vector<std::vector<Index>> faces;
		for (int j = 0; j <= cells; ++j)
			for (int i = 0; i <= cells; ++i)
				vertices.emplace_back(double(i) / cells - 0.5, double(j) / cells - 0.5, 0.0);
		for (int j = 0; j < cells; ++j)
			for (int i = 0; i < cells; ++i) {
				const Index a = j * (cells + 1) + i;
				faces.push_back({a, a + 1, a + cells + 2, a + cells + 1});
			}
		PolygonMesh mesh =
			polygonMesh(vertices, std::vector<Vector3d>(vertices.size(), Vector3d::UnitZ()), faces);
		std::vector<char> onFeature(mesh.vertexCount(), 0);
		EXPECT_EQ(capBulgingFaces(plane.cloud, plane.field, bulge, mesh, onFeature), 0);
		EXPECT_EQ(mesh.faceCount(), Index(cells * cells));
	}
	// A cone whose last face is at its tip.
	const Cone        cone{3.0};
	const ExactCloud  exact = cone.cloud(4000);
	PolygonMesh       mesh  = cone.cutAt(2.97, 6, 12);
	std::vector<char> onFeature(mesh.vertexCount(), 0);
	EXPECT_EQ(capBulgingFaces(exact.cloud, exact.field, bulge, mesh, onFeature), 0);
}

// A cap stands for the end of a limb: faces of many sides are something else.
TEST(FaceCaps, LargeFacesAreLeftAlone)
{
	const Cone        cone{3.0};
	const ExactCloud  exact = cone.cloud(6000);
	PolygonMesh       eight = cone.cutAt(2.0, 8, 6);
	std::vector<char> onFeature(eight.vertexCount(), 0);
	EXPECT_EQ(capBulgingFaces(exact.cloud, exact.field, bulge, eight, onFeature), 0);
}

// A floor of quads, and a ceiling that looks down to it or a cellar: other sheets, however near. A plateau is not.
TEST(FaceCaps, PointsOfAnotherSheetAreLeftAlone)
{
	samples::SampleRequest request;
	request.surface             = "plane";
	request.points              = 2000;
	samples::SampleCloud sample = samples::generate(request);
	const double         edge   = 0.2;
	for (const double height : {0.16, -0.16})
		for (const double side : {1.0, -1.0}) {
			SCOPED_TRACE(testing::Message() << height << " " << side);
			for (Index i = 0; i < 2000; ++i) {
				const Vector3d p       = sample.positions.col(i);
				const bool     other   = std::max(std::abs(p.x()), std::abs(p.y())) < 0.4 * edge;
				sample.positions(2, i) = other ? height : 0.0;
				sample.normals.col(i)  = (other ? side : 1.0) * Vector3d::UnitZ();
				sample.d2.col(i)       = sample.normals.col(i).cross(sample.d1.col(i));
			}
			const ExactCloud                exact = exactCloud(sample);
			std::vector<Vector3d>           vertices;
			std::vector<std::vector<Index>> faces;
			for (int j = 0; j <= 5; ++j)
				for (int i = 0; i <= 5; ++i)
					vertices.emplace_back(edge * i - 0.5, edge * j - 0.5, 0.0);
			for (Index j = 0; j < 5; ++j)
				for (Index i = 0; i < 5; ++i)
					faces.push_back({6 * j + i, 6 * j + i + 1, 6 * j + i + 7, 6 * j + i + 6});
			PolygonMesh mesh = polygonMesh(
				vertices, std::vector<Vector3d>(vertices.size(), Vector3d::UnitZ()), faces);
			std::vector<char> onFeature(mesh.vertexCount(), 0);
			EXPECT_EQ(
				capBulgingFaces(exact.cloud, exact.field, bulge, mesh, onFeature),
				height > 0.0 && side > 0.0 ? 1 : 0);
		}
}

TEST(FaceCaps, GrowWithTheSurface)
{
	const Cone       cone{3.0};
	const ExactCloud exact = cone.cloud(5000);
	ExactCloud       large = exact;
	large.cloud.positions *= 64.0;
	large.sample.k1 /= 64.0;
	const NeighborSearch search(large.cloud.positions);
	large.minimum = minimumNeighborhoods(large.cloud, search);
	large.field   = exactField(large.sample, large.cloud, search, large.minimum);
	PolygonMesh a = cone.cutAt(2.0, 4, 6), b = a;
	b.vertices *= 64.0;
	std::vector<char> onA(a.vertexCount(), 0), onB = onA;
	EXPECT_EQ(capBulgingFaces(exact.cloud, exact.field, bulge, a, onA), 1);
	EXPECT_EQ(capBulgingFaces(large.cloud, large.field, bulge, b, onB), 1);
	ASSERT_EQ(a.vertexCount(), b.vertexCount());
	EXPECT_EQ(a.faces.indices, b.faces.indices);
	EXPECT_LT((b.vertices / 64.0 - a.vertices).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(FaceCaps, AreTheSameForAnyNumberOfThreads)
{
	const Cone       cone{3.0};
	const ExactCloud exact   = cone.cloud(3000);
	const int        threads = omp_get_max_threads();
	PolygonMesh      meshes[2];
	for (const int k : {0, 1}) {
		omp_set_num_threads(1 + 2 * k);
		meshes[k] = cone.cutAt(2.0, 4, 6);
		std::vector<char> onFeature(meshes[k].vertexCount(), 0);
		EXPECT_EQ(capBulgingFaces(exact.cloud, exact.field, bulge, meshes[k], onFeature), 1);
	}
	omp_set_num_threads(threads);
	EXPECT_EQ(meshes[0].vertices, meshes[1].vertices);
	EXPECT_EQ(meshes[0].faces.indices, meshes[1].faces.indices);
}

// Faces without area, and none at all.
TEST(FaceCaps, DegenerateMeshesAreNoProblem)
{
	const ExactCloud  exact = Cone{3.0}.cloud(500);
	PolygonMesh       none;
	std::vector<char> onFeature;
	EXPECT_EQ(capBulgingFaces(exact.cloud, exact.field, bulge, none, onFeature), 0);
	const std::vector<Vector3d> line = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
	PolygonMesh                 flat =
		polygonMesh(line, std::vector<Vector3d>(4, Vector3d::UnitZ()), {{0, 1, 2, 3}});
	onFeature.assign(4, 0);
	EXPECT_EQ(capBulgingFaces(exact.cloud, exact.field, bulge, flat, onFeature), 0);
	EXPECT_EQ(flat.vertexCount(), 4);
}

} // namespace
} // namespace curvature_lines::test
