// Ray tracing of point-set surfaces against exact surfaces; silhouettes, boundaries, cameras, threads, bad input.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "curvature_driven_projection.h"
#include "moving_least_squares.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "point_set_surface.h"
#include "ray_tracing.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

struct Scene {
	explicit Scene(const std::string& surface, int points) : Scene(cloudOf(surface, points)) {}
	explicit Scene(const PointCloud& points) : index(points) {}
	static PointCloud cloudOf(const std::string& surface, int points)
	{
		samples::SampleRequest request;
		request.surface   = surface;
		request.points    = points;
		request.seed      = 1;
		const auto sample = samples::generate(request);
		return {sample.positions, sample.normals};
	}
	const PointCloud& cloud() const { return index.cloud(); }
	double spacing() const { return index.minimum().medianSpacing; }

	const CloudIndex index;
};

RayTracingOptions small(int width = 60, int height = 40)
{
	RayTracingOptions options;
	options.width  = width;
	options.height = height;
	return options;
}

TEST(Camera, IsUprightUnlessUpRunsAlongTheView)
{
	Camera camera;
	EXPECT_TRUE(camera.isUpright());
	camera.up = camera.position - camera.target;
	EXPECT_FALSE(camera.isUpright());
	camera        = {};
	camera.target = camera.position; // no view at all
	EXPECT_FALSE(camera.isUpright());
}

TEST(RayTracing, SphereIsMetWhereTheFormulaSays)
{
	const Scene                     scene("sphere", 4000);
	const CurvatureDrivenSurface    driven(scene.index);
	const MovingLeastSquaresSurface squares(scene.index);
	for (const PointSetSurface* surface :
	     {static_cast<const PointSetSurface*>(&driven),
	      static_cast<const PointSetSurface*>(&squares)}) {
		const RayTracer tracer(*surface, scene.index, {});
		int             wrong = 0, rays = 0;
		for (double x = -1.1; x <= 1.1; x += 0.1)
			for (double y = -1.1; y <= 1.1; y += 0.1, ++rays) {
				const RayHit hit    = tracer.trace({Vector3d(x, y, 5.0), -Vector3d::UnitZ()});
				const double square = 1.0 - x * x - y * y;
				if (std::abs(std::sqrt(x * x + y * y) - 1.0) < 0.01)
					continue; // the silhouette itself
				wrong += hit.exists() != (square > 0.0);
				if (!hit.exists() || square <= 0.0)
					continue;
				EXPECT_NEAR(
					hit.depth, 5.0 - std::sqrt(square), 0.1 * scene.spacing() / std::sqrt(square));
				EXPECT_GT(hit.normal.dot(hit.position.normalized()), 0.999);
			}
		EXPECT_LE(wrong, rays / 200);
	}
}

TEST(RayTracing, BothSurfacesShowTheSamePicture)
{
	const Scene                     scene("torus", 5000);
	const Camera                    camera = Camera::facing(scene.cloud(), 1.5);
	const CurvatureDrivenSurface    driven(scene.index);
	const MovingLeastSquaresSurface squares(scene.index);
	const auto                      options = small(120, 80);
	const auto a      = traceImage(RayTracer(driven, scene.index, options), camera, options);
	const auto b      = traceImage(RayTracer(squares, scene.index, options), camera, options);
	int        differ = 0, both = 0, seen = 0;
	double     depth = 0.0;
	for (std::size_t p = 0; p < a.size(); ++p) {
		differ += a[p].exists() != b[p].exists();
		seen += a[p].exists();
		if (a[p].exists() && b[p].exists()) {
			depth += std::abs(a[p].depth - b[p].depth);
			++both;
		}
	}
	EXPECT_GT(seen, 1500); // the camera sees it large
	EXPECT_LE(differ, int(a.size()) / 200);
	EXPECT_LT(depth / both, 0.2 * scene.spacing());
}

TEST(RayTracing, CameraSeesAllPointsAndTheFrontOfAScan)
{
	const Scene  scene("bent_sheet", 1000);
	const Camera camera = Camera::facing(scene.cloud(), 1.5);
	EXPECT_GT((camera.position - camera.target).dot(scene.cloud().normals.rowwise().mean()), 0.0);
	const auto options = small();
	const Ray  middle  = rayThrough(camera, options, 30.0, 20.0);
	EXPECT_LT(middle.direction.cross(camera.target - camera.position).norm(), 1e-9);
	const Vector3d right = middle.direction.cross(camera.up).normalized(),
				   up    = right.cross(middle.direction);
	const double half    = std::tan(camera.fieldOfView * EIGEN_PI / 360.0);
	for (Index i = 0; i < scene.cloud().size(); ++i) {
		const Vector3d d = scene.cloud().positions.col(i) - camera.position;
		EXPECT_LE(std::abs(d.dot(right) / d.dot(middle.direction)), 1.5 * half);
		EXPECT_LE(std::abs(d.dot(up) / d.dot(middle.direction)), half);
	}
}

