// Position field meshes of exact surfaces: topology, quads, alignment and the number of vertices.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "position_field_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "curvature_estimate.h"
#include "estimated_field.h"
#include "exact_field.h"
#include "line_network.h"
#include "line_networks.h"
#include "mesh_distance.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygon_meshes.h"
#include "thin_shapes.h"

namespace curvature_lines {
namespace {

samples::SampleRequest request(const std::string& surface, int points)
{
	samples::SampleRequest result;
	result.surface = surface;
	result.points  = points;
	result.seed    = 4;
	return result;
}

PositionFieldMeshResult meshOf(const test::ExactCloud& exact, double targetVertices)
{
	PositionFieldMeshOptions options;
	options.targetVertices = targetVertices;
	return buildPositionFieldMesh(exact.cloud, exact.field, {}, options);
}

// Mean angle of inner edges to the nearest principal direction, degrees.
double meanAngle(const std::string& name, const PolygonMesh& mesh)
{
	const samples::AnalyticSurface&        surface = samples::surface(name);
	std::map<std::pair<Index, Index>, int> sides;
	for (Index f = 0; f < mesh.faceCount(); ++f)
		for (Index k = 0; k < mesh.faces[f].size(); ++k)
			++sides[std::minmax(mesh.faces[f][k], mesh.faces[f][(k + 1) % mesh.faces[f].size()])];
	double sum = 0.0, count = 0.0;
	for (const auto& [side, faces] : sides) {
		if (faces < 2)
			continue;
		const Eigen::Vector3d a = mesh.vertices.col(side.first), b = mesh.vertices.col(side.second);
		const samples::SurfaceFrame frame = surface.frame(surface.project(0.5 * (a + b)));
		const Eigen::Vector3d       d     = b - a;
		const double                x = std::abs(d.dot(frame.d1)), y = std::abs(d.dot(frame.d2));
		sum += std::atan2(std::min(x, y), std::max(x, y)) * 180.0 / EIGEN_PI;
		count += 1.0;
	}
	return sum / count;
}

void expectManifold(const PositionFieldMeshResult& result, int euler, int rims)
{
	EXPECT_EQ(result.topology.eulerCharacteristic, euler);
	EXPECT_EQ(result.topology.components, 1);
	EXPECT_EQ(result.topology.boundaryLoops, rims);
	EXPECT_EQ(result.topology.nonmanifoldEdges, 0);
	EXPECT_EQ(result.topology.nonmanifoldVertices, 0);
	EXPECT_TRUE(result.mesh.vertices.allFinite());
}

TEST(PositionFieldMesh, TorusIsAllQuadsAlongItsLinesOfCurvature)
{
	const PositionFieldMeshResult result = meshOf(test::exactCloud(request("torus", 6000)), 800);
	expectManifold(result, 0, 0);
	EXPECT_EQ(result.topology.quads, result.topology.faces);
	EXPECT_EQ(test::irregularVertices(result.mesh), 0);
	EXPECT_EQ(test::foldedCorners("torus", result.mesh), 0);
	EXPECT_NEAR(result.topology.vertices, 800, 40);
	EXPECT_LT(meanAngle("torus", result.mesh), 0.4);
}

TEST(PositionFieldMesh, EllipsoidHasEightConesAndQuadsOnly)
{
	const PositionFieldMeshResult result =
		meshOf(test::exactCloud(request("ellipsoid", 6000)), 800);
	expectManifold(result, 2, 0);
	EXPECT_EQ(result.topology.quads, result.topology.faces);
	EXPECT_EQ(result.singularTriangles, 8);
	EXPECT_LE(test::irregularVertices(result.mesh), 8);
	EXPECT_EQ(test::foldedCorners("ellipsoid", result.mesh), 0);
	EXPECT_NEAR(result.topology.vertices, 800, 40);
	EXPECT_LT(meanAngle("ellipsoid", result.mesh), 2.5);
}

TEST(PositionFieldMesh, SphereIsCoveredByTheSmoothestField)
{
	const PositionFieldMeshResult result = meshOf(test::exactCloud(request("sphere", 6000)), 800);
	expectManifold(result, 2, 0);
	EXPECT_EQ(result.topology.quads, result.topology.faces);
	EXPECT_EQ(result.singularTriangles, 8);
	EXPECT_EQ(result.lineEnds, 0);
	EXPECT_LE(test::irregularVertices(result.mesh), 8);
	EXPECT_EQ(test::foldedCorners("sphere", result.mesh), 0);
	EXPECT_NEAR(result.topology.vertices, 800, 40);
}

// A few of very many points seem to have a direction by chance: they do not bend the field around them.
TEST(PositionFieldMesh, DirectionsByChanceDoNotBendTheFieldOfASphere)
{
	test::ExactCloud exact = test::exactCloud(request("sphere", 6000));
	for (Index i = 0; i < exact.cloud.size(); i += 1000) {
		const double difference = 0.2 * std::abs(exact.field.k2[i]);
		exact.field.k1[i]       = exact.field.k2[i] + difference;
		exact.field.error[i]    = 0.1 * difference;
	}
	const PositionFieldMeshResult result = meshOf(exact, 800);
	expectManifold(result, 2, 0);
	EXPECT_EQ(result.topology.quads, result.topology.faces);
	EXPECT_EQ(result.lineEnds, 0);
}

TEST(PositionFieldMesh, FewVerticesStillMakeATorus)
{
	const test::ExactCloud exact = test::exactCloud(request("torus", 2000));
	for (const double target : {24.0, 60.0, 200.0})
		expectManifold(meshOf(exact, target), 0, 0);
}

TEST(PositionFieldMesh, OpenSurfacesKeepOneLoopPerRim)
{
	struct Open {
		const char* name;
		int         points, target, euler, rims;
	};
	for (const Open& open :
	     {Open{"cylinder", 5000, 600, 0, 2},
	      Open{"helicoid", 5000, 600, 1, 1},
	      Open{"plane", 3000, 300, 1, 1}}) {
		SCOPED_TRACE(open.name);
		const PositionFieldMeshResult result =
			meshOf(test::exactCloud(request(open.name, open.points)), open.target);
		expectManifold(result, open.euler, open.rims);
		EXPECT_EQ(result.topology.quads, result.topology.faces);
		EXPECT_EQ(result.lineEnds, 0);
		// The rims of a helicoid run across the directions: its lines meet them anywhere.
		if (open.name != std::string("helicoid")) {
			EXPECT_EQ(test::irregularVertices(result.mesh), 0);
			EXPECT_EQ(test::foldedCorners(open.name, result.mesh), 0);
		}
	}
}

TEST(PositionFieldMesh, ACubeWithCreasesHasEightIrregularVertices)
{
	std::vector<FeatureLine> edges;
	for (int axis = 0; axis < 3; ++axis)
		for (const double a : {-0.5, 0.5})
			for (const double b : {-0.5, 0.5}) {
				Eigen::Matrix3Xd line(3, 2);
				line.row(axis) << -0.5, 0.5;
				line.row((axis + 1) % 3).setConstant(a);
				line.row((axis + 2) % 3).setConstant(b);
				edges.push_back({line, false});
			}
	const test::ExactCloud   exact = test::exactCloud(request("cube", 4000));
	PositionFieldMeshOptions options;
	options.targetVertices = 400;
	const PositionFieldMeshResult result =
		buildPositionFieldMesh(exact.cloud, exact.field, edges, options);
	expectManifold(result, 2, 0);
	EXPECT_EQ(result.topology.quads, result.topology.faces);
	EXPECT_EQ(test::irregularVertices(result.mesh), 8); // its corners
	EXPECT_LT(distanceToMesh(result.mesh, exact.cloud.positions).distance.maxCoeff(), 1e-3);
}

// Its umbilics are two cones each, around which the families change places: curves that run past them have to be cut.
TEST(PositionFieldMesh, LinesOfAnEllipsoidKeepTheirFamily)
{
	const test::ExactCloud   exact = test::exactCloud(request("ellipsoid", 6000));
	PositionFieldMeshOptions options;
	options.targetVertices  = 800;
	options.keepLines       = true;
	const LineNetwork lines = buildPositionFieldMesh(exact.cloud, exact.field, {}, options).lines;
	const samples::AnalyticSurface& surface = samples::surface("ellipsoid");
	const double                    largest = (exact.field.k1 - exact.field.k2).maxCoeff();
	Index                           judged = 0, wrong = 0, closed = 0;
	for (Index l = 0; l < lines.lines(); ++l) {
		closed += lines.closed[l];
		for (Index v = lines.offsets[l]; v + 1 < lines.offsets[l + 1]; ++v) {
			const Eigen::Vector3d a = lines.vertices.col(v), along = lines.vertices.col(v + 1) - a;
			const samples::SurfaceFrame frame = surface.frame(surface.project(a + 0.5 * along));
			if (frame.k1 - frame.k2 < 0.1 * largest)
				continue;
			const double first  = std::abs(along.dot(frame.d1)),
						 second = std::abs(along.dot(frame.d2));
			++judged;
			wrong += (lines.family[l] == 1) != (first > second);
		}
	}
	EXPECT_GT(judged, 1000);
	EXPECT_LT(wrong, 0.002 * judged); // 3 % when every curve was of one family
	EXPECT_GT(closed, lines.lines() / 3);
}

// Half a spacing of noise: a scaffold over the points themselves is folded, and lines on it turned back and crossed.
TEST(PositionFieldMesh, LinesOfANoisyCloudDoNotCross)
{
	for (const char* surface : {"ellipsoid", "helicoid", "cube"}) {
		samples::SampleRequest noisy      = request(surface, 5000);
		noisy.noise                       = 0.006;
		const samples::SampleCloud sample = samples::generate(noisy);
		test::EstimatedField       estimated =
			test::estimateAdaptiveField(sample.positions, sample.normals);
		PointCloud& cloud = estimated.prepared.cloud;
		cloud.normals     = estimated.field.correctedNormals;
		makeTangent(cloud.normals, estimated.field);
		PositionFieldMeshOptions options;
		options.targetVertices = 800;
		options.keepLines      = true;
		const PositionFieldMeshResult result =
			buildPositionFieldMesh(cloud, estimated.field, {}, options);
		EXPECT_GT(result.lines.lines(), 40) << surface;
		EXPECT_EQ(tests::crossingsWithinFamilies(result.lines), 0) << surface;
		EXPECT_EQ(result.topology.quads, result.topology.faces) << surface;
		// About 740, thinned again and again, when it was folded; with vertices as far apart as the points around ask for, not
		// as the median of all does, 1180 on the helicoid.
		EXPECT_GT(result.scaffoldVertices, 1100) << surface;
	}
}

TEST(PositionFieldMesh, IsTheSameForAnyNumberOfThreads)
{
	const test::ExactCloud exact   = test::exactCloud(request("ellipsoid", 2500));
	const int              threads = omp_get_max_threads();
	omp_set_num_threads(1);
	const PositionFieldMeshResult one = meshOf(exact, 300);
	omp_set_num_threads(3);
	const PositionFieldMeshResult three = meshOf(exact, 300);
	omp_set_num_threads(threads);
	EXPECT_EQ(one.mesh.vertices, three.mesh.vertices);
	EXPECT_EQ(one.mesh.faces.indices, three.mesh.faces.indices);
}

// In which order the points are given says nothing.
TEST(PositionFieldMesh, IsTheSameForAnyOrderOfThePoints)
{
	for (const char* name : {"ellipsoid", "cylinder"}) {
		samples::SampleCloud sample = samples::generate(request(name, 2500));
		samples::Random      random(3, 0);
		std::vector<Index>   order(2500);
		std::iota(order.begin(), order.end(), Index(0));
		for (std::size_t k = order.size(); k > 1; --k)
			std::swap(order[k - 1], order[random.index(k)]);
		samples::SampleCloud other      = sample;
		other.positions                 = sample.positions(Eigen::all, order);
		other.normals                   = sample.normals(Eigen::all, order);
		other.d1                        = sample.d1(Eigen::all, order);
		other.d2                        = sample.d2(Eigen::all, order);
		other.k1                        = sample.k1(order);
		other.k2                        = sample.k2(order);
		const PositionFieldMeshResult a = meshOf(test::exactCloud(sample), 300),
									  b = meshOf(test::exactCloud(other), 300);
		EXPECT_EQ(a.mesh.faces.indices, b.mesh.faces.indices) << name;
		ASSERT_EQ(a.mesh.vertexCount(), b.mesh.vertexCount()) << name;
		EXPECT_LT((a.mesh.vertices - b.mesh.vertices).cwiseAbs().maxCoeff(), 1e-9) << name;
	}
}

struct Thin {
	test::ThinSolid solid;
	int             points;
};

// Faces around at this height: edges that a plane cuts.
Index facesAround(const PolygonMesh& mesh, double z)
{
	Index cut = 0;
	for (Index f = 0; f < mesh.faceCount(); ++f)
		for (Index k = 0; k < mesh.faces[f].size(); ++k)
			cut += mesh.vertices(2, mesh.faces[f][k]) < z &&
			       mesh.vertices(2, mesh.faces[f][(k + 1) % mesh.faces[f].size()]) >= z;
	return cut;
}

// When edges were as long everywhere tips ended 6 % of the diagonal below their points, and rods were gone.
TEST(PositionFieldMesh, TipsAndRodsAreMeshedToTheirEnds)
{
	for (const Thin& thin :
	     {Thin{{true, 0.25}, 8000},
	      Thin{{true, 0.15}, 8000},
	      Thin{{false, 0.1}, 4000},
	      Thin{{false, 0.05}, 8000}})
		for (const double target : {500.0, 1500.0}) {
			SCOPED_TRACE(
				testing::Message() << thin.solid.cone << " " << thin.solid.radius << " " << target);
			const test::ExactCloud   exact = test::exactCloud(thin.solid.sampled(thin.points, 1));
			PositionFieldMeshOptions options;
			options.targetVertices = target;
			options.automatic      = target == 500.0;
			const PositionFieldMeshResult result =
				buildPositionFieldMesh(exact.cloud, exact.field, {}, options);
			expectManifold(result, 2, 0);
			EXPECT_EQ(result.topology.quads, result.topology.faces);
			EXPECT_GE(result.topology.vertices, 0.95 * target);
			EXPECT_LE(result.topology.vertices, (options.automatic ? 1.5 : 1.05) * target);
			const Eigen::Matrix3Xd& points = exact.cloud.positions;
			const double            diagonal =
				(points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
			const Eigen::VectorXd distance = distanceToMesh(result.mesh, points).distance;
			EXPECT_LT(distance.maxCoeff(), 0.025 * diagonal); // at the foot: no crease was given
			for (Index i = 0; i < thin.points; ++i)
				if (points(2, i) > 1.15) {
					EXPECT_LT(distance[i], 0.008 * diagonal) << points.col(i).transpose();
				}
			if (!thin.solid.cone) {
				for (const double z : {1.3, 1.5, 1.7})
					EXPECT_GE(facesAround(result.mesh, z), 5) << z;
			}
		}
}

// Two sheets a third of an edge apart that look away from each other: vertices of one are not put on the other.
TEST(PositionFieldMesh, VerticesStayOnTheirSideOfAThinWall)
{
	const double         inner = 0.95;
	samples::SampleCloud sample;
	const auto           sphere = samples::generate(request("sphere", 4000));
	const auto           other  = samples::generate([] {
        auto result = request("sphere", 3600);
        result.seed = 9;
        return result;
    }());
	const Eigen::Index   n      = 7600;
	sample.positions.resize(3, n);
	sample.positions << sphere.positions, inner * other.positions;
	sample.normals.resize(3, n);
	sample.normals << sphere.normals, -other.normals;
	sample.d1.resize(3, n);
	sample.d1 << sphere.d1, other.d1;
	sample.d2.resize(3, n);
	sample.d2 << sphere.d2, -other.d2;
	sample.k1.resize(n);
	sample.k1 << sphere.k1, -other.k1 / inner;
	sample.k2                            = sample.k1;
	const PositionFieldMeshResult result = meshOf(test::exactCloud(sample), 1000);
	EXPECT_EQ(result.topology.components, 2);
	EXPECT_EQ(result.topology.eulerCharacteristic, 4);
	EXPECT_EQ(result.topology.boundaryLoops, 0);
	Index outside = 0, inside = 0;
	for (Index v = 0; v < result.mesh.vertexCount(); ++v) {
		const Eigen::Vector3d p     = result.mesh.vertices.col(v);
		const bool            isOut = result.mesh.normals.col(v).dot(p) > 0.0;
		EXPECT_NEAR(p.norm(), isOut ? 1.0 : inner, 0.005);
		++(isOut ? outside : inside);
	}
	EXPECT_GT(outside, 400);
	EXPECT_GT(inside, 300);
}

// Not on the chords of the scaffold's rim, which leave a curved surface.
TEST(PositionFieldMesh, RimVerticesAreOnTheSurface)
{
	const PositionFieldMeshResult result =
		meshOf(test::exactCloud(request("half_torus", 6000)), 400);
	const samples::AnalyticSurface& surface = samples::surface("half_torus");
	expectManifold(result, 0, 2);
	std::map<std::pair<Index, Index>, int> sides;
	for (Index f = 0; f < result.mesh.faceCount(); ++f)
		for (Index k = 0; k < result.mesh.faces[f].size(); ++k)
			++sides[std::minmax(
				result.mesh.faces[f][k],
				result.mesh.faces[f][(k + 1) % result.mesh.faces[f].size()])];
	double off = 0.0, length = 0.0, count = 0.0;
	for (const auto& [side, faces] : sides) {
		if (faces != 1)
			continue;
		const Eigen::Vector3d a = result.mesh.vertices.col(side.first),
							  b = result.mesh.vertices.col(side.second);
		const double around     = a.head<2>().norm() - 1.0;
		off += std::pow(std::hypot(around, a.z()) - 0.4, 2); // of the whole torus
		length += (a - b).norm();
		count += 1.0;
		EXPECT_LT((surface.project(a) - a).norm(), 0.05);
	}
	EXPECT_GE(count, 20);
	EXPECT_LT(std::sqrt(off / count), 0.02 * length / count);
}

TEST(PositionFieldMesh, TooFewPointsGiveAnEmptyMesh)
{
	PointCloud few;
	few.positions = Eigen::Matrix3Xd::Identity(3, 3);
	few.normals   = few.positions;
	CurvatureField field;
	EXPECT_EQ(buildPositionFieldMesh(few, field).mesh.faceCount(), 0);
}

} // namespace
} // namespace curvature_lines
