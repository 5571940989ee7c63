// Spheres in a bounding volume hierarchy (Eigen's), and the fixed-point loop along a ray.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "ray_tracing.h"

#include <algorithm>
#include <cmath>

#include <unsupported/Eigen/BVH>

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

constexpr Index  sphereNeighbor = 6;
constexpr double sphereFactor   = 1.5; // radius over the distance of that neighbour
constexpr double largestSphere  = 3.0; // spacings: lonely points enclose no surface
constexpr int    tile           = 16;  // pixels

struct Sphere {
	Vector3d center;
	double   radius;
};

using SphereTree = Eigen::KdBVH<double, 3, Index>;

// Where a ray is inside of a sphere, and its parameter closest to the centre.
struct Passage {
	double enter, exit, closest;
	Index  sphere;
};

// All spheres a ray passes.
struct PassageCollector {
	const std::vector<Sphere>& spheres;
	const Ray&                 ray;
	const Vector3d             inverse;
	std::vector<Passage>&      passages;

	bool intersectVolume(const SphereTree::Volume& box) const
	{
		double first = 0.0, last = std::numeric_limits<double>::infinity();
		for (int c = 0; c < 3; ++c) {
			double a = (box.min()[c] - ray.origin[c]) * inverse[c];
			double b = (box.max()[c] - ray.origin[c]) * inverse[c];
			if (a > b)
				std::swap(a, b);
			first = a > first ? a : first; // not std::max: of 0 * infinity nothing follows
			last  = b < last ? b : last;
		}
		return first <= last;
	}
	bool intersectObject(Index s)
	{
		const Vector3d d       = spheres[s].center - ray.origin;
		const double   closest = d.dot(ray.direction);
		const double   square  = spheres[s].radius * spheres[s].radius - d.squaredNorm() + closest * closest;
		if (square > 0.0 && closest + std::sqrt(square) > 0.0)
			passages.push_back({closest - std::sqrt(square), closest + std::sqrt(square), closest, s});
		return false;
	}
};

// The root of the quadric along `direction` from `start` (both in space) that is nearest to start; where there
// is none, the place of closest approach, and `found` is false.
double stepToQuadric(
	const LocalQuadric& q, const Vector3d& start, const Vector3d& direction, bool& found)
{
	const Vector3d d  = start - q.origin;
	const double   x  = d.dot(q.u), y = d.dot(q.v), z = d.dot(q.n);
	const double   dx = direction.dot(q.u), dy = direction.dot(q.v), dz = direction.dot(q.n);
	const double   a  = q.c[3] * dx * dx + q.c[4] * dx * dy + q.c[5] * dy * dy;
	const double   b  = q.c[1] * dx + q.c[2] * dy + 2.0 * q.c[3] * x * dx + q.c[4] * (x * dy + y * dx) +
		2.0 * q.c[5] * y * dy - dz;
	const double c            = q.height(x, y) - z;
	const double discriminant = b * b - 4.0 * a * c;
	found                     = discriminant >= 0.0 && (a != 0.0 || b != 0.0);
	if (!found)
		return a != 0.0 ? -0.5 * b / a : 0.0;
	// The smaller root, without cancellation.
	const double large = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
	return large != 0.0 ? c / large : 0.0;
}

} // namespace

Camera Camera::facing(const PointCloud& cloud, double aspectRatio, double fieldOfView)
{
	Camera camera;
	camera.fieldOfView = fieldOfView;
	if (cloud.size() == 0)
		return camera;
	const Vector3d low = cloud.positions.rowwise().minCoeff(), high = cloud.positions.rowwise().maxCoeff();
	camera.target          = 0.5 * (low + high);
	const Vector3d outward = cloud.normals.rowwise().mean();
	// Of a closed surface normals cancel.
	Vector3d from = Vector3d(0.45, 0.35, 1.0);
	if (outward.norm() > 0.2)
		from = outward.normalized() + Vector3d(0.1, 0.15, 0.05);
	from.normalize();
	camera.up = std::abs(from.y()) > 0.95 ? Vector3d(0, 0, -1) : Vector3d(0, 1, 0);

	// The nearest place from which all points are in the picture.
	const Vector3d right = (-from).cross(camera.up).normalized(), up = right.cross(-from);
	const double   half  = std::tan(camera.fieldOfView * EIGEN_PI / 360.0) / 1.06;
	const double   wide = half * std::max(1.0, aspectRatio), tall = half * std::max(1.0, 1.0 / aspectRatio);
	double         distance = 0.0;
	for (Index i = 0; i < cloud.size(); ++i) {
		const Vector3d d = cloud.positions.col(i) - camera.target;
		distance         = std::max(
            {distance,
			         d.dot(from) + std::abs(d.dot(right)) / wide,
			         d.dot(from) + std::abs(d.dot(up)) / tall});
	}
	camera.position = camera.target + std::max(distance, 1e-9) * from;
	return camera;
}