TEST(RayTracing, OpenSurfaceEndsNearItsRim)
{
	const Scene                  scene("plane", 2000); // the unit square
	const CurvatureDrivenSurface surface(scene.index);
	const RayTracer              tracer(surface, scene.index, {});
	const Eigen::AlignedBox3d    box = samples::surface("plane").boundingBox();
	const double                 s   = scene.spacing();
	for (double along = 0.05; along < 1.0; along += 0.05) {
		const Vector3d rim = box.min() + Vector3d(along * box.sizes().x(), 0, 0);
		EXPECT_TRUE(tracer.trace({rim + Vector3d(0, 2 * s, 1), -Vector3d::UnitZ()}).exists());
		EXPECT_FALSE(tracer.trace({rim + Vector3d(0, -4 * s, 1), -Vector3d::UnitZ()}).exists());
	}
	// From behind as well, with the same normal.
	const RayHit back = tracer.trace({box.center() - Vector3d::UnitZ(), Vector3d::UnitZ()});
	ASSERT_TRUE(back.exists());
	EXPECT_NEAR(back.depth, 1.0, 1e-6);
	EXPECT_GT(back.normal.z(), 0.99);
	// Nothing behind the eye.
	EXPECT_FALSE(tracer.trace({box.center() - Vector3d::UnitZ(), -Vector3d::UnitZ()}).exists());
}

TEST(RayTracing, RaysOfABlockMeetWhatTheyMeetAlone)
{
	const Scene                  scene("torus", 2000);
	const CurvatureDrivenSurface surface(scene.index);
	const auto                   options = small();
	const RayTracer              tracer(surface, scene.index, options);
	const Camera                 camera = Camera::facing(scene.cloud(), 1.5);
	const auto                   hits   = traceImage(tracer, camera, options);
	for (int y = 0; y < options.height; ++y)
		for (int x = 0; x < options.width; ++x)
			EXPECT_EQ(
				hits[y * options.width + x].depth,
				tracer.trace(rayThrough(camera, options, x + 0.5, y + 0.5)).depth);
}

TEST(RayTracing, ClosedShapesWithSharpEdgesHideTheirBacks)
{
	for (const char* shape : {"cube", "torus"}) {
		const Scene                     scene(shape, 6000);
		const CurvatureDrivenSurface    driven(scene.index);
		const MovingLeastSquaresSurface squares(scene.index);
		const auto                      options = small(150, 100);
		const Camera                    camera  = Camera::facing(scene.cloud(), 1.5);
		for (const PointSetSurface* surface :
		     {static_cast<const PointSetSurface*>(&driven),
		      static_cast<const PointSetSurface*>(&squares)}) {
			const auto hits =
				traceImage(RayTracer(*surface, scene.index, options), camera, options);
			int seen = 0, backs = 0, holes = 0;
			for (int y = 1; y + 1 < options.height; ++y)
				for (int x = 1; x + 1 < options.width; ++x) {
					const auto at = [&](int dx, int dy) {
						return hits[(y + dy) * options.width + x + dx];
					};
					const RayHit& hit = at(0, 0);
					seen += hit.exists();
					backs += hit.exists() &&
					         hit.normal.dot(camera.position - hit.position) < -0.1 * hit.depth;
					holes += !hit.exists() && at(-1, 0).exists() && at(1, 0).exists() &&
					         at(0, -1).exists() && at(0, 1).exists();
				}
			EXPECT_GT(seen, 2500);
			EXPECT_LE(backs, seen / 250) << shape; // along outlines
			EXPECT_LE(holes, seen / 1000) << shape;
		}
	}
}

// A plate, its rims sampled like its sides, points on edges and corners with the mean normal.
PointCloud plate(double thickness, int across)
{
	const double          spacing = 1.0 / across;
	const int             layers  = int(std::lround(thickness / spacing));
	std::vector<Vector3d> positions, normals;
	const auto            side = [](int k, int last) { return double(k == last) - double(k == 0); };
	for (int i = 0; i <= across; ++i)
		for (int j = 0; j <= across; ++j)
			for (int k = 0; k <= layers; ++k) {
				const Vector3d normal(side(i, across), side(j, across), side(k, layers));
				if (normal.isZero())
					continue;
				positions.push_back(
					Vector3d(i * spacing - 0.5, j * spacing - 0.5, k * spacing - 0.5 * thickness));
				normals.push_back(normal.normalized());
			}
	PointCloud cloud{Matrix3Xd(3, positions.size()), Matrix3Xd(3, positions.size())};
	for (std::size_t p = 0; p < positions.size(); ++p) {
		cloud.positions.col(p) = positions[p];
		cloud.normals.col(p)   = normals[p];
	}
	return cloud;
}

