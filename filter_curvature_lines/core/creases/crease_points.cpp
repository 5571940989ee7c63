// Faces around each point by the normals they predict for it, and its foot on their intersection.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "crease_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "local_surface.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "quantile.h"
#include "robust_kernel.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// By experiment (benchmarks/creases.py): cubes, an L-shaped block and a capped cylinder at 0 to 0.5 % noise have all
// their edges, eight smooth surfaces at 0 to 2 % have none.
constexpr Index  neighbors        = 64;
constexpr double spacingsInRadius = 4.5; // of the ball that holds so many points: sqrt(64 / pi)
// The ball is no smaller than this many faceDeviations: in a smaller one a face has no sure normal.
constexpr double deviationsInRadius = 6.0;
constexpr Index  deviationPoints    = 2000; // at which faceDeviation is measured
// Tangent of the turn of a normal up to which a face is continued: 27 degrees.
constexpr double largestTurn = 0.5;
// Of the smallest angle: normals that differ by less are of one face.
constexpr double groupShare = 0.85;
constexpr int    maxFaces   = 6; // around one point; corners have three or four
constexpr int    minMembers = 3; // points of a face
// Faces at a larger angle are the two sides of a thin sheet.
constexpr double largestAngle = 165.0 * EIGEN_PI / 180.0;
// Points of both faces lie within this distance of a crease, in spacings or faceDeviations, and of all points of a face
// this share on its side of the crease: beside a rim there are none beyond.
constexpr double supportSpacings   = 3.0;
constexpr double supportDeviations = 2.5;
constexpr double sideShare         = 0.7;
constexpr double outlierScales     = 3.0; // robust standard deviations: heights beyond do not count

// The points around one point, grouped to faces that can be continued to other places. Holds the scratch of one thread.
class FacesAround {
public:
	static FacesAround& ofThisThread()
	{
		thread_local FacesAround around;
		return around;
	}

	double radius() const { return m_radius; }
	double spacing() const { return m_spacing; }
	int faces() const { return m_faces; }
	int members(int face) const { return m_count[face]; }

	// Face 0 is that of point i.
	void group(
		const std::vector<SurfaceElement>& elements,
		const NeighborSearch&              search,
		Index                              i,
		double                             deviation,
		double                             maxDifference)
	{
		const Vector3d position = elements[i].position;
		m_elements              = &elements;
		m_near                  = search.nearest(position, neighbors);
		m_radius                = (elements[m_near.back()].position - position).norm();
		m_spacing               = m_radius / spacingsInRadius;
		if (m_radius < deviationsInRadius * deviation) {
			m_radius = deviationsInRadius * deviation;
			m_near   = search.within(position, m_radius);
		}
		m_face.assign(m_near.size(), -1);
		m_weight.assign(m_near.size(), 0.0);
		m_faces = 1;
		m_count = {};
		std::array<Vector3d, maxFaces> sums;
		sums[0] = elements[i].normal;
		for (std::size_t k = 0; k < m_near.size(); ++k) {
			const SurfaceElement& e    = elements[m_near[k]];
			const Vector3d        d    = position - e.position;
			const Vector3d        turn = e.shape * d;
			if (turn.norm() > largestTurn)
				continue;
			const Vector3d normal = (e.normal + turn).normalized();
			int            face   = -1;
			double         best   = maxDifference;
			for (int f = 0; f < m_faces; ++f) {
				const double difference = (sums[f].normalized() - normal).norm();
				if (difference < best) {
					best = difference;
					face = f;
				}
			}
			if (face < 0) {
				if (m_faces == maxFaces)
					continue;
				face       = m_faces++;
				sums[face] = Vector3d::Zero();
			}
			m_face[k]   = face;
			m_weight[k] = ballKernel(d.squaredNorm() / (m_radius * m_radius)) + 1e-6;
			sums[face] += m_weight[k] * normal;
			++m_count[face];
		}
	}

	struct Plane {
		Vector3d normal = Vector3d::Zero();
		double   height = 0.0; // of the place above the face
		bool     valid  = false;
	};

	// The face's tangent plane near `place`. `skipped`: a point that does not count.
	Plane planeAt(int face, const Vector3d& place, Index skipped = -1)
	{
		Plane plane;
		m_heights.clear();
		for (std::size_t k = 0; k < m_near.size(); ++k) {
			if (m_face[k] != face || m_near[k] == skipped)
				continue;
			const SurfaceElement& e    = (*m_elements)[m_near[k]];
			const Vector3d        d    = place - e.position;
			const Vector3d        turn = e.shape * d;
			if (turn.norm() > largestTurn)
				continue;
			plane.normal += m_weight[k] * (e.normal + turn);
			m_heights.emplace_back(d.dot(e.normal) + 0.5 * d.dot(turn), m_weight[k]);
		}
		if (static_cast<int>(m_heights.size()) < minMembers)
			return plane;
		plane.normal.normalize();
		plane.height = robustMean();
		plane.valid  = plane.normal.allFinite();
		return plane;
	}

	Vector3d centerOf(int face) const
	{
		Vector3d sum   = Vector3d::Zero();
		double   total = 0.0;
		for (std::size_t k = 0; k < m_near.size(); ++k)
			if (m_face[k] == face) {
				sum += m_weight[k] * (*m_elements)[m_near[k]].position;
				total += m_weight[k];
			}
		return sum / total;
	}

