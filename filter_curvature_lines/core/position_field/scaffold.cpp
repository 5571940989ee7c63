// The advancing front over the sites, and its repair: manifold part, orientation, components
// that are too small, holes the cloud does not have.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "scaffold.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "advancing_front.h"
#include "cloud_index.h"
#include "crease_recovery.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "point_subsets.h"
#include "progress.h"
#include "quantile.h"
#include "scaffold_sites.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// The spacing is the median mean distance to so many neighbours, of so many points.
constexpr Index spacingProbes    = 2000;
constexpr Index spacingNeighbors = 6;
// That mean distance for random points of density 1: sum over k of Gamma(k + 1/2) / (Gamma(k) sqrt(pi)) /
// 6, k = 1 to 6.
constexpr double poissonSpacing = 0.977;
// And for points thinned to distance 1 at random. Measured.
constexpr double evenSites = 1.5;
// Least distances of vertices in an edge of the quad mesh. With mean edges of the scaffold of .4, .66, 1.2,
// 1.7 faces the edges of a torus were .08, .15, .40, .80 degrees from the principal directions in a
// prototype.
constexpr double trianglesPerFace = 3.0;
// Clearance in noise units: the denoised points beside a crease are round. By experiment on cubes.
constexpr double noiseClearance = 2.0;
// Attempts with vertices farther and farther apart, and by how much; and others with a slightly different
// distance, to have other points. By experiment.
constexpr int    attempts      = 3;
constexpr double coarser       = 1.5;
constexpr int    otherTries    = 4;
constexpr double otherDistance = 0.05;
// Creases shorter than this, in distances of vertices, are the first to be left out. By experiment (scans).
constexpr double shortCrease = 10.0;
// Of two attempts the one with fewer flaws is taken; a rim or a handle counts as so many defects. Below
// this number of defects per vertex no other attempt is made. By experiment.
constexpr Index  rimFlaws         = 5;
constexpr double toleratedDefects = 0.002;

double spacingOf(const PointSample& sample)
{
	const Index         count = std::min(sample.cloud.size(), spacingProbes);
	std::vector<double> spacing(count);
	parallelFor(count, {}, [&](Index i) {
		const Vector3d p    = sample.cloud.positions.col(i);
		double         sum  = 0.0;
		const auto     near = sample.search.nearest(p, spacingNeighbors + 1);
		for (const Index j : near)
			sum += (sample.cloud.positions.col(j) - p).norm();
		spacing[i] = sum / std::max<std::size_t>(near.size() - 1, 1);
	});
	return medianInPlace(spacing);
}

// Distance of the neighbours around every site; `distance` in an evenly sampled cloud, more where it is
// sparse.
Eigen::VectorXd localDistances(const Eigen::Matrix3Xd& points, double distance)
{
	const NeighborSearch search(points);
	Eigen::VectorXd      result(points.cols());
	parallelFor(static_cast<Index>(points.cols()), {}, [&](Index i) {
		const Vector3d p   = points.col(i);
		double         sum = 0.0;
		for (const Index j : search.nearest(p, spacingNeighbors + 1))
			sum += (points.col(j) - p).norm() / spacingNeighbors;
		result[i] = std::max(distance, sum / evenSites);
	});
	return result;
}

// Turns every component to the side most of its normals are on.
void orient(
	const TriangleMesh&       mesh,
	const ScaffoldSites&      sites,
	const std::vector<Index>& component,
	std::vector<Triangle>&    triangles)
{
	std::vector<double> votes(mesh.vertexCount(), 0.0);
	for (Index t = 0; t < mesh.triangleCount(); ++t) {
		const Vector3d area = mesh.areaVector(t);
		for (const Index v : triangles[t])
			votes[component[v]] += area.dot(sites.normals.col(v));
	}
	for (Triangle& t : triangles) {
		if (votes[component[t[0]]] < 0.0)
			std::swap(t[1], t[2]);
		std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
	}
}

