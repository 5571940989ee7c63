// Local estimates of the surface from positions (a height polynomial) and from normals (a polynomial of the
// normal field), both robust: what the adaptive curvature is made of.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

#include "local_polynomial.h"
#include "point_cloud.h"
#include "sample_kernels.h"

namespace curvature_lines {

// The surface at one place. shape turns a step along the surface into the change of the normal:
// dn = shape dp, symmetric, shape * normal = 0; positive where convex.
struct SurfaceElement {
	Eigen::Vector3d position = Eigen::Vector3d::Zero();
	Eigen::Vector3d normal   = Eigen::Vector3d::UnitZ(); // unit
	Eigen::Matrix3d shape    = Eigen::Matrix3d::Zero();  // 1/length
	double          residual = 0.0; // RMS of the heights that were fitted, length
	// distance of the weighted mean of the points, in radii: 0 inside, large at a rim
	double offset  = 0.0;
	double support = 0.0; // mean weight of the points: 1/3 on a surface, less off it
	Index  samples = 0;   // points that were fitted
	bool   valid   = false;
};

// Weight of a sample at distance d from the centre of a ball of radius r, t2 = (d / r)^2.
inline double ballKernel(double t2)
{
	const double s = 1.0 - t2;
	return s > 0.0 ? s * s : 0.0;
}

// Points of a ball, relative to its centre in radii, with their normals. The arrays end with points outside.
struct BallPoints {
	Eigen::Vector3d     center = Eigen::Vector3d::Zero();
	double              radius = 1.0;
	int                 size   = 0;
	std::vector<double> position[3], normal[3];

	OrientedColumns columns() const
	{
		return {
			{position[0].data(), position[1].data(), position[2].data()},
			{normal[0].data(), normal[1].data(), normal[2].data()},
			size};
	}
};

struct BallPlane {
	Eigen::Vector3d normal = Eigen::Vector3d::Zero(); // zero if there is none
	double          height = 0.0;
};

// Fits at one place. Holds the scratch of one thread.
class LocalSurfaceFitter {
public:
	// The oriented points the next fits are to: of `points` those `near` `center`, all within `radius`.
	void takeBall(
		const PointCloud&         points,
		const std::vector<Index>& near,
		const Eigen::Vector3d&    center,
		double                    radius);

	// The plane through the points of the ball whose normals do not oppose `normal`: its normal, on their
	// side, and its height above the centre (length).
	BallPlane plane(const Eigen::Vector3d& normal) const;

	// Heights over the tangent plane at `normal`, of the points whose normals do not oppose it, as a
	// polynomial of `degree` 2 or 4. The element moves onto the fitted surface and is fitted again in the
	// new frame, `iterations` times in all.
	SurfaceElement fitHeights(const Eigen::Vector3d& normal, int degree, int iterations);

	// The normals of the points as a polynomial of `degree` 1 to 3 in the tangent plane of `start`, which
	// lies at the centre; its linear part is the shape operator. Normals far off it count less if `robust`.
	// residual and offset are those of `start`.
	SurfaceElement fitNormals(const SurfaceElement& start, int degree, bool robust);

	static LocalSurfaceFitter& ofThisThread();

private:
	template<int Degree>
	bool heightStep(bool lookForOutliers, SurfaceElement& element);
	template<int Degree>
	bool normalStep(bool lookForOutliers, SurfaceElement& element);
	// Geman-McClure weights by `m_residuals`, of this root mean square, in place of those of the step
	// before, `m_robust`.
	template<int Values>
	void reweight(double rms, LocalSamples<Values>& samples);

	BallPoints          m_ball;
	LocalSamples<1>     m_heights;
	LocalSamples<3>     m_normals;
	std::vector<double> m_robust; // per point of the ball, from the step before
	std::vector<double> m_residuals, m_scratch;
};

} // namespace curvature_lines
