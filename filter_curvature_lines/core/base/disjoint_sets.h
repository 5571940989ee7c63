// Disjoint sets of 0 .. n - 1 that are joined (union-find with path halving).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "point_cloud.h"

namespace curvature_lines {

// The name of a set is its smallest member.
class DisjointSets {
public:
	explicit DisjointSets(Index n) : m_parent(n) { std::iota(m_parent.begin(), m_parent.end(), 0); }
	Index find(Index i)
	{
		while (m_parent[i] != i)
			i = m_parent[i] = m_parent[m_parent[i]];
		return i;
	}
	bool join(Index i, Index j) // false: they were joined before
	{
		const Index a = find(i), b = find(j);
		m_parent[std::max(a, b)] = std::min(a, b);
		return a != b;
	}

private:
	std::vector<Index> m_parent;
};

} // namespace curvature_lines
