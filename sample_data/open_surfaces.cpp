// Cylinder, helicoid, half torus, bent sheet and plane: closest points, curvature frames, samplings, rims.
// Textbook differential geometry (do Carmo), with the sign turned so that convex is positive.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_families.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "analytic_surfaces.h"

namespace curvature_lines::samples {
namespace {

using namespace detail;

class Cylinder final : public AnalyticSurface {
public:
	AlignedBox3d boundingBox() const override { return boxAround({R, R, half}); }
	int eulerCharacteristic() const override { return 0; }
	bool closed() const override { return false; }

	Vector3d project(const Vector3d& p) const override
	{
		const Vector2d e = radialDirection(p);
		return {R * e.x(), R * e.y(), std::clamp(p.z(), -half, half)};
	}

	SurfaceFrame frame(const Vector3d& q) const override
	{
		const Vector2d e = radialDirection(q);
		return frameOf({e.x(), e.y(), 0.0}, {-e.y(), e.x(), 0.0}, 1.0 / R, 0.0);
	}

	double rimDistance(const Vector3d& q) const override { return half - std::abs(q.z()); }

	Vector3d sample(Random& random) const override
	{
		// One after the other: the order of arguments is the compiler's choice.
		const double height = random.uniform(-half, half);
		return at(random.uniform(0.0, 2.0 * pi), height);
	}

	Matrix3Xd grid(int points) const override
	{
		return parameterGrid(points, pi * R / half, true, false, [this](double s, double t) {
			return at(2.0 * pi * s, half * (2.0 * t - 1.0));
		});
	}

private:
	static constexpr double R = 0.5, half = 1.0;

	Vector3d at(double u, double z) const { return {R * std::cos(u), R * std::sin(u), z}; }
};

class Helicoid final : public AnalyticSurface {
public:
	AlignedBox3d boundingBox() const override { return boxAround({U, U, c * V}); }
	int eulerCharacteristic() const override { return 1; }
	bool closed() const override { return false; }

	// For given v the best u is known, which leaves a search in v alone: its local minima are bracketed on
	// a grid much finer than they can lie, then found by bisection of the derivative (u drops out of it at
	// its optimum, also where u is clamped to the rim).
	Vector3d project(const Vector3d& p) const override
	{
		constexpr int                     intervals = 128;
		const double                      step      = 2.0 * V / intervals;
		std::array<double, intervals + 1> slope;
		for (int i = 0; i <= intervals; ++i)
			slope[i] = slopeAt(p, i * step - V);

		Vector3d   best      = ruling(p, -V);
		const auto tryRuling = [&](double v) {
			const Vector3d q = ruling(p, v);
			if ((q - p).squaredNorm() < (best - p).squaredNorm())
				best = q;
		};
		tryRuling(V);
		for (int i = 0; i < intervals; ++i)
			if (slope[i] <= 0.0 && slope[i + 1] >= 0.0)
				tryRuling(minimumBetween(p, i * step - V, (i + 1) * step - V));
		return best;
	}

	SurfaceFrame frame(const Vector3d& q) const override
	{
		const auto [u, v] = parameters(q);
		const double   w  = std::hypot(u, c);
		const Vector3d eu(std::cos(v), std::sin(v), 0.0);
		const Vector3d ev(-u / w * std::sin(v), u / w * std::cos(v), c / w);
		// A minimal surface: the asymptotic directions are eu and ev, the principal ones between them.
		const double k = c / (w * w);
		return frameOf(eu.cross(ev), (eu + ev) / std::sqrt(2.0), k, -k);
	}

	double rimDistance(const Vector3d& q) const override
	{
		const auto [u, v] = parameters(q);
		return std::min(U - std::abs(u), (V - std::abs(v)) * std::hypot(u, c));
	}