	// Whether points of the face are near `place` and lie on the side that `inward` points to.
	bool supports(int face, const Vector3d& place, const Vector3d& inward, double reach) const
	{
		int inside = 0, near = 0;
		for (std::size_t k = 0; k < m_near.size(); ++k) {
			if (m_face[k] != face)
				continue;
			const Vector3d d = (*m_elements)[m_near[k]].position - place;
			inside += d.dot(inward) > -0.5 * reach;
			near += d.squaredNorm() < reach * reach;
		}
		return near >= 2 && inside >= sideShare * m_count[face];
	}

private:
	// Of m_heights, without those far from the median.
	double robustMean()
	{
		m_sorted.clear();
		for (const auto& [height, weight] : m_heights)
			m_sorted.push_back(height);
		const double median = medianInPlace(m_sorted);
		for (double& height : m_sorted)
			height = std::abs(height - median);
		const double limit = outlierScales * deviationOverMedian * medianInPlace(m_sorted) + 1e-12;
		double       sum = 0.0, total = 0.0;
		for (const auto& [height, weight] : m_heights)
			if (std::abs(height - median) <= limit) {
				sum += weight * height;
				total += weight;
			}
		return sum / total;
	}

	const std::vector<SurfaceElement>*     m_elements = nullptr;
	double                                 m_radius = 0.0, m_spacing = 0.0;
	int                                    m_faces = 0;
	std::array<int, maxFaces>              m_count = {};
	std::vector<Index>                     m_near;
	std::vector<int>                       m_face;    // per entry of m_near, -1: none
	std::vector<double>                    m_weight;  // per entry of m_near
	std::vector<std::pair<double, double>> m_heights; // height, weight
	std::vector<double>                    m_sorted;
};

// The smallest step onto both planes.
Vector3d stepOntoBoth(const FacesAround::Plane& a, const FacesAround::Plane& b)
{
	const double cosine = a.normal.dot(b.normal);
	const double det    = 1.0 - cosine * cosine;
	return -((a.height - cosine * b.height) * a.normal +
	         (b.height - cosine * a.height) * b.normal) /
	       det;
}

// Where face 0 meets another one. False where they do not.
bool meet(
	FacesAround&    around,
	int             face,
	const Vector3d& position,
	double          deviation,
	double          minAngle,
	CreasePoint&    result)
{
	Vector3d           foot = position;
	FacesAround::Plane own, other;
	double             angle = 0.0;
	// From the second time on with the faces continued to where they meet.
	for (int it = 0; it < 3; ++it) {
		own   = around.planeAt(0, foot);
		other = around.planeAt(face, foot);
		if (!own.valid || !other.valid)
			return false;
		angle = std::atan2(own.normal.cross(other.normal).norm(), own.normal.dot(other.normal));
		if (angle < minAngle || angle > largestAngle)
			return false;
		foot += stepOntoBoth(own, other);
		if ((foot - position).norm() > around.radius())
			return false;
	}
	const Vector3d across     = around.centerOf(face) - around.centerOf(0);
	const double   otherAbove = across.dot(own.normal), ownAbove = -across.dot(other.normal);
	if (otherAbove * ownAbove <= 0.0)
		return false;
	const double side = otherAbove < 0.0 ? 1.0 : -1.0; // +1: convex
	result.position   = foot;
	result.left       = own.normal;
	result.right      = other.normal;
	result.tangent    = (side * own.normal.cross(other.normal)).normalized();
	result.angle      = side * angle;
	result.spacing    = around.spacing();
	result.weight =
		ballKernel((foot - position).squaredNorm() / (around.radius() * around.radius()));
	const double reach =
		std::max(supportSpacings * around.spacing(), supportDeviations * deviation);
	return around.supports(0, foot, own.normal.cross(result.tangent), reach) &&
	       around.supports(face, foot, result.tangent.cross(other.normal), reach);
}

} // namespace

CreasePoint CreasePoint::reversed() const
{
	CreasePoint other = *this;
	other.tangent     = -tangent;
	std::swap(other.left, other.right);
	other.fromLeft = !fromLeft;
	return other;
}

CreasePoints findCreasePoints(
	const std::vector<SurfaceElement>& elements,
	const NeighborSearch&              search,
	double                             minAngle,
	const Progress&                    progress)
{
	const auto          n             = static_cast<Index>(elements.size());
	const double        maxDifference = groupShare * minAngle;
	CreasePoints        result;
	std::vector<double> heights(std::min(n, deviationPoints), -1.0);
	parallelFor(static_cast<Index>(heights.size()), {}, [&](Index i) {
		FacesAround& around = FacesAround::ofThisThread();
		around.group(elements, search, i, 0.0, maxDifference);
		if (const auto plane = around.planeAt(0, elements[i].position, i); plane.valid)
			heights[i] = std::abs(plane.height);
	});
	heights.erase(std::remove(heights.begin(), heights.end(), -1.0), heights.end());
	if (heights.empty())
		return result;
	result.faceDeviation = deviationOverMedian * medianInPlace(heights);

	std::vector<std::vector<CreasePoint>> rows(n);
	parallelForPoints(search, progress, [&](Index i) {
		FacesAround& around = FacesAround::ofThisThread();
		around.group(elements, search, i, result.faceDeviation, maxDifference);
		for (int face = 1; face < around.faces(); ++face) {
			CreasePoint point;
			if (around.members(face) >= minMembers &&
			    meet(around, face, elements[i].position, result.faceDeviation, minAngle, point))
				rows[i].push_back(point);
		}
	});
	for (const auto& row : rows)
		result.points.insert(result.points.end(), row.begin(), row.end());
	return result;
}

} // namespace curvature_lines
