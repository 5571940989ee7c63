// One ray per pixel, more at outlines, then the lines over what the rays met.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_picture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "control_neighborhood.h"
#include "point_cloud.h"
#include "progress.h"
#include "quantile.h"
#include "ray_tracing.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// Appearance of the pictures, chosen by eye.
constexpr Index  colorNeighbors = 8; // control points whose colours are blended
constexpr double ambient        = 0.3;
constexpr double glossShare = 0.12, glossPower = 40.0; // Blinn's highlight
// Neighbouring pixels are on different sides of an outline when the cosine of their normals is less, or their depths
// differ by more spacings.
constexpr double outlineTurn = 0.8;
constexpr double outlineJump = 4.0;
// Lines are drawn when they lie no more than this many spacings behind the surface, so that the error of their projection
// does not hide them.
constexpr double aboveSurface = 1.5;

class Shader {
public:
	Shader(const ControlPoints& control, const Eigen::Matrix3Xd& colors, const Camera& camera) :
			m_control(control), m_colors(colors), m_eye(camera.position)
	{
		const Vector3d forward = (camera.target - camera.position).normalized();
		const Vector3d right = forward.cross(camera.up).normalized(), up = right.cross(forward);
		// From over the left shoulder.
		m_light = (-forward - 0.45 * right + 0.55 * up).normalized();
	}

	Vector3d operator()(const RayHit& hit) const
	{
		const Vector3d toEye  = (m_eye - hit.position).normalized();
		const Vector3d normal = hit.normal.dot(toEye) < 0.0 ? Vector3d(-hit.normal) : hit.normal;
		const double   light  = std::max(0.0, normal.dot(m_light)),
					 front    = std::max(0.0, normal.dot(toEye));
		const double diffuse  = ambient + (1.0 - ambient) * (0.75 * light + 0.25 * front);
		const double gloss =
			glossShare *
			std::pow(std::max(0.0, normal.dot((toEye + m_light).normalized())), glossPower);
		return (diffuse * colorAt(hit.position)).array() + gloss;
	}

private:
	Vector3d colorAt(const Vector3d& position) const
	{
		const auto   near  = m_control.search.nearest(position, colorNeighbors);
		const double reach = (m_control.cloud.positions.col(near.back()) - position).squaredNorm();
		Vector3d     sum   = Vector3d::Zero();
		double       total = 0.0;
		for (const Index j : near) {
			const double w =
				1e-6 + std::max(
						   0.0,
						   1.0 - (m_control.cloud.positions.col(j) - position).squaredNorm() /
									 (reach + 1e-300));
			sum += w * m_colors.col(j);
			total += w;
		}
		return sum / total;
	}

	ControlPoints           m_control;
	const Eigen::Matrix3Xd& m_colors;
	Vector3d                m_eye, m_light;
};

bool isOutline(const RayHit& a, const RayHit& b, double jump)
{
	if (a.exists() != b.exists())
		return true;
	return a.exists() &&
	       (std::abs(a.depth - b.depth) > jump || a.normal.dot(b.normal) < outlineTurn);
}

// Distance in pixels of a pixel's middle from the projected segment, and the depth there.
struct ScreenSegment {
	Eigen::Vector2d from, to;
	double          fromDepth, toDepth;

	std::pair<double, double> nearest(const Eigen::Vector2d& pixel) const
	{
		const Eigen::Vector2d d      = to - from;
		const double          square = d.squaredNorm();
		const double t = square > 0.0 ? std::clamp((pixel - from).dot(d) / square, 0.0, 1.0) : 0.0;
		return {(pixel - from - t * d).norm(), fromDepth + t * (toDepth - fromDepth)};
	}
};

