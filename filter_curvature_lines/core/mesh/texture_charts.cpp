// Charts grow face by face over a grid of cells, none of which is taken twice; their boxes are put side by side in rows.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture_charts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <unordered_set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "linked_faces.h"
#include "point_cloud.h"
#include "polygon_mesh.h"
#include "polygon_triangulation.h"

namespace curvature_lines {

namespace {

using Eigen::Array2i;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Cosine of the bend of an edge from which on it is a crease: 20 degrees. Faces beside a smooth bend turn by less unless the
// mesh is very coarse; creases are looked for from larger angles on.
constexpr double creaseCosine = 0.94;
// Longest side of a chart's box over the one of a square that all faces would fill: long limbs are cut, which would leave most
// of the texture empty. Of 1.2, 1.5 and 2 the one with the smallest textures and fewest charts on the scans of
// benchmarks/output_hashes.py.
constexpr double longestSide = 1.5;
// Empty cells between charts: filters of pictures look one cell around at most when a cell has a few pixels.
constexpr int gap = 1;

// From a cell over its sides, counter-clockwise from the bottom.
const std::array<Array2i, 4> outwards = {
	Array2i(0, -1), Array2i(1, 0), Array2i(0, 1), Array2i(-1, 0)};

// Where a face lies in its chart: the side that starts at corner `base` is side `turn` of the cell.
struct Place {
	Index   chart = -1;
	Array2i cell  = {0, 0};
	Index   base  = 0;
	int     turn  = 0;
};

std::int64_t keyOf(const Array2i& cell)
{
	return (static_cast<std::int64_t>(cell.x()) << 32) ^ static_cast<std::uint32_t>(cell.y());
}

// The corners of a face of n corners in the unit cell, from the start of the side that is the bottom: a half ellipse over it.
// A quad is the cell itself.
std::vector<Vector2d> cornersInCell(Index n)
{
	std::vector<Vector2d> corners = {{0.0, 0.0}, {1.0, 0.0}};
	for (Index k = 2; k < n; ++k) {
		const double angle = EIGEN_PI * (double(k - 2) + 0.5) / double(n - 2);
		corners.emplace_back(0.5 + 0.5 * std::cos(angle), std::sin(angle));
	}
	if (n == 4) {
		corners[2] = {1.0, 1.0};
		corners[3] = {0.0, 1.0};
	}
	return corners;
}

// A point of the unit cell when its bottom becomes side `turn`.
Vector2d turnedInCell(Vector2d p, int turn)
{
	for (int k = 0; k < turn; ++k)
		p = Vector2d(1.0 - p.y(), p.x());
	return p;
}

class ChartGrowth {
public:
	ChartGrowth(const PolygonMesh& mesh, const std::vector<VertexPair>& creases) :
			m_faces(mesh, std::vector<char>(mesh.vertexCount(), 0), creases),
			m_places(mesh.faceCount()),
			m_longest(static_cast<int>(std::ceil(longestSide * std::sqrt(mesh.faceCount()))))
	{
		growAll();
		addOthers();
	}

	const std::vector<Place>& places() const { return m_places; }
	Index charts() const { return static_cast<Index>(m_taken.size()); }

private:
	bool isQuad(Index face) const { return m_faces.size(face) == 4; }
	// The side across, if the texture may run on there.
	Index across(Index side) const
	{
		return m_faces.isFeature(side) ? LinkedFaces::rim : m_faces.across(side);
	}

	// Steps from face to face to the nearest irregular vertex, crease or rim.
	std::vector<int> distances() const
	{
		std::vector<int>   distance(m_places.size(), -1);
		std::vector<Index> front;
		for (Index f = 0; f < m_faces.faceCount(); ++f)
			for (Index k = 0; k < m_faces.size(f); ++k) {
				const Index side = m_faces.firstSide(f) + k, v = m_faces.from(side);
				const bool  regular =
                    m_faces.isOnRim(v) ? m_faces.valence(v) <= 3 : m_faces.valence(v) == 4;
				if ((!regular || across(side) < 0 || !isQuad(f)) && distance[f] < 0) {
					distance[f] = 0;
					front.push_back(f);
				}
			}
		for (std::size_t i = 0; i < front.size(); ++i)
			for (Index k = 0; k < m_faces.size(front[i]); ++k)
				if (const Index there = across(m_faces.firstSide(front[i]) + k); there >= 0)
					if (int& d = distance[m_faces.faceOf(there)]; d < 0) {
						d = distance[front[i]] + 1;
						front.push_back(m_faces.faceOf(there));
					}
		return distance;
	}

