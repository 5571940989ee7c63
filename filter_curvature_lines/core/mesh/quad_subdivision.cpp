// A middle for every edge, a centre for every face.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "quad_subdivision.h"

#include <vector>

#include "linked_faces.h"
#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {

QuadSubdivision subdivided(
	const PolygonMesh&             mesh,
	std::vector<char>&             onFeature,
	const std::vector<VertexPair>& featureEdges)
{
	LinkedFaces                     faces(mesh, onFeature, featureEdges);
	const Index                     faceCount = faces.faceCount(), sideCount = faces.sideCount();
	std::vector<Index>              middle(sideCount, -1), all;
	std::vector<LinkedFaces::Split> splits;
	std::vector<LinkedFaces::Loop>  parts;
	for (Index s = 0; s < sideCount; ++s) {
		const Index there = faces.across(s);
		middle[s]         = there >= 0 && there < s ? middle[there] : faces.addMiddle(s);
		splits.push_back({s, middle[s]});
	}
	for (Index f = 0; f < faceCount; ++f) {
		all.push_back(f);
		const Index center = faces.addCenter(faces.loopFrom(faces.firstSide(f)));
		for (Index k = 0; k < faces.size(f); ++k) {
			const Index s = faces.firstSide(f) + k;
			parts.push_back({center, middle[faces.previous(s)], faces.from(s), middle[s]});
		}
	}
	faces.replace(all, splits, parts);
	onFeature = faces.onFeature();
	return {faces.mesh(), faces.featureEdges()};
}

QuadSubdivision subdivided(const PolygonMesh& mesh, std::vector<char>& onFeature)
{
	return subdivided(mesh, onFeature, edgesBetween(mesh, onFeature));
}

} // namespace curvature_lines
