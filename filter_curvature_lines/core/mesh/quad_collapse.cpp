// Collapses tried one after the other.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "quad_collapse.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "point_cloud.h"
#include "polygon_mesh.h"
#include "quad_edits.h"

namespace curvature_lines {

namespace {

constexpr int rounds = 5;
// Scaled Jacobian below which a face counts as bad, by what it lacks; and the share of that which a collapse must take away.
constexpr double wanted = 0.1, leastGain = 0.1;

// Of the faces around some vertices.
struct Faults {
	double lack    = 0.0;
	int    unsound = 0;
};

Faults faultsAround(const QuadEdits& mesh, const std::vector<Index>& vertices)
{
	Faults faults;
	for (const Index f : mesh.facesAround(vertices)) {
		const double jacobian = mesh.jacobianOf(f);
		faults.lack += std::max(0.0, wanted - jacobian);
		faults.unsound += jacobian < 0.0;
	}
	return faults;
}

// The faces that are gone.
Index collapse(Index face, QuadEdits& mesh)
{
	const std::vector<Index>       corners = mesh.loops()[face];
	const Faults                   before  = faultsAround(mesh, corners);
	Faults                         best;
	std::optional<QuadEdits::Edit> found;
	for (const QuadEdits::Edit& merge : mesh.mergesOf(face)) {
		QuadEdits::Undo undo;
		if (mesh.apply(merge, undo)) {
			const Faults after = faultsAround(mesh, corners);
			if (after.unsound < before.unsound && after.lack <= (1.0 - leastGain) * before.lack &&
			    (!found || after.lack < best.lack)) {
				found = merge;
				best  = after;
			}
		}
		mesh.restore(undo);
	}
	if (!found)
		return 0;
	QuadEdits::Undo undo;
	mesh.apply(*found, undo);
	return static_cast<Index>(
		std::count_if(undo.loops.begin(), undo.loops.end(), [&](const auto& entry) {
			return mesh.loops()[entry.first].empty();
		}));
}

bool isUnsoundQuad(const QuadEdits& mesh, Index face)
{
	return mesh.loops()[face].size() == 4 && mesh.jacobianOf(face) < 0.0;
}

} // namespace

Index collapseUnsoundQuads(std::vector<char>& onFeature, PolygonMesh& mesh)
{
	QuadEdits edits(onFeature, mesh);
	Index     gone = 0;
	for (int round = 0; round < rounds; ++round) {
		std::vector<std::pair<double, Index>> bad;
		for (Index f = 0; f < mesh.faceCount(); ++f)
			if (isUnsoundQuad(edits, f))
				bad.emplace_back(edits.jacobianOf(f), f);
		std::sort(bad.begin(), bad.end());
		const Index before = gone;
		for (const auto& entry : bad)
			if (isUnsoundQuad(edits, entry.second))
				gone += collapse(entry.second, edits);
		if (gone == before)
			break;
	}
	if (gone > 0)
		replaceFaces(edits.loops(), onFeature, mesh);
	return gone;
}

} // namespace curvature_lines
