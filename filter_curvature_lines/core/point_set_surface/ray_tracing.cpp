// Spheres in a bounding volume hierarchy (Eigen's), the fixed-point loop along a ray, and the march where that
// loop is not to be trusted.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "ray_tracing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <unsupported/Eigen/BVH>

#include "control_neighborhood.h"
#include "point_cloud.h"
#include "point_set_surface.h"
#include "progress.h"

namespace curvature_lines {

using Eigen::Vector3d;

// Of a ray through a sphere.
struct RayTracer::Passage {
	double start;   // where on the ray the surface is likely: at the plane of the sphere's point
	double closest; // to the sphere's centre
	double half;    // of the way through
	double aside;   // squared distance from the centre to the ray
	double off;     // and to where the plane is met; larger than all where it is not
	Index  sphere;
	bool   done;

	double squaredDistance(double t) const { return (t - closest) * (t - closest) + aside; }
	bool encloses(double t) const { return std::abs(t - closest) < half; }
};

namespace {

// Adamson and Alexa 2003 leave the radii of the spheres open. A sphere reaches to this neighbour of its point, but within
// these bounds in spacings. With less than 1.3 rays passed between the spheres of uneven points (68 pixels of the dragon);
// radii one and a half times as large leave as few wrong pixels, 7 instead of 8, and take 1.3 to 1.5 times as long
// (benchmarks/ray_tracing.py). Lonely points enclose no surface.
constexpr Index  sphereNeighbor = 6;
constexpr double leastSphere    = 1.3;
constexpr double largestSphere  = 3.0;
// Where a ray is expected to meet the surface: the plane of a sphere's point, unless the sine of their angle is less.
constexpr double steepest = 0.05;
// Spacings around a control point in which its neighbourhood serves all rays: most of them meet the surface there.
constexpr double margin = 0.5;
// When the fixed-point loop of approach() is not trusted, by experiment: radii from the sphere's centre beyond which it
// is given up; cosine between the normals of a hit and of the sphere's point, 14 degrees; radii between a front and a
// back side that is met behind it.
constexpr double strayed = 1.8;
constexpr double turned  = 0.97;
constexpr double behind  = 5.0;
// Of march(), in spacings, by experiment: its shortest step; how much farther than the closest control point others are
// blended in; the height above which the closest point alone tells enough.
constexpr double shortest = 0.35, blend = 0.5, far = 0.4;
// Radii by which march() looks beyond the spheres, because they leave gaps where points are uneven.
constexpr double beyond = 0.5;
// Least cosine between the normal of a hit and the ray, so that it faces the eye.
constexpr double outline = 1e-3;
// Pixels of a square whose rays share neighbourhoods, and of one whose rays share the search for spheres. Change no
// result, only the time.
constexpr int tile = 16, beam = 4;

struct Sphere {
	Vector3d center, normal;
	double   radius;
};

using SphereTree = Eigen::KdBVH<double, 3, Index>;

// All spheres within a distance of a ray.
struct SphereCollector {
	const std::vector<Sphere>& spheres;
	const Ray&                 ray;
	const Vector3d             inverse;
	double                     distance;
	std::vector<Index>&        found;

