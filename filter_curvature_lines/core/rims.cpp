// Corners from chords along a rim, and the rim as the expected end of a random sample.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rims.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "neighborhoods.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

constexpr Index  tangentReach = 4; // vertices to both sides
constexpr Index  chordReach   = 5;
constexpr Index  cornerReach  = 6;   // a corner is the sharpest turn within so many
constexpr double cornerCosine = 0.6; // of the turn: 53 degrees
constexpr double windowLength = 2.5; // half the part of the rim looked at; these in vertex spacings
constexpr double windowDepth  = 3.0;
constexpr double mostOffset   = 1.5;
constexpr double mostCornerOffset = 2.0;
constexpr double sheetHeight  = 1.0;
constexpr double sameSheet    = 0.5; // cosine of normals
constexpr Index  fewestPoints = 4;
constexpr double secondOutermost =
	1.678; // median number of points as far out as the second outermost
constexpr int    smoothingSteps = 8;
constexpr double smoothing      = 0.5,
				 unshrinking    = -0.53;    // Taubin 1995: a low-pass filter that does not shrink
constexpr Index lineBegin = 1, lineEnd = 4; // vertices beside a corner that its sides are fitted to

// Points expected beyond x when they lie `density` per length up to 0, blurred by `noise`.
double expectedBeyond(double x, double density, double noise)
{
	if (!(noise > 0.0))
		return density * std::max(-x, 0.0);
	const double z    = x / noise;
	const double tail = 0.5 * std::erfc(z / std::sqrt(2.0));
	const double bell = std::exp(-0.5 * z * z) / std::sqrt(2.0 * double(EIGEN_PI));
	return density * noise * (bell - z * tail);
}

// Where the second outermost point is expected to be, seen from the end of the sample.
double expectedSecond(double density, double noise)
{
	double low = -2.0 * secondOutermost / density, high = 8.0 * noise;
	for (int k = 0; k < 50; ++k) {
		const double middle = 0.5 * (low + high);
		(expectedBeyond(middle, density, noise) > secondOutermost ? low : high) = middle;
	}
	return 0.5 * (low + high);
}

// How far outward of vertex v the surface ends.
double offsetOf(
	const Vector3d&       p,
	const Vector3d&       normal,
	const Vector3d&       tangent,
	const PointCloud&     cloud,
	const NeighborSearch& search,
	double                spacing,
	double                noise)
{
	const Vector3d      outward = tangent.cross(normal).normalized();
	std::vector<double> depths;
	Index               inside = 0;
	for (const Index j : search.within(p, (windowDepth + windowLength) * spacing)) {
		const Vector3d d = cloud.positions.col(j) - p;
		const double   x = d.dot(outward) / spacing;
		if (std::abs(d.dot(tangent)) > windowLength * spacing || std::abs(x) > windowDepth ||
			std::abs(d.dot(normal)) > sheetHeight * spacing * (1.0 + std::abs(x)) ||
			cloud.normals.col(j).dot(normal) < sameSheet)
			continue;
		depths.push_back(x);
		inside += x < -1.0;
	}
	if (inside < fewestPoints)
		return 0.0;
	std::nth_element(depths.begin(), depths.begin() + 1, depths.end(), std::greater<>());
	const double density = inside / (windowDepth - 1.0);
	const double offset  = depths[1] - expectedSecond(density, noise / spacing);
	return std::clamp(offset, -mostOffset, mostOffset) * spacing;
}

// The line through the positions of the rim from k + step * lineBegin on.
void fitLine(
	const Rim&              rim,
	Index                   k,
	Index                   step,
	const Eigen::Matrix3Xd& positions,
	Vector3d&               origin,
	Vector3d&               direction)
{
	origin.setZero();
	const double count = lineEnd - lineBegin + 1;
	for (Index m = lineBegin; m <= lineEnd; ++m)
		origin += positions.col(rim.at(k + step * m)) / count;
	direction.setZero();
	for (Index m = lineBegin; m <= lineEnd; ++m)
		direction += (m - 0.5 * (lineBegin + lineEnd)) * positions.col(rim.at(k + step * m));
	direction.normalize();
}

// Of the vertices around a corner the one farthest from the chord across it: on a front that cuts the corner
// the turn is about as sharp at several.
Index outermost(const Rim& rim, Index k, const Eigen::Matrix3Xd& positions)
{
	const Vector3d a = positions.col(rim.at(k - chordReach));
	const Vector3d d = (positions.col(rim.at(k + chordReach)) - a).normalized();
	Index          best   = k;
	double         height = 0.0;
	for (Index m = k - chordReach + 1; m < k + chordReach; ++m) {
		const Vector3d p = positions.col(rim.at(m)) - a;
		const double   h = (p - p.dot(d) * d).norm();
		if (h > height) {
			height = h;
			best   = m;
		}
	}
	return (best % rim.size() + rim.size()) % rim.size();
}

