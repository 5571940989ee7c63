// Distances of points to polygon meshes beside a search through every triangle.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Corners = std::array<Vector3d, 3>;

double distanceToSegment(const Vector3d& p, const Vector3d& a, const Vector3d& b)
{
	const double length = (b - a).squaredNorm();
	const double t      = length > 0.0 ? std::clamp((p - a).dot(b - a) / length, 0.0, 1.0) : 0.0;
	return (p - a - t * (b - a)).norm();
}

// To its plane where the foot is inside, else to its sides.
double distanceToTriangle(const Vector3d& p, const Corners& t)
{
	double least = std::min(
		{distanceToSegment(p, t[0], t[1]),
	     distanceToSegment(p, t[1], t[2]),
	     distanceToSegment(p, t[2], t[0])});
	const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
	if (normal.norm() == 0.0)
		return least;
	bool inside = true;
	for (int c = 0; c < 3; ++c)
		inside = inside && (t[(c + 1) % 3] - t[c]).cross(p - t[c]).dot(normal) >= 0.0;
	if (inside)
		least = std::min(least, std::abs((p - t[0]).dot(normal.normalized())));
	return least;
}

PolygonMesh
meshOf(const std::vector<Vector3d>& vertices, const std::vector<std::vector<Index>>& faces)
{
	return polygonMesh(vertices, std::vector<Vector3d>(vertices.size(), Vector3d::UnitZ()), faces);
}

// Faces of three to six corners anywhere, none of them flat.
PolygonMesh randomSoup(Index faces, samples::Random& random)
{
	std::vector<Vector3d>           vertices;
	std::vector<std::vector<Index>> loops;
	for (Index f = 0; f < faces; ++f) {
		const Vector3d center = random.normal3();
		loops.emplace_back();
		for (Index k = 0; k < 3 + f % 4; ++k) {
			loops.back().push_back(static_cast<Index>(vertices.size()));
			vertices.push_back(center + 0.3 * random.normal3());
		}
	}
	return meshOf(vertices, loops);
}

Matrix3Xd randomPoints(Index count, samples::Random& random)
{
	Matrix3Xd points(3, count);
	for (auto p : points.colwise())
		p = 1.5 * random.normal3();
	return points;
}

void expectNearest(const PolygonMesh& mesh, const Matrix3Xd& points, double tolerance)
{
	const FaceTriangles triangles = faceTriangles(mesh);
	const MeshDistance  found     = distanceToMesh(mesh, points);
	for (Index i = 0; i < static_cast<Index>(points.cols()); ++i) {
		double least = INFINITY, ofFace = INFINITY, ofFoot = INFINITY;
		for (std::size_t t = 0; t < triangles.corners.size(); ++t) {
			const double distance = distanceToTriangle(points.col(i), triangles.corners[t]);
			least                 = std::min(least, distance);
			if (triangles.face[t] != found.face[i])
				continue;
			ofFace = std::min(ofFace, distance);
			ofFoot = std::min(ofFoot, distanceToTriangle(found.foot.col(i), triangles.corners[t]));
		}
		EXPECT_NEAR(found.distance[i], least, tolerance);
		EXPECT_NEAR((found.foot.col(i) - points.col(i)).norm(), found.distance[i], 1e-14);
		EXPECT_NEAR(ofFace, least, tolerance); // the face it names is a nearest one
		EXPECT_LT(ofFoot, tolerance);          // and the foot is on it
	}
}

TEST(MeshDistance, IsThatToTheNearestOfAllTriangles)
{
	for (const int seed : {1, 2, 3}) {
		samples::Random   random(seed, 0);
		const PolygonMesh mesh = randomSoup(120, random);
		expectNearest(mesh, randomPoints(400, random), 1e-12);
	}
}

TEST(MeshDistance, OfPointsOnTheMeshIsZero)
{
	samples::Random     random(4, 0);
	const PolygonMesh   mesh      = randomSoup(60, random);
	const FaceTriangles triangles = faceTriangles(mesh);
	Matrix3Xd           points(3, triangles.corners.size());
	for (Index i = 0; i < static_cast<Index>(points.cols()); ++i) {
		const auto& [a, b, c] = triangles.corners[i];
		points.col(i)         = 0.5 * a + 0.3 * b + 0.2 * c;
	}
	EXPECT_LT(distanceToMesh(mesh, points).distance.maxCoeff(), 1e-14);
	EXPECT_LT(distanceToMesh(mesh, mesh.vertices).distance.maxCoeff(), 1e-14);
}

// Corners in one line, corners in one place, and slivers whose height is a rounding error.
TEST(MeshDistance, FacesWithoutAreaDoNoHarm)
{
	const std::vector<Vector3d> vertices = {
		{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}, {1, 1e-15, 0}, {1, -1e-9, 0}};
	const PolygonMesh mesh = meshOf(
		vertices,
		{{0, 1, 2}, {0, 0, 1}, {1, 1, 1}, {2, 2, 2, 2}, {0, 5, 2}, {0, 6, 2}, {0, 2, 3, 4}});
	samples::Random random(5, 0);
	const Matrix3Xd points = randomPoints(300, random);
	const auto      found  = distanceToMesh(mesh, points);
	ASSERT_TRUE(found.distance.allFinite());
	ASSERT_TRUE(found.foot.allFinite());
	expectNearest(mesh, points, 1e-8);
}

