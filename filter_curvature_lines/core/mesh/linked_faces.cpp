// Sides sorted by their vertices find each other; those of new faces among the few that are new.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "linked_faces.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"
#include "polygon_mesh.h"

namespace curvature_lines {

using Eigen::Vector3d;

namespace {

VertexPair edgeOf(Index a, Index b)
{
	return {std::min(a, b), std::max(a, b)};
}

void sortOut(std::vector<VertexPair>& edges)
{
	std::sort(edges.begin(), edges.end());
	edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
}

} // namespace

std::vector<VertexPair> edgesBetween(const PolygonMesh& mesh, const std::vector<char>& marked)
{
	std::vector<VertexPair> edges;
	for (Index f = 0; f < mesh.faceCount(); ++f) {
		const NeighborLists::Row face = mesh.faces[f];
		for (Index k = 0; k < face.size(); ++k) {
			const Index a = face[k], b = face[(k + 1) % face.size()];
			if (marked[a] && marked[b])
				edges.push_back(edgeOf(a, b));
		}
	}
	sortOut(edges);
	return edges;
}

LinkedFaces::LinkedFaces(
	const PolygonMesh&             mesh,
	const std::vector<char>&       onFeature,
	const std::vector<VertexPair>& featureEdges) : m_onFeature(onFeature)
{
	for (Index v = 0; v < mesh.vertexCount(); ++v) {
		m_vertices.emplace_back(mesh.vertices.col(v));
		m_normals.emplace_back(mesh.normals.col(v));
	}
	for (Index f = 0; f < mesh.faceCount(); ++f)
		addFace({mesh.faces[f].begin(), mesh.faces[f].end()});
	link(featureEdges);
	m_valence.assign(m_vertices.size(), 0);
	m_rims.assign(m_vertices.size(), 0);
	for (Index s = 0; s < sideCount(); ++s)
		countEdge(s, 1);
}

void LinkedFaces::countEdge(Index side, Index change)
{
	m_valence[from(side)] += change;
	if (across(side) >= 0)
		return;
	m_valence[to(side)] += change;
	m_rims[from(side)] += change;
	m_rims[to(side)] += change;
}

void LinkedFaces::link(const std::vector<VertexPair>& featureEdges)
{
	std::vector<VertexPair> features = featureEdges;
	sortOut(features);
	std::vector<std::pair<VertexPair, Index>> sides;
	sides.reserve(m_sides.size());
	for (Index s = 0; s < sideCount(); ++s)
		sides.emplace_back(edgeOf(from(s), to(s)), s);
	std::sort(sides.begin(), sides.end());
	for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
		while (j < sides.size() && sides[j].first == sides[i].first)
			++j;
		const bool isFeature = std::binary_search(features.begin(), features.end(), sides[i].first);
		for (std::size_t k = i; k < j; ++k) {
			m_sides[sides[k].second].isFeature = isFeature;
			m_sides[sides[k].second].across    = j - i == 1 ? rim : tangled;
		}
		const Index a = sides[i].second, b = sides[j - 1].second;
		if (j - i == 2 && from(a) != from(b)) {
			m_sides[a].across = b;
			m_sides[b].across = a;
		}
	}
}

Index LinkedFaces::along(Index side, Index steps) const
{
	const Index face = faceOf(side), at = side - m_firstSide[face] + steps;
	return m_firstSide[face] + (at < m_size[face] ? at : at - m_size[face]);
}

LinkedFaces::Loop LinkedFaces::loopFrom(Index side) const
{
	Loop loop;
	for (Index k = 0; k < m_size[faceOf(side)]; ++k)
		loop.push_back(from(along(side, k)));
	return loop;
}

std::vector<Vector3d> LinkedFaces::positionsOf(const Loop& loop) const
{
	std::vector<Vector3d> positions;
	for (const Index v : loop)
		positions.push_back(position(v));
	return positions;
}

Vector3d LinkedFaces::normalOf(const Loop& loop) const
{
	Vector3d sum = Vector3d::Zero();
	for (const Index v : loop)
		sum += normal(v);
	return sum.normalized();
}

Vector3d LinkedFaces::middleOf(Index side) const
{
	return 0.5 * (position(from(side)) + position(to(side)));
}

Index LinkedFaces::addVertex(const Vector3d& position, const Vector3d& normalSum, Index like)
{
	m_vertices.push_back(position);
	m_normals.push_back(normalSum.norm() > 0.0 ? normalSum.normalized() : m_normals[like]);
	m_onFeature.push_back(0);
	m_valence.push_back(0);
	m_rims.push_back(0);
	return static_cast<Index>(m_vertices.size()) - 1;
}

