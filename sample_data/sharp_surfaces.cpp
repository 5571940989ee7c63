// Capped cylinder and L-shaped block: closed surfaces with a curved and with a concave sharp edge.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_families.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>

#include "analytic_surfaces.h"

namespace curvature_lines::samples {
namespace {

using namespace detail;

class CappedCylinder final : public AnalyticSurface {
public:
	AlignedBox3d boundingBox() const override { return boxAround({R, R, half}); }
	int eulerCharacteristic() const override { return 2; }
	bool closed() const override { return true; }

	Vector3d project(const Vector3d& p) const override
	{
		const Vector2d e = radialDirection(p);
		const double   r = std::hypot(p.x(), p.y());
		if (r < R && half - std::abs(p.z()) < R - r)
			return {p.x(), p.y(), std::copysign(half, p.z())};
		return {R * e.x(), R * e.y(), std::clamp(p.z(), -half, half)};
	}

	SurfaceFrame frame(const Vector3d& q) const override
	{
		if (onCap(q))
			return frameOf(
				std::copysign(1.0, q.z()) * Vector3d::UnitZ(), Vector3d::UnitX(), 0.0, 0.0);
		const Vector2d e = radialDirection(q);
		return frameOf({e.x(), e.y(), 0.0}, {-e.y(), e.x(), 0.0}, 1.0 / R, 0.0);
	}

	double featureDistance(const Vector3d& q) const override
	{
		return onCap(q) ? R - std::hypot(q.x(), q.y()) : half - std::abs(q.z());
	}

	Vector3d sample(Random& random) const override
	{
		const double angle = random.uniform(0.0, 2.0 * pi);
		const double share = random.uniform(); // of the area: side, then the caps
		if (share * (2.0 * half + R) < 2.0 * half)
			return at(R, angle, random.uniform(-half, half));
		const double r = R * std::sqrt(random.uniform());
		return at(r, angle, random.uniform() < 0.5 ? -half : half);
	}

	Matrix3Xd grid(int points) const override
	{
		const auto   rounded = [](double count) { return static_cast<int>(std::lround(count)); };
		const int    onCaps  = rounded(0.5 * points * R / (2.0 * half + R)); // on each
		const double onSide  = points - 2 * onCaps;
		const int    rows    = std::max(2, rounded(std::sqrt(onSide * half / (pi * R))));
		const int    columns = std::max(3, rounded(onSide / rows));
		const double goldenAngle = pi * (3.0 - std::sqrt(5.0));
		Matrix3Xd    grid(3, rows * columns + 2 * onCaps);
		Eigen::Index next = 0;
		for (int r = 0; r < rows; ++r)
			for (int c = 0; c < columns; ++c)
				grid.col(next++) =
					at(R, 2.0 * pi * c / columns, half * (2.0 * (r + 0.5) / rows - 1.0));
		for (const double z : {-half, half})
			for (int i = 0; i < onCaps; ++i)
				grid.col(next++) = at(R * std::sqrt((i + 0.5) / onCaps), goldenAngle * i, z);
		return grid;
	}

private:
	static constexpr double R = 0.5, half = 0.5;

	static bool onCap(const Vector3d& q)
	{
		return half - std::abs(q.z()) < R - std::hypot(q.x(), q.y());
	}

	static Vector3d at(double r, double angle, double z)
	{
		return {r * std::cos(angle), r * std::sin(angle), z};
	}
};

// Three cubes of edge 1/2 side by side: 14 squares, 18 edges, one of them concave.
class LBlock final : public AnalyticSurface {
public:
	LBlock()
	{
		std::size_t next = 0;
		for (const double side : {-1.0, 1.0})
			for (const Vector2d& cell : {Vector2d(-h, -h), Vector2d(h, -h), Vector2d(-h, h)})
				m_squares[next++] = {{cell.x(), cell.y(), side * h}, 2, side};
		for (const double along : {-h, h}) {
			m_squares[next++] = {{-2.0 * h, along, 0.0}, 0, -1.0};
			m_squares[next++] = {{along, -2.0 * h, 0.0}, 1, -1.0};
			m_squares[next++] = {{along < 0.0 ? 2.0 * h : 0.0, along, 0.0}, 0, 1.0};
			m_squares[next++] = {{along, along < 0.0 ? 2.0 * h : 0.0, 0.0}, 1, 1.0};
		}
	}

