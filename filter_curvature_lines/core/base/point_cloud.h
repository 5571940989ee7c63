// Oriented point clouds: the one input type of every stage, and the preparation of raw input.
// Neighbour lists and per-point status are the vocabulary the stages share.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <stdexcept>
#include <vector>

#include <Eigen/Core>

namespace curvature_lines {

using Index = std::int32_t;

// Unusable input. what() names the cause and the cure in one sentence for the user.
class InputError : public std::runtime_error {
public:
	using std::runtime_error::runtime_error;
};

struct PointCloud {
	Eigen::Matrix3Xd positions; // 3 x N
	// 3 x N, unit, outward (see curvature conventions in robust_curvature.h)
	Eigen::Matrix3Xd normals;

	Index size() const { return static_cast<Index>(positions.cols()); }
};

// The chosen columns of a 3 x N matrix, in the order of `which`; the chosen points of a cloud.
Eigen::Matrix3Xd columnsOf(const Eigen::Matrix3Xd& columns, const std::vector<Index>& which);
PointCloud columnsOf(const PointCloud& cloud, const std::vector<Index>& which);

// Variable-length rows in one block (CSR). Row i holds indices[offsets[i] .. offsets[i + 1]).
struct NeighborLists {
	struct Row {
		const Index* first = nullptr;
		const Index* last  = nullptr;
		const Index* begin() const { return first; }
		const Index* end() const { return last; }
		Index size() const { return static_cast<Index>(last - first); }
		Index operator[](Index k) const { return first[k]; }
	};

	std::vector<Index> offsets = {0};
	std::vector<Index> indices;

	Index size() const { return static_cast<Index>(offsets.size()) - 1; }
	Row operator[](Index i) const
	{
		return {indices.data() + offsets[i], indices.data() + offsets[i + 1]};
	}
	// Concatenates rows built in parallel; row order is kept, so the result is deterministic.
	static NeighborLists fromRows(const std::vector<std::vector<Index>>& rows);
};

enum class PointStatus : std::uint8_t {
	Ok              = 0,
	Boundary        = 1, // two or more contiguous empty slices; estimated with less confidence
	TooFewNeighbors = 2, // no estimate: curvature 0, arbitrary tangent directions
	Umbilic         = 3, // k1 == k2 within error: directions replaced or meaningless
	Isolated        = 4, // four or more empty slices; rejected as an outlier
	Invalid         = 5, // non-finite coordinates or no usable normal; takes no part
};

// What prepareCloud() made of raw input. Stages work in the unit frame: centred on the bounding box,
// its diagonal scaled to 1, so no tolerance depends on the user's units or distance from the origin.
struct PreparedCloud {
	PointCloud      cloud;          // n <= N distinct finite points, unit normals, unit frame
	Eigen::Vector3d center;         // model units
	double          diagonal = 1.0; // bounding-box diagonal in model units
	// n: raw index of each kept point (the first of its duplicates)
	std::vector<Index> source;
	std::vector<Index> representative;  // N: kept index of each raw point, -1 if dropped
	Index              nonFinite   = 0; // dropped: NaN or infinite coordinates
	Index              zeroNormals = 0; // dropped: zero or non-finite normal
	Index              duplicates  = 0; // merged into an earlier point at the same position

	Eigen::Vector3d toUnit(const Eigen::Vector3d& p) const { return (p - center) / diagonal; }
	Eigen::Vector3d toModel(const Eigen::Vector3d& p) const { return p * diagonal + center; }
};

// Drops non-finite points and points without a normal, merges exact duplicates (Voronoi cells and
// 1/d^2 weights break on them; their normals are averaged), normalises normals and units.
// raw normals may be of any length. Throws InputError when fewer than minPoints distinct usable points
// remain, when they have no extent (all equal, or collinear to 1e-9 of the diagonal), or when most
// normals are missing.
PreparedCloud prepareCloud(
	const Eigen::Matrix3Xd& positions, // 3 x N, model units
	const Eigen::Matrix3Xd& normals,   // 3 x N, any length
	Index                   minPoints = 20);

} // namespace curvature_lines