	bool intersectVolume(const SphereTree::Volume& box) const
	{
		double first = 0.0, last = std::numeric_limits<double>::infinity();
		for (int c = 0; c < 3; ++c) {
			const double a    = (box.min()[c] - distance - ray.origin[c]) * inverse[c];
			const double b    = (box.max()[c] + distance - ray.origin[c]) * inverse[c];
			const double near = a < b ? a : b, far = a < b ? b : a;
			first = near > first ? near : first; // not std::max: of 0 * infinity nothing follows
			last  = far < last ? far : last;
		}
		return first <= last;
	}
	bool intersectObject(Index s)
	{
		const Vector3d d       = spheres[s].center - ray.origin;
		const double   closest = d.dot(ray.direction), reach = spheres[s].radius + distance;
		if (d.squaredNorm() - closest * closest < reach * reach && closest + reach > 0.0)
			found.push_back(s);
		return false;
	}
};

// The root of the quadric along `direction` from `start` (both in space) that is nearest to start; where there
// is none, the place of closest approach, and `found` is false.
double
stepToQuadric(const LocalQuadric& q, const Vector3d& start, const Vector3d& direction, bool& found)
{
	const Vector3d d = start - q.origin;
	const double   x = d.dot(q.u), y = d.dot(q.v), z = d.dot(q.n);
	const double   dx = direction.dot(q.u), dy = direction.dot(q.v), dz = direction.dot(q.n);
	const double   a = q.c[3] * dx * dx + q.c[4] * dx * dy + q.c[5] * dy * dy;
	const double   b = q.c[1] * dx + q.c[2] * dy + 2.0 * q.c[3] * x * dx +
	                 q.c[4] * (x * dy + y * dx) + 2.0 * q.c[5] * y * dy - dz;
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

bool Camera::isUpright() const
{
	// In the unit frame, what is shorter is rounding.
	return (target - position).cross(up).norm() > 1e-12;
}

Camera Camera::facing(const PointCloud& cloud, double aspectRatio, double fieldOfView)
{
	Camera camera;
	camera.fieldOfView = fieldOfView;
	if (cloud.size() == 0)
		return camera;
	const Vector3d low     = cloud.positions.rowwise().minCoeff(),
				   high    = cloud.positions.rowwise().maxCoeff();
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
	const double   half = std::tan(camera.fieldOfView * EIGEN_PI / 360.0) / 1.06;
	const double   wide = half * std::max(1.0, aspectRatio),
				 tall   = half * std::max(1.0, 1.0 / aspectRatio);
	double distance     = 0.0;
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
	const double   pixel =
		2.0 * std::tan(camera.fieldOfView * EIGEN_PI / 360.0) / std::min(image.width, image.height);
	return {
		camera.position,
		(forward + pixel * (column - 0.5 * image.width) * right -
	     pixel * (row - 0.5 * image.height) * up)
			.normalized()};
}

struct RayTracer::Spheres {
	std::vector<Sphere> all;
	SphereTree          tree;
	Eigen::AlignedBox3d box;
};

RayTracer::RayTracer(
	const PointSetSurface&   surface,
	const ControlPoints&     control,
	const RayTracingOptions& options) : m_surface(surface), m_control(control), m_options(options)
{
	const Index n       = control.cloud.size();
	auto        spheres = std::make_unique<Spheres>();
	spheres->all.resize(n);
	parallelFor(n, {}, [&](Index i) {
		const Vector3d center = control.cloud.positions.col(i);
		const auto     near   = control.search.nearest(center, sphereNeighbor + 1);
		const double   radius = (control.cloud.positions.col(near.back()) - center).norm();
		spheres->all[i]       = {
            center,
            control.cloud.normals.col(i),
            std::clamp(
                radius, leastSphere * control.spacing[i], largestSphere * control.spacing[i])};
	});
	std::vector<Index>              indices(n);
	std::vector<SphereTree::Volume> boxes(n);
	for (Index i = 0; i < n; ++i) {
		const auto& [center, normal, radius] = spheres->all[i];
		indices[i]                           = i;
		boxes[i] = {center - Vector3d::Constant(radius), center + Vector3d::Constant(radius)};
		spheres->box.extend(boxes[i]);
	}
	if (n > 0)
		spheres->tree.init(indices.begin(), indices.end(), boxes.begin(), boxes.end());
	m_spheres = std::move(spheres);
}

RayTracer::~RayTracer() = default;

const RayTracer::Memory::Slot& RayTracer::surfaceAt(Index point, Memory& memory) const
{
	Memory::Slot& slot = memory.m_slots[point % memory.m_slots.size()];
	if (slot.point != point) {
		slot.point = point;
		slot.quadric.reset();
		if (m_surface.gather(point, margin, slot.around))
			slot.quadric = m_surface.roughlyAt(slot.around, m_control.cloud.positions.col(point));
	}
	return slot;
}

// A hit only if it is certain: on the side of the sphere's point, and without other sheets around.
RayHit RayTracer::approach(const Ray& ray, const Passage& passage, Memory& memory) const
{
	const Sphere&       sphere = m_spheres->all[passage.sphere];
	const Memory::Slot& slot   = surfaceAt(passage.sphere, memory);
	if (!slot.quadric || slot.around.besideOthers())
		return {};
	LocalQuadric quadric  = *slot.quadric;
	double       t        = passage.start;
	Vector3d     place    = ray.origin + t * ray.direction;
	bool         found    = true;
	double       lastStep = 0.0, lastMove = 0.0;
	for (int it = 0; it < m_options.maxIterations; ++it) {
		const bool   before = found;
		const double step   = stepToQuadric(quadric, place, ray.direction, found);
		// From the third quadric on, a secant step: where the surface bends more than they know, plain steps
		// go to and fro.
		const double change = lastStep - step;
		lastMove            = it > 1 && change * lastMove > 0.25 * lastMove * lastMove
		                          ? step * lastMove / change
		                          : step;
		lastStep            = step;
		t += lastMove;
		place = ray.origin + t * ray.direction;
		// Where the ray misses a quadric it goes to the closest approach; the quadric there has to be met.
		if (!(found || before) || (place - sphere.center).norm() > strayed * sphere.radius ||
		    !(t > 0.0))
			return {};
		if (it > 0 && found && std::abs(step) < m_options.tolerance * slot.around.spacing()) {
			const Vector3d normal = quadric.normalAt(place);
			if (normal.dot(slot.around.side()) > turned)
				return {t, place, normal};
			return {};
		}
		if (!m_surface.follow(slot.around, place, quadric))
			return {};
	}
	return {};
}

struct RayTracer::Elevation {
	double   above   = 0.0; // the surface at its foot
	Vector3d normal  = Vector3d::Zero();
	double   spacing = 0.0;
};

std::optional<RayTracer::Elevation>
RayTracer::elevationOver(Index point, const Vector3d& place, Memory& memory) const
{
	const Memory::Slot& slot = surfaceAt(point, memory);
	if (!slot.quadric)
		return std::nullopt;
	LocalQuadric quadric = *slot.quadric;
	if (!m_surface.follow(slot.around, place, quadric))
		return std::nullopt;
	const Vector3d normal = quadric.normalAt(place);
	const double   above  = (place - quadric.foot(place)).dot(quadric.n);
	return Elevation{
		std::max(above, slot.around.pastEdge(place, normal)), normal, slot.around.spacing()};
}

const RayTracer::Passage& RayTracer::closestTo(double t, const std::vector<Passage>& passages)
{
	return *std::min_element(
		passages.begin(), passages.end(), [t](const Passage& a, const Passage& b) {
			return a.squaredDistance(t) < b.squaredDistance(t);
		});
}

// Blended from the closest control points: of two neighbours, one may know of a sheet that the other does not.
std::optional<RayTracer::Elevation> RayTracer::elevationAt(
	const Ray& ray, double t, const std::vector<Passage>& passages, Memory& memory) const
{
	const Vector3d place   = ray.origin + t * ray.direction;
	const Passage& closest = closestTo(t, passages);
	auto           first   = elevationOver(closest.sphere, place, memory);
	if (!first || std::abs(first->above) > far * first->spacing)
		return first;
	const double least = std::sqrt(closest.squaredDistance(t)),
				 more  = blend * m_control.spacing[closest.sphere];
	Elevation sum      = *first;
	double    total    = 1.0;
	for (const Passage& other : passages) {
		const double square = other.squaredDistance(t);
		if (&other == &closest || square >= (least + more) * (least + more))
			continue;
		const auto   one   = elevationOver(other.sphere, place, memory);
		const double share = 1.0 - (std::sqrt(square) - least) / more, w = share * share;
		if (!one)
			continue;
		sum.above += w * one->above;
		sum.normal += w * one->normal;
		sum.spacing += w * one->spacing;
		total += w;
	}
	return Elevation{sum.above / total, sum.normal.normalized(), sum.spacing / total};
}

// Between two places on either side of the surface.
RayHit RayTracer::bracketed(
	const Ray&                  ray,
	double                      low,
	double                      high,
	Elevation                   atLow,
	Elevation                   atHigh,
	const std::vector<Passage>& passages,
	Memory&                     memory) const
{
	const bool inwards = atLow.above > 0.0;
	double     t       = high;
	Elevation  found   = atHigh;
	for (int it = 0; it < m_options.maxIterations; ++it) {
		const double tolerance = m_options.tolerance * found.spacing;
		if (high - low < tolerance || (it > 0 && std::abs(found.above) < 0.1 * tolerance))
			break;
		t                = (low * atHigh.above - high * atLow.above) / (atHigh.above - atLow.above);
		const auto there = elevationAt(ray, t, passages, memory);
		if (!there)
			break;
		found = *there;
		// Regula falsi; an end that stays counts half from then on (Illinois).
		if ((found.above > 0.0) == inwards) {
			low   = t;
			atLow = found;
			atHigh.above *= 0.5;
		}
		else {
			high   = t;
			atHigh = found;
			atLow.above *= 0.5;
		}
	}
	// At an outline normals may turn a little too far.
	const double along = found.normal.dot(ray.direction), least = inwards ? -outline : outline;
	Vector3d     normal = found.normal;
	if (inwards ? along > least : along < least)
		normal = (normal + (least - along) * ray.direction).normalized();
	return {t, ray.origin + t * ray.direction, normal};
}

// Steps along the ray through the spheres until the height over the surface changes its sign: slower than approach(), and
// reliable where the ray grazes the surface and where sheets are close to each other.
RayHit RayTracer::march(
	const Ray& ray, double end, const std::vector<Passage>& passages, Memory& memory) const
{
	thread_local std::vector<std::pair<double, double>> ways;
	ways.clear();
	for (const Passage& passage : passages) {
		const double half = passage.half + beyond * m_spheres->all[passage.sphere].radius;
		ways.emplace_back(passage.closest - half, passage.closest + half);
	}
	std::sort(ways.begin(), ways.end());
	for (std::size_t k = 0; k < ways.size();) {
		double t = std::max(0.0, ways[k].first), out = ways[k].second;
		for (; k < ways.size() && ways[k].first <= out; ++k)
			out = std::max(out, ways[k].second);
		std::optional<Elevation> last;
		for (double lastT = t; t < std::min(out, end);) {
			const auto here = elevationAt(ray, t, passages, memory);
			if (last && here && (last->above > 0.0) != (here->above > 0.0)) {
				const RayHit hit = bracketed(ray, lastT, t, *last, *here, passages, memory);
				if (last->above > 0.0 || !besideFront(ray, hit.depth, passages))
					return hit;
			}
			last  = here;
			lastT = t;
			t += here ? std::max(shortest * here->spacing, 0.9 * std::abs(here->above))
			          : shortest * m_spheres->all[passages.front().sphere].radius;
		}
	}
	return {};
}

// At thin rims a ray may pass the rounded front and meet the back side from within. Whether there is a front nearby that
// the ray should have met.
bool RayTracer::besideFront(
	const Ray& ray, double depth, const std::vector<Passage>& passages) const
{
	return std::any_of(passages.begin(), passages.end(), [&](const Passage& passage) {
		const Sphere& sphere = m_spheres->all[passage.sphere];
		return sphere.normal.dot(ray.direction) < 0.0 &&
		       std::abs(passage.closest - depth) < behind * sphere.radius;
	});
}

void RayTracer::aim(const Ray& axis, double spread, Memory& memory) const
{
	memory.m_spheres.clear();
	if (m_spheres->all.empty())
		return;
	const Eigen::AlignedBox3d& box = m_spheres->box;
	const double    farthest = (axis.origin - box.center()).norm() + 0.5 * box.diagonal().norm();
	SphereCollector collector{
		m_spheres->all, axis, axis.direction.cwiseInverse(), spread * farthest, memory.m_spheres};
	Eigen::BVIntersect(m_spheres->tree, collector);
}

RayHit RayTracer::trace(const Ray& ray) const
{
	Memory memory;
	aim(ray, 0.0, memory);
	return trace(ray, memory);
}

void RayTracer::findPassages(
	const Ray& ray, const Memory& memory, std::vector<Passage>& passages) const
{
	passages.clear();
	for (const Index s : memory.m_spheres) {
		const Sphere&  sphere  = m_spheres->all[s];
		const Vector3d d       = sphere.center - ray.origin;
		const double   closest = d.dot(ray.direction);
		const double   whole   = sphere.radius * sphere.radius,
					 aside     = d.squaredNorm() - closest * closest;
		if (!(whole > aside))
			continue;
		const double half = std::sqrt(whole - aside);
		if (!(closest + half > 0.0))
			continue;
		const double slope = ray.direction.dot(sphere.normal);
		const double start = d.dot(sphere.normal) / slope, along = start - closest;
		const bool   inside = std::abs(slope) > steepest && std::abs(along) < half;
		passages.push_back(
			{inside ? start : closest,
		     closest,
		     half,
		     aside,
		     aside + (inside ? along * along : whole),
		     s,
		     false});
	}
	std::sort(passages.begin(), passages.end(), [](const Passage& a, const Passage& b) {
		return a.start != b.start ? a.start < b.start : a.sphere < b.sphere;
	});
}

RayHit RayTracer::trace(const Ray& ray, Memory& memory) const
{
	RayHit                            best;
	thread_local std::vector<Passage> passages;
	findPassages(ray, memory, passages);
	for (std::size_t first = 0; first < passages.size() && passages[first].start < best.depth;
	     ++first) {
		if (passages[first].done)
			continue;
		// Of the spheres that expect the surface about here, the one whose point is closest to it.
		const double last   = passages[first].start + m_spheres->all[passages[first].sphere].radius;
		std::size_t  chosen = first;
		for (std::size_t k = first; k < passages.size() && passages[k].start < last; ++k)
			if (!passages[k].done && passages[k].off < passages[chosen].off)
				chosen = k;
		RayHit hit = approach(ray, passages[chosen], memory);
		if (hit.exists() && !passages[chosen].encloses(hit.depth)) {
			// Outside of its sphere a hit is found again from the sphere around it.
			Passage closest = closestTo(hit.depth, passages);
			closest.start   = hit.depth;
			hit             = approach(ray, closest, memory);
			if (!closest.encloses(hit.depth))
				hit = {};
		}
		if (!hit.exists() ||
		    (hit.normal.dot(ray.direction) > 0.0 && besideFront(ray, hit.depth, passages))) {
			const RayHit crossing = march(ray, best.depth, passages, memory);
			return crossing.exists() ? crossing : best;
		}
		if (hit.depth < best.depth)
			best = hit;
		// Spheres about there would find the same.
		passages[first].done = passages[chosen].done = true;
		for (Passage& passage : passages)
			if (std::abs(passage.closest - hit.depth) < m_spheres->all[passage.sphere].radius)
				passage.done = true;
	}
	return best;
}

void aimAt(
	const RayTracer&         tracer,
	const Camera&            camera,
	const RayTracingOptions& image,
	double                   column,
	double                   row,
	double                   size,
	RayTracer::Memory&       memory)
{
	const Ray axis   = rayThrough(camera, image, column, row);
	double    spread = 0.0;
	for (const double dx : {-0.5, 0.5})
		for (const double dy : {-0.5, 0.5}) {
			const Vector3d corner =
				rayThrough(camera, image, column + dx * size, row + dy * size).direction;
			const double along = corner.dot(axis.direction);
			spread             = std::max(spread, (corner / along - axis.direction).norm());
		}
	tracer.aim(axis, spread, memory);
}

std::vector<RayHit> traceImage(
	const RayTracer&         tracer,
	const Camera&            camera,
	const RayTracingOptions& options,
	const Progress&          progress)
{
	std::vector<RayHit> hits(std::size_t(options.width) * options.height);
	const int columns = (options.width + tile - 1) / tile,
			  rows    = (options.height + tile - 1) / tile;
	parallelFor(columns * rows, progress, [&](Index t) {
		const int         left = tile * (t % columns), top = tile * (t / columns);
		RayTracer::Memory memory;
		for (int block = 0; block < (tile / beam) * (tile / beam); ++block) {
			const int x0 = left + beam * (block % (tile / beam)),
					  y0 = top + beam * (block / (tile / beam));
			aimAt(tracer, camera, options, x0 + 0.5 * beam, y0 + 0.5 * beam, beam, memory);
			for (int y = y0; y < std::min(y0 + beam, options.height); ++y)
				for (int x = x0; x < std::min(x0 + beam, options.width); ++x)
					hits[std::size_t(y) * options.width + x] =
						tracer.trace(rayThrough(camera, options, x + 0.5, y + 0.5), memory);
		}
	});
	return hits;
}

} // namespace curvature_lines
