// Curvature-driven projection: accuracy on exact surfaces, noise, idempotence, invariances, degenerate input.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "control_neighborhood.h"
#include "curvature_driven_projection.h"
#include "estimated_field.h"
#include "local_polynomial.h"
#include "moving_least_squares.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "point_set_surface.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Diffusion = CurvatureDrivenOptions::Diffusion;

struct Control {
	Control(const Matrix3Xd& positions, const Matrix3Xd& normals) :
			index(PointCloud{positions, normals})
	{
	}
	CurvatureDrivenSurface surface(const CurvatureDrivenOptions& options = {}) const
	{
		return {index, options};
	}
	double spacing() const { return index.minimum().medianSpacing; }

	const CloudIndex index;
};

samples::SampleCloud sampled(const std::string& name, int points, double noise = 0.0)
{
	samples::SampleRequest request;
	request.surface = name;
	request.points  = points;
	request.noise   = noise;
	request.seed    = 1;
	return samples::generate(request);
}

double distance(const std::string& name, const Matrix3Xd& positions)
{
	const samples::GroundTruth truth = samples::groundTruth(samples::surface(name), positions);
	return std::sqrt((positions - truth.footPoints).squaredNorm() / double(positions.cols()));
}

Matrix3Xd scattered(const Matrix3Xd& positions, double by)
{
	samples::Random random(3, 1);
	Matrix3Xd       result = positions;
	for (Index i = 0; i < static_cast<Index>(result.cols()); ++i)
		result.col(i) += by * random.normal3();
	return result;
}

TEST(CurvatureDrivenProjection, LandsOnACleanSurface)
{
	const auto      torus = sampled("torus", 20000);
	const Control   control(torus.positions, torus.normals);
	const Matrix3Xd queries = scattered(torus.positions.leftCols(4000), 0.5 * control.spacing());
	const ProjectedPoints found = projectPoints(control.surface(), queries);
	EXPECT_EQ(std::count(found.projected.begin(), found.projected.end(), 1), 4000);
	EXPECT_LT(distance("torus", found.positions), 0.01 * control.spacing());

	const auto truth   = samples::groundTruth(samples::surface("torus"), found.positions);
	double     normals = 0.0, k1 = 0.0;
	const CurvatureDrivenSurface surface = control.surface();
	for (Index i = 0; i < 4000; ++i) {
		normals += 1.0 - found.normals.col(i).dot(truth.normals.col(i));
		ControlNeighborhood around;
		ASSERT_TRUE(surface.gather(found.positions.col(i), around));
		const auto quadric = surface.near(around, found.positions.col(i));
		ASSERT_TRUE(quadric);
		k1 += std::pow(-2.0 * quadric->c[3] - truth.k1[i], 2) / 4000;
		EXPECT_NEAR(found.normals.col(i).norm(), 1.0, 1e-9);
	}
	EXPECT_LT(normals / 4000, 1e-3);
	EXPECT_LT(std::sqrt(k1), 0.1); // of 2.5; normals are means of those around

	// What has been projected stays.
	const ProjectedPoints again = projectPoints(control.surface(), found.positions, {1e-4, 1});
	EXPECT_LT(
		std::sqrt((again.positions - found.positions).squaredNorm() / 4000),
		1e-3 * control.spacing());
}

TEST(CurvatureDrivenProjection, PublishedDiffusionShrinksByASmallShareOfTheSpacing)
{
	const auto    torus = sampled("torus", 5000);
	const Control control(torus.positions, torus.normals);
	for (const Diffusion diffusion : {Diffusion::Cutoff, Diffusion::Rational}) {
		CurvatureDrivenOptions options;
		options.diffusion           = diffusion;
		const ProjectedPoints found = projectPoints(control.surface(options), torus.positions);
		EXPECT_LT(distance("torus", found.positions), 0.2 * control.spacing());
		EXPECT_GT(
			distance("torus", found.positions),
			2.0 * distance("torus", projectPoints(control.surface(), torus.positions).positions));
	}
}

TEST(CurvatureDrivenProjection, RemovesNoise)
{
	const auto            torus = sampled("torus", 20000, 0.005);
	const Control         control(torus.positions, planeFitNormals(torus, 16));
	const Matrix3Xd       some  = torus.positions.leftCols(3000);
	const ProjectedPoints found = projectPoints(control.surface(), some);
	EXPECT_LT(distance("torus", found.positions), 0.35 * distance("torus", some));
}