bool meetsBox(const Ray& ray, const Vector3d& half)
{
	const Eigen::Array3d inverse = ray.direction.array().inverse();
	const Eigen::Array3d a       = (-half - ray.origin).array() * inverse,
						 b       = (half - ray.origin).array() * inverse;
	return a.min(b).maxCoeff() < a.max(b).minCoeff();
}

TEST(RayTracing, ThinPlatesHaveNoHolesAndCleanOutlines)
{
	const int    across  = 30;
	const double spacing = 1.0 / across;
	for (const double thickness : {2.0 * spacing, 4.0 * spacing}) {
		const Scene                     scene(plate(thickness, across));
		const CurvatureDrivenSurface    driven(scene.index);
		const MovingLeastSquaresSurface squares(scene.index);
		const Vector3d                  half(0.5, 0.5, 0.5 * thickness);
		for (const PointSetSurface* surface :
		     {static_cast<const PointSetSurface*>(&driven),
		      static_cast<const PointSetSurface*>(&squares)})
			for (const Vector3d& tilt :
			     {Vector3d(0.02, 0.01, 1.0),
			      Vector3d(0.2, 0.05, 1.0),
			      Vector3d(0.4, 0.3, 1.0),
			      Vector3d(1.0, 0.2, 0.1)}) {
				const RayTracer    tracer(*surface, scene.index, {});
				const Vector3d     direction = -tilt.normalized();
				const TangentFrame frame(direction);
				int                holes = 0, strays = 0, inside = 0;
				// Fitted planes know no normals: at corners they may stick out a little.
				const double outside = surface == &driven ? 0.25 : 1.0;
				SCOPED_TRACE(surface == &driven ? "curvature-driven" : "moving least squares");
				for (double x = -0.9; x < 0.9; x += 0.017)
					for (double y = -0.9; y < 0.9; y += 0.017) {
						const Ray  ray{x * frame.u + y * frame.v - 3.0 * direction, direction};
						const bool hit  = tracer.trace(ray).exists();
						const bool deep = meetsBox(ray, half.array() - 0.8 * spacing);
						inside += deep;
						holes += deep && !hit;
						strays += hit && !meetsBox(ray, half.array() + outside * spacing);
					}
				EXPECT_GT(inside, 100);
				EXPECT_EQ(holes, 0) << thickness << ", from " << tilt.transpose();
				EXPECT_EQ(strays, 0) << thickness << ", from " << tilt.transpose();
			}
	}
}

TEST(RayTracing, NumberOfThreadsChangesNothing)
{
	const Scene                  scene("torus", 1500);
	const CurvatureDrivenSurface surface(scene.index);
	const auto                   options = small();
	const RayTracer              tracer(surface, scene.index, options);
	const Camera                 camera  = Camera::facing(scene.cloud(), 1.5);
	const int                    threads = omp_get_max_threads();
	omp_set_num_threads(1);
	const auto one = traceImage(tracer, camera, options);
	omp_set_num_threads(3);
	const auto three = traceImage(tracer, camera, options);
	omp_set_num_threads(threads);
	for (std::size_t p = 0; p < one.size(); ++p)
		EXPECT_EQ(one[p].depth, three[p].depth);
}

TEST(RayTracing, FewPointsAreNoSurfaceAndARowOfThemAStripAtMost)
{
	for (const Index n : {0, 1, 2, 30}) {
		PointCloud cloud{Matrix3Xd::Zero(3, n), Matrix3Xd::Zero(3, n)};
		if (n > 0)
			cloud.positions.row(0).setLinSpaced(0.0, n > 1 ? 1.0 : 0.0);
		cloud.normals.row(2).setOnes();
		const Scene                  scene(cloud);
		const CurvatureDrivenSurface surface(scene.index);
		const auto                   options = small(16, 16);
		const Camera                 camera  = Camera::facing(scene.cloud(), 1.0);
		for (const RayHit& hit :
		     traceImage(RayTracer(surface, scene.index, options), camera, options)) {
			EXPECT_TRUE(n == 30 || !hit.exists());
			EXPECT_NEAR(hit.position.z(), 0.0, 1e-9);
		}
	}
}

} // namespace
} // namespace curvature_lines::test
