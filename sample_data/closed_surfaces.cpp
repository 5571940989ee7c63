// Torus, sphere, capsule, cube and ellipsoid: closest points, curvature frames, samplings.
// Textbook differential geometry (do Carmo), with the sign turned so that convex is positive.
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

class Torus final : public AnalyticSurface {
public:
	AlignedBox3d boundingBox() const override { return boxAround({R + r, R + r, r}); }
	int eulerCharacteristic() const override { return 0; }
	bool closed() const override { return true; }

	Vector3d project(const Vector3d& p) const override
	{
		const Vector2d e = radialDirection(p);
		const Vector3d center(R * e.x(), R * e.y(), 0.0);
		const Vector3d d = p - center;
		const double   l = d.norm();
		return l > 0.0 ? Vector3d(center + r / l * d) : at(std::atan2(e.y(), e.x()), 0.0);
	}

	SurfaceFrame frame(const Vector3d& q) const override
	{
		const Vector2d e = radialDirection(q);
		const double   v = std::atan2(q.z(), std::hypot(q.x(), q.y()) - R);
		const double   c = std::cos(v), s = std::sin(v);
		return frameOf(
			{c * e.x(), c * e.y(), s}, {-s * e.x(), -s * e.y(), c}, 1.0 / r, c / (R + r * c));
	}

	Vector3d sample(Random& random) const override
	{
		// The area element is proportional to R + r cos v.
		double v;
		do {
			v = random.uniform(0.0, 2.0 * pi);
		} while (random.uniform(0.0, R + r) > R + r * std::cos(v));
		return at(random.uniform(0.0, 2.0 * pi), v);
	}

	Matrix3Xd grid(int points) const override
	{
		return parameterGrid(points, R / r, true, true, [this](double s, double t) {
			return at(2.0 * pi * s, 2.0 * pi * t);
		});
	}

private:
	static constexpr double R = 1.0, r = 0.4;

	Vector3d at(double u, double v) const
	{
		const double w = R + r * std::cos(v);
		return {w * std::cos(u), w * std::sin(u), r * std::sin(v)};
	}
};

// A cylinder with hemispherical caps; of height 0, a sphere. By Archimedes' hat-box theorem its area per
// unit of z is 2 pi R throughout, so sampling is that of a straight cylinder.
class Capsule final : public AnalyticSurface {
public:
	Capsule(double radius, double height) : R(radius), m_half(height / 2.0) {}

	AlignedBox3d boundingBox() const override { return boxAround({R, R, R + m_half}); }
	int eulerCharacteristic() const override { return 2; }
	bool closed() const override { return true; }

	Vector3d project(const Vector3d& p) const override
	{
		const Vector3d center = axisPoint(p);
		const Vector3d d      = p - center;
		const double   l      = d.norm();
		return l > 0.0 ? Vector3d(center + R / l * d) : Vector3d(center + Vector3d(R, 0.0, 0.0));
	}

	SurfaceFrame frame(const Vector3d& q) const override
	{
		const Vector2d e   = radialDirection(q);
		const bool     cap = m_half == 0.0 || std::abs(q.z()) > m_half; // a sphere is all cap
		// Parallels are d1 on the cylinder; going on with them over the caps keeps the choice smooth.
		return frameOf(
			(q - axisPoint(q)).normalized(), {-e.y(), e.x(), 0.0}, 1.0 / R, cap ? 1.0 / R : 0.0);
	}

	double featureDistance(const Vector3d& q) const override
	{
		if (m_half == 0.0)
			return infinity;
		const double z = std::abs(q.z()) - m_half;
		return z > 0.0 ? R * std::asin(std::min(1.0, z / R)) : -z;
	}

	Vector3d sample(Random& random) const override
	{
		// One after the other: the order of arguments is the compiler's choice.
		const double angle = random.uniform(0.0, 2.0 * pi);
		return at(random.uniform(-R - m_half, R + m_half), angle);
	}

	Matrix3Xd grid(int points) const override
	{
		// A Fibonacci spiral: no grid of parallels and meridians is even at the poles.
		const double goldenAngle = pi * (3.0 - std::sqrt(5.0));
		Matrix3Xd    grid(3, points);
		for (int i = 0; i < points; ++i)
			grid.col(i) = at((R + m_half) * (2.0 * (i + 0.5) / points - 1.0), goldenAngle * i);
		return grid;
	}

private:
	double R, m_half;

	Vector3d axisPoint(const Vector3d& p) const
	{
		return {0.0, 0.0, std::clamp(p.z(), -m_half, m_half)};
	}

	Vector3d at(double z, double u) const
	{
		const double h = std::max(0.0, std::abs(z) - m_half);
		const double w = std::sqrt(std::max(0.0, R * R - h * h));
		return {w * std::cos(u), w * std::sin(u), z};
	}
};

class Cube final : public AnalyticSurface {
public:
	AlignedBox3d boundingBox() const override { return boxAround({half, half, half}); }
	int eulerCharacteristic() const override { return 2; }
	bool closed() const override { return true; }