// Half-way between the nearest points of the two sides' lines; what the sides look like beside the corner
// depends on the void beyond it, and is not used.
void fitCorner(const Rim& rim, Index k, double most, Eigen::Matrix3Xd& positions)
{
	Vector3d p, q, d, e;
	fitLine(rim, k, -1, positions, p, d);
	fitLine(rim, k, 1, positions, q, e);
	const double b = d.dot(e), det = 1.0 - b * b;
	if (!(det > 0.1))
		return;
	const Vector3d w = q - p;
	const double   s = (w.dot(d) - b * w.dot(e)) / det, t = (b * w.dot(d) - w.dot(e)) / det;
	const Vector3d meet = 0.5 * (p + s * d + q + t * e);
	if (!((meet - positions.col(rim.at(k))).norm() < most))
		return;
	positions.col(rim.at(k)) = meet;
	for (const Index side : {-1, 1}) {
		const Vector3d end = positions.col(rim.at(k + side * lineBegin));
		for (Index m = 1; m < lineBegin; ++m)
			positions.col(rim.at(k + side * m)) = meet + double(m) / lineBegin * (end - meet);
	}
}

} // namespace

Vector3d Rim::tangent(Index k, const Eigen::Matrix3Xd& positions) const
{
	const Index reach    = std::max<Index>(1, std::min(tangentReach, size() / 6));
	const auto  isCorner = [&](Index m) { return corner[(m % size() + size()) % size()] != 0; };
	Index       ahead = k, behind = k;
	while (ahead < k + reach && (ahead == k || !isCorner(ahead)))
		++ahead;
	while (behind > k - reach && (behind == k || !isCorner(behind)))
		--behind;
	return (positions.col(at(ahead)) - positions.col(at(behind))).normalized();
}

std::vector<Rim> findRims(const TriangleMesh& mesh)
{
	std::vector<Rim> rims;
	for (std::vector<Index>& loop : mesh.rims()) {
		Rim rim{std::move(loop), {}};
		rim.corner.assign(rim.size(), 0);
		if (rim.size() > 4 * chordReach) {
			std::vector<double> cosines;
			for (Index k = 0; k < rim.size(); ++k) {
				const Vector3d p = mesh.vertices.col(rim.at(k));
				const Vector3d a = p - mesh.vertices.col(rim.at(k - chordReach));
				const Vector3d b = mesh.vertices.col(rim.at(k + chordReach)) - p;
				cosines.push_back(a.normalized().dot(b.normalized()));
			}
			for (Index k = 0; k < rim.size(); ++k) {
				bool sharpest = cosines[k] < cornerCosine;
				for (Index m = -cornerReach; m <= cornerReach && sharpest; ++m) {
					const double other = cosines[(k + m + rim.size()) % rim.size()];
					sharpest           = m < 0 ? cosines[k] < other : cosines[k] <= other;
				}
				if (sharpest)
					rim.corner[outermost(rim, k, mesh.vertices)] = 1;
			}
		}
		rims.push_back(std::move(rim));
	}
	return rims;
}

void fitRims(
	const std::vector<Rim>& rims,
	const PointCloud&       cloud,
	const Eigen::Matrix3Xd& normals,
	double                  noise,
	Scaffold&               scaffold)
{
	if (rims.empty())
		return;
	const NeighborSearch search(cloud.positions);
	Eigen::Matrix3Xd&    positions = scaffold.mesh.vertices;
	for (const Rim& rim : rims) {
		std::vector<Vector3d> moved(rim.size());
		parallelFor(rim.size(), {}, [&](Index k) {
			const Vector3d p = positions.col(rim.at(k)), normal = normals.col(rim.at(k));
			Vector3d       tangent = rim.tangent(k, positions);
			tangent                = (tangent - tangent.dot(normal) * normal).normalized();
			moved[k]               = p;
			if (tangent.allFinite())
				moved[k] += tangent.cross(normal).normalized() *
							offsetOf(p, normal, tangent, cloud, search, scaffold.spacing, noise);
		});
		for (Index k = 0; k < rim.size(); ++k)
			positions.col(rim.at(k)) = moved[k];
		for (Index k = 0; k < rim.size(); ++k)
			if (rim.corner[k])
				fitCorner(rim, k, mostCornerOffset * scaffold.spacing, positions);
		for (int step = 0; step < smoothingSteps; ++step) {
			for (const double share : {smoothing, unshrinking}) {
				for (Index k = 0; k < rim.size(); ++k) {
					const Vector3d p = positions.col(rim.at(k));
					const Vector3d middle =
						0.5 * (positions.col(rim.at(k - 1)) + positions.col(rim.at(k + 1)));
					moved[k] = rim.corner[k] ? p : Vector3d(p + share * (middle - p));
				}
				for (Index k = 0; k < rim.size(); ++k)
					positions.col(rim.at(k)) = moved[k];
			}
		}
	}
}

} // namespace curvature_lines