// Fills a rim with triangles about its centre.
void fillRim(const std::vector<Index>& rim, ScaffoldSites& sites, std::vector<Triangle>& triangles)
{
	const auto n = static_cast<Index>(rim.size());
	if (n == 3) {
		triangles.push_back({rim[2], rim[1], rim[0]});
		return;
	}
	Vector3d center = Vector3d::Zero();
	for (const Index v : rim)
		center += sites.points.col(v) / n;
	const Index hub = static_cast<Index>(sites.points.cols());
	sites.points.conservativeResize(3, hub + 1);
	sites.normals.conservativeResize(3, hub + 1);
	sites.points.col(hub) = center;
	sites.normals.col(hub).setZero();
	sites.source.push_back(-1);
	for (Index k = 0; k < n; ++k)
		triangles.push_back({hub, rim[(k + 1) % n], rim[k]});
}

double lengthOf(const std::vector<Index>& rim, const Eigen::Matrix3Xd& points)
{
	double length = 0.0;
	for (std::size_t k = 0; k < rim.size(); ++k)
		length += (points.col(rim[k]) - points.col(rim[(k + 1) % rim.size()])).norm();
	return length;
}

// Only vertices that a triangle uses.
TriangleMesh
compact(const ScaffoldSites& sites, std::vector<Triangle> triangles, std::vector<Index>& nameOf)
{
	nameOf.assign(sites.points.cols(), -1);
	for (const Triangle& t : triangles)
		for (const Index v : t)
			nameOf[v] = 0;
	Index used = 0;
	for (Index& name : nameOf)
		name = name < 0 ? -1 : used++;
	Eigen::Matrix3Xd points(3, used);
	for (std::size_t v = 0; v < nameOf.size(); ++v)
		if (nameOf[v] >= 0)
			points.col(nameOf[v]) = sites.points.col(v);
	for (Triangle& t : triangles)
		for (Index& v : t)
			v = nameOf[v];
	return {std::move(points), std::move(triangles)};
}

// The part of the front that is a manifold; vertices in which several fans meet are copied, in `sites` too.
// Adds what had to be left out or copied to the defects.
std::vector<Triangle>
separated(const std::vector<Triangle>& front, ScaffoldSites& sites, Scaffold& scaffold)
{
	const Index           originals = static_cast<Index>(sites.points.cols());
	std::vector<Index>    copies;
	std::vector<Triangle> triangles = manifoldPart(front, originals, copies);
	scaffold.defects  = static_cast<Index>(front.size() - triangles.size() + copies.size());
	const Index total = originals + static_cast<Index>(copies.size());
	sites.points.conservativeResize(3, total);
	sites.normals.conservativeResize(3, total);
	sites.source.resize(total);
	for (std::size_t k = 0; k < copies.size(); ++k) {
		const Index to        = originals + static_cast<Index>(k);
		sites.points.col(to)  = sites.points.col(copies[k]);
		sites.normals.col(to) = sites.normals.col(copies[k]);
		sites.source[to]      = sites.source[copies[k]];
	}
	return triangles;
}

// Drops components that are too small for a mesh, unless there is no larger one.
void dropSmallComponents(
	const TriangleMesh&       mesh,
	const std::vector<Index>& component,
	const ScaffoldOptions&    options,
	Scaffold&                 scaffold,
	std::vector<Triangle>&    triangles)
{
	std::vector<double> area(mesh.vertexCount(), 0.0);
	for (Index t = 0; t < mesh.triangleCount(); ++t)
		area[component[triangles[t][0]]] += mesh.areaVector(t).norm();
	// A small component whose rim is filled as a hole would become a closed surface of two sheets. The least
	// area is so large that its rim is longer than a small hole.
	const double least = std::max(
		options.leastArea * scaffold.cell * scaffold.cell,
		options.smallHole * scaffold.spacing * scaffold.spacing);
	const double      largest = area.empty() ? 0.0 : *std::max_element(area.begin(), area.end());
	std::vector<char> dropped(area.size(), 0);
	for (std::size_t v = 0; v < area.size(); ++v) {
		if (!(area[v] > 0.0))
			continue;
		dropped[v] = area[v] < std::min(least, largest);
		++(dropped[v] ? scaffold.droppedComponents : scaffold.components);
	}
	triangles.erase(
		std::remove_if(
			triangles.begin(),
			triangles.end(),
			[&](const Triangle& t) { return dropped[component[t[0]]] != 0; }),
		triangles.end());
}

