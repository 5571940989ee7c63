// Crosses on exact triangulations: they keep the principal directions they are given, continue them where nothing is
// known, and their singular points add up to the Euler characteristic.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "cross_field.h"
#include "curvature_field.h"
#include "exact_field.h"
#include "point_cloud.h"
#include "scaffold.h"
#include "triangle_mesh.h"
#include "triangulated_surfaces.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

DirectionGuide guideOf(const test::TriangulatedSurface& surface, double weight)
{
	DirectionGuide guide;
	guide.normals    = surface.truth.normals;
	guide.directions = surface.truth.d1;
	guide.weights    = Eigen::VectorXd::Constant(surface.size(), weight);
	guide.onCrease.assign(surface.size(), 0);
	return guide;
}

// Angle between a cross and a direction, 0 .. 45 degrees, radians.
double crossAngle(const CrossField& field, Index v, const Vector3d& direction)
{
	return std::min(
		test::lineAngle(field.d1.col(v), direction), test::lineAngle(field.d2.col(v), direction));
}

double largestCrossAngle(const CrossField& field, const Eigen::Matrix3Xd& directions)
{
	double largest = 0.0;
	for (Index v = 0; v < static_cast<Index>(directions.cols()); ++v)
		largest = std::max(largest, crossAngle(field, v, directions.col(v)));
	return largest;
}

// The sum of the indices in quarters; one of two quarters has no sign and must not occur.
int sumOfIndices(const CrossField& field)
{
	int sum = 0;
	for (const std::uint8_t index : field.index) {
		EXPECT_NE(index, 2);
		sum += index == 3 ? -1 : index;
	}
	return sum;
}

void expectSound(const TriangleMesh& mesh, const CrossField& field)
{
	for (Index v = 0; v < mesh.vertexCount(); ++v) {
		const Vector3d n = field.normals.col(v), d1 = field.d1.col(v), d2 = field.d2.col(v);
		ASSERT_NEAR(d1.norm(), 1.0, 1e-9);
		ASSERT_NEAR(d1.dot(n), 0.0, 1e-9);
		ASSERT_LT((n.cross(d1) - d2).norm(), 1e-9);
	}
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		const auto&    edge = mesh.edges()[e];
		const Vector3d d    = transported(
            field.d1.col(edge.from), field.normals.col(edge.from), field.normals.col(edge.to));
		// d1 of `from`, seen at `to`, is nearest to the arm that the turns name.
		const Complex z(d.dot(field.d1.col(edge.to)), d.dot(field.d2.col(edge.to)));
		EXPECT_GT(
			(z * std::conj(turned(1.0, field.turns[e]))).real(), std::cos(EIGEN_PI / 4) - 1e-9);
	}
	for (Index t = 0; t < mesh.triangleCount(); ++t) {
		int sum = 0;
		for (int c = 0; c < 3; ++c) {
			const int turns = field.turns[mesh.edgeOf(t, c)];
			sum += mesh.isForward(t, c) ? turns : -turns;
		}
		ASSERT_EQ(field.index[t], sum & 3);
	}
}

TEST(CrossField, KeepsThePrincipalDirectionsOfATorusAndACylinder)
{
	for (const auto& [name, surface] :
	     {std::pair("torus", test::triangulatedTorus(60, 30)),
	      std::pair("cylinder", test::triangulatedCylinder(40, 30))}) {
		const CrossField field = smoothCrossField(surface.mesh, guideOf(surface, 1.0));
		expectSound(surface.mesh, field);
		EXPECT_LT(largestCrossAngle(field, surface.truth.d1), 1e-3) << name;
		EXPECT_EQ(singularTriangles(field).size(), 0) << name;
	}
}