	Vector3d sample(Random& random) const override
	{
		// The area element is sqrt(u^2 + c^2).
		double u;
		do {
			u = random.uniform(-U, U);
		} while (random.uniform(0.0, std::hypot(U, c)) > std::hypot(u, c));
		return at(u, random.uniform(-V, V));
	}

	Matrix3Xd grid(int points) const override
	{
		// Columns run along v, whose mean length is 2 V times the mean of sqrt(u^2 + c^2).
		const double meanSpeed = (std::hypot(U, c) * U + c * c * std::asinh(U / c)) / (2.0 * U);
		return parameterGrid(points, U / (V * meanSpeed), false, false, [this](double s, double t) {
			return at(U * (2.0 * s - 1.0), V * (2.0 * t - 1.0));
		});
	}

private:
	static constexpr double c = 0.5, U = 1.0, V = pi;

	Vector3d at(double u, double v) const { return {u * std::cos(v), u * std::sin(v), c * v}; }

	struct Parameters {
		double u, v;
	};
	Parameters parameters(const Vector3d& q) const
	{
		const double v = q.z() / c;
		return {q.x() * std::cos(v) + q.y() * std::sin(v), v};
	}

	Vector3d ruling(const Vector3d& p, double v) const
	{
		return at(std::clamp(p.x() * std::cos(v) + p.y() * std::sin(v), -U, U), v);
	}

	// Half the derivative of the squared distance to the ruling at v.
	double slopeAt(const Vector3d& p, double v) const
	{
		const double cv = std::cos(v), sv = std::sin(v);
		const double u = std::clamp(p.x() * cv + p.y() * sv, -U, U);
		return u * (p.x() * sv - p.y() * cv) + c * (c * v - p.z());
	}

	double minimumBetween(const Vector3d& p, double from, double to) const
	{
		for (int i = 0; i < 60; ++i) {
			const double middle                    = 0.5 * (from + to);
			(slopeAt(p, middle) < 0.0 ? from : to) = middle;
		}
		return 0.5 * (from + to);
	}
};

// A sheet of width 1 along y whose profile is a straight line and then an arc that bends
// away from the normal +z. s is arc length along the profile, 0 where the arc begins.
class BentSheet final : public AnalyticSurface {
public:
	AlignedBox3d boundingBox() const override
	{
		AlignedBox3d box(at(from, -half));
		return box.extend(at(from, half)).extend(at(to, half));
	}
	int eulerCharacteristic() const override { return 1; }
	bool closed() const override { return false; }

	Vector3d project(const Vector3d& p) const override
	{
		const double y    = std::clamp(p.y(), -half, half);
		const double turn = std::clamp(std::atan2(p.x(), p.z() + R), 0.0, bend);
		Vector3d     best = at(std::clamp(p.x(), from, 0.0), y);
		for (double s : {R * turn, to})
			if (const Vector3d q = at(s, y); (q - p).squaredNorm() < (best - p).squaredNorm())
				best = q;
		return best;
	}

	SurfaceFrame frame(const Vector3d& q) const override
	{
		const double s = arcLength(q), t = std::max(0.0, s) / R;
		return frameOf(
			{std::sin(t), 0.0, std::cos(t)},
			{std::cos(t), 0.0, -std::sin(t)},
			s > 0.0 ? 1.0 / R : 0.0,
			0.0);
	}

	double rimDistance(const Vector3d& q) const override
	{
		const double s = arcLength(q);
		return std::min({s - from, to - s, half - std::abs(q.y())});
	}

	double featureDistance(const Vector3d& q) const override { return std::abs(arcLength(q)); }

	Vector3d sample(Random& random) const override
	{
		const double s = random.uniform(from, to);
		return at(s, random.uniform(-half, half));
	}

	Matrix3Xd grid(int points) const override
	{
		const double length = to - from;
		return parameterGrid(points, length / (2.0 * half), false, false, [&](double s, double t) {
			return at(from + s * length, half * (2.0 * t - 1.0));
		});
	}

private:
	static constexpr double R = 0.5, bend = pi / 2.0, half = 0.5, from = -1.0, to = R * bend;