	// From the faces farthest from all seams that must be.
	void growAll()
	{
		const std::vector<int> distance = distances();
		std::vector<Index>     seeds(m_places.size());
		std::iota(seeds.begin(), seeds.end(), Index(0));
		std::stable_sort(seeds.begin(), seeds.end(), [&](Index a, Index b) {
			return distance[a] > distance[b];
		});
		for (const Index seed : seeds)
			if (isQuad(seed) && m_places[seed].chart < 0)
				grow(seed);
	}

	// Of the face across a side of a quad that has its place.
	Place placeAcross(Index side, Index there) const
	{
		const Index  quad  = m_faces.faceOf(side);
		const Place& place = m_places[quad];
		const int    own =
			static_cast<int>(side - m_faces.firstSide(quad) - place.base + place.turn) & 3;
		return {
			place.chart,
			place.cell + outwards[own],
			there - m_faces.firstSide(m_faces.faceOf(there)),
			(own + 2) & 3};
	}

	// In rings around the seed.
	void grow(Index seed)
	{
		m_taken.emplace_back();
		auto&   taken = m_taken.back();
		Array2i low = {0, 0}, high = {0, 0}; // inclusive
		m_places[seed] = {charts() - 1, {0, 0}, 0, 0};
		taken.insert(keyOf(m_places[seed].cell));
		std::vector<Index> front = {seed};
		for (std::size_t i = 0; i < front.size(); ++i)
			for (Index k = 0; k < 4; ++k) {
				const Index side = m_faces.firstSide(front[i]) + k, there = across(side);
				if (there < 0)
					continue;
				const Index next = m_faces.faceOf(there);
				if (!isQuad(next) || m_places[next].chart >= 0)
					continue;
				const Place   place = placeAcross(side, there);
				const Array2i from = low.min(place.cell), to = high.max(place.cell);
				if ((to - from).maxCoeff() >= m_longest || !taken.insert(keyOf(place.cell)).second)
					continue;
				low            = from;
				high           = to;
				m_places[next] = place;
				front.push_back(next);
			}
	}

	// Triangles, pentagons and what else there is: in the first free cell beside a quad, or in a chart of their own.
	void addOthers()
	{
		for (Index f = 0; f < m_faces.faceCount(); ++f) {
			if (isQuad(f))
				continue;
			for (Index k = 0; k < m_faces.size(f) && m_places[f].chart < 0; ++k) {
				const Index side = m_faces.firstSide(f) + k, there = across(side);
				if (there < 0 || !isQuad(m_faces.faceOf(there)))
					continue;
				const Place place = placeAcross(there, side);
				if (m_taken[place.chart].insert(keyOf(place.cell)).second)
					m_places[f] = place;
			}
			if (m_places[f].chart < 0) {
				m_taken.emplace_back();
				m_taken.back().insert(keyOf({0, 0}));
				m_places[f] = {charts() - 1, {0, 0}, 0, 0};
			}
		}
	}

	LinkedFaces                                   m_faces;
	std::vector<Place>                            m_places;  // of every face
	int                                           m_longest; // cells along a side of a chart's box
	std::vector<std::unordered_set<std::int64_t>> m_taken;   // cells of every chart
};

// The box of a chart, and where it goes in the texture.
struct Box {
	Array2i low  = Array2i::Constant(std::numeric_limits<int>::max());
	Array2i high = Array2i::Constant(std::numeric_limits<int>::min()); // exclusive
	bool    lies = false; // turned by a quarter, as boxes are that are higher than wide
	Array2i at   = {0, 0};

