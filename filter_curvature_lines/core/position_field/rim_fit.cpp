// The frontier of the cloud as seen from each vertex of a rim, in the plane onto which the strip beside it
// unrolls: a projection would bend and crowd what is far, and corners, which see one side, need to look
// far.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rim_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "frontier.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "quantile.h"
#include "rims.h"
#include "scaffold.h"

namespace curvature_lines {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Chosen on helicoids, seeds 1 to 20 (benchmarks/quad_mesh.py open). "Vertices" are those of the rim;
// "spacings" those of the scaffold's vertices.

// Vertices to either side, of the part of a rim whose points are used for one vertex: at most, and at least.
constexpr Index longestReach  = 90;
constexpr Index shortestReach = 12;
// RMS distance of that part from a circle, in spacings: beyond, a shorter part is taken.
constexpr double mostWinding = 1.0;
// Cosine of the turn from the first to the last chord of that part, 120 degrees, and the vertices of a chord.
constexpr double sameCourse = -0.5;
constexpr Index  chordReach = 4;
// Vertices over which the direction is taken in which a side meets a corner, and beside which points of the
// other side lie.
constexpr Index sideReach    = 6;
constexpr Index aroundCorner = 5;
// Points count that are of the rim's sheet (cosine of normals, 60 degrees) and within so many spacings of it.
constexpr double sameSheet = 0.5;
constexpr double depth     = 4.0;
// The density is that of a band along the rim, so many spacings deep, without the gap next to the rim that
// noise and voids make: a spacing and two noise units, but at most so many spacings. The length of the band
// over the rim's is at least leastBand, where the rim bends around it.
constexpr double bandDepth = 3.0;
constexpr double mostGap   = 2.0;
constexpr double leastBand = 0.5;
// Spacings that a vertex and a corner may move in one round.
constexpr double mostOffset       = 1.5;
constexpr double mostCornerOffset = 4.0;
// Cosine of the turn, 26 degrees, below which a corner is none: the front only turned around a void.
constexpr double straight = 0.9;
// Rounds: each sees sides and corners where the last one put them.
constexpr int fitSteps = 3;

// A vertex of a rim and its frame: along the rim and outwards.
struct View {
	Vector3d origin, tangent, outward;

	View(const Vector3d& from, const Vector3d& along, const Vector3d& normal) :
			origin(from), tangent((along - along.dot(normal) * normal).normalized()),
			outward(tangent.cross(normal))
	{
	}
	Vector2d of(const Vector3d& p) const
	{
		return {(p - origin).dot(tangent), (p - origin).dot(outward)};
	}
	Vector3d at(double s, double x) const { return origin + s * tangent + x * outward; }

	// From another vertex, turned no more than the normal.
	View moved(const Vector3d& to, const Vector3d& normal) const
	{
		const auto turn = Eigen::Quaterniond::FromTwoVectors(outward.cross(tangent), normal);
		View       next = *this;
		next.origin     = to;
		next.tangent    = turn * tangent;
		next.outward    = turn * outward;
		return next;
	}

	void turn(double slope)
	{
		const Vector3d along = (tangent + slope * outward).normalized();
		outward              = (outward - slope * tangent).normalized();
		tangent              = along;
	}
};

// A circle through the origin of a plane, there about in the direction of its first axis. Straightens what
// lies along it: the end of a surface that is bent as a parabola is only for a short way is then nearly
// straight.
struct Circle {
	double slope = 0.0, curvature = 0.0;
	double winding = 0.0; // RMS distance of what it was found for