	Vector3d at(double s, double y) const
	{
		const double t = std::max(0.0, s) / R;
		return {s > 0.0 ? R * std::sin(t) : s, y, R * (std::cos(t) - 1.0)};
	}

	double arcLength(const Vector3d& q) const
	{
		return q.x() > 0.0 ? R * std::atan2(q.x(), q.z() + R) : q.x();
	}
};

class Plane final : public AnalyticSurface {
public:
	AlignedBox3d boundingBox() const override { return boxAround({half, half, 0.0}); }
	int eulerCharacteristic() const override { return 1; }
	bool closed() const override { return false; }

	Vector3d project(const Vector3d& p) const override
	{
		return {std::clamp(p.x(), -half, half), std::clamp(p.y(), -half, half), 0.0};
	}

	SurfaceFrame frame(const Vector3d&) const override
	{
		return frameOf(Vector3d::UnitZ(), Vector3d::UnitX(), 0.0, 0.0);
	}

	double rimDistance(const Vector3d& q) const override
	{
		return half - std::max(std::abs(q.x()), std::abs(q.y()));
	}

	Vector3d sample(Random& random) const override
	{
		const double x = random.uniform(-half, half);
		return {x, random.uniform(-half, half), 0.0};
	}

	Matrix3Xd grid(int points) const override
	{
		return parameterGrid(points, 1.0, false, false, [](double s, double t) {
			return Vector3d(s - half, t - half, 0.0);
		});
	}

private:
	static constexpr double half = 0.5;
};

// Half a torus, y >= 0: a bent pipe that ends in two meridians.
class HalfTorus final : public AnalyticSurface {
public:
	AlignedBox3d boundingBox() const override
	{
		return {Vector3d(-R - r, 0.0, -r), Vector3d(R + r, R + r, r)};
	}
	int eulerCharacteristic() const override { return 0; }
	bool closed() const override { return false; }

	Vector3d project(const Vector3d& p) const override
	{
		if (p.y() >= 0.0)
			return m_torus->project(p);
		return m_torus->project({p.x(), 0.0, p.z()});
	}

	SurfaceFrame frame(const Vector3d& q) const override { return m_torus->frame(q); }

	// Along the parallel, the shortest way where it is short.
	double rimDistance(const Vector3d& q) const override
	{
		return std::hypot(q.x(), q.y()) * std::atan2(std::max(q.y(), 0.0), std::abs(q.x()));
	}

	Vector3d sample(Random& random) const override
	{
		const Vector3d p = m_torus->sample(random);
		return {p.x(), std::abs(p.y()), p.z()};
	}

	Matrix3Xd grid(int points) const override
	{
		return parameterGrid(points, 0.5 * R / r, false, true, [](double s, double t) {
			const double w = R + r * std::cos(2.0 * pi * t);
			return Vector3d(w * std::cos(pi * s), w * std::sin(pi * s), r * std::sin(2.0 * pi * t));
		});
	}

private:
	static constexpr double                      R = 1.0, r = 0.4; // as of the whole torus
	const std::unique_ptr<const AnalyticSurface> m_torus = makeTorus();
};

} // namespace

std::unique_ptr<const AnalyticSurface> makeHalfTorus()
{
	return std::make_unique<HalfTorus>();
}

std::unique_ptr<const AnalyticSurface> makeCylinder()
{
	return std::make_unique<Cylinder>();
}

std::unique_ptr<const AnalyticSurface> makeHelicoid()
{
	return std::make_unique<Helicoid>();
}

std::unique_ptr<const AnalyticSurface> makeBentSheet()
{
	return std::make_unique<BentSheet>();
}

std::unique_ptr<const AnalyticSurface> makePlane()
{
	return std::make_unique<Plane>();
}

} // namespace curvature_lines::samples
