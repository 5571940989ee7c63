// Curves on triangulations of which everything is known: where functions of position have whole values.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"
#include "surface_curves.h"
#include "triangle_mesh.h"

namespace curvature_lines::test {

using LevelFunction = std::function<double(const Eigen::Vector3d&)>;

// The curves of every function, interpolated along edges, as chords; points of all families sorted together.
inline SurfaceCurves
levelSets(const TriangleMesh& mesh, const std::vector<LevelFunction>& functions)
{
	SurfaceCurves curves;
	curves.points.resize(mesh.edgeCount());
	std::vector<std::vector<std::pair<int, int>>> names(mesh.edgeCount()); // family, level
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		std::vector<std::tuple<double, int, int>> found;
		for (int f = 0; f < static_cast<int>(functions.size()); ++f) {
			const double a = functions[f](mesh.vertices.col(mesh.edges()[e].from));
			const double b = functions[f](mesh.vertices.col(mesh.edges()[e].to));
			for (int q = static_cast<int>(std::ceil(std::min(a, b))); q < std::max(a, b); ++q)
				found.emplace_back((q - a) / (b - a), f, q);
		}
		std::sort(found.begin(), found.end());
		for (const auto& [t, f, q] : found) {
			curves.points[e].push_back({t, f});
			names[e].emplace_back(f, q);
		}
	}
	for (Index t = 0; t < mesh.triangleCount(); ++t) {
		std::map<std::pair<int, int>, SurfaceCurves::End> open;
		for (int c = 0; c < 3; ++c) {
			const Index e = mesh.edgeOf(t, c);
			for (Index p = 0; p < static_cast<Index>(names[e].size()); ++p) {
				const auto other = open.find(names[e][p]);
				if (other == open.end())
					open[names[e][p]] = {e, p};
				else
					curves.chords.push_back({t, other->second, {e, p}});
			}
		}
	}
	return curves;
}

} // namespace curvature_lines::test
