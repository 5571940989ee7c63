// Analytic line networks for the tests of crossings and meshes: polylines on exact surfaces, with
// noise. SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "analytic_surfaces.h"
#include "line_network.h"
#include "point_cloud.h"

namespace curvature_lines::tests {

constexpr double Pi = 3.14159265358979323846;

// Lines are added as curves [0, 1] -> space; the surface, or a fixed normal, gives the normals.
class NetworkBuilder {
public:
	using Curve  = std::function<Eigen::Vector3d(double)>;
	using Normal = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

	NetworkBuilder(Normal normal, double noise = 0.0, std::uint64_t seed = 0) :
			m_normal(std::move(normal)), m_noise(noise), m_random(seed, 7)
	{
	}

	NetworkBuilder& add(int family, bool closed, int segments, const Curve& curve)
	{
		for (int k = 0; k < (closed ? segments : segments + 1); ++k) {
			const Eigen::Vector3d p = curve(double(k) / segments);
			m_normals.push_back(m_normal(p));
			m_vertices.push_back(p + m_noise * m_random.normal3());
		}
		m_lines.offsets.push_back(static_cast<Index>(m_vertices.size()));
		m_lines.family.push_back(family);
		m_lines.closed.push_back(closed);
		m_lines.ends.push_back({LineEnd::None, LineEnd::None});
		return *this;
	}

	NetworkBuilder&
	addSegment(int family, const Eigen::Vector3d& a, const Eigen::Vector3d& b, int segments)
	{
		return add(
			family, false, segments, [&](double t) { return Eigen::Vector3d(a + t * (b - a)); });
	}

	LineNetwork lines() const
	{
		LineNetwork result = m_lines;
		const auto  count  = static_cast<Eigen::Index>(m_vertices.size());
		result.vertices.resize(3, count);
		result.normals.resize(3, count);
		result.curvature.setZero(count);
		for (Eigen::Index i = 0; i < count; ++i) {
			result.vertices.col(i) = m_vertices[i];
			result.normals.col(i)  = m_normals[i];
		}
		return result;
	}

private:
	Normal                       m_normal;
	double                       m_noise;
	samples::Random              m_random;
	LineNetwork                  m_lines;
	std::vector<Eigen::Vector3d> m_vertices, m_normals;
};

inline NetworkBuilder::Normal normalOf(const char* surface)
{
	const samples::AnalyticSurface& s = samples::surface(surface);
	return [&s](const Eigen::Vector3d& p) { return s.frame(s.project(p)).normal; };
}

inline NetworkBuilder::Normal planeNormal()
{
	return [](const Eigen::Vector3d&) { return Eigen::Vector3d(0, 0, 1); };
}

inline PointCloud sampleCloud(const char* surface, int points, std::uint64_t seed)
{
	samples::SampleRequest request;
	request.surface                 = surface;
	request.points                  = points;
	request.seed                    = seed;
	const samples::SampleCloud made = samples::generate(request);
	return {made.positions, made.normals};
}

// Circles around the tube (family 1) and around the axis (family 2) of the torus R = 1, r = 0.4.
inline LineNetwork
torusNetwork(int meridians, int parallels, int segments, double noise, std::uint64_t seed)
{
	NetworkBuilder  builder(normalOf("torus"), noise, seed);
	samples::Random random(seed, 3);
	const auto      torus = [](double u, double v) {
        const double rho = 1.0 + 0.4 * std::cos(v);
        return Eigen::Vector3d(rho * std::cos(u), rho * std::sin(u), 0.4 * std::sin(v));
	};
	for (int i = 0; i < meridians; ++i) {
		const double u = 2 * Pi * (i + random.uniform(0.0, 0.3)) / meridians;
		builder.add(1, true, segments, [&](double t) { return torus(u, 2 * Pi * t + u); });
	}
	for (int i = 0; i < parallels; ++i) {
		const double v = 2 * Pi * (i + random.uniform(0.0, 0.3)) / parallels;
		builder.add(2, true, 2 * segments, [&](double t) { return torus(2 * Pi * t + v, v); });
	}
	return builder.lines();
}

inline LineNetwork greatCircles(int count, int segments, double noise, std::uint64_t seed)
{
	NetworkBuilder  builder([](const Eigen::Vector3d& p) { return p.normalized(); }, noise, seed);
	samples::Random random(seed, 5);
	for (int i = 0; i < count; ++i) {
		const Eigen::Vector3d axis = random.normal3().normalized();
		const Eigen::Vector3d x = axis.unitOrthogonal(), y = axis.cross(x);
		builder.add(1 + i % 2, true, segments, [&](double t) {
			return Eigen::Vector3d(std::cos(2 * Pi * t) * x + std::sin(2 * Pi * t) * y);
		});
	}
	return builder.lines();
}

// Pairs of segments of one family, on one face and without a common vertex, that cross in the tangent plane of the first.
inline Index crossingsWithinFamilies(const LineNetwork& lines)
{
	struct Segment {
		Index from, to;
		int   family;
	};
	std::vector<Segment> segments;
	for (Index l = 0; l < lines.lines(); ++l) {
		const Index first = lines.offsets[l], last = lines.offsets[l + 1] - 1;
		for (Index v = first; v < last; ++v)
			segments.push_back({v, v + 1, lines.family[l]});
		if (lines.closed[l])
			segments.push_back({last, first, lines.family[l]});
	}
	const auto parted = [&](const Segment& a, const Segment& b, const Eigen::Vector3d& normal) {
		const Eigen::Vector3d start = lines.vertices.col(a.from),
							  along = lines.vertices.col(a.to) - start;
		const auto side             = [&](Index v) {
            return along.cross(lines.vertices.col(v) - start).dot(normal);
		};
		return side(b.from) * side(b.to) < 0.0;
	};
	Index count = 0;
	for (std::size_t s = 0; s < segments.size(); ++s)
		for (std::size_t t = s + 1; t < segments.size(); ++t) {
			const Segment&        a      = segments[s];
			const Segment&        b      = segments[t];
			const Eigen::Vector3d normal = lines.normals.col(a.from);
			const double reach = (lines.vertices.col(a.to) - lines.vertices.col(a.from)).norm() +
			                     (lines.vertices.col(b.to) - lines.vertices.col(b.from)).norm();
			count += a.family == b.family && a.from != b.to && a.to != b.from &&
			         (lines.vertices.col(a.from) - lines.vertices.col(b.from)).norm() < reach &&
			         normal.dot(lines.normals.col(b.from)) > 0.5 && parted(a, b, normal) &&
			         parted(b, a, normal);
		}
	return count;
}

} // namespace curvature_lines::tests
