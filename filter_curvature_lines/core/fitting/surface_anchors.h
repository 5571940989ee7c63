// Anchors: local surface estimates at a thinned set of points, the first stage of the adaptive curvature.
// Internal to adaptive_curvature.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "anchor_fits.h"
#include "local_surface.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "point_subsets.h"

namespace curvature_lines {

// How to estimate the shape operator: a height polynomial at radius height.radius, then, unless
// normalRadius is 0, a cubic polynomial of the normals of anchors within normalRadius.
struct CurvatureScale {
	HeightScale height;
	double      normalRadius  = 0.0; // length
	int         family        = 0;   // scales of one family differ in size only
	int         level         = 0;
	double      usualResidual = 0.0; // of the heights, where the surface is smooth (length)

	double radius() const { return std::max(height.radius, normalRadius); }
};

// A place where two faces meet, seen from a point on one of them.
struct EdgeNearby {
	double angle    = 0.0; // between the faces' normals, 0: no edge
	double distance = 0.0; // of the point from the edge, length
};

// The anchors of one scale. Where a height polynomial does not fit although it does elsewhere, a sharp edge
// runs through its ball: the anchor then takes the surface of the face it lies nearest to, continued from
// anchors whose balls hold one face only, and normals are never fitted across.
class SurfaceAnchors {
public:
	SurfaceAnchors(
		const AnchorFits&     fits,
		const PointSubsets&   subsets,
		const CurvatureScale& scale,
		double                quadricResidual, // of the heights off edges, a length
		AnchorDetail          detail = AnchorDetail::Full);

	Index size() const { return static_cast<Index>(m_elements.size()); }
	const std::vector<SurfaceElement>& elements() const { return m_elements; }
	const Eigen::Matrix3Xd& origins() const { return m_origins; }
	bool hasEdges() const { return m_hasEdges; }
	// Normals further apart than this (length of the difference) belong to different faces.
	double jump() const { return m_jump; }
	// Whether an edge may run through the ball at `position`.
	bool nearEdge(const Eigen::Vector3d& position) const;

	// The face nearest to `position`; invalid where none is known. Tells the edge nearby if asked.
	SurfaceElement faceAt(const Eigen::Vector3d& position, EdgeNearby* edge = nullptr) const;

	// `element`, fitted at `position`, or the face there if the fit was spoilt by an edge.
	SurfaceElement onFace(const SurfaceElement& element, const Eigen::Vector3d& position) const;

	// Second stage: `start` with the shape operator and the normal of the normal field around.
	SurfaceElement normalField(const SurfaceElement& start) const;

private:
	// A face of the surface, continued to a point from the anchors around it.
	struct Face {
		Eigen::Vector3d normal  = Eigen::Vector3d::Zero();
		Eigen::Vector3d center  = Eigen::Vector3d::Zero(); // of the anchors
		Eigen::Matrix3d shape   = Eigen::Matrix3d::Zero();
		double          height  = 0.0; // of the point above the face
		double          weight  = 0.0;
		int             members = 0;
	};
	enum class Meeting { Convex, Concave, Mixed };

	std::vector<Face> facesAround(const Eigen::Vector3d& position) const;
	static Meeting meetingOf(const std::vector<Face>& faces);
	static double nearness(Meeting meeting, double height); // the smallest is the nearest
	SurfaceElement
	nearestFace(const Eigen::Vector3d& position, std::vector<Face> faces, EdgeNearby* edge) const;
	// RMS distance of the points around from the nearest of the faces.
	double misfitOfFaces(
		const PointSample&       sample,
		const Eigen::Vector3d&   position,
		const std::vector<Face>& faces) const;

	double typicalLink() const;
	void flagMisfits();
	void link();
	std::vector<SurfaceElement> continuedTo(
		const std::vector<Index>& misfits, const PointSubsets& subsets, Index stride, double gain);
	std::vector<Index> agreeing(const std::vector<Index>& clear) const;
	void continueFaces(const PointSubsets& subsets, AnchorDetail detail);
	void cutLinks();
	double offsetOf(const std::vector<Index>& near, const Eigen::Vector3d& center) const;
	double jumpBetween(Index a, Index b) const;
	// Those of `near` that are reached from the best match of `start` without crossing a cut.
	void keepConnected(const SurfaceElement& start, std::vector<Index>& near) const;

	CurvatureScale              m_scale;
	std::vector<SurfaceElement> m_elements;
	std::vector<Index>          m_places; // as in the fits
	Eigen::Matrix3Xd            m_origins;
	// positions and normals of the elements, together for the fits
	PointCloud                      m_surface;
	std::unique_ptr<NeighborSearch> m_search;       // over m_surface
	std::unique_ptr<NeighborSearch> m_originSearch; // over m_origins
	bool                            m_hasEdges    = false;
	bool                            m_hasOutliers = false; // among the points anchors were tried at
	double                          m_quadricResidual = 0.0;
	double                          m_jump            = 0.35;
	double                          m_linkLength      = 0.0;
	std::vector<char>               m_misfit; // an edge runs through the ball
	std::vector<char>               m_atCut;  // a link of it was cut
	NeighborLists                   m_links;
	// of fitting anchors near misfits: their refined surface
	std::vector<SurfaceElement> m_faces;
};

} // namespace curvature_lines
