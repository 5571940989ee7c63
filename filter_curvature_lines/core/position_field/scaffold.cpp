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
#include "disjoint_sets.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "point_subsets.h"
#include "progress.h"
#include "scaffold_sites.h"
#include "sizing_field.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// Least distances of vertices in an edge of the quad mesh. With mean edges of the scaffold of .4, .66, 1.2,
// 1.7 faces the edges of a torus were .08, .15, .40, .80 degrees from the principal directions in a
// prototype.
constexpr double trianglesPerFace = 3.0;
// And in the longest edge that the shape allows, six of which go around a limb: then some nine vertices do. By experiment on rods
// and a tongue with three points around.
constexpr double limbDistance = 0.45;
// Triangles behind the neck through which the front twists, at least; edges of the neck, at most: few, or few for what is
// behind (times the root of the number of triangles; 2.3 around a disk, such as a patch of normals that point inwards).
constexpr Index  fewestTwisted = 6, widestNeck = 4;
constexpr double neckOfRoot = 0.7;
// Triangles of a part whose being turned over is a flaw of the whole.
constexpr Index fewestInPart = 100;
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
constexpr Index  unusedFlaws      = 3;
constexpr double toleratedDefects = 0.002;

// Length of the rims that are filled in any case over ScaffoldOptions::holeSize: what the front leaves of a hole. By
// experiment.
constexpr double smallGap = 1.5;
// Edges of the front must reach the vertices around, in their distances, however small the holes.
constexpr double shortestEdge = 2.0;
// A sheet has at most the area of a disk with its rim's length around; what has so many times as much is a body with a hole.
constexpr double bodyOverDisk = 1.5;
// Spacings by which edges of the front across a hole make it narrower.
constexpr double narrower = 2.0;

// Of the vertices, at every point.
Eigen::VectorXd distancesFor(const SizingField& sizing, const ScaffoldOptions& options)
{
	const Eigen::VectorXd size = sizing.size();
	Eigen::VectorXd       distance(size.size());
	for (Eigen::Index i = 0; i < size.size(); ++i) {
		const double spacing = sizing.spacing[i];
		const double least   = std::clamp(
            limbDistance * sizing.feature[i],
            options.limbThinning * spacing,
            options.thinning * spacing);
		distance[i] = std::max(least, size[i] / trianglesPerFace);
	}
	return distance;
}

// Turns every component to the side most of its normals are on.
void orient(const ScaffoldSites& sites, std::vector<Triangle>& triangles)
{
	const TriangleMesh       mesh(sites.points, triangles);
	const std::vector<Index> component = mesh.components();
	std::vector<double>      votes(mesh.vertexCount(), 0.0);
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
	const Index hub = sites.size();
	sites.appendCopies({rim[0]});
	sites.points.col(hub) = center;
	sites.normals.col(hub).setZero();
	sites.source[hub] = -1;
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
	std::vector<Index>    copies;
	std::vector<Triangle> triangles = manifoldPart(front, sites.size(), copies);
	scaffold.defects += static_cast<Index>(front.size() - triangles.size() + copies.size());
	sites.appendCopies(copies);
	return triangles;
}

// Of every triangle: it looks against the normals of its corners.
std::vector<char> turned(const ScaffoldSites& sites, const std::vector<Triangle>& triangles)
{
	const TriangleMesh mesh(sites.points, triangles);
	std::vector<char>  against(mesh.triangleCount(), 0);
	for (Index t = 0; t < mesh.triangleCount(); ++t) {
		Vector3d sum = Vector3d::Zero();
		for (const Index v : triangles[t])
			sum += sites.normals.col(v);
		against[t] = mesh.areaVector(t).dot(sum) < 0.0;
	}
	return against;
}

