// Umbilic points, regions and their directions on exact surfaces.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "exact_field.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "umbilics.h"

namespace curvature_lines::test {
namespace {

using Eigen::Vector3d;

ExactCloud cleanCloud(const std::string& surface, int points = 2000)
{
	samples::SampleRequest request;
	request.surface = surface;
	request.points  = points;
	request.seed    = 5;
	return exactCloud(request);
}

UmbilicRegions umbilicsOf(const ExactCloud& exact, const UmbilicOptions& options = {})
{
	return findUmbilics(exact.cloud, exact.field, exact.minimum, options);
}

Index count(const std::vector<char>& flags)
{
	return static_cast<Index>(std::count(flags.begin(), flags.end(), 1));
}

void expectFrames(const ExactCloud& exact, const UmbilicRegions& u)
{
	for (Index i = 0; i < exact.cloud.size(); ++i) {
		const Vector3d n = exact.cloud.normals.col(i);
		EXPECT_NEAR(u.d1.col(i).norm(), 1.0, 1e-9);
		EXPECT_NEAR(u.d1.col(i).dot(n), 0.0, 1e-9);
		EXPECT_NEAR((n.cross(u.d1.col(i)) - u.d2.col(i)).norm(), 0.0, 1e-9);
	}
}

TEST(Umbilics, SphereIsOneRegionWithTwoPoles)
{
	const ExactCloud     exact = cleanCloud("sphere");
	const UmbilicRegions u     = umbilicsOf(exact);
	EXPECT_EQ(count(u.umbilic), exact.cloud.size());
	EXPECT_EQ(u.regions, 1);
	expectFrames(exact, u);

	// All d1 are projections of one axis, so all d2 are orthogonal to it.
	const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(u.d2 * u.d2.transpose());
	EXPECT_NEAR(solver.eigenvalues()[0], 0.0, 1e-9);
	const Vector3d axis = solver.eigenvectors().col(0);
	for (Index i = 0; i < exact.cloud.size(); ++i)
		EXPECT_EQ(u.singular[i] != 0, exact.cloud.normals.col(i).cross(axis).norm() < 0.15);
	EXPECT_GT(count(u.singular), 5);
}

TEST(Umbilics, NoneOnTorusHelicoidAndCylinder)
{
	for (const char* name : {"torus", "helicoid", "cylinder"}) { // the helicoid has k2 = -k1
		const ExactCloud     exact = cleanCloud(name);
		const UmbilicRegions u     = umbilicsOf(exact);
		EXPECT_EQ(count(u.umbilic), 0) << name;
		EXPECT_EQ(u.regions, 0) << name;
		EXPECT_EQ(u.d1, exact.field.d1) << name;
	}
}

TEST(Umbilics, FewOnAnEllipsoid)
{
	// four isolated ones in truth
	EXPECT_LT(count(umbilicsOf(cleanCloud("ellipsoid")).umbilic), 20);
}

TEST(Umbilics, CubeFacesAreSixRegionsWithParallelDirectionsAlongTheEdges)
{
	const ExactCloud     exact = cleanCloud("cube");
	const UmbilicRegions u     = umbilicsOf(exact);
	ASSERT_EQ(u.regions, 6);
	expectFrames(exact, u);
	std::vector<Index> first(6, -1);
	std::set<int>      faces;
	for (Index i = 0; i < exact.cloud.size(); ++i) {
		ASSERT_GE(u.region[i], 0);
		Index& reference = first[u.region[i]];
		if (reference < 0) {
			reference = i;
			Eigen::Index axis;
			exact.cloud.normals.col(i).cwiseAbs().maxCoeff(&axis);
			faces.insert(int(axis) + (exact.cloud.normals(axis, i) > 0.0 ? 10 : 0));
			// Square faces: the PCA axes alone would be arbitrary.
			EXPECT_GT(u.d1.col(i).cwiseAbs().maxCoeff(), std::cos(0.08));
		}
		EXPECT_GT(exact.cloud.normals.col(i).dot(exact.cloud.normals.col(reference)), 0.999);
		EXPECT_LT(lineAngle(u.d1.col(i), u.d1.col(reference)), 1e-7);
		EXPECT_FALSE(u.singular[i]);
	}
	EXPECT_EQ(faces.size(), 6u);
}

TEST(Umbilics, PlaneIsFlat)
{
	const ExactCloud     exact = cleanCloud("plane");
	const UmbilicRegions u     = umbilicsOf(exact);
	EXPECT_EQ(u.regions, 1);
	for (Index i = 0; i < exact.cloud.size(); ++i)
		EXPECT_LT(lineAngle(u.d1.col(i), u.d1.col(0)), 1e-7);
}

TEST(Umbilics, LongFaceFollowsItsLongAxis)
{
	ExactCloud exact = cleanCloud("plane");
	exact.cloud.positions.row(1) *= 0.3;
	exact.minimum = minimumNeighborhoods(exact.cloud, NeighborSearch(exact.cloud.positions));
	EXPECT_LT(lineAngle(umbilicsOf(exact).d1.col(0), Vector3d::UnitX()), 0.05);
}

TEST(Umbilics, CapsuleKeepsTheCylinderAndReplacesTheCaps)
{
	const ExactCloud     exact = cleanCloud("capsule");
	const UmbilicRegions u     = umbilicsOf(exact);
	EXPECT_EQ(u.regions, 2);
	for (Index i = 0; i < exact.cloud.size(); ++i) {
		const double seam = exact.cloud.positions.col(i).z();
		if (std::abs(std::abs(seam) - 0.5) < 2.0 * exact.minimum.medianSpacing)
			continue; // the median filter may move the border by a point
		EXPECT_EQ(u.umbilic[i] != 0, std::abs(seam) > 0.5);
		if (!u.umbilic[i]) {
			EXPECT_EQ(u.region[i], -1);
			EXPECT_EQ(u.d1.col(i), exact.field.d1.col(i));
		}
	}
}

TEST(Umbilics, StatisticalTestSeesWhatTheRatioCannot)
{
	ExactCloud      exact = cleanCloud("sphere");
	samples::Random random(3, 1);
	for (Index i = 0; i < exact.cloud.size(); ++i) {
		const double a = 1.0 + 0.1 * random.normal(), b = 1.0 + 0.1 * random.normal();
		exact.field.k1[i] = std::max(a, b);
		exact.field.k2[i] = std::min(a, b);
	}
	EXPECT_LT(count(umbilicsOf(exact).umbilic), exact.cloud.size() / 2);
	exact.field.error.setConstant(0.14); // of k1 - k2
	EXPECT_GT(count(umbilicsOf(exact).umbilic), 0.99 * exact.cloud.size());
}

TEST(Umbilics, RatioIsTheThreshold)
{
	ExactCloud exact = cleanCloud("sphere");
	exact.field.k2.setConstant(0.9);
	EXPECT_EQ(count(umbilicsOf(exact).umbilic), 0);
	UmbilicOptions wider;
	wider.ratio = 0.85;
	EXPECT_EQ(count(umbilicsOf(exact, wider).umbilic), exact.cloud.size());
}

// Where estimates are in doubt the field goes on: the axes of such a region turned lines by 40 degrees.
TEST(Umbilics, SmoothedDirectionsLeadThroughRegionsOfDoubt)
{
	ExactCloud exact = cleanCloud("helicoid");
	exact.field.error.setZero();
	for (Index i = 0; i < exact.cloud.size(); ++i)
		if (exact.cloud.positions.col(i).head<2>().norm() > 0.7 &&
		    exact.cloud.positions(2, i) > 0.5)
			exact.field.error[i] = 10.0; // at the rim
	const Index doubtful = count(umbilicsOf(exact).umbilic);
	EXPECT_GT(doubtful, 100);
	UmbilicOptions smoothed;
	smoothed.smoothed = true;
	EXPECT_LT(count(umbilicsOf(exact, smoothed).umbilic), 10);
	EXPECT_EQ(umbilicsOf(exact, smoothed).regions, 0);

	// Not through umbilics: around those of an ellipsoid the directions turn, over the caps of a capsule they must.
	for (const char* name : {"ellipsoid", "capsule", "sphere", "cube"}) {
		ExactCloud umbilical = cleanCloud(name, 4000);
		if (name == std::string("ellipsoid"))
			umbilical.field.error = 0.3 * (umbilical.field.k1 - umbilical.field.k2).mean() *
			                        Eigen::VectorXd::Ones(umbilical.cloud.size());
		const UmbilicRegions all = umbilicsOf(umbilical), left = umbilicsOf(umbilical, smoothed);
		EXPECT_GT(all.regions, 0) << name;
		EXPECT_EQ(left.region, all.region) << name;
		EXPECT_EQ(left.d1, all.d1) << name;
	}
}

TEST(Umbilics, SinglePointsAreFiltered)
{
	ExactCloud exact    = cleanCloud("torus");
	exact.field.k2[100] = exact.field.k1[100];
	EXPECT_EQ(count(umbilicsOf(exact).umbilic), 0);
	ExactCloud sphere    = cleanCloud("sphere");
	sphere.field.k2[100] = -sphere.field.k1[100];
	EXPECT_EQ(count(umbilicsOf(sphere).umbilic), sphere.cloud.size());
}

TEST(Umbilics, SmallRegionsKeepTheirDirections)
{
	const ExactCloud exact = cleanCloud("sphere", 300);
	UmbilicOptions   options;
	options.minRegion      = 301;
	const UmbilicRegions u = umbilicsOf(exact, options);
	EXPECT_EQ(u.regions, 0);
	EXPECT_EQ(count(u.umbilic), 300);
	EXPECT_EQ(u.d1, exact.field.d1);
	EXPECT_EQ(u.region, std::vector<Index>(300, -1));
}

TEST(Umbilics, FollowRigidMotionScaleAndFlippedNormals)
{
	const ExactCloud      exact = cleanCloud("capsule", 1000);
	const UmbilicRegions  a     = umbilicsOf(exact);
	const Eigen::Matrix3d rotation =
		Eigen::AngleAxisd(0.7, Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
	ExactCloud moved      = exact;
	moved.cloud.positions = 4.0 * rotation * exact.cloud.positions;
	moved.cloud.normals   = -rotation * exact.cloud.normals;
	moved.field.d1        = rotation * exact.field.d2;
	moved.field.d2        = rotation * exact.field.d1;
	moved.field.k1        = -exact.field.k2 / 4.0;
	moved.field.k2        = -exact.field.k1 / 4.0;
	moved.minimum.medianSpacing *= 4.0;
	for (double& spacing : moved.minimum.spacing)
		spacing *= 4.0;
	const UmbilicRegions b = umbilicsOf(moved);
	EXPECT_EQ(a.umbilic, b.umbilic);
	EXPECT_EQ(a.region, b.region);
	EXPECT_EQ(a.singular, b.singular);
	for (Index i = 0; i < exact.cloud.size(); ++i) {
		if (a.region[i] >= 0 && !a.singular[i]) {
			EXPECT_LT(lineAngle(rotation * a.d1.col(i), b.d1.col(i)), 1e-5);
		}
	}
}

TEST(Umbilics, SurviveDegenerateClouds)
{
	ExactCloud exact;
	exact.cloud.positions = Eigen::Matrix3Xd::Zero(3, 20); // on a line
	exact.cloud.positions.row(0).setLinSpaced(20, 0.0, 1.0);
	exact.cloud.normals = Vector3d::UnitZ().replicate(1, 20);
	exact.minimum       = minimumNeighborhoods(exact.cloud, NeighborSearch(exact.cloud.positions));
	exact.field.k1 = exact.field.k2 = exact.field.error = Eigen::VectorXd::Zero(20);
	exact.field.d1                                      = Vector3d::UnitX().replicate(1, 20);
	exact.field.d2                                      = Vector3d::UnitY().replicate(1, 20);
	const UmbilicRegions u                              = umbilicsOf(exact);
	EXPECT_EQ(count(u.umbilic), 20);
	expectFrames(exact, u);
}

} // namespace
} // namespace curvature_lines::test
