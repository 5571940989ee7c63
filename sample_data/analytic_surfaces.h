// Analytic surfaces with exact foot points, normals and principal curvatures, and seeded oriented clouds
// sampled from them: the ground truth of the C++ and Python tests, the demo and the benchmarks.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace curvature_lines::samples {

// The standard fixes the engine's output but not that of its distributions, so these are our own and
// the same seed gives the same cloud with every standard library.
class Random {
public:
	// Streams of one seed are independent: outliers do not change the inliers.
	Random(std::uint64_t seed, std::uint64_t stream);
	double uniform(double from = 0.0, double to = 1.0); // [from, to)
	double normal();                                    // mean 0, standard deviation 1
	Eigen::Vector3d normal3();
	std::size_t index(std::size_t count); // [0, count)

private:
	std::mt19937_64 m_engine;
};

// Convex positive, outward normal, k1 >= k2 by signed value; d1, d2, normal unit and orthogonal, d2 = n x d1.
// Where k1 == k2 the directions are one smooth choice of many.
struct SurfaceFrame {
	Eigen::Vector3d normal, d1, d2;
	double          k1 = 0.0, k2 = 0.0;
};

class AnalyticSurface {
public:
	virtual ~AnalyticSurface() = default;

	virtual Eigen::AlignedBox3d boundingBox() const = 0;
	virtual int eulerCharacteristic() const         = 0;
	virtual bool closed() const                     = 0;
	// closest surface point
	virtual Eigen::Vector3d project(const Eigen::Vector3d& point) const = 0;
	// foot on the surface
	virtual SurfaceFrame frame(const Eigen::Vector3d& foot) const = 0;

	// Distances within the surface, infinite where there is no such thing: to the rim of an open surface,
	// and to the nearest sharp edge or jump of curvature. Truth is compared with estimates away from both.
	virtual double rimDistance(const Eigen::Vector3d& foot) const;
	virtual double featureDistance(const Eigen::Vector3d& foot) const;

	virtual Eigen::Vector3d sample(Random& random) const = 0; // uniform by area
	// evenly spaced, about so many points
	virtual Eigen::Matrix3Xd grid(int points) const = 0;

	double diagonal() const { return boundingBox().diagonal().norm(); }
};

// torus       R = 1, r = 0.4
// sphere      radius 1
// cylinder    radius 0.5, height 2, open at both ends
// helicoid    (u cos v, u sin v, v / 2), |u| <= 1, |v| <= pi; open
// cube        edge 1
// ellipsoid   half axes 1, 0.7, 0.5
// capsule     cylinder of radius 0.5 and height 1 with hemispherical caps: umbilic and non-umbilic regions
// bent_sheet  unit square that goes over into a quarter cylinder of radius 0.5: flat and singly curved; open
// plane       unit square, z = 0, normal +z; open
// capped_cylinder  radius 0.5, height 1, closed by two discs: circular sharp edges
// l_block     three cubes of edge 0.5 in an L, in the plane of x and y: 17 convex edges and a concave one
// double_torus     two tori (R = 0.7, r = 0.3) side by side in the plane of x and y, blended smoothly: genus 2
// half_torus       the half y >= 0 of the torus; open
const std::vector<std::string>& surfaceNames();
// Throws std::invalid_argument for a name not listed above.
const AnalyticSurface& surface(const std::string& name);

// Frames at the foot points of N arbitrary points, by column.
struct GroundTruth {
	Eigen::Matrix3Xd footPoints, normals, d1, d2; // 3 x N
	Eigen::VectorXd  k1, k2;                      // N
};
GroundTruth groundTruth(const AnalyticSurface& surface, const Eigen::Matrix3Xd& points);

struct SampleRequest {
	std::string surface = "torus";
	int         points  = 2000; // inliers; outliers come on top
	// standard deviation per coordinate, fraction of the surface's diagonal
	double noise       = 0.0;
	double farOutliers = 0.0; // share of the cloud; uniform in 1.2 times the bounding box
	// share; clusters of 12 points, 3 to 8 noise units off the surface
	double        nearOutliers = 0.0;
	std::uint64_t seed         = 0;
	// AnalyticSurface::grid instead of area-uniform random points
	bool regular = false;
};

enum PointLabel : int { Inlier = 0, FarOutlier = 1, NearOutlier = 2 };

// Ground truth of every point is that of its foot point, outliers included; `normals` are the true ones.
struct SampleCloud : GroundTruth {
	Eigen::Matrix3Xd positions; // 3 x N
	Eigen::VectorXi  label;     // N, PointLabel
};

// Points come in random order when there are outliers. Throws std::invalid_argument for a request that
// makes no sense.
SampleCloud generate(const SampleRequest& request);

} // namespace curvature_lines::samples