// Triangles in parts that are turned over, without the few at the tips of limbs that every front has.
Index turnedPart(const ScaffoldSites& sites, const std::vector<Triangle>& triangles)
{
	const TriangleMesh      mesh(sites.points, triangles);
	const std::vector<char> against = turned(sites, triangles);
	DisjointSets            sets(mesh.triangleCount());
	for (const TriangleMesh::Edge& edge : mesh.edges())
		if (!edge.isRim() && against[edge.left] && against[edge.right])
			sets.join(edge.left, edge.right);
	std::vector<Index> size(mesh.triangleCount(), 0);
	for (Index t = 0; t < mesh.triangleCount(); ++t)
		++size[sets.find(t)];
	Index count = 0;
	for (Index t = 0; t < mesh.triangleCount(); ++t)
		count += against[t] && size[sets.find(t)] >= fewestInPart;
	return count;
}

// Where limbs are so thin that a single triangle joins two parts the front may twist: a part of the surface behind such a
// neck, against whose normals its triangles run, is turned over; the neck tears.
void untwist(ScaffoldSites& sites, Scaffold& scaffold, std::vector<Triangle>& triangles)
{
	const TriangleMesh      mesh(sites.points, triangles);
	const std::vector<char> against = turned(sites, triangles);
	DisjointSets            sets(mesh.triangleCount());
	std::vector<Index>      neck(mesh.triangleCount(), 0), size(mesh.triangleCount(), 0);
	for (const TriangleMesh::Edge& edge : mesh.edges())
		if (!edge.isRim() && against[edge.left] && against[edge.right])
			sets.join(edge.left, edge.right);
	for (const TriangleMesh::Edge& edge : mesh.edges())
		if (!edge.isRim() && against[edge.left] != against[edge.right])
			++neck[sets.find(against[edge.left] ? edge.left : edge.right)];
	for (Index t = 0; t < mesh.triangleCount(); ++t)
		++size[sets.find(t)];
	bool any = false;
	for (Index t = 0; t < mesh.triangleCount(); ++t) {
		const Index  set    = sets.find(t);
		const double widest = std::max<double>(widestNeck, neckOfRoot * std::sqrt(size[set]));
		if (!against[t] || neck[set] > widest || size[set] < fewestTwisted)
			continue;
		std::swap(triangles[t][1], triangles[t][2]);
		any = true;
	}
	if (any)
		triangles = separated(triangles, sites, scaffold);
}

// Drops components that are too small for a mesh, unless there is no larger one.
void dropSmallComponents(
	const TriangleMesh&       mesh,
	const std::vector<Index>& component,
	const Eigen::VectorXd&    size,
	const ScaffoldOptions&    options,
	const ScaffoldSites&      sites,
	Scaffold&                 scaffold,
	std::vector<Triangle>&    triangles)
{
	// In least areas. A small component whose rim is filled as a hole would become a closed surface of two sheets. The
	// least area is so large that its rim is longer than a small hole.
	std::vector<double> area(mesh.vertexCount(), 0.0);
	for (Index t = 0; t < mesh.triangleCount(); ++t) {
		const double third = mesh.areaVector(t).norm() / 3.0;
		for (const Index v : triangles[t]) {
			const double faces = size.size() > 0 ? std::pow(size[sites.place[v]], 2) : 0.0;
			area[component[v]] += third / std::max(
											  options.leastArea * faces,
											  options.smallHole * std::pow(sites.distance[v], 2));
		}
	}
	const double      largest = area.empty() ? 0.0 : *std::max_element(area.begin(), area.end());
	std::vector<char> dropped(area.size(), 0);
	for (std::size_t v = 0; v < area.size(); ++v) {
		if (!(area[v] > 0.0))
			continue;
		dropped[v] = area[v] < std::min(1.0, largest);
		++(dropped[v] ? scaffold.droppedComponents : scaffold.components);
	}
	triangles.erase(
		std::remove_if(
			triangles.begin(),
			triangles.end(),
			[&](const Triangle& t) { return dropped[component[t[0]]] != 0; }),
		triangles.end());
}

// Of the component every vertex is of.
std::vector<double> componentAreas(const TriangleMesh& mesh)
{
	const std::vector<Index> component = mesh.components();
	const Eigen::VectorXd    area      = mesh.vertexAreas();
	std::vector<double>      sum(component.size(), 0.0), result(component.size());
	for (std::size_t v = 0; v < component.size(); ++v)
		sum[component[v]] += area[v];
	for (std::size_t v = 0; v < component.size(); ++v)
		result[v] = sum[component[v]];
	return result;
}