void drawLines(
	const PictureLines&        lines,
	const Camera&              camera,
	const PictureOptions&      options,
	const std::vector<RayHit>& hits,
	double                     spacing,
	Eigen::Matrix3Xd&          pixels)
{
	const int      width = options.image.width, height = options.image.height;
	const Vector3d forward = (camera.target - camera.position).normalized();
	const Vector3d right = forward.cross(camera.up).normalized(), up = right.cross(forward);
	const double   scale =
		0.5 * std::min(width, height) / std::tan(camera.fieldOfView * EIGEN_PI / 360.0);
	const double       half = 0.5 * options.lineWidth;
	std::vector<float> covered(hits.size(), 0.0f);
	Eigen::Matrix3Xd   color = Eigen::Matrix3Xd::Zero(3, pixels.cols());
	const auto         place = [&](Index v, Eigen::Vector2d& at, double& depth) {
        const Vector3d d = lines.vertices.col(v) - camera.position;
        const double   z = d.dot(forward);
        at = {0.5 * width + scale * d.dot(right) / z, 0.5 * height - scale * d.dot(up) / z};
        depth = d.norm();
        return z > 0.0;
	};
	for (std::size_t s = 0; s < lines.segments.size(); ++s) {
		ScreenSegment segment;
		if (!place(lines.segments[s].first, segment.from, segment.fromDepth) ||
		    !place(lines.segments[s].second, segment.to, segment.toDepth))
			continue;
		const auto low  = segment.from.cwiseMin(segment.to).array() - half - 1.0;
		const auto high = segment.from.cwiseMax(segment.to).array() + half + 1.0;
		if (!(high.x() > 0.0 && high.y() > 0.0 && low.x() < width && low.y() < height))
			continue;
		for (int y = std::max(0, int(low.y())); y <= std::min(height - 1.0, high.y()); ++y)
			for (int x = std::max(0, int(low.x())); x <= std::min(width - 1.0, high.x()); ++x) {
				const std::size_t p          = std::size_t(y) * width + x;
				const auto [distance, depth] = segment.nearest({x + 0.5, y + 0.5});
				const auto coverage          = float(std::clamp(half + 0.5 - distance, 0.0, 1.0));
				if (coverage <= covered[p] || !hits[p].exists() ||
				    depth > hits[p].depth + aboveSurface * spacing)
					continue;
				covered[p]   = coverage;
				color.col(p) = lines.colors.col(s);
			}
	}
	for (std::size_t p = 0; p < hits.size(); ++p)
		if (covered[p] > 0.0f)
			pixels.col(p) += covered[p] * (color.col(p) - pixels.col(p));
}

} // namespace

Picture renderPicture(
	const RayTracer&        tracer,
	const ControlPoints&    control,
	const Eigen::Matrix3Xd& colors,
	const PictureLines&     lines,
	const Camera&           camera,
	const PictureOptions&   options,
	const Progress&         progress)
{
	const int  width = options.image.width, height = options.image.height;
	const auto hits =
		traceImage(tracer, camera, options.image, progress.sub(0.0, 0.8, "Tracing rays"));
	std::vector<double> spacings = control.spacing;
	const double        spacing  = spacings.empty() ? 0.0 : medianInPlace(spacings);

	const Shader     shade(control, colors, camera);
	Eigen::Matrix3Xd pixels(3, hits.size());
	const auto       colorOf = [&](const RayHit& hit) {
        return hit.exists() ? shade(hit) : options.background;
	};
	parallelFor(height, progress.sub(0.8, 1.0, "Shading"), [&](Index y) {
		RayTracer::Memory memory;
		for (int x = 0; x < width; ++x) {
			const std::size_t p       = std::size_t(y) * width + x;
			bool              outline = false;
			if (options.smoothOutlines) {
				const double jump = outlineJump * spacing;
				outline           = (x > 0 && isOutline(hits[p], hits[p - 1], jump)) ||
				          (x + 1 < width && isOutline(hits[p], hits[p + 1], jump)) ||
				          (y > 0 && isOutline(hits[p], hits[p - width], jump)) ||
				          (y + 1 < height && isOutline(hits[p], hits[p + width], jump));
			}
			if (!outline) {
				pixels.col(p) = colorOf(hits[p]);
				continue;
			}
			Vector3d sum = Vector3d::Zero();
			aimAt(tracer, camera, options.image, x + 0.5, y + 0.5, 1.0, memory);
			for (const double dx : {0.25, 0.75})
				for (const double dy : {0.25, 0.75})
					sum += colorOf(
						tracer.trace(rayThrough(camera, options.image, x + dx, y + dy), memory));
			pixels.col(p) = 0.25 * sum;
		}
	});
	drawLines(lines, camera, options, hits, spacing, pixels);

	Picture picture{width, height, std::vector<std::uint8_t>(3 * hits.size()), 0};
	for (std::size_t p = 0; p < hits.size(); ++p) {
		picture.hits += hits[p].exists();
		for (int c = 0; c < 3; ++c)
			picture.rgb[3 * p + c] =
				std::uint8_t(std::lround(255.0 * std::clamp(pixels(c, p), 0.0, 1.0)));
	}
	return picture;
}

} // namespace curvature_lines