Ray rayThrough(const Camera& camera, const RayTracingOptions& image, double column, double row)
{
	const Vector3d forward = (camera.target - camera.position).normalized();
	const Vector3d right = forward.cross(camera.up).normalized(), up = right.cross(forward);
	const double   pixel = 2.0 * std::tan(camera.fieldOfView * EIGEN_PI / 360.0) / std::min(image.width, image.height);
	return {
		camera.position,
		(forward + pixel * (column - 0.5 * image.width) * right - pixel * (row - 0.5 * image.height) * up)
			.normalized()};
}

struct RayTracer::Spheres {
	std::vector<Sphere> all;
	SphereTree          tree;
};

RayTracer::RayTracer(
	const PointSetSurface& surface, const ControlPoints& control, const RayTracingOptions& options) :
		m_surface(surface), m_options(options)
{
	const Index n       = control.cloud.size();
	auto        spheres = std::make_unique<Spheres>();
	spheres->all.resize(n);
	parallelFor(n, {}, [&](Index i) {
		const Vector3d center = control.cloud.positions.col(i);
		const auto     near   = control.search.nearest(center, sphereNeighbor + 1);
		const double   radius = sphereFactor * (control.cloud.positions.col(near.back()) - center).norm();
		spheres->all[i]       = {center, std::min(radius, largestSphere * control.spacing[i])};
	});
	std::vector<Index>             indices(n);
	std::vector<SphereTree::Volume> boxes(n);
	for (Index i = 0; i < n; ++i) {
		const auto& [center, radius] = spheres->all[i];
		indices[i]                   = i;
		boxes[i] = {center - Vector3d::Constant(radius), center + Vector3d::Constant(radius)};
	}
	if (n > 0)
		spheres->tree.init(indices.begin(), indices.end(), boxes.begin(), boxes.end());
	m_spheres = std::move(spheres);
}

RayTracer::~RayTracer() = default;

RayHit RayTracer::traceInSphere(const Ray& ray, const Vector3d& center, double radius) const
{
	RayHit hit;
	double t     = (center - ray.origin).dot(ray.direction);
	bool   found = true;
	for (int it = 0; it < m_options.maxIterations; ++it) {
		const Vector3d                    point   = ray.origin + t * ray.direction;
		const std::optional<LocalQuadric> quadric = m_surface.near(point);
		if (!quadric)
			return hit;
		const bool   before = found;
		const double step   = stepToQuadric(*quadric, point, ray.direction, found);
		t += step;
		const Vector3d moved = ray.origin + t * ray.direction;
		// A quadric that the ray misses tells little at a distance: a nearer one has to confirm it.
		if (!(found || before) || (moved - center).squaredNorm() > radius * radius || !(t > 0.0))
			return hit;
		if (found && std::abs(step) < m_options.tolerance * quadric->spacing) {
			hit.depth    = t;
			hit.position = moved;
			hit.normal   = quadric->normalAt(moved);
			return hit;
		}
	}
	return hit;
}

RayHit RayTracer::trace(const Ray& ray) const
{
	RayHit best;
	if (m_spheres->all.empty())
		return best;
	thread_local std::vector<Passage> passages;
	passages.clear();
	PassageCollector collector{m_spheres->all, ray, ray.direction.cwiseInverse(), passages};
	Eigen::BVIntersect(m_spheres->tree, collector);
	std::sort(passages.begin(), passages.end(), [](const Passage& a, const Passage& b) {
		return a.enter != b.enter ? a.enter < b.enter : a.sphere < b.sphere;
	});
	// Spheres that hold the hit already found would find it again: only what lies before it is of interest.
	for (const Passage& passage : passages) {
		if (passage.enter > best.depth)
			break;
		if (passage.exit > best.depth)
			continue;
		const Sphere& sphere = m_spheres->all[passage.sphere];
		const RayHit  hit    = traceInSphere(ray, sphere.center, sphere.radius);
		if (hit.depth < best.depth)
			best = hit;
	}
	return best;
}

std::vector<RayHit> traceImage(
	const RayTracer&         tracer,
	const Camera&            camera,
	const RayTracingOptions& options,
	const Progress&          progress)
{
	std::vector<RayHit> hits(std::size_t(options.width) * options.height);
	const int           columns = (options.width + tile - 1) / tile, rows = (options.height + tile - 1) / tile;
	parallelFor(columns * rows, progress, [&](Index t) {
		const int left = tile * (t % columns), top = tile * (t / columns);
		for (int y = top; y < std::min(top + tile, options.height); ++y)
			for (int x = left; x < std::min(left + tile, options.width); ++x)
				hits[std::size_t(y) * options.width + x] =
					tracer.trace(rayThrough(camera, options, x + 0.5, y + 0.5));
	});
	return hits;
}

} // namespace curvature_lines