	Array2i size() const { return lies ? Array2i((high - low).reverse()) : Array2i(high - low); }
	// Of a point of the chart, in the texture.
	Vector2d placed(const Vector2d& p) const
	{
		const Vector2d q = p - low.cast<double>().matrix();
		return at.cast<double>().matrix() +
		       (lies ? Vector2d(double(size().x()) - q.y(), q.x()) : q);
	}
};

std::vector<Box> boxesOf(const std::vector<Place>& places, Index charts)
{
	std::vector<Box> boxes(charts);
	for (const Place& place : places) {
		Box& box = boxes[place.chart];
		box.low  = box.low.min(place.cell);
		box.high = box.high.max(place.cell + 1);
	}
	for (Box& box : boxes)
		box.lies = box.high.y() - box.low.y() > box.high.x() - box.low.x();
	return boxes;
}

// Rows of boxes in the given order, no wider than `width`; how high they are.
int putInRows(std::vector<Box>& boxes, const std::vector<Index>& order, int width)
{
	int x = 0, y = 0, above = 0;
	for (const Index b : order) {
		const Array2i size = boxes[b].size();
		if (x > 0 && x + size.x() > width) {
			x = 0;
			y = above + gap;
		}
		boxes[b].at = {x, y};
		x += size.x() + gap;
		above = std::max(above, y + size.y());
	}
	return above;
}

// Highest boxes first, in rows so wide that the square around all is small. Its side.
int pack(std::vector<Box>& boxes)
{
	constexpr double   wider = 1.05; // from width to width tried
	std::vector<Index> order(boxes.size());
	std::int64_t       all    = 0;
	int                widest = 1;
	std::iota(order.begin(), order.end(), Index(0));
	for (const Box& box : boxes) {
		widest = std::max(widest, box.size().x());
		all += box.size().x() + gap;
	}
	std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
		return boxes[a].size().y() > boxes[b].size().y();
	});
	int best = std::numeric_limits<int>::max(), bestWidth = widest;
	for (double width = widest; width <= double(all); width = std::ceil(wider * width)) {
		const int height = putInRows(boxes, order, static_cast<int>(width));
		const int side   = std::max(static_cast<int>(width), height);
		if (side < best) {
			best      = side;
			bestWidth = static_cast<int>(width);
		}
		if (height <= width)
			break; // wider only makes it larger
	}
	putInRows(boxes, order, bestWidth);
	int side = 1;
	for (const Box& box : boxes)
		side = std::max(side, (box.at + box.size()).maxCoeff());
	return side;
}

Vector3d normalOf(const PolygonMesh& mesh, Index face)
{
	const NeighborLists::Row loop = mesh.faces[face];
	Vector3d                 sum  = Vector3d::Zero();
	for (Index k = 0; k < loop.size(); ++k)
		sum += Vector3d(mesh.vertices.col(loop[k]))
		           .cross(Vector3d(mesh.vertices.col(loop[(k + 1) % loop.size()])));
	return sum.normalized();
}

} // namespace

TextureCoordinates
textureCoordinates(const PolygonMesh& mesh, const std::vector<VertexPair>& creases)
{
	TextureCoordinates result;
	result.corners.resize(2, static_cast<Index>(mesh.faces.indices.size()));
	if (mesh.faceCount() == 0)
		return result;
	const ChartGrowth growth(mesh, creases);
	std::vector<Box>  boxes = boxesOf(growth.places(), growth.charts());
	result.charts           = growth.charts();
	result.cells            = pack(boxes);
	for (Index f = 0; f < mesh.faceCount(); ++f) {
		const Place&                place = growth.places()[f];
		const Index                 n     = mesh.faces[f].size();
		const std::vector<Vector2d> cell  = cornersInCell(n);
		result.chart.push_back(place.chart);
		for (Index k = 0; k < n; ++k) {
			const Vector2d p = turnedInCell(cell[(k - place.base + n) % n], place.turn) +
			                   place.cell.cast<double>().matrix();
			result.corners.col(mesh.faces.offsets[f] + k) =
				boxes[place.chart].placed(p) / double(result.cells);
		}
	}
	return result;
}

std::vector<VertexPair> bentEdgesBetween(const PolygonMesh& mesh, const std::vector<char>& marked)
{
	const std::vector<VertexPair> candidates = edgesBetween(mesh, marked);
	const LinkedFaces             faces(mesh, marked, candidates);
	std::vector<VertexPair>       bent;
	for (Index s = 0; s < faces.sideCount(); ++s) {
		const Index there = faces.across(s);
		if (there < s || !faces.isFeature(s)) // each edge once
			continue;
		if (normalOf(mesh, faces.faceOf(s)).dot(normalOf(mesh, faces.faceOf(there))) < creaseCosine)
			bent.emplace_back(
				std::min(faces.from(s), faces.to(s)), std::max(faces.from(s), faces.to(s)));
	}
	std::sort(bent.begin(), bent.end());
	return bent;
}

Eigen::Matrix2Xd cornersOfTriangles(
	const PolygonMesh& polygons, const Eigen::Matrix2Xd& corners, const PolygonTriangulation& cut)
{
	const NeighborLists& triangles = cut.triangles.faces;
	Eigen::Matrix2Xd     result(2, static_cast<Index>(triangles.indices.size()));
	for (Index t = 0; t < triangles.size(); ++t) {
		const Index              polygon = cut.polygon[t], first = polygons.faces.offsets[polygon];
		const NeighborLists::Row loop = polygons.faces[polygon];
		for (Index c = 0; c < 3; ++c) {
			const auto at = std::find(loop.begin(), loop.end(), triangles[t][c]);
			if (at != loop.end())
				result.col(3 * t + c) = corners.col(first + (at - loop.begin()));
			else
				result.col(3 * t + c) = corners.middleCols(first, loop.size()).rowwise().mean();
		}
	}
	return result;
}

} // namespace curvature_lines