TEST(MeshDistance, IsInfiniteWithoutFaces)
{
	samples::Random random(6, 0);
	const Matrix3Xd points = randomPoints(5, random);
	// No face at all, and only faces without area.
	const PolygonMesh line = meshOf({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}});
	for (const PolygonMesh& mesh : {PolygonMesh(), line}) {
		const MeshDistance found = distanceToMesh(mesh, points);
		ASSERT_EQ(found.distance.size(), 5);
		ASSERT_EQ(found.foot.cols(), 5);
		for (Index i = 0; i < 5; ++i) {
			EXPECT_EQ(found.distance[i], INFINITY);
			EXPECT_EQ(found.face[i], -1);
		}
	}
	const MeshDistance none = distanceToMesh(randomSoup(3, random), Matrix3Xd(3, 0));
	EXPECT_EQ(none.distance.size(), 0);
	EXPECT_TRUE(none.face.empty());
}

TEST(MeshDistance, MovesWithTheMesh)
{
	samples::Random   random(7, 0);
	PolygonMesh       mesh   = randomSoup(60, random);
	const Matrix3Xd   points = randomPoints(200, random);
	const RigidMotion motion;
	const auto        before = distanceToMesh(mesh, points);
	mesh.vertices            = motion.ofPoints(mesh.vertices);
	const auto after         = distanceToMesh(mesh, motion.ofPoints(points));
	EXPECT_LT((after.distance - before.distance).cwiseAbs().maxCoeff(), 1e-12);
	EXPECT_LT((after.foot - motion.ofPoints(before.foot)).cwiseAbs().maxCoeff(), 1e-11);
	mesh.vertices *= 1e4;
	const auto large = distanceToMesh(mesh, 1e4 * motion.ofPoints(points));
	EXPECT_LT((1e-4 * large.distance - before.distance).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(MeshDistance, IsTheSameForAnyNumberOfThreads)
{
	samples::Random   random(8, 0);
	const PolygonMesh mesh    = randomSoup(80, random);
	const Matrix3Xd   points  = randomPoints(500, random);
	const int         threads = omp_get_max_threads();
	omp_set_num_threads(1);
	const MeshDistance one = distanceToMesh(mesh, points);
	omp_set_num_threads(3);
	const MeshDistance three = distanceToMesh(mesh, points);
	omp_set_num_threads(threads);
	EXPECT_EQ(one.distance, three.distance);
	EXPECT_EQ(one.foot, three.foot);
	EXPECT_EQ(one.face, three.face);
}

TEST(FaceTriangles, CoverFlatFacesOnce)
{
	std::vector<Vector3d>           vertices;
	std::vector<std::vector<Index>> faces;
	std::vector<double>             areas;
	for (Index sides = 3; sides <= 8; ++sides) {
		faces.emplace_back();
		for (Index k = 0; k < sides; ++k) {
			const double angle = 2.0 * EIGEN_PI * k / sides;
			faces.back().push_back(static_cast<Index>(vertices.size()));
			vertices.emplace_back(std::cos(angle), std::sin(angle), double(sides));
		}
		areas.push_back(0.5 * sides * std::sin(2.0 * EIGEN_PI / sides));
	}
	const FaceTriangles triangles = faceTriangles(meshOf(vertices, faces));
	ASSERT_EQ(triangles.face.size(), triangles.corners.size());
	std::vector<double> sums(faces.size(), 0.0);
	for (std::size_t t = 0; t < triangles.corners.size(); ++t) {
		const auto& [a, b, c] = triangles.corners[t];
		const double area     = 0.5 * (b - a).cross(c - a).z();
		EXPECT_GT(area, 0.0); // turned as their faces
		sums[triangles.face[t]] += area;
	}
	for (std::size_t f = 0; f < faces.size(); ++f)
		EXPECT_NEAR(sums[f], areas[f], 1e-12);
}

// A bent quad is a roof over its shorter diagonal, whichever corner comes first.
TEST(FaceTriangles, QuadsAreCutAlongTheShorterDiagonal)
{
	const std::vector<Vector3d> vertices = {{0, 0, 0}, {2, -1, 1}, {4, 0, 0}, {2, 1, 1}};
	for (Index first = 0; first < 4; ++first) {
		const PolygonMesh mesh =
			meshOf(vertices, {{first, (first + 1) % 4, (first + 2) % 4, (first + 3) % 4}});
		EXPECT_EQ(faceTriangles(mesh).corners.size(), 2u);
		const MeshDistance found = distanceToMesh(mesh, Vector3d(2, 0, 3));
		EXPECT_NEAR(found.distance[0], 2.0, 1e-14); // the ridge is at 1; the other diagonal at 0
	}
}

} // namespace
} // namespace curvature_lines::test
