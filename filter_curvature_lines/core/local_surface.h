// Local estimates of the surface from positions (a height polynomial) and from normals (a polynomial of the
// normal field), both robust: what the adaptive curvature is made of.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "local_polynomial.h"
#include "neighborhoods.h"

namespace curvature_lines {

// The surface at one place. shape turns a step along the surface into the change of the normal:
// dn = shape dp, symmetric, shape * normal = 0; positive where convex.
struct SurfaceElement {
	Eigen::Vector3d position = Eigen::Vector3d::Zero();
	Eigen::Vector3d normal   = Eigen::Vector3d::UnitZ(); // unit
	Eigen::Matrix3d shape    = Eigen::Matrix3d::Zero();  // 1/length
	double          residual = 0.0; // RMS of the heights that were fitted, length
	double          offset   = 0.0; // distance of the weighted mean of the points, in radii: 0 inside, large at a rim
	double          support  = 0.0; // mean weight of the points: 1/3 on a surface, less off it
	Index           samples  = 0;   // points that were fitted
	bool            valid    = false;
};

// Weight of a sample at distance d from the centre of a ball of radius r, t2 = (d / r)^2.
inline double ballKernel(double t2)
{
	const double s = 1.0 - t2;
	return s > 0.0 ? s * s : 0.0;
}

// Fits at one place. Holds the scratch of one thread.
class LocalSurfaceFitter {
public:
	// Heights over the tangent plane at `start`, of the points `near` it (all within `radius` of its
	// position, gate normals not opposing), as a polynomial of `degree` 2 or 4. The element moves onto
	// the fitted surface and is fitted again in the new frame, `iterations` times in all. The start normal
	// needs only the right sign.
	SurfaceElement fitHeights(
		const PointCloud&         cloud,
		const std::vector<Index>& near,
		const Eigen::Vector3d&    position,
		const Eigen::Vector3d&    normal,
		double                    radius,
		int                       degree,
		int                       iterations);

	// The normals of the elements `near` `start` (all within `radius`) as a polynomial of `degree` 1 to 3
	// in its tangent plane; its linear part is the shape operator. Elements far off it count less if `robust`.
	// residual and offset are those of `start`.
	SurfaceElement fitNormals(
		const std::vector<SurfaceElement>& elements,
		const std::vector<Index>&          near,
		const SurfaceElement&              start,
		double                             radius,
		int                                degree,
		bool                               robust);

	static LocalSurfaceFitter& ofThisThread();

private:
	template<int Degree>
	bool normalStep(
		const std::vector<SurfaceElement>& elements,
		const std::vector<Index>&          near,
		const Eigen::Vector3d&             center,
		double                             radius,
		bool                               lookForOutliers,
		SurfaceElement&                    element);
	template<int Degree>
	bool heightStep(
		const PointCloud&         cloud,
		const std::vector<Index>& near,
		double                    radius,
		bool                      lookForOutliers,
		SurfaceElement&           element);
	// Geman-McClure weights of m_residuals into m_factors, if there are suspicious ones.
	bool robustFactors(double rms);
	bool planeStart(
		const PointCloud&         cloud,
		const std::vector<Index>& near,
		double                    radius,
		SurfaceElement&           element) const;

	LocalSamples<1>     m_heights;
	LocalSamples<3>     m_normals;
	std::vector<double> m_robust;  // per entry of `near`, from the step before
	std::vector<Index>  m_entries; // of `near`, per sample
	std::vector<double> m_residuals, m_sorted, m_factors;
};

} // namespace curvature_lines
