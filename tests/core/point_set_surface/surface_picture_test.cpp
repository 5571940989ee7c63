// Pictures of a sphere: its silhouette, the light on it, outlines, and which lines show.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_picture.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>
#include <omp.h>

#include "analytic_surfaces.h"
#include "cloud_index.h"
#include "curvature_driven_projection.h"
#include "point_cloud.h"
#include "ray_tracing.h"

namespace curvature_lines::test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr int width = 91, height = 61; // odd: one pixel is the middle

// The unit sphere, seen from the z axis.
class Scene {
public:
	Scene() : m_index(sphere()), m_surface(m_index)
	{
		options.image.width  = width;
		options.image.height = height;
		camera.position      = {0.0, 0.0, 5.0};
	}

	Matrix3Xd plain(const Vector3d& color) const { return color.replicate(1, m_index.size()); }
	const Matrix3Xd& positions() const { return m_index.cloud().positions; }
	Picture render(const Matrix3Xd& colors, const PictureLines& lines = {}) const
	{
		return renderPicture(
			RayTracer(m_surface, m_index, options.image), m_index, colors, lines, camera, options);
	}

	Camera         camera;
	PictureOptions options;

private:
	static PointCloud sphere()
	{
		samples::SampleRequest request;
		request.surface                   = "sphere";
		request.points                    = 3000;
		request.seed                      = 1;
		const samples::SampleCloud sample = samples::generate(request);
		return {sample.positions, sample.normals};
	}

	const CloudIndex             m_index;
	const CurvatureDrivenSurface m_surface;
};

// Of the sphere's silhouette, in pixels: rays touch it at the angle whose sine is 1 / 5.
double silhouetteRadius(const Camera& camera)
{
	const double distance = camera.position.norm();
	return 0.5 * height / std::tan(camera.fieldOfView * EIGEN_PI / 360.0) /
	       std::sqrt(distance * distance - 1.0);
}

double fromMiddle(int x, int y)
{
	return std::hypot(x + 0.5 - 0.5 * width, y + 0.5 - 0.5 * height);
}

Vector3d pixel(const Picture& picture, int x, int y)
{
	const std::size_t p = 3 * (static_cast<std::size_t>(y) * width + x);
	return Vector3d(picture.rgb[p], picture.rgb[p + 1], picture.rgb[p + 2]) / 255.0;
}

// A line over the sphere from one side to the other, `lift` radii from the middle, in a plane through the z axis.
PictureLines arc(double lift, const Vector3d& color)
{
	PictureLines lines;
	const int    pieces = 40;
	lines.vertices.resize(3, pieces + 1);
	lines.colors = color.replicate(1, pieces);
	for (int k = 0; k <= pieces; ++k) {
		const double angle = (0.2 + 0.6 * k / pieces) * EIGEN_PI;
		lines.vertices.col(k) << lift * std::cos(angle), 0.0, lift * std::sin(angle);
		if (k > 0)
			lines.segments.emplace_back(k - 1, k);
	}
	return lines;
}

const Vector3d gray(0.5, 0.5, 0.5), red(1.0, 0.0, 0.0), blue(0.0, 0.0, 1.0), green(0.0, 1.0, 0.0);

TEST(SurfacePicture, ShowsTheSurfaceInsideItsSilhouetteAndTheBackgroundAround)
{
	Scene scene;
	scene.options.background = {0.2, 0.4, 0.6};
	const Picture picture    = scene.render(scene.plain(gray));
	ASSERT_EQ(picture.width, width);
	ASSERT_EQ(picture.height, height);
	ASSERT_EQ(picture.rgb.size(), 3u * width * height);
	const double radius = silhouetteRadius(scene.camera);
	ASSERT_GT(radius, 20.0);
	EXPECT_NEAR(picture.hits / (EIGEN_PI * radius * radius), 1.0, 0.02);
	for (int y = 0; y < height; ++y)
		for (int x = 0; x < width; ++x) {
			const Vector3d color = pixel(picture, x, y);
			if (fromMiddle(x, y) > radius + 2.0) {
				EXPECT_EQ(color, Vector3d(0.2, 0.4, 0.6)) << x << ' ' << y;
			}
			else if (fromMiddle(x, y) < radius - 2.0) {
				EXPECT_EQ(color.minCoeff(), color.maxCoeff()) << x << ' ' << y; // gray
			}
		}
}