void fillRims(
	const ScaffoldOptions& options,
	ScaffoldSites&         sites,
	Scaffold&              scaffold,
	std::vector<Triangle>& triangles)
{
	const TriangleMesh open(sites.points, triangles);
	for (const std::vector<Index>& rim : open.rims()) {
		const double length = lengthOf(rim, sites.points);
		const bool   hole   = length <= options.smallHole * scaffold.spacing;
		if (!hole && length > options.closedRim * scaffold.cell)
			continue;
		scaffold.filledHoles += hole;
		fillRim(rim, sites, triangles);
	}
	scaffold.defects += scaffold.filledHoles;
}

// The mesh with the sources of its vertices and its creases.
void finish(const ScaffoldSites& sites, std::vector<Triangle> triangles, Scaffold& scaffold)
{
	std::vector<Index> nameOf;
	scaffold.mesh = compact(sites, std::move(triangles), nameOf);
	scaffold.source.resize(scaffold.mesh.vertexCount());
	for (std::size_t v = 0; v < nameOf.size(); ++v)
		if (nameOf[v] >= 0)
			scaffold.source[nameOf[v]] = sites.source[v];
	scaffold.creaseEdge.assign(scaffold.mesh.edgeCount(), 0);
	for (const auto& [a, b] : sites.creaseEdges) {
		const bool  used = nameOf[a] >= 0 && nameOf[b] >= 0;
		const Index edge = used ? scaffold.mesh.edgeBetween(nameOf[a], nameOf[b]) : -1;
		if (edge < 0)
			++scaffold.lostCreaseEdges;
		else
			scaffold.creaseEdge[edge] = 1;
	}
}

Scaffold
triangulatedSites(ScaffoldSites sites, double distance, double cell, const ScaffoldOptions& options)
{
	Scaffold scaffold;
	scaffold.spacing = distance;
	scaffold.cell    = cell;

	const std::vector<Triangle> front = advancingFront(
		sites.points, sites.normals, options.longestEdge * localDistances(sites.points, distance));
	std::vector<Triangle>    triangles = separated(front, sites, scaffold);
	const TriangleMesh       raw(sites.points, triangles);
	const std::vector<Index> component = raw.components();
	orient(raw, sites, component, triangles);
	dropSmallComponents(raw, component, options, scaffold, triangles);
	fillRims(options, sites, scaffold, triangles);
	recoverCreaseEdges(sites.points, sites.creaseEdges, triangles);
	finish(sites, std::move(triangles), scaffold);
	return scaffold;
}

// Rims and handles. True ones are in every attempt, false ones are not.
Index topologicalFeatures(const Scaffold& scaffold)
{
	const auto  rims = static_cast<Index>(scaffold.mesh.rims().size());
	const Index handles =
		(2 * scaffold.components - scaffold.mesh.eulerCharacteristic() - rims) / 2;
	return rims + handles;
}

// Per vertex: a coarse attempt has fewer of everything.
double flawsOf(const Scaffold& scaffold)
{
	const Index flaws =
		scaffold.defects + scaffold.lostCreaseEdges + rimFlaws * topologicalFeatures(scaffold);
	return double(flaws) / std::max<Index>(1, scaffold.mesh.vertexCount());
}

