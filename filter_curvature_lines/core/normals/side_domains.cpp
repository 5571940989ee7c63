// Domains over smooth edges, walls between them, and the cost of a turn in winding number.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "side_domains.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "dipole_sums.h"
#include "disjoint_sets.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"

namespace curvature_lines {

namespace {

constexpr Index  edgeNeighbors = 16;
constexpr double parallel      = 0.8;  // cosine of the normals of an edge, at least
constexpr double tangential    = 0.35; // cosine of the edge with both normals, at most
constexpr Index  minDomain     = 30;   // points
constexpr int maxDomains = 400; // above, the cloud is no surface and each has a field to be summed
// A wall of edges that contradict, in square roots of the size of the domain.
constexpr double wallLength = 1.5;
// Change of the squared error of the winding number per point. Planes 0, open scans .17 to .25, a thin plate .5,
// closed shapes .77 to .98.
constexpr double openCost = 0.35;

struct Edge {
	Index i, j;
	bool  same;
};

struct Edges {
	std::vector<Edge>   edges;
	std::vector<double> weight; // N: area of a point over 4 pi
};

Edges smoothEdges(
	const Eigen::Matrix3Xd& positions,
	const Eigen::Matrix3Xd& normals,
	const NeighborSearch&   search)
{
	const auto                     n = static_cast<Index>(positions.cols());
	std::vector<std::vector<Edge>> rows(n);
	Edges                          result;
	result.weight.resize(n);
	parallelFor(n, {}, [&](Index i) {
		const std::vector<Index> near = search.nearest(positions.col(i), edgeNeighbors + 1);
		result.weight[i] =
			(positions.col(near.back()) - positions.col(i)).squaredNorm() / (4.0 * edgeNeighbors);
		for (Index j : near) {
			if (j > i &&
			    areOnOnePiece(positions.col(j) - positions.col(i), normals.col(i), normals.col(j)))
				rows[i].push_back({i, j, normals.col(i).dot(normals.col(j)) > 0.0});
		}
	});
	for (const auto& row : rows)
		result.edges.insert(result.edges.end(), row.begin(), row.end());
	return result;
}

// Sets of at least minDomain points, numbered by their first; -1: in none.
struct Domains {
	std::vector<int>   of;
	std::vector<Index> size;

	explicit Domains(DisjointSets& sets, Index n) : of(n, -1)
	{
		std::vector<Index> count(n, 0);
		for (Index i = 0; i < n; ++i)
			++count[sets.find(i)];
		std::vector<int> number(n, -1);
		for (Index i = 0; i < n; ++i) {
			const Index root = sets.find(i);
			if (count[root] < minDomain)
				continue;
			if (number[root] < 0) {
				number[root] = static_cast<int>(size.size());
				size.push_back(count[root]);
			}
			of[i] = number[root];
		}
	}
};

// Winding numbers of the points, and of one domain at a time.
struct Windings {
	const DipoleSums&          sums;
	const Eigen::Matrix3Xd&    normals;
	const std::vector<double>& weight;
	float                      width;