	Vector3d project(const Vector3d& p) const override
	{
		Vector3d q = p.cwiseMax(-half).cwiseMin(half);
		if (q == p) {
			const int axis = faceAxis(p);
			q[axis]        = std::copysign(half, p[axis]);
		}
		return q;
	}

	SurfaceFrame frame(const Vector3d& q) const override
	{
		const int axis = faceAxis(q);
		return frameOf(
			std::copysign(1.0, q[axis]) * Vector3d::Unit(axis),
			Vector3d::Unit((axis + 1) % 3),
			0.0,
			0.0);
	}

	double featureDistance(const Vector3d& q) const override
	{
		std::array<double, 3> gap = {
			half - std::abs(q.x()), half - std::abs(q.y()), half - std::abs(q.z())};
		std::sort(gap.begin(), gap.end());
		return gap[1]; // gap[0] is 0: the face itself
	}

	Vector3d sample(Random& random) const override
	{
		const std::size_t face = random.index(6);
		const double      s = random.uniform(-half, half), t = random.uniform(-half, half);
		return at(face, s, t);
	}

	Matrix3Xd grid(int points) const override
	{
		// Cell centres, so that no point lies on an edge, where there is no normal.
		const int m = std::max(2, static_cast<int>(std::lround(std::sqrt(points / 6.0))));
		Matrix3Xd grid(3, 6 * m * m);
		for (int i = 0; i < 6 * m * m; ++i)
			grid.col(i) = at(i / (m * m), (i % m + 0.5) / m - half, (i / m % m + 0.5) / m - half);
		return grid;
	}

private:
	static constexpr double half = 0.5;

	static int faceAxis(const Vector3d& p)
	{
		int axis;
		p.cwiseAbs().maxCoeff(&axis);
		return axis;
	}

	static Vector3d at(std::size_t face, double s, double t)
	{
		Vector3d p;
		p[face % 3]       = face < 3 ? half : -half;
		p[(face + 1) % 3] = s;
		p[(face + 2) % 3] = t;
		return p;
	}
};

class Ellipsoid final : public AnalyticSurface {
public:
	AlignedBox3d boundingBox() const override { return boxAround(axes()); }
	int eulerCharacteristic() const override { return 2; }
	bool closed() const override { return true; }

	// The foot point is a^2 p / (a^2 + t) for the largest root t of sum (a p / (a^2 + t))^2 = 1.
	Vector3d project(const Vector3d& p) const override
	{
		const Vector3d a = axes(), a2 = a.cwiseAbs2(), ap = a.cwiseProduct(p);
		double         from = -a2.z(), to = ap.norm();
		while (true) {
			const double t = 0.5 * (from + to);
			if (t <= from || t >= to)
				break;
			const Vector3d x                    = ap.cwiseQuotient(a2 + Vector3d::Constant(t));
			(x.squaredNorm() > 1.0 ? from : to) = t;
		}
		Vector3d x = ap.cwiseQuotient(a2 + Vector3d::Constant(to)); // on the unit sphere
		// Points of the plane z = 0 near the middle have two feet, above and below, that the root misses.
		const double missing = 1.0 - x.head<2>().squaredNorm();
		if (std::abs(x.squaredNorm() - 1.0) > 1e-9 && missing > 0.0)
			x.z() = std::copysign(std::sqrt(missing), p.z());
		return a.cwiseProduct(x.normalized());
	}

	SurfaceFrame frame(const Vector3d& q) const override
	{
		// Level set of sum (x / a)^2.
		const Vector3d inverse = axes().cwiseAbs2().cwiseInverse();
		return levelSetFrame(inverse.cwiseProduct(q), inverse.asDiagonal());
	}

	Vector3d sample(Random& random) const override
	{
		// Area of the image of a small piece of the unit sphere at g is proportional to |g / a|.
		Vector3d g;
		do {
			g = random.normal3().normalized();
		} while (random.uniform(0.0, 1.0 / axes().z()) > g.cwiseQuotient(axes()).norm());
		return axes().cwiseProduct(g);
	}

	// The spiral of the sphere, stretched: smooth and regular, but twice as dense at the ends of the
	// longest axis as in the middle.
	Matrix3Xd grid(int points) const override
	{
		return axes().asDiagonal() * Capsule(1.0, 0.0).grid(points);
	}

private:
	static Vector3d axes() { return {1.0, 0.7, 0.5}; }
};

} // namespace

std::unique_ptr<const AnalyticSurface> makeTorus()
{
	return std::make_unique<Torus>();
}

std::unique_ptr<const AnalyticSurface> makeCapsule(double radius, double height)
{
	return std::make_unique<Capsule>(radius, height);
}

std::unique_ptr<const AnalyticSurface> makeCube()
{
	return std::make_unique<Cube>();
}

std::unique_ptr<const AnalyticSurface> makeEllipsoid()
{
	return std::make_unique<Ellipsoid>();
}

} // namespace curvature_lines::samples