Index LinkedFaces::addMiddle(Index side)
{
	const Index a = from(side), b = to(side);
	const Index middle = addVertex(middleOf(side), m_normals[a] + m_normals[b], a);
	m_onFeature[middle] =
		m_onFeature[a] && m_onFeature[b] && (isFeature(side) || across(side) == rim);
	return middle;
}

Index LinkedFaces::addCenter(const Loop& corners)
{
	Vector3d position = Vector3d::Zero(), normal = Vector3d::Zero();
	for (const Index v : corners) {
		position += m_vertices[v] / double(corners.size());
		normal += m_normals[v];
	}
	return addVertex(position, normal, corners.front());
}

void LinkedFaces::addFace(const Loop& loop)
{
	m_firstSide.push_back(sideCount());
	m_size.push_back(static_cast<Index>(loop.size()));
	double sum = 0.0;
	for (std::size_t k = 0; k < loop.size(); ++k) {
		const Index  v = loop[k], w = loop[k + 1 == loop.size() ? 0 : k + 1];
		const double length = (m_vertices[v] - m_vertices[w]).norm();
		m_sides.push_back({v, faceCount() - 1, rim, false, length});
		sum += length;
	}
	m_meanLength.push_back(sum / static_cast<double>(loop.size()));
}

void LinkedFaces::replace(
	const std::vector<Index>& faces, std::vector<Split> splits, const std::vector<Loop>& parts)
{
	const Index first = sideCount();
	for (const Loop& part : parts)
		addFace(part);
	std::vector<Index> added(static_cast<std::size_t>(sideCount() - first));
	std::iota(added.begin(), added.end(), first);
	const auto ends = [&](Index s) { return std::make_pair(from(s), to(s)); };
	std::sort(added.begin(), added.end(), [&](Index s, Index t) { return ends(s) < ends(t); });
	const auto find = [&](Index a, Index b) {
		const auto wanted = std::make_pair(a, b);
		const auto found  = std::lower_bound(
            added.begin(), added.end(), wanted, [&](Index s, const VertexPair& pair) {
                return ends(s) < pair;
            });
		return found != added.end() && ends(*found) == wanted ? *found : rim;
	};
	for (const Index s : added)
		m_sides[s].across = find(to(s), from(s));

	std::sort(splits.begin(), splits.end(), [](const Split& a, const Split& b) {
		return a.side < b.side;
	});
	std::vector<std::tuple<Index, Index, Index>> gone; // from, to, side
	for (const Index f : faces)
		for (Index k = 0; k < m_size[f]; ++k) {
			const Index s = m_firstSide[f] + k;
			countEdge(s, -1);
			const auto split =
				std::lower_bound(splits.begin(), splits.end(), s, [](const Split& a, Index side) {
					return a.side < side;
				});
			if (split == splits.end() || split->side != s) {
				gone.emplace_back(from(s), to(s), s);
				continue;
			}
			for (const Index half : {find(from(s), split->middle), find(split->middle, to(s))})
				if (half >= 0)
					m_sides[half].isFeature = isFeature(s);
		}
	for (const Index f : faces)
		m_size[f] = 0;
	for (const auto& [a, b, s] : gone) {
		const Index now = find(a, b);
		if (now < 0)
			continue;
		m_sides[now].isFeature = isFeature(s);
		if (across(s) < 0) {
			m_sides[now].across = across(s);
		}
		else if (!isReplaced(faceOf(across(s)))) {
			m_sides[now].across       = across(s);
			m_sides[across(s)].across = now;
		}
	}
	for (Index s = first; s < sideCount(); ++s)
		countEdge(s, 1);
}

PolygonMesh LinkedFaces::mesh() const
{
	std::vector<Loop> loops;
	for (Index f = 0; f < faceCount(); ++f)
		if (!isReplaced(f))
			loops.push_back(loopFrom(m_firstSide[f]));
	return polygonMesh(m_vertices, m_normals, loops);
}

std::vector<VertexPair> LinkedFaces::featureEdges() const
{
	std::vector<VertexPair> edges;
	for (Index f = 0; f < faceCount(); ++f)
		for (Index k = 0; k < m_size[f]; ++k)
			if (const Index s = m_firstSide[f] + k; isFeature(s))
				edges.push_back(edgeOf(from(s), to(s)));
	sortOut(edges);
	return edges;
}

} // namespace curvature_lines
