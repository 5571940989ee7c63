// Balanced tree, interaction lists per leaf, and the three kernels.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "dipole_sums.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

namespace {

constexpr Index leafSize = 16;
// A node is one dipole for a leaf at more than this many of its radii (first order, error of some per cent).
constexpr float openingRatio = 2.0f;

} // namespace

// What the points of one leaf sum over, coordinate by coordinate for the vector units.
struct DipoleSums::Sources {
	std::vector<float> x, y, z, u, v, w;
	void add(const Eigen::Vector3f& point, const Eigen::Vector3f& value)
	{
		x.push_back(point.x());
		y.push_back(point.y());
		z.push_back(point.z());
		u.push_back(value.x());
		v.push_back(value.y());
		w.push_back(value.z());
	}
};

DipoleSums::DipoleSums(const Eigen::Matrix3Xd& positions) :
		m_order(static_cast<std::size_t>(positions.cols()))
{
	if (m_order.empty())
		return;
	std::iota(m_order.begin(), m_order.end(), 0);
	build(positions, 0, static_cast<Index>(m_order.size()));
	m_points = columnsOf(positions, m_order).cast<float>();
	m_far.resize(m_leaves.size());
	m_near.resize(m_leaves.size());
	for (std::size_t leaf = 0; leaf < m_leaves.size(); ++leaf)
		interactions(leaf, 0);
}

Index DipoleSums::build(const Eigen::Matrix3Xd& positions, Index begin, Index end)
{
	const auto      id  = static_cast<Index>(m_nodes.size());
	Eigen::Vector3d low = positions.col(m_order[begin]), high = low, mean = Eigen::Vector3d::Zero();
	for (Index k = begin; k < end; ++k) {
		low  = low.cwiseMin(positions.col(m_order[k]));
		high = high.cwiseMax(positions.col(m_order[k]));
		mean += positions.col(m_order[k]);
	}
	mean /= double(end - begin);
	double radius = 0.0;
	for (Index k = begin; k < end; ++k)
		radius = std::max(radius, (positions.col(m_order[k]) - mean).norm());
	Node node;
	node.begin  = begin;
	node.end    = end;
	node.center = mean.cast<float>();
	node.radius = static_cast<float>(radius);
	m_nodes.push_back(node);
	if (end - begin <= leafSize) {
		m_leaves.push_back(id);
		return id;
	}
	int axis = 0;
	(high - low).maxCoeff(&axis);
	const Index middle = begin + (end - begin) / 2;
	std::nth_element(
		m_order.begin() + begin,
		m_order.begin() + middle,
		m_order.begin() + end,
		[&](Index i, Index j) {
			const double a = positions(axis, i), b = positions(axis, j);
			return a < b || (a == b && i < j);
		});
	const Index left  = build(positions, begin, middle);
	const Index right = build(positions, middle, end);
	m_nodes[id].left  = left;
	m_nodes[id].right = right;
	return id;
}

void DipoleSums::interactions(std::size_t leaf, Index node)
{
	const Node& target = m_nodes[m_leaves[leaf]];
	const Node& source = m_nodes[node];
	if ((target.center - source.center).norm() > openingRatio * source.radius + target.radius) {
		m_far[leaf].push_back(node);
	}
	else if (source.left < 0) {
		m_near[leaf].push_back(node);
	}
	else {
		interactions(leaf, source.left);
		interactions(leaf, source.right);
	}
}

template<class Kernel>
DipoleSums::Vectors
DipoleSums::sum(const Vectors& values, const Progress& progress, const Kernel& kernel) const
{
	Vectors sums = Vectors::Zero(3, static_cast<Eigen::Index>(m_nodes.size()));
	for (auto id = static_cast<Index>(m_nodes.size()); id-- > 0;) {
		const Node& node = m_nodes[id];
		if (node.left < 0)
			for (Index k = node.begin; k < node.end; ++k)
				sums.col(id) += values.col(m_order[k]);
		else
			sums.col(id) = sums.col(node.left) + sums.col(node.right);
	}
	Vectors result(3, values.cols());
	parallelFor(static_cast<Index>(m_leaves.size()), progress, [&](Index leaf) {
		Sources sources;
		for (Index id : m_far[leaf])
			sources.add(m_nodes[id].center, sums.col(id));
		for (Index id : m_near[leaf])
			for (Index k = m_nodes[id].begin; k < m_nodes[id].end; ++k)
				sources.add(m_points.col(k), values.col(m_order[k]));
		const Node& target = m_nodes[m_leaves[leaf]];
		for (Index k = target.begin; k < target.end; ++k)
			result.col(m_order[k]) = kernel(m_points.col(k), sources);
	});
	return result;
}

