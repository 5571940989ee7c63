// Double torus: a closed surface of genus 2, the zero set of two tori blended smoothly.
// Curvatures from the gradient and the Hessian of the function (Goldman 2005), closest points by Newton's method.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_families.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "analytic_surfaces.h"

namespace curvature_lines::samples {
namespace {

using namespace detail;

// f = -log(exp(-k f1) + exp(-k f2)) / k, where f1 and f2 are the squared distances from the two circles less r^2.
class DoubleTorus final : public AnalyticSurface {
public:
	// The blend is too thin to reach beyond the tori at the ends of the box.
	AlignedBox3d boundingBox() const override { return boxAround({offset + R + r, R + r, r}); }
	int eulerCharacteristic() const override { return -2; }
	bool closed() const override { return true; }

	Vector3d project(const Vector3d& p) const override
	{
		Vector3d closest = Vector3d::Zero();
		double   least   = infinity;
		for (const Vector3d& start : {nearestOnTorus(p, 0), nearestOnTorus(p, 1), p}) {
			const Vector3d q = descend(p, onSurface(start));
			if (const double d = (q - p).norm(); d < least) {
				least   = d;
				closest = q;
			}
		}
		return closest;
	}

	SurfaceFrame frame(const Vector3d& q) const override
	{
		const Level at = level(q);
		return levelSetFrame(at.gradient, at.hessian);
	}

	// Where random lines meet a surface is uniform by area (Crofton). Of the places on a line one is taken, and
	// none as often as a line of most places would have others.
	Vector3d sample(Random& random) const override
	{
		const double reach = boundingBox().diagonal().norm() / 2.0;
		while (true) {
			const Vector3d d = random.normal3().normalized(), u = d.unitOrthogonal();
			const double   angle = random.uniform(0.0, 2.0 * pi);
			const double   out   = reach * std::sqrt(random.uniform());
			const Vector3d foot  = out * (std::cos(angle) * u + std::sin(angle) * d.cross(u));
			const auto     found = crossings(foot, d, reach);
			const auto     index = random.index(mostCrossings);
			if (index < found.size())
				return onSurface(foot + found[index] * d);
		}
	}

	// Every point as far as can be from those before, out of many random ones: no parameters, no grid.
	Matrix3Xd grid(int points) const override
	{
		constexpr int choice = 8;
		Random        random(1, 0);
		Matrix3Xd     from(3, choice * points), chosen(3, points);
		for (Eigen::Index i = 0; i < from.cols(); ++i)
			from.col(i) = sample(random);
		Eigen::Index    next = 0;
		Eigen::VectorXd gap  = Eigen::VectorXd::Constant(from.cols(), infinity);
		for (int k = 0; k < points; ++k) {
			chosen.col(k) = from.col(next);
			gap =
				gap.cwiseMin((from.colwise() - chosen.col(k)).colwise().squaredNorm().transpose());
			gap.maxCoeff(&next);
		}
		return chosen;
	}

private:
	static constexpr double R = 0.7, r = 0.3, offset = 0.85; // of the centres from the middle
	static constexpr double k = 12.0;                        // sharpness of the blend
	// of a line; each torus is met four times at most
	static constexpr std::size_t mostCrossings = 8;

	struct Level {
		double          value;
		Vector3d        gradient;
		Eigen::Matrix3d hessian;
	};

	static Vector3d fromCenter(const Vector3d& p, int torus)
	{
		return p + Vector3d(torus == 0 ? offset : -offset, 0.0, 0.0);
	}

	static double fromCircle(const Vector3d& p, int torus)
	{
		const Vector3d q = fromCenter(p, torus);
		return std::hypot(std::hypot(q.x(), q.y()) - R, q.z());
	}

	static double value(const Vector3d& p)
	{
		const double a = std::pow(fromCircle(p, 0), 2), b = std::pow(fromCircle(p, 1), 2);
		return std::min(a, b) - std::log1p(std::exp(-k * std::abs(a - b))) / k - r * r;
	}