TEST(MovingLeastSquares, LandsOnACleanSurfaceAndStays)
{
	const auto                      torus = sampled("torus", 20000);
	const Control                   control(torus.positions, torus.normals);
	const MovingLeastSquaresSurface surface(control.index);
	const Matrix3Xd queries = scattered(torus.positions.leftCols(2000), 0.5 * control.spacing());
	const ProjectedPoints found = projectPoints(surface, queries);
	EXPECT_EQ(std::count(found.projected.begin(), found.projected.end(), 1), 2000);
	EXPECT_LT(distance("torus", found.positions), 0.01 * control.spacing());
	const ProjectedPoints again = projectPoints(surface, found.positions, {1e-4, 1});
	EXPECT_LT(
		std::sqrt((again.positions - found.positions).squaredNorm() / 2000),
		1e-3 * control.spacing());
	const ProjectedPoints other = projectPoints(control.surface(), queries);
	EXPECT_LT(
		std::sqrt((other.positions - found.positions).squaredNorm() / 2000),
		0.2 * control.spacing());
}

TEST(CurvatureDrivenProjection, PlaneIsExactAndItsBoundaryEnds)
{
	const auto    sheet = sampled("plane", 2000);
	const Control control(sheet.positions, sheet.normals);
	Matrix3Xd     queries(3, 3);
	queries.col(0)              = Vector3d(0.1, 0.2, 0.01);
	queries.col(1)              = Vector3d(0.1, 0.2, 5.0);
	queries.col(2)              = Vector3d(9.0, 0.0, 0.0);
	const ProjectedPoints found = projectPoints(control.surface(), queries);
	EXPECT_TRUE(found.projected[0]);
	EXPECT_LT((found.positions.col(0) - Vector3d(0.1, 0.2, 0.0)).norm(), 1e-9);
	for (const Index far : {1, 2}) { // stay where they are
		EXPECT_FALSE(found.projected[far]);
		EXPECT_EQ(found.positions.col(far), queries.col(far));
	}
}