TEST(SurfacePicture, LightComesOverTheLeftShoulderWhateverTheNormalsSay)
{
	Scene         scene;
	const Picture picture = scene.render(scene.plain(gray));
	const int     a       = static_cast<int>(0.6 * silhouetteRadius(scene.camera) / std::sqrt(2.0));
	const auto    light   = [&](int dx, int dy) {
        return pixel(picture, width / 2 + dx, height / 2 + dy).x();
	};
	EXPECT_GT(light(-a, -a), light(a, -a)); // rows go down
	EXPECT_GT(light(-a, -a), light(-a, a));
	EXPECT_GT(light(a, -a), light(a, a));
	EXPECT_GT(light(-a, a), light(a, a));
	EXPECT_GT(light(a, a), 0.0); // nothing is black
	// From within, a sphere is lit as well: its normals point away from the eye.
	scene.camera.position = {0.0, 0.0, 0.5};
	const Picture inside  = scene.render(scene.plain(gray));
	EXPECT_EQ(inside.hits, width * height);
	EXPECT_GT(pixel(inside, width / 2, height / 2).x(), 0.25);
}

TEST(SurfacePicture, ColorsAreThoseOfThePointsAround)
{
	const Scene scene;
	Matrix3Xd   colors = scene.plain(red);
	for (Eigen::Index i = 0; i < colors.cols(); ++i)
		if (scene.positions()(0, i) > 0.0)
			colors.col(i) = blue;
	const Picture picture = scene.render(colors);
	const int     aside   = static_cast<int>(0.5 * silhouetteRadius(scene.camera));
	const auto    left    = pixel(picture, width / 2 - aside, height / 2),
			   right      = pixel(picture, width / 2 + aside, height / 2),
			   middle     = pixel(picture, width / 2, height / 2);
	EXPECT_GT(left.x(), left.z() + 0.3);
	EXPECT_GT(right.z(), right.x() + 0.3);
	EXPECT_LT(std::abs(middle.x() - middle.z()), 0.5 * std::abs(left.x() - left.z())); // blended
}

TEST(SurfacePicture, SmoothOutlinesChangeTheOutlineAlone)
{
	Scene         scene;
	const Picture smooth         = scene.render(scene.plain(gray));
	scene.options.smoothOutlines = false;
	const Picture plain          = scene.render(scene.plain(gray));
	EXPECT_EQ(smooth.hits, plain.hits);
	const double radius = silhouetteRadius(scene.camera);
	int          mixed  = 0;
	for (int y = 0; y < height; ++y)
		for (int x = 0; x < width; ++x) {
			const Vector3d a = pixel(smooth, x, y), b = pixel(plain, x, y);
			EXPECT_TRUE(a == b || std::abs(fromMiddle(x, y) - radius) < 2.0) << x << ' ' << y;
			mixed += a != b;
		}
	EXPECT_GT(mixed, 0.5 * 2.0 * EIGEN_PI * radius);
}

TEST(SurfacePicture, LinesShowInFrontOfTheSurfaceOnly)
{
	Scene scene;
	scene.options.lineWidth = 3.0;
	const Matrix3Xd colors  = scene.plain(gray);
	const Picture   bare = scene.render(colors), front = scene.render(colors, arc(1.0, green)),
				  back = scene.render(colors, arc(-1.0, green));
	EXPECT_EQ(back.rgb, bare.rgb);
	EXPECT_EQ(front.hits, bare.hits);
	int drawn = 0;
	for (int y = 0; y < height; ++y)
		for (int x = 0; x < width; ++x) {
			const bool differs = pixel(front, x, y) != pixel(bare, x, y);
			EXPECT_FALSE(differs && std::abs(y - height / 2) > 2) << x << ' ' << y;
			drawn += differs;
		}
	// Over the angles from 36 to 144 degrees, three pixels wide.
	const double scale  = silhouetteRadius(scene.camera);
	const double length = 2.0 * scale * std::cos(0.2 * EIGEN_PI);
	EXPECT_GT(drawn, 3.0 * 0.9 * length);
	for (const int dx : {-10, 0, 10})
		EXPECT_EQ(pixel(front, width / 2 + dx, height / 2), green);

	// Beside the surface, and behind the camera.
	EXPECT_EQ(scene.render(colors, arc(30.0, green)).rgb, bare.rgb);
	PictureLines beside = arc(1.0, green);
	beside.vertices.row(1).setConstant(1.3);
	EXPECT_EQ(scene.render(colors, beside).rgb, bare.rgb);
}

TEST(SurfacePicture, IsTheSameForAnyThreads)
{
	const Scene     scene;
	const Matrix3Xd colors  = scene.positions().cwiseAbs();
	const int       threads = omp_get_max_threads();
	const Picture   two     = scene.render(colors, arc(1.0, red));
	omp_set_num_threads(1);
	const Picture one = scene.render(colors, arc(1.0, red));
	omp_set_num_threads(threads);
	EXPECT_EQ(one.rgb, two.rgb);
	EXPECT_EQ(one.hits, two.hits);
}

} // namespace
} // namespace curvature_lines::test