	// Along it, and how far to its left.
	Vector2d of(const Vector2d& point) const
	{
		const double   length = std::sqrt(1.0 + slope * slope);
		const Vector2d p(
			(point.x() + slope * point.y()) / length, (point.y() - slope * point.x()) / length);
		const double across = 2.0 * p.y() - curvature * p.squaredNorm();
		const double share  = std::sqrt(std::max(0.0, 1.0 - curvature * across)); // of the radius
		const double angle  = std::atan2(curvature * p.x(), 1.0 - curvature * p.y());
		const double along  = std::abs(angle) > 1e-6 ? angle / curvature : p.x();
		return {along, across / (1.0 + share)};
	}
};

// The one beside points by algebraic least squares, moved to the origin.
Circle circleAlong(const std::vector<Vector2d>& points)
{
	double scale = 0.0;
	for (const Vector2d& p : points)
		scale = std::max(scale, p.norm());
	Eigen::Matrix3d left  = Eigen::Matrix3d::Zero();
	Vector3d        right = Vector3d::Zero();
	for (const Vector2d& p : points) {
		const Vector2d u = p / scale;
		const Vector3d row(1.0, u.x(), 0.5 * u.squaredNorm());
		left += row * row.transpose();
		right += u.y() * row;
	}
	const Vector3d c      = left.ldlt().solve(right);
	const double   square = 1.0 + c[1] * c[1] + 2.0 * c[0] * c[2];
	Circle         circle;
	if (c.allFinite() && square > 0.0) {
		circle.slope     = c[1];
		circle.curvature = c[2] / (scale * std::sqrt(square));
	}
	Eigen::VectorXd across(points.size());
	for (std::size_t i = 0; i < points.size(); ++i)
		across[i] = circle.of(points[i]).y();
	circle.winding = std::sqrt((across.array() - across.mean()).square().mean());
	return circle;
}

// Part of a rim around one vertex: the strip beside it unrolled into the plane, the rim about along the
// first axis.
struct Strip {
	std::vector<Vector2d> rim, points;
	Vector2d              begin = Vector2d::Zero(), end = Vector2d::Zero(); // of the rim
	double                density = 0.0;                                    // of points
};

// Of every vertex; beside a rim, where neighbours are missing, no more than of most.
Eigen::VectorXd spacingsOf(const Scaffold& scaffold)
{
	std::vector<double> all(scaffold.spacing.begin(), scaffold.spacing.end());
	return scaffold.spacing.cwiseMin(medianInPlace(all));
}

// The rims of a scaffold with the cloud beside them.
class RimFit {
public:
	RimFit(
		std::vector<Rim>&       rims,
		const PointCloud&       cloud,
		const Eigen::Matrix3Xd& normals,
		double                  noise,
		Scaffold&               scaffold) :
			m_rims(rims), m_cloud(cloud), m_normals(normals), m_noise(noise),
			m_spacing(spacingsOf(scaffold)), m_positions(scaffold.mesh.vertices)
	{
		for (Index r = 0; r < static_cast<Index>(rims.size()); ++r)
			for (Index k = 0; k < rims[r].size(); ++k)
				m_places.push_back({r, k});
	}

	void step()
	{
		assignPoints();
		Eigen::Matrix3Xd  moved(3, m_places.size());
		std::vector<char> corner(m_places.size());
		parallelFor(m_places.size(), {}, [&](Index i) {
			const Rim&  rim  = m_rims[m_places[i].rim];
			const Index k    = m_places[i].k;
			const auto  meet = rim.corner[k] ? fittedCorner(rim, k) : std::nullopt;
			corner[i]        = meet.has_value();
			moved.col(i)     = meet ? *meet : fitted(rim, k);
		});
		for (std::size_t i = 0; i < m_places.size(); ++i) {
			m_positions.col(vertexAt(i))                  = moved.col(i);
			m_rims[m_places[i].rim].corner[m_places[i].k] = corner[i];
		}
	}

private:
	struct Place {
		Index rim, k;
	};

	// In which the density is measured: past what noise and voids do at the rim.
	struct Band {
		double points = 0.0, length = 0.0;

		void operator+=(const Band& other)
		{
			points += other.points;
			length += other.length;
		}
	};

