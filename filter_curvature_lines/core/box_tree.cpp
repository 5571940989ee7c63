// Bottom-up packing, depth-first queries.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "box_tree.h"

#include <algorithm>
#include <limits>

#include "simd_block.h"
#include "spatial_order.h"

namespace curvature_lines {

namespace {

constexpr Index  fanOut    = 2 * blockSize;
constexpr double nowhere   = std::numeric_limits<double>::quiet_NaN(); // at no distance
constexpr int    maxLevels = 11; // 8^11 > 2^31

Index paddedSize(Index n)
{
	return (n + fanOut - 1) / fanOut * fanOut;
}

} // namespace

BoxTree::BoxTree(const Eigen::Matrix3Xd& positions) : m_original(curvature_lines::spatialOrder(positions))
{
	const Index n = size();
	for (int c = 0; c < 3; ++c) {
		m_points[c].assign(paddedSize(n), nowhere);
		for (Index k = 0; k < n; ++k)
			m_points[c][k] = positions(c, m_original[k]);
	}
	const auto* low  = &m_points;
	const auto* high = &m_points;
	Index       below = n;
	while (below > 0) {
		const Index boxes = (below + fanOut - 1) / fanOut;
		Level       level;
		for (int c = 0; c < 3; ++c) {
			level.low[c].assign(paddedSize(boxes), nowhere);
			level.high[c].assign(paddedSize(boxes), nowhere);
			for (Index b = 0; b < boxes; ++b) {
				const Index first = b * fanOut, last = std::min(below, first + fanOut);
				level.low[c][b] = *std::min_element((*low)[c].begin() + first, (*low)[c].begin() + last);
				level.high[c][b] =
					*std::max_element((*high)[c].begin() + first, (*high)[c].begin() + last);
			}
		}
		m_levels.push_back(std::move(level));
		low   = &m_levels.back().low;
		high  = &m_levels.back().high;
		below = boxes > fanOut ? boxes : 0;
	}
}

// Rounding does not make a box farther than a point in it: the same operations on smaller numbers.
inline void BoxTree::distances(Node node, const double* query, double* squared) const
{
	const Index first = node.number * fanOut;
	for (int half = 0; half < fanOut; half += blockSize) {
		Block       sum  = {};
		const Block zero = {};
		for (int c = 0; c < 3; ++c) {
			if (node.level < 0) {
				const Block d = blockAt(&m_points[c][first + half]) - query[c];
				sum += d * d;
				continue;
			}
			const Level& level = m_levels[node.level];
			const Block  below = blockAt(&level.low[c][first + half]) - query[c];
			const Block  above = query[c] - blockAt(&level.high[c][first + half]);
			const Block  out   = below > above ? below : above;
			sum += out <= 0.0 ? zero : out * out;
		}
		blockAt(squared + half) = sum;
	}
}

// Returns how many were found; not more than one, which is not written, when only the `first` is asked for.
CURVATURE_LINES_AVX2_CLONE Index
BoxTree::collect(const double* query, double squaredRadius, bool first, Index* found) const
{
	Node   open[maxLevels * fanOut];
	int    count    = 0;
	Index  size     = 0;
	double squared[fanOut];
	open[count++] = root();
	while (count > 0) {
		const Node node = open[--count];
		distances(node, query, squared);
		if (node.level >= 0) {
			for (int k = fanOut - 1; k >= 0; --k) { // the first is taken next
				open[count] = {node.level - 1, node.number * fanOut + k};
				count += squared[k] <= squaredRadius;
			}
		}
		else if (first) {
			for (int k = 0; k < fanOut; ++k)
				if (squared[k] <= squaredRadius)
					return 1;
		}
		else {
			const Index* original = m_original.data() + node.number * fanOut;
			const int    points   = std::min(fanOut, static_cast<Index>(m_original.size()) - node.number * fanOut);
			for (int k = 0; k < points; ++k) {
				found[size] = original[k];
				size += squared[k] <= squaredRadius;
			}
		}
	}
	return size;
}

void BoxTree::within(const Eigen::Vector3d& query, double radius, std::vector<Index>& found) const
{
	found.clear();
	if (!(radius >= 0.0) || size() == 0)
		return;
	thread_local std::vector<Index> room;
	if (room.size() <= m_original.size())
		room.resize(m_original.size() + 1);
	const Index count = collect(query.data(), radius * radius, false, room.data());
	found.assign(room.begin(), room.begin() + count);
}

bool BoxTree::anyWithin(const Eigen::Vector3d& query, double radius) const
{
	return radius >= 0.0 && size() > 0 && collect(query.data(), radius * radius, true, nullptr) > 0;
}

CURVATURE_LINES_AVX2_CLONE void BoxTree::addNearest(
	const double* query, Node node, std::size_t k, double& bound, std::vector<Found>& found) const
{
	double squared[fanOut];
	distances(node, query, squared);
	if (node.level < 0) {
		for (int c = 0; c < fanOut; ++c)
			if (squared[c] <= bound)
				found.emplace_back(squared[c], m_original[node.number * fanOut + c]);
		if (found.size() >= 2 * k) {
			std::nth_element(found.begin(), found.begin() + (k - 1), found.end());
			found.resize(k);
			bound = found.back().first;
		}
		return;
	}
	int order[fanOut], count = 0; // children by distance
	for (int c = 0; c < fanOut; ++c) {
		if (!(squared[c] <= bound))
			continue;
		int at = count++;
		for (; at > 0 && squared[c] < squared[order[at - 1]]; --at)
			order[at] = order[at - 1];
		order[at] = c;
	}
	for (int c = 0; c < count && squared[order[c]] <= bound; ++c)
		addNearest(query, {node.level - 1, node.number * fanOut + order[c]}, k, bound, found);
}

void BoxTree::nearest(const Eigen::Vector3d& query, Index k, std::vector<Found>& found) const
{
	found.clear();
	if (k <= 0 || size() == 0)
		return;
	double bound = std::numeric_limits<double>::max();
	addNearest(query.data(), root(), static_cast<std::size_t>(k), bound, found);
	const auto last = found.begin() + std::min<std::size_t>(found.size(), k);
	if (last != found.end())
		std::nth_element(found.begin(), last, found.end());
	std::sort(found.begin(), last);
	found.erase(last, found.end());
}

} // namespace curvature_lines
