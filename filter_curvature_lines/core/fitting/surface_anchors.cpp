// The anchors of one scale, and the faces that meet at sharp edges.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_anchors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "anchor_fits.h"
#include "local_surface.h"
#include "monomials.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "point_subsets.h"
#include "progress.h"
#include "quantile.h"

namespace curvature_lines {

namespace {

// By experiment: sharp edges and the torus at 2 % noise, where false edges were most of the error
// (benchmarks/curvature.py). docs/method.md, "Sharp faces", has the steps.
constexpr Index countedAnchors = 40; // whose distances make the length of links
// Times the distance to the eighth anchor: the anchors of a face hang together.
constexpr double linkStretch = 1.15;
// A residual is too large for noise when it exceeds that of a good fit by misfitRatio, or by misfitErrors standard errors
// of a residual if that is more, and by this share of the radius. Of the anchors within half a radius a share of
// minAgreement has to agree. With fewer than minAnchors anchors nothing is flagged.
constexpr double misfitRatio  = 0.15;
constexpr double misfitErrors = 2.0;
constexpr double misfitFloor  = 0.004;
constexpr double minAgreement = 0.35;
constexpr Index  minAnchors   = 30;
// An edge explains a misfit when its points lie on the faces within faceRatio quadricResiduals, and closer than faceGain
// of the residual of one surface; and clearGain at clearAgreement anchors nearby.
constexpr double      faceRatio      = 1.25;
constexpr double      faceGain       = 0.9;
constexpr double      clearGain      = 0.6;
constexpr std::size_t clearAgreement = 3;
constexpr double      faceReach      = 3.0; // radii from which anchors are continued to a misfit
// Every fourth anchor is enough to find out whether there is an edge.
constexpr Index sketchStride = 4;
// Weight of a face over that of the largest one: a few wrong anchors have less.
constexpr double leastFace = 0.15;
// Tangent of the turn of a normal up to which a face is continued: 27 degrees.
constexpr double largestTurn  = 0.5;
constexpr double spoiltRatio  = 2.0;  // residual over the usual one, of a fit that outliers spoilt
constexpr double smallestJump = 0.35; // difference of normals that is an edge, at least: 20 degrees

std::vector<Index>& scratchList()
{
	thread_local std::vector<Index> list;
	return list;
}

} // namespace

SurfaceAnchors::SurfaceAnchors(
	const AnchorFits&     fits,
	const PointSubsets&   subsets,
	const CurvatureScale& scale,
	double                quadricResidual,
	AnchorDetail          detail) :
		m_scale(scale), m_hasOutliers(fits.hasOutliers), m_quadricResidual(quadricResidual)
{
	std::vector<Index> valid;
	for (std::size_t a = 0; a < fits.fits.size(); ++a)
		if (fits.fits[a].of(scale.height.degree).valid)
			valid.push_back(static_cast<Index>(a));
	m_elements.reserve(valid.size());
	for (auto* vectors : {&m_origins, &m_surface.positions, &m_surface.normals})
		vectors->resize(3, valid.size());
	for (std::size_t k = 0; k < valid.size(); ++k) {
		const SurfaceElement& element = fits.fits[valid[k]].of(scale.height.degree);
		m_elements.push_back(element);
		m_places.push_back(fits.places[valid[k]]);
		m_origins.col(k)           = fits.points.col(valid[k]);
		m_surface.positions.col(k) = element.position;
		m_surface.normals.col(k)   = element.normal;
	}
	m_originSearch = std::make_unique<NeighborSearch>(m_origins);
	flagMisfits();
	if (m_hasEdges) {
		link();
		continueFaces(subsets, detail);
	}
	if (m_hasEdges)
		cutLinks();
	m_search = std::make_unique<NeighborSearch>(m_surface.positions);
}

// A little more than the distance to the eighth anchor: enough for the anchors of a face to hang together.
double SurfaceAnchors::typicalLink() const
{
	std::vector<double> distances;
	std::vector<Index>  some(size());
	std::iota(some.begin(), some.end(), 0);
	const auto last = some.begin() + std::min(size(), countedAnchors);
	std::partial_sort(some.begin(), last, some.end(), [&](Index a, Index b) {
		return m_places[a] < m_places[b];
	});
	some.erase(last, some.end());
	for (const Index a : some) {
		const auto near = m_originSearch->nearest(m_origins.col(a), 9);
		distances.push_back((m_origins.col(near.back()) - m_origins.col(a)).norm());
	}
	return linkStretch * medianInPlace(distances);
}

void SurfaceAnchors::flagMisfits()
{
	const Index n = size();
	m_misfit.assign(n, 0);
	if (n < minAnchors)
		return;
	m_linkLength = typicalLink();
	std::vector<char> high(n);
	for (Index a = 0; a < n; ++a) {
		// The residual of few samples scatters; the kernel leaves about half of them.
		const double freedom =
			std::max(2.0, 0.5 * m_elements[a].samples - monomialCount(m_scale.height.degree));
		const double ratio = 1.0 + std::max(misfitRatio, misfitErrors / std::sqrt(2.0 * freedom));
		high[a]            = m_elements[a].residual >
		          ratio * m_scale.usualResidual + misfitFloor * m_scale.height.radius;
	}
	// An edge passes through the balls of many neighbours; a residual that is large by chance is alone.
	std::vector<Index> near;
	for (Index a = 0; a < n; ++a) {
		if (!high[a])
			continue;
		m_originSearch->within(
			m_origins.col(a), std::max(0.5 * m_scale.height.radius, m_linkLength), near);
		const auto agree =
			std::count_if(near.begin(), near.end(), [&](Index b) { return high[b]; });
		if (agree >= 3 && agree >= minAgreement * near.size()) {
			m_misfit[a] = 1;
			m_hasEdges  = true;
		}
		else if (
			m_elements[a].residual >
			spoiltRatio * m_scale.usualResidual + misfitFloor * m_scale.height.radius) {
			m_elements[a].valid = false;
		}
	}
}

void SurfaceAnchors::link()
{
	std::vector<std::vector<Index>> rows(size());
	parallelFor(size(), {}, [&](Index a) {
		m_originSearch->within(m_origins.col(a), m_linkLength, rows[a]);
		rows[a].erase(std::remove(rows[a].begin(), rows[a].end(), a), rows[a].end());
	});
	m_links = NeighborLists::fromRows(rows);
	std::vector<double> jumps;
	for (Index a = 0; a < size(); ++a)
		for (const Index b : m_links[a])
			if (a < b && !m_misfit[a] && !m_misfit[b])
				jumps.push_back(jumpBetween(a, b));
	if (jumps.empty())
		return;
	m_jump = std::max(smallestJump, 4.0 * medianInPlace(jumps));
}

// What is left of the difference of two normals after the bend the elements themselves predict.
double SurfaceAnchors::jumpBetween(Index a, Index b) const
{
	const SurfaceElement& first  = m_elements[a];
	const SurfaceElement& second = m_elements[b];
	const Eigen::Vector3d d      = second.position - first.position;
	const double onward   = (second.normal - (first.normal + first.shape * d).normalized()).norm();
	const double backward = (first.normal - (second.normal - second.shape * d).normalized()).norm();
	return std::max(onward, backward);
}

// The faces continued to those of `misfits` that an edge explains, from every `stride`-th anchor.
std::vector<SurfaceElement> SurfaceAnchors::continuedTo(
	const std::vector<Index>& misfits, const PointSubsets& subsets, Index stride, double gain)
{
	const double           reach   = faceReach * m_scale.height.radius;
	const Eigen::Matrix3Xd origins = m_origins(Eigen::all, misfits);
	const NeighborSearch   misfitSearch(origins);
	m_faces.assign(size(), {});
	parallelFor(size(), {}, [&](Index a) {
		// Faces are asked for where an edge may be near: up to a radius and a link from the misfits.
		if (m_misfit[a] || m_places[a] % stride != 0 ||
		    !misfitSearch.anyWithin(m_origins.col(a), reach + 1.5 * m_scale.height.radius))
			return;
		m_faces[a] = m_scale.normalRadius > 0.0 ? normalField(m_elements[a]) : m_elements[a];
	});
	std::vector<SurfaceElement> continued(size());
	parallelFor(static_cast<Index>(misfits.size()), {}, [&](Index k) {
		// A bend that is merely too tight for the radius is no edge: faces continued into it do not fit.
		const Index           a        = misfits[k];
		const Eigen::Vector3d position = m_origins.col(a);
		std::vector<Face>     faces    = facesAround(position);
		if (faces.size() < 2)
			return;
		const double misfit = misfitOfFaces(subsets[m_places[a]], position, faces);
		if (misfit < faceRatio * m_quadricResidual + misfitFloor * m_scale.height.radius &&
		    misfit < gain * m_elements[a].residual)
			continued[a] = nearestFace(position, std::move(faces), nullptr);
	});
	return continued;
}

// Those with enough others nearby: an edge is clear in many balls, a false one in a single ball.
std::vector<Index> SurfaceAnchors::agreeing(const std::vector<Index>& clear) const
{
	const Eigen::Matrix3Xd origins = m_origins(Eigen::all, clear);
	const NeighborSearch   search(origins);
	std::vector<Index>     agree, near;
	for (const Index a : clear) {
		search.within(m_origins.col(a), m_scale.height.radius, near);
		if (near.size() >= clearAgreement)
			agree.push_back(a);
	}
	return agree;
}

// Before misfits have a face of their own, they separate the faces: links to them do not count.
void SurfaceAnchors::continueFaces(const PointSubsets& subsets, AnchorDetail detail)
{
	m_search = std::make_unique<NeighborSearch>(m_surface.positions);
	m_atCut  = m_misfit;
	std::vector<Index> misfits;
	for (Index a = 0; a < size(); ++a)
		if (m_misfit[a])
			misfits.push_back(a);
	// In single balls noise makes a bend look like an edge. A true edge is clear in some balls along it.
	const std::vector<SurfaceElement> clear =
		continuedTo(misfits, subsets, sketchStride, clearGain);
	std::vector<Index> found, atEdges;
	for (const Index a : misfits)
		if (clear[a].valid)
			found.push_back(a);
	if (detail == AnchorDetail::Full)
		found = agreeing(found);
	const Eigen::Matrix3Xd origins = m_origins(Eigen::all, found);
	const NeighborSearch   foundSearch(origins);
	for (const Index a : misfits)
		if (foundSearch.anyWithin(m_origins.col(a), faceReach * m_scale.height.radius))
			atEdges.push_back(a);
	const std::vector<SurfaceElement> continued =
		continuedTo(atEdges, subsets, detail == AnchorDetail::Sketch ? sketchStride : 1, faceGain);
	// What an edge spoilt and no face explains, as in a corner, is not used.
	for (Index a = 0; a < size(); ++a) {
		const NeighborLists::Row row = m_links[a];
		if (m_misfit[a] && !continued[a].valid &&
		    std::any_of(row.begin(), row.end(), [&](Index b) { return continued[b].valid; }))
			m_elements[a].valid = false;
	}
	m_hasEdges = false;
	for (Index a = 0; a < size(); ++a)
		if (continued[a].valid) {
			m_elements[a]              = continued[a];
			m_surface.positions.col(a) = continued[a].position;
			m_surface.normals.col(a)   = continued[a].normal;
			m_hasEdges                 = true;
		}
}

void SurfaceAnchors::cutLinks()
{
	std::vector<std::vector<Index>> rows(size());
	m_atCut.assign(size(), 0);
	for (Index a = 0; a < size(); ++a)
		for (const Index b : m_links[a]) {
			if (!m_elements[b].valid)
				continue;
			if (!(m_misfit[a] || m_misfit[b]) || jumpBetween(a, b) < m_jump)
				rows[a].push_back(b);
			else
				m_atCut[a] = 1;
		}
	m_links = NeighborLists::fromRows(rows);
	std::fill(m_misfit.begin(), m_misfit.end(), 0);
}

bool SurfaceAnchors::nearEdge(const Eigen::Vector3d& position) const
{
	if (!m_hasEdges)
		return false;
	std::vector<Index>& near = scratchList();
	m_originSearch->within(position, m_scale.height.radius, near);
	return std::any_of(near.begin(), near.end(), [&](Index a) { return m_atCut[a]; });
}

// Faces end where they meet: the foot point of a point on either side of the surface lies, at a convex
// edge, on the face it is highest above, at a concave one on the face it is lowest above.
double SurfaceAnchors::nearness(Meeting meeting, double height)
{
	return meeting == Meeting::Convex    ? -height
	       : meeting == Meeting::Concave ? height
	                                     : std::abs(height);
}

std::vector<SurfaceAnchors::Face> SurfaceAnchors::facesAround(const Eigen::Vector3d& position) const
{
	const double        reach = faceReach * m_scale.height.radius;
	std::vector<Index>& near  = scratchList();
	m_originSearch->within(position, reach, near);
	std::vector<std::pair<double, Index>> ordered;
	for (const Index a : near)
		if (m_faces[a].valid)
			ordered.emplace_back((m_origins.col(a) - position).squaredNorm(), a);
	std::sort(ordered.begin(), ordered.end());
	std::vector<Face> faces;
	for (const auto& [squared, a] : ordered) {
		const SurfaceElement& e = m_faces[a];
		// The surface as a quadric around the anchor, continued to the point.
		const Eigen::Vector3d d      = position - e.position;
		const Eigen::Vector3d turn   = e.shape * d;
		const double          height = d.dot(e.normal) + 0.5 * d.dot(turn);
		// Bent too much to be known there, or another sheet.
		if (turn.norm() > largestTurn || std::abs(height) > m_scale.height.radius)
			continue;
		const Eigen::Vector3d normal = (e.normal + turn).normalized();
		const double          weight = ballKernel(squared / (reach * reach)) + 1e-6;
		auto                  face   = std::find_if(faces.begin(), faces.end(), [&](const Face& f) {
            return (f.normal.normalized() - normal).norm() < m_jump;
        });
		if (face == faces.end())
			face = faces.emplace(faces.end());
		face->normal += weight * normal;
		face->shape += weight * e.shape;
		face->center += weight * e.position;
		face->height += weight * height;
		face->weight += weight;
		++face->members;
	}
	double largest = 0.0;
	for (const Face& face : faces)
		largest = std::max(largest, face.weight);
	faces.erase(
		std::remove_if(
			faces.begin(),
			faces.end(),
			[&](const Face& f) { return f.members < 3 || f.weight < leastFace * largest; }),
		faces.end());
	for (Face& face : faces) {
		face.height /= face.weight;
		face.shape /= face.weight;
		face.center /= face.weight;
		face.normal.normalize();
	}
	return faces;
}

SurfaceAnchors::Meeting SurfaceAnchors::meetingOf(const std::vector<Face>& faces)
{
	bool convex = true, concave = true;
	for (const Face& a : faces)
		for (const Face& b : faces)
			if (&a != &b) {
				const double side = (b.center - a.center).dot(a.normal);
				convex            = convex && side < 0.0;
				concave           = concave && side > 0.0;
			}
	return convex ? Meeting::Convex : concave ? Meeting::Concave : Meeting::Mixed;
}

double SurfaceAnchors::misfitOfFaces(
	const PointSample&       sample,
	const Eigen::Vector3d&   position,
	const std::vector<Face>& faces) const
{
	thread_local std::vector<Index> near;
	const double                    radius  = m_scale.height.radius;
	const Meeting                   meeting = meetingOf(faces);
	sample.search.within(position, radius, near);
	std::vector<std::pair<double, double>> samples; // squared distance, weight
	for (const Index i : near) {
		const Eigen::Vector3d d        = sample.cloud.positions.col(i) - position;
		double                distance = 0.0, nearest = std::numeric_limits<double>::infinity();
		for (const Face& face : faces) {
			const double height = face.height + d.dot(face.normal) + 0.5 * d.dot(face.shape * d);
			const double key    = nearness(meeting, height);
			if (key < nearest) {
				nearest  = key;
				distance = height;
			}
		}
		samples.emplace_back(distance * distance, ballKernel(d.squaredNorm() / (radius * radius)));
	}
	std::sort(samples.begin(), samples.end());
	double sum = 0.0, total = 0.0;
	for (std::size_t k = 0; k < 0.95 * samples.size(); ++k) { // outliers do not decide
		sum += samples[k].first * samples[k].second;
		total += samples[k].second;
	}
	return total > 0.0 ? std::sqrt(sum / total) : std::numeric_limits<double>::infinity();
}

SurfaceElement SurfaceAnchors::faceAt(const Eigen::Vector3d& position, EdgeNearby* edge) const
{
	return nearestFace(position, facesAround(position), edge);
}

SurfaceElement SurfaceAnchors::nearestFace(
	const Eigen::Vector3d& position, std::vector<Face> faces, EdgeNearby* edge) const
{
	SurfaceElement result;
	if (faces.empty())
		return result;
	const Meeting meeting = meetingOf(faces);
	std::stable_sort(faces.begin(), faces.end(), [&](const Face& a, const Face& b) {
		return nearness(meeting, a.height) < nearness(meeting, b.height);
	});
	const Face& own = faces.front();
	result.normal   = own.normal;
	result.position = position - own.height * own.normal;
	result.shape    = own.shape;
	result.residual = m_quadricResidual;
	result.valid    = true;
	if (edge && faces.size() > 1) {
		const Face&  other  = faces[1];
		const double cosine = own.normal.dot(other.normal);
		const double sine   = std::max(own.normal.cross(other.normal).norm(), 1e-9);
		// From the foot point on the own plane to the other plane, within the own one.
		edge->angle    = std::atan2(sine, cosine);
		edge->distance = std::abs(other.height - own.height * cosine) / sine;
	}
	return result;
}

SurfaceElement
SurfaceAnchors::onFace(const SurfaceElement& element, const Eigen::Vector3d& position) const
{
	if (!m_hasEdges || !nearEdge(position))
		return element;
	const SurfaceElement face = faceAt(position);
	if (!face.valid)
		return element;
	SurfaceElement result = face;
	result.residual       = element.residual;
	result.offset         = element.offset;
	return result;
}

void SurfaceAnchors::keepConnected(const SurfaceElement& start, std::vector<Index>& near) const
{
	const double unit    = 1.0 / (m_scale.height.radius * m_scale.height.radius);
	Index        seed    = -1;
	double       closest = std::numeric_limits<double>::infinity();
	// References: an access to a thread_local costs a call.
	thread_local std::vector<char>  marks;
	thread_local std::vector<Index> queue;
	std::vector<char>&              inBall  = marks;
	std::vector<Index>&             reached = queue;
	inBall.resize(std::max<std::size_t>(inBall.size(), size()), 0);
	for (const Index a : near) {
		if (m_misfit[a] || !m_elements[a].valid)
			continue;
		inBall[a]             = 1;
		const double distance = unit * (m_surface.positions.col(a) - start.position).squaredNorm() +
		                        4.0 * (m_surface.normals.col(a) - start.normal).squaredNorm();
		if (distance < closest) {
			closest = distance;
			seed    = a;
		}
	}
	reached.clear();
	if (seed >= 0) {
		reached.push_back(seed);
		inBall[seed] = 0;
	}
	for (std::size_t k = 0; k < reached.size(); ++k)
		for (const Index b : m_links[reached[k]])
			if (inBall[b]) {
				inBall[b] = 0;
				reached.push_back(b);
			}
	for (const Index a : near)
		inBall[a] = 0;
	near.swap(reached);
}

// Distance of the weighted mean of the anchors from the centre of the ball, in radii.
double SurfaceAnchors::offsetOf(const std::vector<Index>& near, const Eigen::Vector3d& center) const
{
	Eigen::Vector3d sum   = Eigen::Vector3d::Zero();
	double          total = 0.0;
	for (const Index a : near) {
		const Eigen::Vector3d d = (m_surface.positions.col(a) - center) / m_scale.normalRadius;
		const double          w = ballKernel(d.squaredNorm());
		sum += w * d;
		total += w;
	}
	return total > 0.0 ? sum.norm() / total : 1.0;
}

SurfaceElement SurfaceAnchors::normalField(const SurfaceElement& start) const
{
	thread_local std::vector<Index> scratch;
	std::vector<Index>&             near = scratch;
	m_search->within(start.position, m_scale.normalRadius, near);
	int degree = 3;
	if (m_hasEdges) {
		if (std::any_of(near.begin(), near.end(), [&](Index a) { return m_atCut[a]; })) {
			keepConnected(start, near);
			// A cubic through one side of a ball says little about the other.
			const double off = offsetOf(near, start.position);
			degree           = off > 0.25 ? 1 : off > 0.12 ? 2 : 3;
		}
		else {
			near.erase(
				std::remove_if(
					near.begin(), near.end(), [&](Index a) { return !m_elements[a].valid; }),
				near.end());
		}
	}
	LocalSurfaceFitter& fitter = LocalSurfaceFitter::ofThisThread();
	fitter.takeBall(m_surface, near, start.position, m_scale.normalRadius);
	return fitter.fitNormals(start, degree, m_hasOutliers);
}

} // namespace curvature_lines