	// Gives every point near a rim to the vertex next to it.
	void assignPoints()
	{
		Eigen::Matrix3Xd rimPositions(3, m_places.size());
		for (std::size_t i = 0; i < m_places.size(); ++i)
			rimPositions.col(i) = m_positions.col(vertexAt(i));
		const NeighborSearch search(rimPositions);
		std::vector<Index>   owner(m_cloud.size(), -1);
		parallelFor(m_cloud.size(), {}, [&](Index j) {
			const Index i = search.nearest(m_cloud.positions.col(j), 1)[0];
			if ((m_cloud.positions.col(j) - rimPositions.col(i)).norm() <
			        depth * m_spacing[vertexAt(i)] &&
			    m_cloud.normals.col(j).dot(m_normals.col(vertexAt(i))) > sameSheet)
				owner[j] = vertexAt(i);
		});
		m_beside.assign(m_positions.cols(), {});
		for (Index j = 0; j < m_cloud.size(); ++j)
			if (owner[j] >= 0)
				m_beside[owner[j]].push_back(j);
		m_inBand.assign(m_positions.cols(), 0);
		m_besideCorner.assign(m_positions.cols(), 0);
		for (const Place& place : m_places) {
			const Rim& rim = m_rims[place.rim];
			for (Index m = -aroundCorner; m <= aroundCorner; ++m)
				m_besideCorner[rim.at(place.k)] |= rim.isCorner(place.k + m);
			const View view(
				position(rim, place.k),
				position(rim, place.k + 1) - position(rim, place.k - 1),
				m_normals.col(rim.at(place.k)));
			const double spacing = m_spacing[rim.at(place.k)];
			for (const Index j : m_beside[rim.at(place.k)]) {
				const double x = view.of(m_cloud.positions.col(j)).y();
				m_inBand[rim.at(place.k)] += x < -gap(spacing) && x > -bandDepth * spacing;
			}
		}
	}

	double gap(double spacing) const
	{
		return std::min(spacing + 2.0 * m_noise, mostGap * spacing);
	}

	Index vertexAt(std::size_t i) const { return m_rims[m_places[i].rim].at(m_places[i].k); }

	Vector3d position(const Rim& rim, Index k) const { return m_positions.col(rim.at(k)); }

	// Up to corners, to where the rim has turned away, and to `most` vertices; ahead (side 1), behind (-1) or
	// both (0).
	Strip unrolled(const Rim& rim, Index k, const View& view, int side, Index most) const
	{
		Strip      strip;
		const auto addPoints = [&](Index here, const View& local, const Vector2d& at) {
			for (const Index j : m_beside[rim.at(here)])
				strip.points.push_back(at + local.of(m_cloud.positions.col(j)));
		};
		strip.rim.push_back(Vector2d::Zero());
		addPoints(k, view, Vector2d::Zero());
		Band all, clear; // beside corners a part of the band is the other side's
		for (const Index step : {-1, 1}) {
			View                  local = view;
			std::vector<Vector2d> course(1, Vector2d::Zero());
			// Points of this side lie beside the first vertices beyond its corner too.
			bool  beyond = side == -step;
			Index last   = beyond ? aroundCorner : most;
			for (Index m = 1; m <= last; ++m) {
				const Index    here = k + step * m, before = here - step;
				const View     next = local.moved(position(rim, here), m_normals.col(rim.at(here)));
				const Vector2d to =
					course.back() + 0.5 * (local.of(next.origin) - next.of(local.origin));
				const Vector2d chord = to - course[std::max<Index>(0, m - chordReach)];
				if (!beyond && m > 1 && !(step * chord.normalized().x() > sameCourse))
					break;
				local = next;
				course.push_back(to);
				addPoints(here, local, to);
				if (beyond)
					continue;
				strip.rim.push_back(to);
				(step < 0 ? strip.begin : strip.end) = to;
				const Band between{
					0.5 * (m_inBand[rim.at(here)] + m_inBand[rim.at(before)]),
					(position(rim, here) - position(rim, before)).norm()};
				all += between;
				if (!m_besideCorner[rim.at(here)] && !m_besideCorner[rim.at(before)])
					clear += between;
				if (rim.isCorner(here)) {
					beyond = true;
					last   = m + aroundCorner;
				}
			}
		}
		const Band&  band    = clear.length > 0.0 ? clear : all;
		const double spacing = m_spacing[rim.at(k)];
		strip.density        = band.points / (band.length * (bandDepth * spacing - gap(spacing)));
		return strip;
	}