	Eigen::VectorXd of(const std::vector<int>& domain, int which) const // -1: of all
	{
		DipoleSums::Vectors dipoles = DipoleSums::Vectors::Zero(3, normals.cols());
		for (Eigen::Index i = 0; i < normals.cols(); ++i)
			if (which < 0 || domain[i] == which)
				dipoles.col(i) = (weight[i] * normals.col(i)).cast<float>();
		return sums.winding(dipoles, width, {}).cast<double>();
	}
};

double turnCost(const Eigen::VectorXd& all, const Eigen::VectorXd& part)
{
	const Eigen::ArrayXd error = all.array() - 0.5;
	return ((error - 2.0 * part.array()).square() - error.square()).sum();
}

using Walls = std::map<std::pair<int, int>, Index>; // opposing less agreeing edges

void turnDomains(
	Eigen::Matrix3Xd& normals, const Domains& domains, const Walls& walls, const Windings& windings)
{
	const auto                   count = static_cast<int>(domains.size.size());
	std::vector<Eigen::VectorXd> part(count);
	for (const auto& [pair, wall] : walls)
		for (int a : {pair.first, pair.second})
			if (part[a].size() == 0)
				part[a] = windings.of(domains.of, a);
	Eigen::VectorXd     all = windings.of(domains.of, -1);
	std::vector<double> sign(count, 1.0);
	for (int turn = 0; turn < 2 * count; ++turn) {
		std::vector<double> length(count, 0.0);
		for (const auto& [pair, wall] : walls)
			for (int a : {pair.first, pair.second})
				length[a] += sign[pair.first] * sign[pair.second] * double(wall);
		int best = -1;
		for (int a = 0; a < count; ++a) {
			const auto size = double(domains.size[a]);
			if (part[a].size() > 0 && length[a] > wallLength * std::sqrt(size) &&
			    (best < 0 || length[a] > length[best]) && turnCost(all, part[a]) < openCost * size)
				best = a;
		}
		if (best < 0)
			break;
		sign[best] = -sign[best];
		all -= 2.0 * part[best];
		part[best] = -part[best];
	}
	for (Eigen::Index i = 0; i < normals.cols(); ++i)
		if (domains.of[i] >= 0 && sign[domains.of[i]] < 0.0)
			normals.col(i) *= -1.0;
}

// Whole pieces that are as good inside out.
Index turnOpenPieces(
	Eigen::Matrix3Xd&                            normals,
	const Domains&                               pieces,
	const Windings&                              windings,
	const std::function<Eigen::Vector3d(Index)>& preferred)
{
	const auto            count = static_cast<int>(pieces.size.size());
	const Eigen::VectorXd all   = windings.of(pieces.of, -1);
	std::vector<double>   sign(count, 1.0);
	Index                 undecided = 0;
	for (int a = 0; a < count; ++a) {
		const Eigen::VectorXd part = count == 1 ? all : windings.of(pieces.of, a);
		if (turnCost(all, part) >= openCost * double(pieces.size[a]))
			continue;
		undecided += pieces.size[a];
		double agreement = 0.0;
		for (Eigen::Index i = 0; preferred && i < normals.cols(); ++i)
			if (pieces.of[i] == a)
				agreement += normals.col(i).dot(preferred(static_cast<Index>(i)));
		if (agreement < 0.0)
			sign[a] = -1.0;
	}
	for (Eigen::Index i = 0; i < normals.cols(); ++i)
		if (pieces.of[i] >= 0 && sign[pieces.of[i]] < 0.0)
			normals.col(i) *= -1.0;
	return undecided;
}

} // namespace

bool areOnOnePiece(const Eigen::Vector3d& d, const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
	const double lift = std::max(std::abs(a.dot(d)), std::abs(b.dot(d)));
	return std::abs(a.dot(b)) > parallel && lift < tangential * d.norm();
}

SideDomains alignSideDomains(
	const Eigen::Matrix3Xd&                      positions,
	Eigen::Matrix3Xd                             normals,
	const NeighborSearch&                        search,
	const DipoleSums&                            sums,
	double                                       width,
	const std::function<Eigen::Vector3d(Index)>& preferred,
	const Progress&                              progress)
{
	const auto   n    = static_cast<Index>(positions.cols());
	const Edges  near = smoothEdges(positions, normals, search);
	DisjointSets same(n), joined(n);
	for (const Edge& edge : near.edges) {
		joined.join(edge.i, edge.j);
		if (edge.same)
			same.join(edge.i, edge.j);
	}
	SideDomains    result{std::move(normals)};
	const Windings windings{sums, result.normals, near.weight, static_cast<float>(width)};
	const Domains  domains(same, n), pieces(joined, n);
	if (domains.size.size() <= maxDomains) {
		Walls walls;
		for (const Edge& edge : near.edges) {
			const int a = domains.of[edge.i], b = domains.of[edge.j];
			if (a >= 0 && b >= 0 && a != b)
				walls[{std::min(a, b), std::max(a, b)}] += edge.same ? -1 : 1;
		}
		if (!walls.empty())
			turnDomains(result.normals, domains, walls, windings);
	}
	progress.report(0.5);
	if (pieces.size.size() <= maxDomains)
		result.undecidedShare =
			double(turnOpenPieces(result.normals, pieces, windings, preferred)) / double(n);
	return result;
}

} // namespace curvature_lines