void fillRims(
	const Eigen::VectorXd& spacing,
	const Eigen::VectorXd& size,
	const ScaffoldOptions& options,
	ScaffoldSites&         sites,
	Scaffold&              scaffold,
	std::vector<Triangle>& triangles)
{
	const TriangleMesh open(sites.points, triangles);
	const bool         wide    = options.holeSize > usualHoleSize;
	const double       smaller = std::min(1.0, options.holeSize / usualHoleSize);
	const double longestSmall  = smallGap * smaller * usualHoleSize; // in spacings of the cloud
	const std::vector<double> areas = wide ? componentAreas(open) : std::vector<double>();
	for (const std::vector<Index>& rim : open.rims()) {
		const double length = lengthOf(rim, sites.points);
		double       small = 0.0, edge = 0.0, gap = 0.0; // means along the rim
		for (const Index v : rim) {
			small += std::max(
						 smaller * options.smallHole * sites.around[v],
						 longestSmall * spacing[sites.place[v]]) /
			         double(rim.size());
			gap += spacing[sites.place[v]] / double(rim.size());
			edge += size.size() > 0 ? size[sites.place[v]] / double(rim.size()) : 0.0;
		}
		// A single triangle is no hole of the cloud: around those, however small, more vertices lie. The front leaves
		// one out where it would have to turn by more than 149 degrees (COS_ALPHA_SLIVER of CGAL's reconstruction).
		const bool hole  = length <= small || rim.size() == 3;
		const bool asked = wide && length <= EIGEN_PI * (options.holeSize - narrower) * gap &&
		                   areas[rim[0]] >= bodyOverDisk * length * length / (4.0 * EIGEN_PI);
		if (!hole && !asked && length > options.closedRim * edge)
			continue;
		scaffold.filledHoles += hole || asked;
		fillRim(rim, sites, triangles);
	}
	scaffold.defects += scaffold.filledHoles;
}

