// Edges joined end to end.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "line_chains.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "point_cloud.h"

namespace curvature_lines {

namespace {

using Neighbors = std::vector<std::vector<Index>>; // of each vertex, along edges

// From `start` on, towards the lower neighbour where there are two, as far as vertices are not visited.
std::vector<Index> follow(const Neighbors& neighbors, Index start, std::vector<char>& visited)
{
	std::vector<Index> chain;
	for (Index at = start; at >= 0;) {
		visited[at] = 1;
		chain.push_back(at);
		Index next = -1;
		for (const Index n : neighbors[at])
			if (!visited[n] && (next < 0 || n < next))
				next = n;
		at = next;
	}
	return chain;
}

} // namespace

std::optional<LineChains>
chainEdges(Index vertexCount, const std::vector<std::array<Index, 2>>& edges)
{
	Neighbors neighbors(vertexCount);
	for (const auto& [a, b] : edges) {
		neighbors[a].push_back(b);
		neighbors[b].push_back(a);
	}
	for (const auto& row : neighbors)
		if (row.size() > 2)
			return std::nullopt;

	// Open lines first: what is left of vertices with two neighbours are closed ones.
	std::vector<std::pair<std::vector<Index>, char>> lines;
	std::vector<char>                                visited(vertexCount, 0);
	for (const std::size_t ends : {1, 2})
		for (Index v = 0; v < vertexCount; ++v)
			if (!visited[v] && neighbors[v].size() == ends)
				lines.emplace_back(follow(neighbors, v, visited), ends == 2);
	std::sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) {
		return a.first.front() < b.first.front();
	});

	LineChains chains;
	for (auto& [vertices, closed] : lines) {
		chains.vertices.push_back(std::move(vertices));
		chains.closed.push_back(closed);
	}
	return chains;
}

} // namespace curvature_lines
