// The frontier of the cloud as seen from each vertex of a rim.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rim_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "frontier.h"
#include "neighborhoods.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

constexpr Index  longestReach = 40; // of the part of a rim that tells where it lies, to either side
constexpr Index  sideReach    = 6;  // of the direction in which a side meets a corner
constexpr double sameCourse   = 0.6; // cosine of the turn
constexpr double sameSheet    = 0.5; // cosine of normals
constexpr double depth        = 4.0; // points so near are looked at; these in vertex spacings
constexpr double bandDepth    = 3.0; // the density is that of the points from a gap to this
constexpr double mostGap      = 2.0;
constexpr double mostOffset   = 1.5;
constexpr double mostCornerOffset = 4.0;
constexpr double straight         = 0.9; // cosine of the turn of a corner that is none
constexpr int    fitSteps         = 3;   // each sees sides and corners where the last put them

// A vertex of a rim and the frame from which it looks at the end of the surface.
struct View {
	Vector3d origin, tangent, outward;

	View(const Vector3d& from, const Vector3d& along, const Vector3d& normal) :
			origin(from), tangent((along - along.dot(normal) * normal).normalized()),
			outward(tangent.cross(normal))
	{
	}
	Eigen::Vector2d of(const Vector3d& p) const
	{
		return {(p - origin).dot(tangent), (p - origin).dot(outward)};
	}
	Vector3d at(double s, double x) const { return origin + s * tangent + x * outward; }
};

// Part of a rim around one vertex, up to corners and to where it has turned away.
struct Reach {
	Index behind = 0, ahead = 0; // vertices
};

// The rims of a scaffold with the cloud beside them.
class RimFit {
public:
	RimFit(
		std::vector<Rim>&       rims,
		const PointCloud&       cloud,
		const Eigen::Matrix3Xd& normals,
		double                  noise,
		Scaffold&               scaffold) :
			m_rims(rims),
			m_cloud(cloud), m_normals(normals), m_noise(noise), m_spacing(scaffold.spacing),
			m_positions(scaffold.mesh.vertices)
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
			if ((m_cloud.positions.col(j) - rimPositions.col(i)).norm() < depth * m_spacing &&
				m_cloud.normals.col(j).dot(m_normals.col(vertexAt(i))) > sameSheet)
				owner[j] = vertexAt(i);
		});
		m_beside.assign(m_positions.cols(), {});
		for (Index j = 0; j < m_cloud.size(); ++j)
			if (owner[j] >= 0)
				m_beside[owner[j]].push_back(j);
		m_inBand.assign(m_positions.cols(), 0);
		for (const Place& place : m_places) {
			const Rim& rim = m_rims[place.rim];
			const View view(
				position(rim, place.k),
				position(rim, place.k + 1) - position(rim, place.k - 1),
				m_normals.col(rim.at(place.k)));
			for (const Index j : m_beside[rim.at(place.k)]) {
				const double x = view.of(m_cloud.positions.col(j)).y();
				m_inBand[rim.at(place.k)] += x < -gap() && x > -bandDepth * m_spacing;
			}
		}
	}

	// Of the band in which the density is measured from the rim: past what noise and voids do there.
	double gap() const { return std::min(m_spacing + 2.0 * m_noise, mostGap * m_spacing); }

	Index vertexAt(std::size_t i) const { return m_rims[m_places[i].rim].at(m_places[i].k); }

	Vector3d position(const Rim& rim, Index k) const { return m_positions.col(rim.at(k)); }

	Reach reachOf(const Rim& rim, Index k, const View& view) const
	{
		const Index most   = std::min(longestReach, rim.size() / 4);
		const auto  extent = [&](Index step) {
			Index m = 0;
			while (m < most) {
				const Index    here = k + step * m;
				const Vector3d edge = position(rim, here + step) - position(rim, here);
				const bool turned   = step * edge.normalized().dot(view.tangent) < sameCourse;
				if (m > 0 && (rim.isCorner(here) || turned))
					break;
				++m;
			}
			return m;
		};
		return {extent(-1), extent(1)};
	}

	// Where the surface ends as seen from a vertex.
	std::optional<Frontier>
	frontierOf(const Rim& rim, Index k, const View& view, const Reach& reach) const
	{
		std::vector<Eigen::Vector2d> seen;
		double                       inBand = 0.0, length = 0.0;
		for (Index m = k - reach.behind; m <= k + reach.ahead; ++m) {
			for (const Index j : m_beside[rim.at(m)])
				seen.push_back(view.of(m_cloud.positions.col(j)));
			if (m == k - reach.behind || m == k + reach.ahead) // only half beside the part
				continue;
			inBand += m_inBand[rim.at(m)];
			length += 0.5 * (position(rim, m + 1) - position(rim, m)).norm() +
					  0.5 * (position(rim, m) - position(rim, m - 1)).norm();
		}
		const double density = inBand / (length * (bandDepth * m_spacing - gap()));
		if (!(density > 0.0) || !std::isfinite(density))
			return {};
		return fitFrontier(
			Eigen::Map<const Eigen::Matrix2Xd>(seen[0].data(), 2, seen.size()),
			view.of(position(rim, k - reach.behind)).x(),
			view.of(position(rim, k + reach.ahead)).x(),
			density,
			m_noise);
	}

	Vector3d fitted(const Rim& rim, Index k) const
	{
		const View view(position(rim, k), rim.tangent(k, m_positions), m_normals.col(rim.at(k)));
		if (!view.tangent.allFinite())
			return view.origin;
		const auto   frontier = frontierOf(rim, k, view, reachOf(rim, k, view));
		const double most     = mostOffset * m_spacing;
		return view.at(0.0, frontier ? std::clamp(frontier->value, -most, most) : 0.0);
	}

	// Half-way between the nearest points of the lines in which the two sides end. Nothing where these are one:
	// the front turned around a void.
	std::optional<Vector3d> fittedCorner(const Rim& rim, Index k) const
	{
		const Vector3d start = position(rim, k), normal = m_normals.col(rim.at(k));
		Vector3d       p[2], d[2];
		for (const Index side : {0, 1}) {
			const View view(
				start,
				side == 0 ? start - position(rim, k - sideReach)
						  : position(rim, k + sideReach) - start,
				normal);
			if (!view.tangent.allFinite())
				return start;
			Reach reach                              = reachOf(rim, k, view);
			(side == 0 ? reach.ahead : reach.behind) = 0;
			const auto frontier                      = frontierOf(rim, k, view, reach);
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
		return (meet - start).norm() < mostCornerOffset * m_spacing ? meet : start;
	}

	std::vector<Rim>&               m_rims;
	const PointCloud&               m_cloud;
	const Eigen::Matrix3Xd&         m_normals;
	double                          m_noise, m_spacing;
	Eigen::Matrix3Xd&               m_positions;
	std::vector<Place>              m_places;
	std::vector<std::vector<Index>> m_beside; // of every vertex: points of the cloud
	std::vector<Index>              m_inBand; // how many of them tell the density
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