// A third of the directions is wrong, and said to be uncertain.
TEST(CrossField, SureDirectionsSetUncertainOnesRight)
{
	const auto      surface = test::triangulatedTorus(60, 30);
	DirectionGuide  guide   = guideOf(surface, 1.0);
	samples::Random random(5, 0);
	for (Index v = 0; v < surface.size(); v += 3) {
		const double a = random.uniform(0.0, EIGEN_PI);
		guide.directions.col(v) =
			std::cos(a) * surface.truth.d1.col(v) + std::sin(a) * surface.truth.d2.col(v);
		guide.weights[v] = 0.01;
	}
	const CrossField field = smoothCrossField(surface.mesh, guide);
	EXPECT_LT(largestCrossAngle(field, surface.truth.d1), 0.02);
	EXPECT_EQ(singularTriangles(field).size(), 0);
}

// Directions at the two rims of a cylinder only: the smoothest continuation between them.
TEST(CrossField, ContinuesWhatIsKnownWhereNothingIs)
{
	const auto     surface = test::triangulatedCylinder(40, 30);
	DirectionGuide guide   = guideOf(surface, 0.0);
	for (const auto& rim : surface.mesh.rims())
		for (const Index v : rim)
			guide.weights[v] = 10.0;
	const CrossField field = smoothCrossField(surface.mesh, guide);
	EXPECT_LT(largestCrossAngle(field, surface.truth.d1), 1e-3);
	EXPECT_EQ(singularTriangles(field).size(), 0);
}

// Poincare and Hopf: in quarters, the indices of crosses add up to four times the Euler characteristic.
TEST(CrossField, SingularPointsAddUpToTheEulerCharacteristic)
{
	const auto       sphere = test::triangulatedSphere(4);
	const CrossField smooth = smoothCrossField(sphere.mesh, guideOf(sphere, 0.0));
	expectSound(sphere.mesh, smooth);
	EXPECT_EQ(std::abs(sumOfIndices(smooth)), 4 * sphere.mesh.eulerCharacteristic());
	EXPECT_EQ(singularTriangles(smooth).size(), 8); // those of a cube

	const auto torus = test::triangulatedTorus(48, 24);
	EXPECT_EQ(sumOfIndices(smoothCrossField(torus.mesh, guideOf(torus, 0.0))), 0);

	// However wild the field is.
	DirectionGuide  wild = guideOf(sphere, 1.0);
	samples::Random random(8, 0);
	for (Index v = 0; v < sphere.size(); ++v) {
		const Vector3d n       = wild.normals.col(v);
		wild.directions.col(v) = n.cross(random.normal3()).normalized();
		wild.weights[v]        = random.uniform(0.0, 0.3);
	}
	const CrossField field = smoothCrossField(sphere.mesh, wild);
	int              sum   = 0; // modulo four, as an index of two quarters has no sign
	for (const std::uint8_t index : field.index)
		sum += index;
	EXPECT_EQ(sum % 4, 0);
	EXPECT_GE(singularTriangles(field).size(), 8);
}

TEST(CrossField, MovesAndGrowsWithTheSurface)
{
	const auto              surface = test::triangulatedTorus(40, 20);
	const test::RigidMotion motion;
	DirectionGuide          guide = guideOf(surface, 0.3), moved = guide;
	for (Index v = 0; v < surface.size(); v += 2)
		guide.weights[v] = moved.weights[v] = 0.0;
	moved.normals    = motion.ofVectors(guide.normals);
	moved.directions = motion.ofVectors(guide.directions);
	const TriangleMesh other(
		7.0 * motion.ofPoints(surface.mesh.vertices), surface.mesh.triangles());
	const CrossField a = smoothCrossField(surface.mesh, guide), b = smoothCrossField(other, moved);
	EXPECT_LT(largestCrossAngle(b, motion.ofVectors(a.d1)), 1e-6);
	EXPECT_EQ(singularTriangles(a).size(), singularTriangles(b).size());
}

