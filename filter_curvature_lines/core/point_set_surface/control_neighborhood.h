// Control points of a point-set surface around a place, laid out for sums over them (T06 section 5; Alexa et
// al. 2003).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "cloud_index.h"
#include "local_polynomial.h"
#include "neighborhoods.h"
#include "point_cloud.h"

namespace curvature_lines {

// The points that define a surface. Cheap to copy: it shares the index.
struct ControlPoints {
	// With the spacing of the minimum neighbourhoods, which are found now unless they were before.
	ControlPoints(const CloudIndex& points);
	// With another spacing (N, lengths), which must outlive it.
	ControlPoints(const CloudIndex& points, const std::vector<double>& spacings);

	CloudIndex                 index; // what the others are part of
	const PointCloud&          cloud;
	const NeighborSearch&      search;
	const std::vector<double>& spacing; // N, lengths
};

// What the points around a place say about the surface there, weighted by w = exp(-d^2 / h^2).
struct NormalSums {
	double          weight = 0.0;                     // sum w
	Eigen::Vector3d offset = Eigen::Vector3d::Zero(); // sum w d, d = p - place
	Eigen::Vector3d normal = Eigen::Vector3d::Zero(); // sum w n
	double          plane  = 0.0;                     // sum w <d, n>
};
struct PlaneSums {
	double          weight = 0.0;
	Eigen::Vector3d offset = Eigen::Vector3d::Zero();
	Eigen::Matrix3d square = Eigen::Matrix3d::Zero(); // sum w d d^T
};

// Control points around a place, all on one sheet. Scratch of one thread, good for places up to about a
// spacing away from the one it was gathered for.
class ControlNeighborhood {
public:
	// The control points within `reach` local spacings, without those whose normals oppose that of the
	// closest; where they are many, the closest of them. False where there is no surface: farther than three
	// spacings from the closest.
	bool gather(const ControlPoints& control, const Eigen::Vector3d& place, double reach);
	// The same around a control point.
	bool gather(const ControlPoints& control, Index point, double reach);

	// around, length: changes gradually
	double spacing() const { return m_spacing; }
	const Eigen::Vector3d& side() const { return m_side; } // normal of the closest point
	int size() const { return m_size; }
	Eigen::Vector3d position(int k) const { return {row(0)[k], row(1)[k], row(2)[k]}; }
	Eigen::Vector3d normal(int k) const { return {row(3)[k], row(4)[k], row(5)[k]}; }

	NormalSums normalSums(const Eigen::Vector3d& place, double h) const;
	PlaneSums planeSums(const Eigen::Vector3d& place, double h) const;
	// Whether points on other sheets are around.
	bool besideOthers() const { return !m_opposing.empty(); }
	// How far a place on this sheet, with this normal, lies past the edge where a sheet behind it ends it;
	// negative before the edge, minus infinity where no sheet is behind.
	double pastEdge(const Eigen::Vector3d& place, const Eigen::Vector3d& normal) const;
	// Heights over the tangent plane at a place, in units of h, with the same weights.
	void heights(
		const Eigen::Vector3d& place,
		const TangentFrame&    frame,
		double                 h,
		LocalSamples<1>&       samples) const;

private:
	struct OrientedPoint {
		Eigen::Vector3d position, normal;
	};

	bool
	gather(const ControlPoints& control, const Eigen::Vector3d& place, Index closest, double reach);
	const double* row(int r) const { return m_rows.data() + std::size_t(r) * m_padded; }

	std::vector<double> m_rows; // x, y, z and the normals' components; padded with points far away
	int                 m_size = 0, m_padded = 0;
	double              m_spacing = 0.0;
	Eigen::Vector3d     m_side    = Eigen::Vector3d::Zero();
	std::vector<OrientedPoint> m_opposing; // around, on other sheets
	std::vector<Index>         m_found;    // scratch of gather()
	// likewise: squared distances, points of the sheet
	std::vector<std::pair<double, Index>> m_near;
};

} // namespace curvature_lines
