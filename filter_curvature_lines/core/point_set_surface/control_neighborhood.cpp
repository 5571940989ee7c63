// Gathering of control points and Gaussian sums over them.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "control_neighborhood.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "block_size.h"
#include "cloud_index.h"
#include "gaussian_sums.h"
#include "local_polynomial.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "sample_kernels.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// Spacings from the closest control point beyond which there is no surface. T06 leaves the support open.
constexpr double isolated = 3.0;
// Control points kept: as many as a ball of the same radius holds on an even grid, pi and a little more per squared
// spacing. Noise and uneven clouds may put more into it. With less than this share of them on the sheet the search is for
// neighbours by number instead.
constexpr double gridPoints = 3.6;
constexpr double fewest     = 0.4;
constexpr double farAway = 1e30; // coordinate of the points that fill up a block: their weight is 0
// Cosine between normals below which points are on another sheet, 110 degrees: faces at a right angle are one sheet,
// those of a thin plate are two.
constexpr double opposing = -0.34;

} // namespace

ControlPoints::ControlPoints(const CloudIndex& points) :
		ControlPoints(points, points.minimum().spacing)
{
}

ControlPoints::ControlPoints(const CloudIndex& points, const std::vector<double>& spacings) :
		index(points), cloud(index.cloud()), search(index.search()), spacing(spacings)
{
}

bool ControlNeighborhood::gather(const ControlPoints& control, const Vector3d& place, double reach)
{
	if (!place.allFinite() || control.cloud.size() == 0)
		return false;
	return gather(control, place, control.search.nearest(place, 1).front(), reach);
}

bool ControlNeighborhood::gather(const ControlPoints& control, Index point, double reach)
{
	return gather(control, control.cloud.positions.col(point), point, reach);
}

bool ControlNeighborhood::gather(
	const ControlPoints& control, const Vector3d& place, Index closest, double reach)
{
	const Eigen::Matrix3Xd& positions = control.cloud.positions;
	const Eigen::Matrix3Xd& normals   = control.cloud.normals;
	const auto squaredDistance = [&](Index j) { return (positions.col(j) - place).squaredNorm(); };

	const double radius = reach * control.spacing[closest],
				 far    = isolated * control.spacing[closest];
	if (!(radius > 0.0) || squaredDistance(closest) > far * far)
		return false;
	m_side            = normals.col(closest);
	const auto enough = static_cast<std::size_t>(gridPoints * reach * reach);
	const auto split  = [&] {
        m_near.clear();
        m_opposing.clear();
        for (const Index j : m_found)
            if (normals.col(j).dot(m_side) > opposing)
                m_near.emplace_back(squaredDistance(j), j);
            else
                m_opposing.push_back({positions.col(j), normals.col(j)});
	};
	control.search.within(place, radius, m_found);
	split();
	if (double(m_near.size()) < fewest * double(enough)) {
		m_found = control.search.nearest(place, Index(4 * enough));
		split();
	}
	if (m_near.size() > enough) {
		std::nth_element(m_near.begin(), m_near.begin() + enough, m_near.end());
		m_near.resize(enough);
	}

	m_size   = int(m_near.size());
	m_padded = (m_size + blockSize - 1) / blockSize * blockSize;
	m_rows.resize(std::size_t(6) * m_padded);
	for (int r = 0; r < 6; ++r)
		std::fill(
			m_rows.begin() + r * m_padded + m_size, m_rows.begin() + (r + 1) * m_padded, farAway);
	double total = 0.0;
	m_spacing    = 0.0;
	for (int k = 0; k < m_size; ++k) {
		const auto [square, j] = m_near[k];
		for (int c = 0; c < 3; ++c) {
			m_rows[std::size_t(c) * m_padded + k]     = positions(c, j);
			m_rows[std::size_t(3 + c) * m_padded + k] = normals(c, j);
		}
		const double w = std::max(0.05, 1.0 - square / (radius * radius));
		m_spacing += w * control.spacing[j];
		total += w;
	}
	m_spacing /= total;
	return total > 0.0 && m_spacing > 0.0;
}

NormalSums ControlNeighborhood::normalSums(const Vector3d& place, double h) const
{
	const GaussianNormalSums sums =
		gaussianNormalSums({m_rows.data(), m_padded}, place.data(), 1.0 / (h * h));
	return {sums.weight, Vector3d(sums.offset), Vector3d(sums.normal), sums.plane};
}

PlaneSums ControlNeighborhood::planeSums(const Vector3d& place, double h) const
{
	const GaussianPlaneSums sums =
		gaussianPlaneSums({m_rows.data(), m_padded}, place.data(), 1.0 / (h * h));
	const double (&m)[6] = sums.square;
	Eigen::Matrix3d square;
	square << m[0], m[1], m[2], m[1], m[3], m[4], m[2], m[4], m[5];
	return {sums.weight, Vector3d(sums.offset), square};
}

double ControlNeighborhood::pastEdge(const Vector3d& place, const Vector3d& normal) const
{
	double closest = std::numeric_limits<double>::infinity(), above = -closest;
	for (const OrientedPoint& other : m_opposing) {
		const Vector3d d = place - other.position;
		// Sheets in front are those across a gap.
		if (d.dot(normal) > 0.0 && d.squaredNorm() < closest) {
			closest = d.squaredNorm();
			above   = d.dot(other.normal);
		}
	}
	return above;
}

void ControlNeighborhood::heights(
	const Vector3d& place, const TangentFrame& frame, double h, LocalSamples<1>& samples) const
{
	samples.resize(m_padded);
	FrameColumns columns;
	for (int c = 0; c < 3; ++c) {
		columns.origin[c] = place[c];
		columns.u[c]      = frame.u[c] / h;
		columns.v[c]      = frame.v[c] / h;
		columns.n[c]      = frame.n[c] / h;
	}
	toGaussianSamples({m_rows.data(), m_padded}, columns, 1.0 / (h * h), samples.columns());
	samples.resize(m_size);
}

} // namespace curvature_lines