// Two surfaces in one mesh do not mix: one is known, the other free.
TEST(CrossField, ComponentsAreSolvedApart)
{
	const auto            torus     = test::triangulatedTorus(40, 20);
	const auto            ball      = test::triangulatedSphere(3);
	const Index           first     = torus.size();
	std::vector<Triangle> triangles = torus.mesh.triangles();
	for (Triangle t : ball.mesh.triangles()) {
		for (Index& v : t)
			v += first;
		triangles.push_back(t);
	}
	Eigen::Matrix3Xd vertices(3, first + ball.size());
	vertices << torus.mesh.vertices, ball.mesh.vertices.colwise() + Vector3d(5, 0, 0);
	const TriangleMesh both(vertices, triangles);
	DirectionGuide     guide = guideOf(torus, 1.0), free = guideOf(ball, 0.0);
	guide.normals.conservativeResize(3, vertices.cols());
	guide.directions.conservativeResize(3, vertices.cols());
	guide.weights.conservativeResize(vertices.cols());
	guide.normals.rightCols(ball.size())    = free.normals;
	guide.directions.rightCols(ball.size()) = free.directions;
	guide.weights.tail(ball.size())         = free.weights;
	guide.onCrease.resize(vertices.cols(), 0);
	const CrossField field = smoothCrossField(both, guide);
	double           worst = 0.0;
	for (Index v = 0; v < first; ++v)
		worst = std::max(worst, crossAngle(field, v, torus.truth.d1.col(v)));
	EXPECT_LT(worst, 1e-3);
	EXPECT_EQ(singularTriangles(field).size(), 8);
}

TEST(CrossField, EmptyMesh)
{
	DirectionGuide guide;
	guide.normals.resize(3, 0);
	guide.directions.resize(3, 0);
	EXPECT_EQ(smoothCrossField(TriangleMesh(), guide).d1.cols(), 0);
}

TEST(CrossField, TransportIsTheSmallestRotation)
{
	samples::Random random(1, 0);
	for (int k = 0; k < 200; ++k) {
		const Vector3d from = random.normal3().normalized(), to = random.normal3().normalized(),
					   d                = random.normal3();
		const Eigen::Quaterniond oracle = Eigen::Quaterniond::FromTwoVectors(from, to);
		EXPECT_LT((transported(d, from, to) - oracle * d).norm(), 1e-9);
		EXPECT_LT((transported(from, from, to) - to).norm(), 1e-12);
	}
}

TEST(CrossField, QuartersAndFamiliesAgreeWithPowersOfI)
{
	const Complex z(0.3, -1.7);
	for (int quarters = -6; quarters <= 6; ++quarters) {
		EXPECT_LT(std::abs(turned(z, quarters) - z * std::pow(Complex(0, 1), quarters)), 1e-12);
		const Complex image = turned(z, -quarters);
		for (int f = 0; f < 2; ++f) {
			const FamilyImage behind = familyBehind(quarters, f);
			const double      value  = behind.family == 0 ? z.real() : z.imag();
			EXPECT_EQ(behind.sign * value, f == 0 ? image.real() : image.imag());
		}
	}
}

TEST(CrossField, CornerTurnsLeadBackToTheFirstCorner)
{
	const auto       sphere = test::triangulatedSphere(3);
	const CrossField field  = smoothCrossField(sphere.mesh, guideOf(sphere, 0.0));
	for (Index t = 0; t < sphere.mesh.triangleCount(); ++t) {
		const std::array<int, 3> turns = cornerTurns(sphere.mesh, field, t);
		const auto               side  = [&](int c) {
            const int q = field.turns[sphere.mesh.edgeOf(t, c)];
            return sphere.mesh.isForward(t, c) ? q : -q;
		};
		EXPECT_EQ(turns[0], 0);
		EXPECT_EQ(turns[1], side(0) & 3);
		EXPECT_EQ((turns[2] + side(2)) & 3, 0);
		EXPECT_EQ((turns[2] - turns[1] - side(1) + field.index[t]) & 3, 0);
	}
}