	AlignedBox3d boundingBox() const override { return boxAround({2.0 * h, 2.0 * h, h}); }
	int eulerCharacteristic() const override { return 2; }
	bool closed() const override { return true; }

	Vector3d project(const Vector3d& p) const override { return nearest(p).closest(p); }

	SurfaceFrame frame(const Vector3d& q) const override
	{
		const Square& s = nearest(q);
		return frameOf(s.side * Vector3d::Unit(s.axis), Vector3d::Unit((s.axis + 1) % 3), 0.0, 0.0);
	}

	double featureDistance(const Vector3d& q) const override
	{
		static const std::array<Vector2d, 6> outline = {
			Vector2d(-2 * h, -2 * h),
			Vector2d(2 * h, -2 * h),
			Vector2d(2 * h, 0),
			Vector2d(0, 0),
			Vector2d(0, 2 * h),
			Vector2d(-2 * h, 2 * h)};
		const double top      = h - std::abs(q.z());
		double       distance = infinity;
		for (std::size_t k = 0; k < outline.size(); ++k) {
			const Vector2d& a = outline[k];
			const Vector2d  d = outline[(k + 1) % outline.size()] - a;
			const Vector2d  p = q.head<2>() - a;
			const double    t = std::clamp(p.dot(d) / d.squaredNorm(), 0.0, 1.0);
			distance          = std::min({distance, p.norm(), std::hypot((p - t * d).norm(), top)});
		}
		return distance;
	}

	Vector3d sample(Random& random) const override
	{
		const std::size_t square = random.index(m_squares.size());
		const double      s = random.uniform(-h, h), t = random.uniform(-h, h);
		return m_squares[square].at(s, t);
	}

	Matrix3Xd grid(int points) const override
	{
		const double share   = double(points) / double(m_squares.size());
		const int    rows    = std::max(2, static_cast<int>(std::lround(std::sqrt(share))));
		const int    columns = std::max(2, static_cast<int>(std::lround(share / rows)));
		Matrix3Xd    grid(3, static_cast<int>(m_squares.size()) * rows * columns);
		Eigen::Index next = 0;
		for (const Square& square : m_squares)
			for (int r = 0; r < rows; ++r)
				for (int c = 0; c < columns; ++c)
					grid.col(next++) = square.at(
						h * (2.0 * (r + 0.5) / rows - 1.0), h * (2.0 * (c + 0.5) / columns - 1.0));
		return grid;
	}

private:
	static constexpr double h = 0.25; // half an edge of the cubes

	struct Square {
		Vector3d center;
		int      axis = 0; // the normal is +-Unit(axis)
		double   side = 1.0;

		Vector3d at(double s, double t) const
		{
			return center + s * Vector3d::Unit((axis + 1) % 3) + t * Vector3d::Unit((axis + 2) % 3);
		}
		Vector3d closest(const Vector3d& p) const
		{
			Vector3d half = Vector3d::Constant(h);
			half[axis]    = 0.0;
			return p.cwiseMax(center - half).cwiseMin(center + half);
		}
	};

	const Square& nearest(const Vector3d& p) const
	{
		return *std::min_element(
			m_squares.begin(), m_squares.end(), [&](const Square& a, const Square& b) {
				return (a.closest(p) - p).squaredNorm() < (b.closest(p) - p).squaredNorm();
			});
	}

	std::array<Square, 14> m_squares;
};

} // namespace

std::unique_ptr<const AnalyticSurface> makeCappedCylinder()
{
	return std::make_unique<CappedCylinder>();
}

std::unique_ptr<const AnalyticSurface> makeLBlock()
{
	return std::make_unique<LBlock>();
}

} // namespace curvature_lines::samples