// The mesh with the sources of its vertices, their sizes, and its creases.
void finish(
	const ScaffoldSites&      sites,
	const std::vector<Index>& order,
	const Eigen::VectorXd&    size,
	std::vector<Triangle>     triangles,
	Scaffold&                 scaffold)
{
	std::vector<Index> nameOf;
	scaffold.mesh       = compact(sites, std::move(triangles), nameOf);
	const Index count   = scaffold.mesh.vertexCount();
	const bool  isSized = size.size() > 0;
	scaffold.source.resize(count);
	scaffold.place.resize(count);
	scaffold.spacing.resize(count);
	scaffold.size.resize(isSized ? count : 0);
	for (std::size_t v = 0; v < nameOf.size(); ++v) {
		const Index name = nameOf[v];
		if (name < 0)
			continue;
		scaffold.source[name]  = sites.source[v];
		scaffold.place[name]   = order[sites.place[v]];
		scaffold.spacing[name] = sites.distance[v];
		if (isSized)
			scaffold.size[name] = size[sites.place[v]];
	}
	scaffold.unusedSites = sites.size() - count;
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

// `order`: points of the cloud at the places of the sample; `spacing`: of the cloud there, `size`: of the quad mesh; empty: any.
Scaffold triangulatedSites(
	ScaffoldSites             sites,
	const std::vector<Index>& order,
	const Eigen::VectorXd&    spacing,
	const Eigen::VectorXd&    size,
	const ScaffoldOptions&    options)
{
	Scaffold     scaffold;
	const double bridged = std::min(options.holeSize, usualHoleSize);
	const double edge    = std::max(shortestEdge, options.longestEdge * bridged / usualHoleSize);
	const Eigen::VectorXd longest = (edge * sites.around).cwiseMax(bridged * spacing(sites.place));
	const std::vector<Triangle> front     = advancingFront(sites.points, sites.normals, longest);
	std::vector<Triangle>       triangles = separated(front, sites, scaffold);
	orient(sites, triangles);
	untwist(sites, scaffold, triangles);
	const TriangleMesh       raw(sites.points, triangles);
	const std::vector<Index> component = raw.components();
	dropSmallComponents(raw, component, size, options, sites, scaffold, triangles);
	fillRims(spacing, size, options, sites, scaffold, triangles);
	recoverCreaseEdges(sites.points, sites.creaseEdges, triangles);
	scaffold.turnedTriangles = turnedPart(sites, triangles);
	finish(sites, order, size, std::move(triangles), scaffold);
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
	const Index flaws = scaffold.defects + scaffold.lostCreaseEdges + scaffold.turnedTriangles +
	                    unusedFlaws * scaffold.unusedSites +
	                    rimFlaws * topologicalFeatures(scaffold);
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
	Eigen::VectorXd spacing, distance, size; // of every point of the sample, the first attempt's
	const ScaffoldOptions& options;

	// With vertices so many times as far apart.
	Scaffold at(double factor, const std::vector<FeatureLine>& creases) const
	{
		const Eigen::VectorXd wanted = factor * distance;
		const Eigen::VectorXd clearance =
			(options.creaseClearance * wanted).cwiseMax(noiseClearance * options.noise);
		return triangulatedSites(
			chooseSites(sample, order, creases, wanted, clearance), order, spacing, size, options);
	}

	// Coarser and coarser, until there are few defects: the one with the fewest flaws.
	Scaffold coarserFrom(
		double factor, const std::vector<FeatureLine>& creases, const Progress& progress) const
	{
		Scaffold best;
		double   fewest = 0.0;
		for (int k = 0; k < attempts; ++k, factor *= coarser) {
			progress.report(double(k) / attempts);
			Scaffold     next  = at(factor, creases);
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
	const SizingField&              sizing,
	const ScaffoldOptions&          options,
	const Progress&                 progress)
{
	if (index.size() < 4)
		return {};
	const std::vector<Index>& order = index.shuffled();
	const PointSample         sample(columnsOf(index.cloud(), order), index.shuffledSearch());
	Attempts                  tries{sample, order, {}, {}, {}, options};
	if (sizing.feature.size() > 0) {
		tries.spacing  = sizing.spacing(order);
		tries.size     = sizing.size()(order);
		tries.distance = distancesFor(sizing, options)(order);
	}
	else {
		tries.spacing.setConstant(index.size(), index.minimum().medianSpacing);
		tries.distance = options.thinning * tries.spacing;
	}
	Scaffold best = tries.coarserFrom(1.0, creases, progress.sub(0.0, 0.4, "Triangulating"));
	// Whether the front crosses a crease is a matter of chance: other points, another try.
	for (int k = 1; k <= otherTries && best.lostCreaseEdges > 0; ++k) {
		progress.report(0.4 + 0.2 * k / otherTries);
		Scaffold next = tries.at(1.0 + k * otherDistance, creases);
		if (flawsOf(next) < flawsOf(best))
			best = std::move(next);
	}
	// So are false holes and handles on thin limbs. True rims are in every attempt: a first one that has as many is the last.
	for (int k = 1; k <= otherTries && topologicalFeatures(best) > 0; ++k) {
		Scaffold   next   = tries.at(1.0 - k * otherDistance, creases);
		const bool better = flawsOf(next) < flawsOf(best);
		if (better)
			best = std::move(next);
		else if (k > 1 || topologicalFeatures(next) >= topologicalFeatures(best))
			break;
	}
	// False creases, as between wrinkles, can spoil the front: those that are shorter, then all, are left out.
	std::vector<FeatureLine> kept = creases;
	double                   done = 0.6;
	for (const double least : {shortCrease * tries.distance.mean(), double(INFINITY)}) {
		if (kept.empty() || topologicalFeatures(best) == 0)
			break;
		const std::size_t before = kept.size();
		kept                     = longerThan(least, kept);
		const Progress part      = progress.sub(done, done + 0.2, "Triangulating");
		done += 0.2;
		if (kept.size() == before)
			continue;
		Scaffold next = tries.coarserFrom(1.0, kept, part);
		if (topologicalFeatures(next) < topologicalFeatures(best) &&
		    next.turnedTriangles <= best.turnedTriangles)
			best = std::move(next);
	}
	return best;
}

} // namespace curvature_lines
