// The surfaces by name, and the ground truth of arbitrary points.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_families.h"

#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "analytic_surfaces.h"

namespace curvature_lines::samples {
namespace {

using SurfacePointer = std::unique_ptr<const AnalyticSurface>;

const std::map<std::string, SurfacePointer>& registry()
{
	static const auto surfaces = [] {
		std::map<std::string, SurfacePointer> s;
		s["torus"]           = makeTorus();
		s["sphere"]          = makeCapsule(1.0, 0.0);
		s["cylinder"]        = makeCylinder();
		s["helicoid"]        = makeHelicoid();
		s["cube"]            = makeCube();
		s["ellipsoid"]       = makeEllipsoid();
		s["capsule"]         = makeCapsule(0.5, 1.0);
		s["bent_sheet"]      = makeBentSheet();
		s["plane"]           = makePlane();
		s["l_block"]         = makeLBlock();
		s["capped_cylinder"] = makeCappedCylinder();
		s["double_torus"]    = makeDoubleTorus();
		s["half_torus"]      = makeHalfTorus();
		return s;
	}();
	return surfaces;
}

} // namespace

double AnalyticSurface::rimDistance(const Eigen::Vector3d&) const
{
	return detail::infinity;
}

double AnalyticSurface::featureDistance(const Eigen::Vector3d&) const
{
	return detail::infinity;
}

const std::vector<std::string>& surfaceNames()
{
	static const auto names = [] {
		std::vector<std::string> n;
		for (const auto& entry : registry())
			n.push_back(entry.first);
		return n;
	}();
	return names;
}

const AnalyticSurface& surface(const std::string& name)
{
	const auto found = registry().find(name);
	if (found == registry().end())
		throw std::invalid_argument("no analytic surface is called '" + name + "'");
	return *found->second;
}

GroundTruth groundTruth(const AnalyticSurface& surface, const Eigen::Matrix3Xd& points)
{
	const Eigen::Index n = points.cols();
	GroundTruth        truth;
	for (Eigen::Matrix3Xd* m : {&truth.footPoints, &truth.normals, &truth.d1, &truth.d2})
		m->resize(3, n);
	truth.k1.resize(n);
	truth.k2.resize(n);
	for (Eigen::Index i = 0; i < n; ++i) {
		truth.footPoints.col(i) = surface.project(points.col(i));
		const SurfaceFrame f    = surface.frame(truth.footPoints.col(i));
		truth.normals.col(i)    = f.normal;
		truth.d1.col(i)         = f.d1;
		truth.d2.col(i)         = f.d2;
		truth.k1[i]             = f.k1;
		truth.k2[i]             = f.k2;
	}
	return truth;
}

} // namespace curvature_lines::samples