// Every frame turned by a little around its normal.
CrossField withTurnedCrosses(CrossField field, double most, samples::Random& random)
{
	for (Index v = 0; v < static_cast<Index>(field.d1.cols()); ++v) {
		const double   a  = random.uniform(-most, most);
		const Vector3d d1 = field.d1.col(v), d2 = field.d2.col(v);
		field.d1.col(v) = std::cos(a) * d1 + std::sin(a) * d2;
		field.d2.col(v) = std::cos(a) * d2 - std::sin(a) * d1;
	}
	return field;
}

// Of the angles along the edges that are left over the turns.
double roughness(const TriangleMesh& mesh, const CrossField& field)
{
	const Eigen::VectorXd weights = mesh.cotangentWeights();
	double                sum     = 0.0;
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		const auto&    edge = mesh.edges()[e];
		const Vector3d d    = transported(
            field.d1.col(edge.from), field.normals.col(edge.from), field.normals.col(edge.to));
		const double angle = std::atan2(d.dot(field.d2.col(edge.to)), d.dot(field.d1.col(edge.to)));
		sum += weights[e] *
		       std::pow(std::remainder(angle - 0.5 * EIGEN_PI * field.turns[e], 2.0 * EIGEN_PI), 2);
	}
	return sum;
}

TEST(SmoothWithTurns, BringsDirectionsBackToTheGuide)
{
	samples::Random random(12, 0);
	const auto      torus = test::triangulatedTorus(48, 24);
	CrossField      field = smoothCrossField(torus.mesh, guideOf(torus, 1.0));
	const auto      turns = field.turns;
	CrossField      again = field;
	smoothWithTurns(torus.mesh, guideOf(torus, 1.0), again);
	EXPECT_LT(largestCrossAngle(again, field.d1), 1e-3); // nothing to do
	field = withTurnedCrosses(field, 0.3, random);
	ASSERT_GT(largestCrossAngle(field, torus.truth.d1), 0.25);
	smoothWithTurns(torus.mesh, guideOf(torus, 1.0), field);
	EXPECT_LT(largestCrossAngle(field, torus.truth.d1), 1e-3);
	EXPECT_EQ(field.turns, turns);
	expectSound(torus.mesh, field);
}

// Without a guide the crosses are as smooth as they can be with their singular points, wherever those are.
TEST(SmoothWithTurns, NothingNearIsSmoother)
{
	samples::Random      random(13, 0);
	const auto           sphere = test::triangulatedSphere(3);
	const DirectionGuide guide  = guideOf(sphere, 0.0);
	for (const bool moved : {false, true}) {
		CrossField field = smoothCrossField(sphere.mesh, guide);
		if (moved) { // a pair of new singular points
			const Index e  = 77;
			field.turns[e] = static_cast<std::uint8_t>((field.turns[e] + 1) & 3);
			for (const Index t : {sphere.mesh.edges()[e].left, sphere.mesh.edges()[e].right})
				field.index[t] = static_cast<std::uint8_t>(
					(field.index[t] + (t == sphere.mesh.edges()[e].left ? 1 : 3)) & 3);
		}
		const auto index    = field.index;
		field               = withTurnedCrosses(field, 0.3, random);
		const double before = roughness(sphere.mesh, field);
		smoothWithTurns(sphere.mesh, guide, field);
		const double after = roughness(sphere.mesh, field);
		EXPECT_LT(after, 0.8 * before);
		EXPECT_EQ(field.index, index);
		for (int trial = 0; trial < 10; ++trial)
			EXPECT_GT(roughness(sphere.mesh, withTurnedCrosses(field, 0.05, random)), after - 1e-6);
		for (Index v = 0; v < sphere.size(); ++v) {
			const Vector3d n = field.normals.col(v), d1 = field.d1.col(v), d2 = field.d2.col(v);
			EXPECT_NEAR(d1.norm(), 1.0, 1e-9);
			EXPECT_LT((n.cross(d1) - d2).norm(), 1e-9);
		}
	}
}