	// Where the surface ends as seen from a vertex along the longest part of the rim that follows a circle;
	// turns the view along that.
	std::optional<Frontier> frontierOf(const Rim& rim, Index k, View& view, int side) const
	{
		const double spacing = m_spacing[rim.at(k)];
		Index        reach   = std::min(longestReach, rim.size() / 4);
		Strip        strip   = unrolled(rim, k, view, side, reach);
		Circle       circle  = circleAlong(strip.rim);
		while (circle.winding > mostWinding * spacing && reach > shortestReach) {
			reach  = 2 * reach / 3;
			strip  = unrolled(rim, k, view, side, reach);
			circle = circleAlong(strip.rim);
		}
		// The band lies deeper than the rim, and where this bends around it is shorter.
		const double middle  = 0.5 * (gap(spacing) + bandDepth * spacing);
		const double density = strip.density / std::max(leastBand, 1.0 + circle.curvature * middle);
		if (!(density > 0.0) || !std::isfinite(density))
			return {};
		view.turn(circle.slope);
		Eigen::Matrix2Xd seen(2, strip.points.size());
		Index            count = 0;
		for (const Vector2d& p : strip.points) {
			seen.col(count) = circle.of(p);
			count += seen(1, count) > -depth * spacing;
		}
		return fitFrontier(
			seen.leftCols(count),
			circle.of(strip.begin).x(),
			circle.of(strip.end).x(),
			density,
			m_noise);
	}

	Vector3d fitted(const Rim& rim, Index k) const
	{
		View view(position(rim, k), rim.tangent(k, m_positions), m_normals.col(rim.at(k)));
		if (!view.tangent.allFinite())
			return view.origin;
		const auto   frontier = frontierOf(rim, k, view, 0);
		const double most     = mostOffset * m_spacing[rim.at(k)];
		return view.at(0.0, frontier ? std::clamp(frontier->value, -most, most) : 0.0);
	}

	// Half-way between the nearest points of the lines in which the two sides end. Nothing where these are
	// one: the front turned around a void.
	std::optional<Vector3d> fittedCorner(const Rim& rim, Index k) const
	{
		Vector3d       start  = position(rim, k);
		const Vector3d normal = m_normals.col(rim.at(k));
		Vector3d       p[2], d[2];
		for (const Index side : {0, 1}) {
			View view(
				start,
				side == 0 ? start - position(rim, k - sideReach)
						  : position(rim, k + sideReach) - start,
				normal);
			if (!view.tangent.allFinite())
				return start;
			const auto frontier = frontierOf(rim, k, view, side == 0 ? -1 : 1);
			if (!frontier)
				return start;
			p[side] = view.at(0.0, frontier->value);
			d[side] = (view.tangent + frontier->slope * view.outward).normalized();
		}
		const double cosine = d[0].dot(d[1]), det = 1.0 - cosine * cosine;
		if (cosine > straight)
			return {};
		if (!(cosine > -straight))
			return start;
		const Vector3d w    = p[1] - p[0];
		const double   s    = (w.dot(d[0]) - cosine * w.dot(d[1])) / det,
					 t      = (cosine * w.dot(d[0]) - w.dot(d[1])) / det;
		const Vector3d meet = 0.5 * (p[0] + s * d[0] + p[1] + t * d[1]);
		return (meet - start).norm() < mostCornerOffset * m_spacing[rim.at(k)] ? meet : start;
	}

	std::vector<Rim>&               m_rims;
	const PointCloud&               m_cloud;
	const Eigen::Matrix3Xd&         m_normals;
	double                          m_noise;
	Eigen::VectorXd                 m_spacing; // of every vertex
	Eigen::Matrix3Xd&               m_positions;
	std::vector<Place>              m_places;
	std::vector<std::vector<Index>> m_beside; // of every vertex: points of the cloud
	std::vector<Index>              m_inBand; // of every vertex: how many of them
	std::vector<char>               m_besideCorner;
};

} // namespace

void fitRims(
	std::vector<Rim>&       rims,
	const PointCloud&       cloud,
	const Eigen::Matrix3Xd& normals,
	double                  noise,
	Scaffold&               scaffold)
{
	if (rims.empty())
		return;
	RimFit fit(rims, cloud, normals, noise, scaffold);
	for (int step = 0; step < fitSteps; ++step)
		fit.step();
}

} // namespace curvature_lines