	static Level level(const Vector3d& p)
	{
		std::array<Vector3d, 2>        g;
		std::array<Eigen::Matrix3d, 2> h;
		std::array<double, 2>          f;
		for (int torus = 0; torus < 2; ++torus) {
			const Vector3d q   = fromCenter(p, torus);
			const Vector2d e   = radialDirection(q);
			const double   rho = std::max(std::hypot(q.x(), q.y()), 1e-300);
			g[torus]           = 2.0 * (q - R * Vector3d(e.x(), e.y(), 0.0));
			h[torus]           = 2.0 * Eigen::Matrix3d::Identity();
			// The unit vector from the axis turns by 1 / rho.
			const Vector2d across(-e.y(), e.x());
			h[torus].topLeftCorner<2, 2>() -= 2.0 * R / rho * across * across.transpose();
			f[torus] = std::pow(fromCircle(p, torus), 2);
		}
		const double    w    = 1.0 / (1.0 + std::exp(k * (f[0] - f[1]))); // weight of the first
		const Vector3d  mean = w * g[0] + (1.0 - w) * g[1], apart = g[0] - g[1];
		Eigen::Matrix3d hessian = w * h[0] + (1.0 - w) * h[1];
		hessian -= k * w * (1.0 - w) * apart * apart.transpose();
		return {value(p), mean, hessian};
	}

	static Vector3d nearestOnTorus(const Vector3d& p, int torus)
	{
		const Vector3d q = fromCenter(p, torus);
		const Vector2d e = radialDirection(q);
		const Vector3d center(R * e.x(), R * e.y(), 0.0);
		const Vector3d d = q - center;
		const double   l = d.norm();
		return p - q + center + (l > 0.0 ? Vector3d(r / l * d) : Vector3d(r * center.normalized()));
	}

	// Newton's method along the gradient, to the last digit.
	static Vector3d onSurface(Vector3d p)
	{
		double best = std::abs(value(p));
		for (int step = 0; step < 60 && best > 0.0; ++step) {
			const Level at   = level(p);
			Vector3d    move = -at.value / (at.gradient.squaredNorm() + 1e-300) * at.gradient;
			if (move.norm() > 0.5 * r)
				move *= 0.5 * r / move.norm();
			const double next = std::abs(value(p + move));
			if (next < 1e-14 && next >= best)
				break;
			p += move;
			best = next;
		}
		return p;
	}

	// From a point q of the surface down to one whose distance from p no step in the surface makes less.
	static Vector3d descend(const Vector3d& p, Vector3d q)
	{
		// second derivative along a direction that would lead to a farthest point
		constexpr double least = 0.1;
		for (int step = 0; step < 100; ++step) {
			const Level        at   = level(q);
			const SurfaceFrame f    = levelSetFrame(at.gradient, at.hessian);
			const Vector3d     d    = p - q;
			const double       h    = d.dot(f.normal);
			Vector3d           move = d.dot(f.d1) / std::max(1.0 + h * f.k1, least) * f.d1 +
			                d.dot(f.d2) / std::max(1.0 + h * f.k2, least) * f.d2;
			if (move.norm() > r)
				move *= r / move.norm();
			Vector3d next = onSurface(q + move);
			while ((next - p).norm() >= d.norm() && move.norm() > 1e-16) {
				move *= 0.25;
				next = onSurface(q + move);
			}
			if (!((next - p).norm() < d.norm()))
				break;
			q = next;
		}
		return q;
	}

	// Parameters within +-reach where the line foot + t d meets the surface, which lies between the tori and
	// slightly thicker ones. Pairs nearer than the least step are missed: lines that hardly touch.
	static std::vector<double> crossings(const Vector3d& foot, const Vector3d& d, double reach)
	{
		constexpr double    leastStep = 0.004;
		const double        thick     = std::sqrt(r * r + std::log(2.0) / k);
		std::vector<double> found;
		double              t = -reach, last = value(foot + t * d);
		while (t < reach) {
			const Vector3d p    = foot + t * d;
			const double   core = std::min(fromCircle(p, 0), fromCircle(p, 1));
			const double   step = std::max({leastStep, core - thick, r - core});
			const double   next = value(foot + (t + step) * d);
			if ((last < 0.0) != (next < 0.0)) {
				double from = t, to = t + step;
				for (int halving = 0; halving < 50; ++halving) {
					const double middle = 0.5 * (from + to);
					((value(foot + middle * d) < 0.0) == (last < 0.0) ? from : to) = middle;
				}
				found.push_back(from);
			}
			t += step;
			last = next;
		}
		return found;
	}
};

} // namespace

std::unique_ptr<const AnalyticSurface> makeDoubleTorus()
{
	return std::make_unique<DoubleTorus>();
}

} // namespace curvature_lines::samples
