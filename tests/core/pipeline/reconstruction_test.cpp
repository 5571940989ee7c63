// The whole pipeline on exact surfaces: topology and distance of the mesh, what each switch does,
// threads, progress, degenerate clouds.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "curvature_estimate.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "progress.h"
#include "reconstruction.h"
#include "stages.h"

namespace curvature_lines {
namespace {

struct Scan {
	samples::SampleCloud sample;
	PreparedCloud        prepared;
};

Scan scanOf(const samples::SampleRequest& request)
{
	Scan scan{samples::generate(request), {}};
	scan.prepared = prepareCloud(scan.sample.positions, scan.sample.normals);
	return scan;
}

samples::SampleRequest torus(int points, double noise = 0.0, double outliers = 0.0)
{
	samples::SampleRequest request;
	request.points      = points;
	request.noise       = noise;
	request.farOutliers = outliers;
	request.seed        = 7;
	return request;
}

// RMS distance of unit-frame points to the surface, as a fraction of its diagonal.
double
distanceTo(const std::string& name, const PreparedCloud& frame, const Eigen::Matrix3Xd& positions)
{
	const samples::AnalyticSurface& surface = samples::surface(name);
	double                          sum     = 0.0;
	for (Eigen::Index i = 0; i < positions.cols(); ++i) {
		const Eigen::Vector3d p = frame.toModel(positions.col(i));
		sum += (p - surface.project(p)).squaredNorm();
	}
	return std::sqrt(sum / double(positions.cols())) / surface.diagonal();
}

using Method = ReconstructionOptions::Method;

ReconstructionOptions quick(Method method = Method::PositionField)
{
	ReconstructionOptions options;
	options.method         = method;
	options.rejectOutliers = false;
	options.denoise        = false;
	return options;
}

TEST(Reconstruction, CleanTorusIsAQuadDominantTorus)
{
	const Scan scan = scanOf(torus(2000));
	for (const Method method : {Method::PositionField, Method::TracedLines}) {
		const ReconstructionResult result = reconstruct(scan.prepared.cloud, quick(method));
		const MeshTopology&        t      = result.mesh.topology;
		EXPECT_EQ(t.eulerCharacteristic, 0);
		EXPECT_EQ(t.components, 1);
		EXPECT_EQ(t.boundaryEdges, 0);
		EXPECT_EQ(t.nonmanifoldEdges, 0);
		EXPECT_GT(t.quads, (method == Method::PositionField ? 0.97 : 0.6) * t.faces);
		EXPECT_LT(distanceTo("torus", scan.prepared, result.mesh.mesh.vertices), 0.001);
		if (method == Method::TracedLines) {
			EXPECT_LT(distanceTo("torus", scan.prepared, result.lines.vertices), 0.001);
		}
	}
}

// Of random points on a cube: the creases are found, and the twelve edges are edges of the mesh.
TEST(Reconstruction, CubeKeepsItsEdges)
{
	samples::SampleRequest request;
	request.surface                   = "cube";
	request.points                    = 6000;
	request.seed                      = 2;
	const Scan                 scan   = scanOf(request);
	const ReconstructionResult result = reconstruct(scan.prepared.cloud, quick());
	EXPECT_EQ(result.creases.curves.size(), 12u);
	EXPECT_EQ(result.mesh.topology.eulerCharacteristic, 2);
	EXPECT_EQ(result.mesh.topology.boundaryEdges, 0);
	EXPECT_GT(result.mesh.topology.quads, 0.98 * result.mesh.topology.faces);
	const Eigen::Matrix3Xd& vertices = result.mesh.mesh.vertices;
	Index                   onEdges  = 0;
	for (Eigen::Index i = 0; i < vertices.cols(); ++i) {
		Eigen::Array3d to = 0.5 - scan.prepared.toModel(vertices.col(i)).array().abs();
		std::sort(
			to.data(), to.data() + 3, [](double a, double b) { return std::abs(a) < std::abs(b); });
		onEdges += std::abs(to[0]) < 0.003 && std::abs(to[1]) < 0.003;
	}
	EXPECT_GT(onEdges, 12 * 4);
}

TEST(Reconstruction, DirtyScanIsCleanedAndStaysManifold)
{
	const Scan                 scan   = scanOf(torus(1500, 0.005, 0.03));
	const ReconstructionResult result = reconstruct(scan.prepared.cloud);
	const MeshTopology&        t      = result.mesh.topology;
	EXPECT_EQ(t.nonmanifoldEdges, 0);
	EXPECT_GT(t.quads, 0.5 * t.faces);
	EXPECT_LT(distanceTo("torus", scan.prepared, result.mesh.mesh.vertices), 0.005);
	EXPECT_LT(
		distanceTo("torus", scan.prepared, result.cloud.positions),
		0.5 * distanceTo("torus", scan.prepared, scan.prepared.cloud.positions));
	EXPECT_GT(result.rmsMove, 0.0);
}

TEST(Reconstruction, DenoisesRobustlyUnlessToldToDoAsPublished)
{
	const Scan   scan   = scanOf(torus(1500, 0.005));
	const double before = distanceTo("torus", scan.prepared, scan.prepared.cloud.positions);
	ReconstructionOptions options     = quick();
	options.denoise                   = true;
	const ReconstructionResult robust = reconstruct(scan.prepared.cloud, options);
	EXPECT_LT(distanceTo("torus", scan.prepared, robust.cloud.positions), 0.3 * before);
	EXPECT_NEAR(robust.noise, 0.005, 0.001);
	options.denoising.method         = DenoisingOptions::Method::Paper;
	const ReconstructionResult paper = reconstruct(scan.prepared.cloud, options);
	EXPECT_LT(distanceTo("torus", scan.prepared, paper.cloud.positions), 0.7 * before);
	EXPECT_EQ(paper.noise, 0.0);
	for (const ReconstructionResult* result : {&robust, &paper}) {
		EXPECT_GT(result->rmsMove, 0.0);
		EXPECT_LT((surfaceNormals(result->field) - result->cloud.normals).norm(), 1e-9);
		EXPECT_EQ(result->seconds.count("denoising"), 1u);
	}
}

TEST(Reconstruction, KeptPointsAndOutliersAreThePartsOfTheInput)
{
	const Scan            scan        = scanOf(torus(1000, 0.002, 0.05));
	ReconstructionOptions options     = quick();
	options.rejectOutliers            = true;
	const ReconstructionResult result = reconstruct(scan.prepared.cloud, options);
	const Index                n      = scan.prepared.cloud.size();
	ASSERT_EQ(static_cast<Index>(result.outlier.size()), n);
	ASSERT_EQ(result.cloud.size(), static_cast<Index>(result.kept.size()));
	EXPECT_EQ(
		result.cloud.size(), n - std::count(result.outlier.begin(), result.outlier.end(), char(1)));
	EXPECT_LT(result.cloud.size(), n);
	EXPECT_TRUE(std::is_sorted(result.kept.begin(), result.kept.end()));
	for (Index i = 0; i < result.cloud.size(); ++i) {
		EXPECT_FALSE(result.outlier[result.kept[i]]);
		EXPECT_EQ(result.cloud.positions.col(i), scan.prepared.cloud.positions.col(result.kept[i]));
	}
}

TEST(Reconstruction, ThinsCloudsMuchDenserThanTheMesh)
{
	const Scan            scan         = scanOf(torus(24000));
	ReconstructionOptions options      = quick();
	options.tracing.targetVertices     = 500;
	const ReconstructionResult thinned = reconstruct(scan.prepared.cloud, options);
	EXPECT_NEAR(thinned.cloud.size(), 20000, 500);
	EXPECT_TRUE(std::is_sorted(thinned.kept.begin(), thinned.kept.end()));
	EXPECT_EQ(thinned.seconds.count("sampling"), 1u);
	EXPECT_EQ(thinned.mesh.topology.eulerCharacteristic, 0);
	EXPECT_EQ(thinned.mesh.topology.boundaryEdges, 0);
	EXPECT_LT(distanceTo("torus", scan.prepared, thinned.mesh.mesh.vertices), 0.001);
	for (Index i = 0; i < thinned.cloud.size(); i += 100)
		EXPECT_EQ(
			thinned.cloud.positions.col(i), scan.prepared.cloud.positions.col(thinned.kept[i]));

	options.pointsPerVertex = 0.0;
	EXPECT_EQ(reconstruct(scan.prepared.cloud, options).cloud.size(), scan.prepared.cloud.size());
}

TEST(Reconstruction, SwitchedOffStagesTakeNoTimeAndChangeNothing)
{
	const Scan            scan        = scanOf(torus(800));
	ReconstructionOptions options     = quick(Method::TracedLines);
	options.smoothDirections          = false;
	const ReconstructionResult result = reconstruct(scan.prepared.cloud, options);
	EXPECT_EQ(result.cloud.positions, scan.prepared.cloud.positions);
	EXPECT_EQ(result.cloud.normals, result.field.correctedNormals);
	EXPECT_LT((result.cloud.normals - scan.prepared.cloud.normals).colwise().norm().mean(), 0.01);
	EXPECT_EQ(result.rmsMove, 0.0);
	for (const char* stage : {"outliers", "denoising", "directions"})
		EXPECT_EQ(result.seconds.count(stage), 0u) << stage;
	for (const char* stage :
	     {"neighborhoods", "curvature", "umbilics", "voronoi", "tracing", "mesh"})
		EXPECT_EQ(result.seconds.count(stage), 1u) << stage;
	const ReconstructionResult field = reconstruct(scan.prepared.cloud, quick());
	for (const char* stage : {"neighborhoods", "curvature", "creases", "mesh"})
		EXPECT_EQ(field.seconds.count(stage), 1u) << stage;
	EXPECT_EQ(field.seconds.count("tracing"), 0u);
}

// The published scale leaves the normals to denoising; the directions are tangent to them either way.
TEST(Reconstruction, BothScaleModes)
{
	const Scan            scan    = scanOf(torus(1000));
	ReconstructionOptions options = quick();
	for (const ScaleMode mode : {ScaleMode::Adaptive, ScaleMode::Paper}) {
		options.curvature.scaleMode       = mode;
		const ReconstructionResult result = reconstruct(scan.prepared.cloud, options);
		EXPECT_EQ(result.cloud.normals == scan.prepared.cloud.normals, mode == ScaleMode::Paper);
		EXPECT_LT((surfaceNormals(result.field) - result.cloud.normals).norm(), 1e-9);
		EXPECT_EQ(result.mesh.topology.eulerCharacteristic, 0);
		EXPECT_GT(result.mesh.topology.quads, 0.6 * result.mesh.topology.faces);
	}
}

TEST(Reconstruction, DensityFollowsTheCloudUnlessGiven)
{
	const Scan            scan     = scanOf(torus(1200));
	ReconstructionOptions options  = quick();
	const auto            vertices = [&] {
        return double(reconstruct(scan.prepared.cloud, options).mesh.topology.vertices);
	};
	EXPECT_NEAR(vertices(), automaticTargetVertices(1200), 0.5 * automaticTargetVertices(1200));
	options.tracing.targetVertices = 50;
	EXPECT_NEAR(vertices(), 50, 25);
	options.tracing.targetVertices = 0;
	options.tracing.epsilon        = 0.02;
	const double coarse            = vertices();
	options.tracing.epsilon        = 0.001; // both above what goes around the tube at least
	EXPECT_LT(coarse, vertices());
	options.method = Method::TracedLines;
	EXPECT_LT(coarse, vertices());
}

TEST(Reconstruction, IsTheSameForAnyNumberOfThreads)
{
	const Scan scan    = scanOf(torus(600, 0.003));
	const int  threads = omp_get_max_threads();
	omp_set_num_threads(1);
	const ReconstructionResult one = reconstruct(scan.prepared.cloud);
	omp_set_num_threads(3);
	const ReconstructionResult three = reconstruct(scan.prepared.cloud);
	omp_set_num_threads(threads);
	EXPECT_EQ(one.outlier, three.outlier);
	EXPECT_EQ(one.cloud.positions, three.cloud.positions);
	ASSERT_EQ(one.mesh.mesh.vertexCount(), three.mesh.mesh.vertexCount());
	EXPECT_EQ(one.mesh.mesh.vertices, three.mesh.mesh.vertices);
	EXPECT_EQ(one.mesh.mesh.faces.indices, three.mesh.mesh.faces.indices);
}

TEST(Reconstruction, ProgressGoesForwardToTheEndAndCancels)
{
	const Scan scan = scanOf(torus(800));
	double     last = 0.0;
	reconstruct(scan.prepared.cloud, quick(), Progress([&](double fraction, const char*) {
					EXPECT_GE(fraction, last - 1e-12);
					last = fraction;
					return true;
				}));
	EXPECT_DOUBLE_EQ(last, 1.0);

	for (const double stop : {0.1, 0.5, 0.9})
		EXPECT_THROW(
			reconstruct(scan.prepared.cloud, quick(), Progress([&](double fraction, const char*) {
							return fraction < stop;
						})),
			Cancelled);
}

TEST(Reconstruction, SmallAndFlatCloudsEndInAMeshOrAnInputError)
{
	for (const int points : {20, 40, 100})
		for (const char* name : {"plane", "sphere", "cube"}) {
			samples::SampleRequest request;
			request.surface = name;
			request.points  = points;
			request.seed    = 3;
			try {
				const ReconstructionResult result = reconstruct(scanOf(request).prepared.cloud);
				EXPECT_TRUE(result.mesh.mesh.vertices.allFinite()) << name << points;
				EXPECT_EQ(result.mesh.topology.nonmanifoldEdges, 0) << name << points;
			}
			catch (const InputError& error) {
				EXPECT_GT(std::string(error.what()).size(), 20u) << name << points;
			}
		}
}

} // namespace
} // namespace curvature_lines