Scaffold scaffoldOf(const test::TriangulatedSurface& surface)
{
	Scaffold scaffold;
	scaffold.mesh = surface.mesh;
	scaffold.source.resize(surface.size());
	for (Index v = 0; v < surface.size(); ++v)
		scaffold.source[v] = v;
	scaffold.creaseEdge.assign(surface.mesh.edgeCount(), 0);
	scaffold.spacing.setConstant(scaffold.mesh.vertexCount(), 0.1);
	scaffold.size.setConstant(scaffold.mesh.vertexCount(), 0.2);
	return scaffold;
}

CurvatureField curvatureOf(const test::TriangulatedSurface& surface, double error)
{
	CurvatureField field;
	field.k1 = surface.truth.k1;
	field.k2 = surface.truth.k2;
	field.d1 = surface.truth.d1;
	field.d2 = surface.truth.d2;
	field.error.setConstant(surface.size(), error);
	field.status.assign(surface.size(), PointStatus::Ok);
	return field;
}

TEST(DirectionGuide, WeighsDirectionsByTheirErrors)
{
	const auto     surface  = test::triangulatedTorus(40, 20);
	const Scaffold scaffold = scaffoldOf(surface);
	const auto     exact    = directionGuide(scaffold, curvatureOf(surface, 0.0));
	const auto     rough    = directionGuide(scaffold, curvatureOf(surface, 0.15));
	const auto     hopeless = directionGuide(scaffold, curvatureOf(surface, 10.0));
	EXPECT_GT(exact.weights.minCoeff(), 0.0);
	for (Index v = 0; v < surface.size(); ++v) {
		EXPECT_LE(rough.weights[v], exact.weights[v]);
		EXPECT_LT(test::lineAngle(exact.directions.col(v), surface.truth.d1.col(v)), 1e-9);
		EXPECT_GT(exact.normals.col(v).dot(surface.truth.normals.col(v)), 1.0 - 1e-9);
	}
	EXPECT_LT(rough.weights.sum(), 0.9 * exact.weights.sum());
	EXPECT_EQ(hopeless.weights.maxCoeff(), 0.0);
	// Spheres have no directions, however exact the estimate is.
	const auto ball = test::triangulatedSphere(3);
	EXPECT_EQ(directionGuide(scaffoldOf(ball), curvatureOf(ball, 0.0)).weights.maxCoeff(), 0.0);
}

TEST(DirectionGuide, SaysNothingOnCreasesAndBetweenThePoints)
{
	const auto surface     = test::triangulatedTorus(40, 20);
	Scaffold   scaffold    = scaffoldOf(surface);
	scaffold.creaseEdge[5] = 1;
	const Index a = surface.mesh.edges()[5].from, b = surface.mesh.edges()[5].to, none = 100;
	scaffold.source[none] = -1;
	CurvatureField failed = curvatureOf(surface, 0.0);
	const Index    few    = 200;
	failed.status[few]    = PointStatus::TooFewNeighbors;
	const auto guide      = directionGuide(scaffold, failed);
	const auto fromFaces  = surface.mesh.vertexNormals();
	for (const Index v : {a, b, none, few})
		EXPECT_EQ(guide.weights[v], 0.0);
	for (const Index v : {a, b, none})
		EXPECT_LT((guide.normals.col(v) - fromFaces.col(v)).norm(), 1e-12);
	for (Index v = 0; v < surface.size(); ++v) {
		EXPECT_EQ(guide.onCrease[v] != 0, v == a || v == b);
		EXPECT_NEAR(guide.directions.col(v).norm(), 1.0, 1e-9);
		EXPECT_NEAR(guide.directions.col(v).dot(guide.normals.col(v)), 0.0, 1e-9);
	}
}

} // namespace
} // namespace curvature_lines