TEST(CurvatureDrivenProjection, SheetsThatTouchDoNotMix)
{
	const auto     sheet = sampled("plane", 2000);
	Matrix3Xd      positions(3, 4000), normals(3, 4000);
	const Vector3d gap(0, 0, -0.02);
	positions << sheet.positions, sheet.positions.colwise() + gap;
	normals << sheet.normals, -sheet.normals;
	const Control         control(positions, normals);
	const ProjectedPoints found = projectPoints(control.surface(), positions);
	EXPECT_LT((found.positions - positions).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(CurvatureDrivenProjection, InvariancesOfTheGeometry)
{
	const auto            shape = sampled("ellipsoid", 2000, 0.001);
	const Control         control(shape.positions, shape.normals);
	const Matrix3Xd       queries = shape.positions.leftCols(500);
	const ProjectedPoints base    = projectPoints(control.surface(), queries);
	const double          near    = 1e-3 * control.spacing();

	const Control         scaled(1024.0 * shape.positions, shape.normals);
	const ProjectedPoints large = projectPoints(scaled.surface(), 1024.0 * queries);
	EXPECT_LT((large.positions / 1024.0 - base.positions).cwiseAbs().maxCoeff(), near);

	const Control         flipped(shape.positions, -shape.normals);
	const ProjectedPoints other = projectPoints(flipped.surface(), queries);
	EXPECT_LT((other.positions - base.positions).cwiseAbs().maxCoeff(), near);
	EXPECT_LT((other.normals + base.normals).cwiseAbs().maxCoeff(), 1e-3);

	const Eigen::Matrix3d turn =
		Eigen::AngleAxisd(1.1, Vector3d(0.4, -0.8, 0.3).normalized()).toRotationMatrix();
	// With one spacing everywhere: slices of minimum neighbourhoods turn with the frame.
	const std::vector<double> even(2000, control.spacing());
	const PointCloud          turnedCloud{turn * shape.positions, turn * shape.normals};
	const ProjectedPoints     turned =
		projectPoints(CurvatureDrivenSurface(ControlPoints(turnedCloud, even)), turn * queries);
	const ProjectedPoints straight =
		projectPoints(CurvatureDrivenSurface(ControlPoints(control.index, even)), queries);
	EXPECT_LT((turned.positions - turn * straight.positions).cwiseAbs().maxCoeff(), near);

	const int threads = omp_get_max_threads();
	omp_set_num_threads(3);
	EXPECT_EQ(projectPoints(control.surface(), queries).positions, base.positions);
	omp_set_num_threads(threads);
}

TEST(ControlNeighborhood, SumsAreThoseOfTheFormula)
{
	const auto          torus = sampled("torus", 3000, 0.002);
	const Control       control(torus.positions, torus.normals);
	const ControlPoints points(control.index);
	const Vector3d place = torus.positions.col(7) + 0.3 * control.spacing() * torus.normals.col(7);
	ControlNeighborhood around;
	ASSERT_TRUE(around.gather(points, place, 4.4));
	EXPECT_GT(around.size(), 40);
	EXPECT_NEAR(around.spacing(), control.spacing(), 0.3 * control.spacing());
	const double h = 2.0 * around.spacing();
	NormalSums   normals;
	PlaneSums    plane;
	for (int k = 0; k < around.size(); ++k) {
		const Vector3d d = around.position(k) - place;
		const double   w = std::exp(-d.squaredNorm() / (h * h));
		normals.weight += w;
		normals.offset += w * d;
		normals.normal += w * around.normal(k);
		normals.plane += w * d.dot(around.normal(k));
		plane.square += w * d * d.transpose();
	}
	const NormalSums a    = around.normalSums(place, h);
	const PlaneSums  b    = around.planeSums(place, h);
	const double     near = 1e-8 * normals.weight;
	EXPECT_NEAR(a.weight, normals.weight, near);
	EXPECT_LT((a.offset - normals.offset).norm(), near * h);
	EXPECT_LT((a.normal - normals.normal).norm(), near);
	EXPECT_NEAR(a.plane, normals.plane, near * h);
	EXPECT_NEAR(b.weight, normals.weight, near);
	EXPECT_LT((b.offset - normals.offset).norm(), near * h);
	EXPECT_LT((b.square - plane.square).norm(), near * h * h);

	LocalSamples<1>    heights;
	const TangentFrame frame(around.side());
	around.heights(place, frame, h, heights);
	ASSERT_EQ(heights.size(), around.size());
	for (int k = 0; k < around.size(); ++k) {
		const Vector3d d = (around.position(k) - place) / h;
		EXPECT_NEAR(heights.x[k], d.dot(frame.u), 1e-12);
		EXPECT_NEAR(heights.y[k], d.dot(frame.v), 1e-12);
		EXPECT_NEAR(heights.value[0][k], d.dot(frame.n), 1e-12);
		EXPECT_NEAR(heights.weight[k], std::exp(-d.squaredNorm()), 1e-8);
	}
}

TEST(ControlNeighborhood, UnevenCloudsGiveSomeNeighboursAndNotTooMany)
{
	// A patch much denser than the sheet it is on, and a sheet behind it.
	const auto sparse = sampled("plane", 1600);
	Matrix3Xd  positions(3, 4200), normals = Vector3d::UnitZ().replicate(1, 4200);
	positions << sparse.positions, 0.2 * sampled("plane", 1000).positions,
		sparse.positions.colwise() - Vector3d(0, 0, 0.02);
	normals.rightCols(1600) *= -1.0;
	const Control       control(positions, normals);
	const ControlPoints points(control.index);
	ControlNeighborhood around;
	for (Index i = 0; i < control.index.size(); i += 7) {
		ASSERT_TRUE(around.gather(points, i, 4.4));
		EXPECT_GE(around.size(), 10);
		EXPECT_LE(around.size(), 300);
		EXPECT_GT(around.spacing(), 0.0);
		for (int k = 0; k < around.size(); ++k)
			EXPECT_GT(around.normal(k).dot(normals.col(i)), 0.0);
	}
	EXPECT_FALSE(around.gather(points, Vector3d(3, 3, 3), 4.4));
	EXPECT_FALSE(around.gather(points, Vector3d::Constant(std::nan("")), 4.4));
}

TEST(CurvatureDrivenProjection, DegenerateControlCloudsLeavePointsWhereTheyAre)
{
	for (const Index n : {0, 1, 2, 30}) {
		Matrix3Xd positions = Matrix3Xd::Zero(3, n), normals = Matrix3Xd::Zero(3, n);
		if (n > 0)
			positions.row(0).setLinSpaced(0.0, n > 1 ? 1.0 : 0.0);
		normals.row(2).setOnes();
		const Control         control(positions, normals);
		const Matrix3Xd       queries = Matrix3Xd::Constant(3, 2, 0.01);
		const ProjectedPoints found   = projectPoints(control.surface(), queries);
		EXPECT_EQ(found.positions, queries);
		EXPECT_FALSE(found.projected[0]);
	}
	const Control control(sampled("plane", 100).positions, sampled("plane", 100).normals);
	EXPECT_EQ(projectPoints(control.surface(), Matrix3Xd(3, 0)).positions.cols(), 0);
}

} // namespace
} // namespace curvature_lines::test
