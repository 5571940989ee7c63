// Ray tracing of point-set surfaces (Adamson and Alexa 2003; T06 section 5): spheres around the control points
// enclose the surface, and local quadrics lead a ray to it. Where a ray grazes the surface, or sheets are close
// to each other, that loop may slide past it; there the ray is marched along until it crosses the surface, which
// is not in Adamson and Alexa.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "control_neighborhood.h"
#include "point_cloud.h"
#include "point_set_surface.h"
#include "progress.h"

namespace curvature_lines {

// A pinhole. Pixel rows go down, columns to the right.
struct Camera {
	Eigen::Vector3d position = {0, 0, 2}, target = {0, 0, 0}, up = {0, 1, 0};
	double          fieldOfView = 30.0; // degrees, across the shorter side of the image

	// Whether there is a view direction, and `up` says what is up in the picture: it does not run along the view.
	bool isUpright() const;

	// Looks at the middle of the points from the side of their normals' mean, from a little above, and sees
	// all of them.
	static Camera facing(const PointCloud& cloud, double aspectRatio, double fieldOfView = 30.0);
};

struct RayTracingOptions {
	int width = 533, height = 400; // pixels
	// in local spacings: the last step along the ray, many times the error left
	double tolerance     = 1e-2;
	int    maxIterations = 10; // quadrics per sphere
};

struct RayHit {
	// along the unit ray; infinite: none
	double          depth    = std::numeric_limits<double>::infinity();
	Eigen::Vector3d position = Eigen::Vector3d::Zero();
	Eigen::Vector3d normal   = Eigen::Vector3d::Zero(); // unit, towards the outside of the surface

	bool exists() const { return depth < std::numeric_limits<double>::infinity(); }
};

struct Ray {
	Eigen::Vector3d origin, direction; // unit
};

// Ready for any number of rays, from any number of threads.
class RayTracer {
public:
	RayTracer(
		const PointSetSurface&   surface,
		const ControlPoints&     control,
		const RayTracingOptions& options);
	~RayTracer();

	// What rays next to each other share; changes no result. For one tracer and one thread.
	class Memory {
		friend class RayTracer;
		struct Slot {
			Index                       point = -1;
			ControlNeighborhood         around;
			std::optional<LocalQuadric> quadric; // at the point; none where there is no surface
		};
		std::vector<Slot>  m_slots = std::vector<Slot>(256);
		std::vector<Index> m_spheres; // those that rays of the beam may pass
	};

	// Prepares for rays from one origin whose directions differ from that of the axis by `spread` (tangent) at
	// most.
	void aim(const Ray& axis, double spread, Memory& memory) const;
	RayHit trace(const Ray& ray, Memory& memory) const;
	// Of a single ray.
	RayHit trace(const Ray& ray) const;

private:
	struct Spheres;
	struct Passage;
	struct Elevation; // of a place over the surface

	const Memory::Slot& surfaceAt(Index point, Memory& memory) const;
	void findPassages(const Ray& ray, const Memory& memory, std::vector<Passage>& passages) const;
	// The fixed-point loop along a ray, and the march.
	RayHit approach(const Ray& ray, const Passage& passage, Memory& memory) const;
	RayHit
	march(const Ray& ray, double end, const std::vector<Passage>& passages, Memory& memory) const;
	RayHit bracketed(
		const Ray&                  ray,
		double                      low,
		double                      high,
		Elevation                   atLow,
		Elevation                   atHigh,
		const std::vector<Passage>& passages,
		Memory&                     memory) const;
	std::optional<Elevation> elevationAt(
		const Ray& ray, double t, const std::vector<Passage>& passages, Memory& memory) const;
	// As the neighbours of one control point know it.
	std::optional<Elevation>
	elevationOver(Index point, const Eigen::Vector3d& place, Memory& memory) const;
	static const Passage& closestTo(double t, const std::vector<Passage>& passages);
	bool besideFront(const Ray& ray, double depth, const std::vector<Passage>& passages) const;

	const PointSetSurface&         m_surface;
	ControlPoints                  m_control;
	RayTracingOptions              m_options;
	std::unique_ptr<const Spheres> m_spheres;
};

Ray rayThrough(const Camera& camera, const RayTracingOptions& image, double column, double row);
// For the rays through a square of pixels, `size` wide, about a place of the image.
void aimAt(
	const RayTracer&         tracer,
	const Camera&            camera,
	const RayTracingOptions& image,
	double                   column,
	double                   row,
	double                   size,
	RayTracer::Memory&       memory);

// width x height hits, row by row, through the middles of the pixels.
std::vector<RayHit> traceImage(
	const RayTracer&         tracer,
	const Camera&            camera,
	const RayTracingOptions& options,
	const Progress&          progress = {});

} // namespace curvature_lines
