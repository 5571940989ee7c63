// Active sets of at most three planes, tried one by one.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "face_projection.h"

#include <limits>

#include <Eigen/Dense>

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

constexpr double minDeterminant = 0.05; // of unit normals: an edge of 13 degrees

// +1: the faces meet in a ridge, each lies below the other; -1: in a valley; 0: neither.
int bend(const LocalFace& a, const LocalFace& b)
{
	const double bOverA = a.height + a.normal.dot(b.center);
	const double aOverB = b.height + b.normal.dot(a.center);
	return bOverA < 0.0 && aOverB < 0.0 ? 1 : bOverA > 0.0 && aOverB > 0.0 ? -1 : 0;
}

// Half spaces normal . x + height <= 0.
struct Corner {
	Eigen::Matrix3d normals; // by column
	Vector3d        heights;
	int             count = 0;

	void add(const LocalFace& face, int side)
	{
		normals.col(count) = side * face.normal;
		heights[count]     = side * face.height;
		++count;
	}
};

// Least move onto the planes of `subset`; false when that is not the projection onto the corner.
bool project(const Corner& corner, unsigned subset, Vector3d& move)
{
	constexpr double                                  tolerance = 1e-12;
	Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> active(3, 0);
	Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> heights(0);
	for (int k = 0; k < corner.count; ++k)
		if (subset >> k & 1u) {
			active.conservativeResize(3, active.cols() + 1);
			heights.conservativeResize(active.cols());
			active.col(active.cols() - 1) = corner.normals.col(k);
			heights[active.cols() - 1]    = corner.heights[k];
		}
	const auto gram = (active.transpose() * active).eval();
	if (gram.determinant() < minDeterminant)
		return false;
	const auto pull = gram.ldlt().solve(heights).eval();
	if (pull.minCoeff() < 0.0)
		return false;
	move               = -active * pull;
	const double slack = tolerance + 1e-9 * heights.norm();
	for (int k = 0; k < corner.count; ++k)
		if (corner.normals.col(k).dot(move) + corner.heights[k] > slack)
			return false;
	return true;
}

} // namespace

Vector3d moveOntoFaces(const LocalFaces& faces)
{
	Corner corner;
	int    side = 0;
	for (int k = 1; k < faces.count; ++k) {
		const int b = bend(faces.face[0], faces.face[k]);
		if (b == 0 || (side != 0 && b != side))
			continue;
		if (side == 0)
			corner.add(faces.face[0], side = b);
		corner.add(faces.face[k], side);
	}
	Vector3d own = -faces.face[0].height * faces.face[0].normal;
	if (side == 0)
		return own;

	int nearest = 0;
	for (int k = 1; k < corner.count; ++k)
		if (corner.heights[k] > corner.heights[nearest])
			nearest = k;
	if (corner.heights[nearest] <= 0.0)
		return -corner.heights[nearest] * corner.normals.col(nearest);
	double   least = std::numeric_limits<double>::infinity();
	Vector3d best  = own, move;
	for (unsigned subset = 1; subset < 1u << corner.count; ++subset)
		if (project(corner, subset, move) && move.squaredNorm() < least) {
			least = move.squaredNorm();
			best  = move;
		}
	return best;
}

} // namespace curvature_lines