Eigen::VectorXf
DipoleSums::winding(const Vectors& dipoles, float width, const Progress& progress) const
{
	const float square = width * width;
	return sum(dipoles,
	           progress,
	           [square](const Eigen::Vector3f& p, const Sources& s) {
				   const float  px = p.x(), py = p.y(), pz = p.z();
				   const float *x = s.x.data(), *y = s.y.data(), *z = s.z.data();
				   const float *u = s.u.data(), *v = s.v.data(), *w = s.w.data();
				   const int    n   = static_cast<int>(s.x.size());
				   float        all = 0.0f;
#pragma omp simd reduction(+ : all)
				   for (int t = 0; t < n; ++t) {
					   const float dx = x[t] - px, dy = y[t] - py, dz = z[t] - pz;
					   const float d2   = dx * dx + dy * dy + dz * dz;
					   const float safe = d2 > square ? d2 : 1.0f;
					   const float cube = d2 > square ? 1.0f / (safe * std::sqrt(safe)) : 0.0f;
					   all += (dx * u[t] + dy * v[t] + dz * w[t]) * cube;
				   }
				   return Eigen::Vector3f(all, 0.0f, 0.0f);
			   })
	    .row(0)
	    .transpose();
}

DipoleSums::Vectors
DipoleSums::adjoint(const Eigen::VectorXf& strengths, float width, const Progress& progress) const
{
	Vectors values     = Vectors::Zero(3, strengths.size());
	values.row(0)      = strengths.transpose();
	const float square = width * width;
	return sum(values, progress, [square](const Eigen::Vector3f& p, const Sources& s) {
		const float  px = p.x(), py = p.y(), pz = p.z();
		const float *x = s.x.data(), *y = s.y.data(), *z = s.z.data(), *u = s.u.data();
		const int    n  = static_cast<int>(s.x.size());
		float        ax = 0.0f, ay = 0.0f, az = 0.0f;
#pragma omp simd reduction(+ : ax, ay, az)
		for (int t = 0; t < n; ++t) {
			const float dx = px - x[t], dy = py - y[t], dz = pz - z[t];
			const float d2   = dx * dx + dy * dy + dz * dz;
			const float safe = d2 > square ? d2 : 1.0f;
			const float cube = d2 > square ? u[t] / (safe * std::sqrt(safe)) : 0.0f;
			ax += dx * cube;
			ay += dy * cube;
			az += dz * cube;
		}
		return Eigen::Vector3f(ax, ay, az);
	});
}

DipoleSums::Vectors
DipoleSums::gradient(const Vectors& dipoles, float width, const Progress& progress) const
{
	const float square = width * width;
	return sum(dipoles, progress, [square](const Eigen::Vector3f& p, const Sources& s) {
		const float  px = p.x(), py = p.y(), pz = p.z();
		const float *x = s.x.data(), *y = s.y.data(), *z = s.z.data();
		const float *u = s.u.data(), *v = s.v.data(), *w = s.w.data();
		const int    n  = static_cast<int>(s.x.size());
		float        ax = 0.0f, ay = 0.0f, az = 0.0f;
#pragma omp simd reduction(+ : ax, ay, az)
		for (int t = 0; t < n; ++t) {
			const float dx = x[t] - px, dy = y[t] - py, dz = z[t] - pz;
			const float d2    = dx * dx + dy * dy + dz * dz;
			const float safe  = d2 > square ? d2 : 1.0f;
			const float cube  = d2 > square ? 1.0f / (safe * std::sqrt(safe)) : 0.0f;
			const float along = 3.0f * (dx * u[t] + dy * v[t] + dz * w[t]) / safe;
			ax += (u[t] - dx * along) * cube;
			ay += (v[t] - dy * along) * cube;
			az += (w[t] - dz * along) * cube;
		}
		return Eigen::Vector3f(ax, ay, az);
	});
}

} // namespace curvature_lines
