// Gathering of control points and Gaussian sums over them, four at a time.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "control_neighborhood.h"

#include <algorithm>
#include <limits>

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

// Offsets of four points from a place, and their Gaussian weights.
struct Offsets {
	Block x, y, z, weight;
};

inline void offsetsAt(
	const double* rows, int padded, int s, const Vector3d& place, double sharpness, Offsets& d)
{
	d.x      = blockAt(rows + s) - place.x();
	d.y      = blockAt(rows + padded + s) - place.y();
	d.z      = blockAt(rows + 2 * padded + s) - place.z();
	d.weight = sharpness * (d.x * d.x + d.y * d.y + d.z * d.z);
	toExpOfNegative(d.weight);
}

CURVATURE_LINES_AVX2_CLONE void
addUp(const double* rows, int padded, const Vector3d& place, double sharpness, NormalSums& sums)
{
	Block weight = {}, plane = {}, offset[3] = {}, normal[3] = {};
	for (int s = 0; s < padded; s += blockSize) {
		Offsets d;
		offsetsAt(rows, padded, s, place, sharpness, d);
		const Block nx = blockAt(rows + 3 * padded + s), ny = blockAt(rows + 4 * padded + s),
					nz = blockAt(rows + 5 * padded + s);
		const Block w  = d.weight;
		weight += w;
		offset[0] += w * d.x;
		offset[1] += w * d.y;
		offset[2] += w * d.z;
		normal[0] += w * nx;
		normal[1] += w * ny;
		normal[2] += w * nz;
		plane += w * (d.x * nx + d.y * ny + d.z * nz);
	}
	sums.weight = sumOf(weight);
	sums.offset = {sumOf(offset[0]), sumOf(offset[1]), sumOf(offset[2])};
	sums.normal = {sumOf(normal[0]), sumOf(normal[1]), sumOf(normal[2])};
	sums.plane  = sumOf(plane);
}

CURVATURE_LINES_AVX2_CLONE void
addUp(const double* rows, int padded, const Vector3d& place, double sharpness, PlaneSums& sums)
{
	Block weight = {}, offset[3] = {}, xx = {}, xy = {}, xz = {}, yy = {}, yz = {}, zz = {};
	for (int s = 0; s < padded; s += blockSize) {
		Offsets d;
		offsetsAt(rows, padded, s, place, sharpness, d);
		const Block wx = d.weight * d.x, wy = d.weight * d.y, wz = d.weight * d.z;
		weight += d.weight;
		offset[0] += wx;
		offset[1] += wy;
		offset[2] += wz;
		xx += wx * d.x;
		xy += wx * d.y;
		xz += wx * d.z;
		yy += wy * d.y;
		yz += wy * d.z;
		zz += wz * d.z;
	}
	sums.weight      = sumOf(weight);
	sums.offset      = {sumOf(offset[0]), sumOf(offset[1]), sumOf(offset[2])};
	const double sxy = sumOf(xy), sxz = sumOf(xz), syz = sumOf(yz);
	sums.square << sumOf(xx), sxy, sxz, sxy, sumOf(yy), syz, sxz, syz, sumOf(zz);
}

CURVATURE_LINES_AVX2_CLONE void project(
	const double*       rows,
	int                 padded,
	const Vector3d&     place,
	const TangentFrame& frame,
	double              h,
	LocalSamples<1>&    samples)
{
	const Vector3d u = frame.u / h, v = frame.v / h, n = frame.n / h;
	for (int s = 0; s < padded; s += blockSize) {
		Offsets d;
		offsetsAt(rows, padded, s, place, 1.0 / (h * h), d);
		blockAt(&samples.x[s])        = d.x * u.x() + d.y * u.y() + d.z * u.z();
		blockAt(&samples.y[s])        = d.x * v.x() + d.y * v.y() + d.z * v.z();
		blockAt(&samples.value[0][s]) = d.x * n.x() + d.y * n.y() + d.z * n.z();
		blockAt(&samples.weight[s])   = d.weight;
	}
}

} // namespace

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
	NormalSums sums;
	addUp(m_rows.data(), m_padded, place, 1.0 / (h * h), sums);
	return sums;
}

PlaneSums ControlNeighborhood::planeSums(const Vector3d& place, double h) const
{
	PlaneSums sums;
	addUp(m_rows.data(), m_padded, place, 1.0 / (h * h), sums);
	return sums;
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
	project(m_rows.data(), m_padded, place, frame, h, samples);
	samples.resize(m_size);
}

} // namespace curvature_lines