std::vector<FeatureLine> longerThan(double least, const std::vector<FeatureLine>& creases)
{
	std::vector<FeatureLine> kept;
	for (const FeatureLine& crease : creases) {
		double length = 0.0;
		for (Eigen::Index k = 1; k < crease.points.cols(); ++k)
			length += (crease.points.col(k) - crease.points.col(k - 1)).norm();
		if (length >= least)
			kept.push_back(crease);
	}
	return kept;
}

// What all attempts at one scaffold share.
struct Attempts {
	const PointSample&        sample;
	const std::vector<Index>& order;
	double                    cell;
	const ScaffoldOptions&    options;

	Scaffold at(double distance, const std::vector<FeatureLine>& creases) const
	{
		const double clearance =
			std::max(options.creaseClearance * distance, noiseClearance * options.noise);
		return triangulatedSites(
			chooseSites(sample, order, creases, distance, clearance), distance, cell, options);
	}

	// From `distance` on coarser and coarser, until there are few defects: the one with the fewest flaws.
	Scaffold coarserFrom(
		double distance, const std::vector<FeatureLine>& creases, const Progress& progress) const
	{
		Scaffold best;
		double   fewest = 0.0;
		for (int k = 0; k < attempts; ++k, distance *= coarser) {
			progress.report(double(k) / attempts);
			Scaffold     next  = at(distance, creases);
			const double flaws = flawsOf(next);
			if (k == 0 || (next.mesh.triangleCount() > 0 && flaws < fewest)) {
				best   = std::move(next);
				fewest = flaws;
			}
			if (best.defects + best.lostCreaseEdges <= toleratedDefects * best.mesh.vertexCount())
				break;
		}
		return best;
	}
};

} // namespace

bool Scaffold::hasCreases() const
{
	return std::count(creaseEdge.begin(), creaseEdge.end(), char(1)) > 0;
}

Scaffold buildScaffold(
	const CloudIndex&               index,
	const std::vector<FeatureLine>& creases,
	const ScaffoldOptions&          options,
	const Progress&                 progress)
{
	if (index.size() < 4)
		return {};
	const std::vector<Index>& order = index.shuffled();
	const PointSample         sample(columnsOf(index.cloud(), order), index.shuffledSearch());
	const double              spacing = spacingOf(sample);
	const double              cell =
        options.targetVertices > 0.0
						 ? spacing / poissonSpacing * std::sqrt(index.size() / options.targetVertices)
						 : 0.0;

	const double   distance = std::max(options.thinning * spacing, cell / trianglesPerFace);
	const Attempts tries{sample, order, cell, options};
	Scaffold best = tries.coarserFrom(distance, creases, progress.sub(0.0, 0.4, "Triangulating"));
	// Whether the front crosses a crease is a matter of chance: other points, another try.
	for (int k = 1; k <= otherTries && best.lostCreaseEdges > 0; ++k) {
		progress.report(0.4 + 0.2 * k / otherTries);
		Scaffold next = tries.at((1.0 + k * otherDistance) * distance, creases);
		if (flawsOf(next) < flawsOf(best))
			best = std::move(next);
	}
	// False creases, as between wrinkles, can spoil the front: those that are shorter, then all, are left out.
	std::vector<FeatureLine> kept = creases;
	double                   done = 0.6;
	for (const double least : {shortCrease * distance, double(INFINITY)}) {
		if (kept.empty() || topologicalFeatures(best) == 0)
			break;
		const std::size_t before = kept.size();
		kept                     = longerThan(least, kept);
		const Progress part      = progress.sub(done, done + 0.2, "Triangulating");
		done += 0.2;
		if (kept.size() == before)
			continue;
		Scaffold next = tries.coarserFrom(distance, kept, part);
		if (topologicalFeatures(next) < topologicalFeatures(best))
			best = std::move(next);
	}
	return best;
}

} // namespace curvature_lines
