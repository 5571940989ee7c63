// Values of kept points handed on to raw points, in model units.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "raw_curvatures.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "curvature_field.h"
#include "neighborhoods.h"
#include "point_cloud.h"

namespace curvature_lines {

namespace {

constexpr double AgreementCosine = 0.99985; // of one degree, see RawCurvatures

Eigen::Vector3d unitNormal(const Eigen::Vector3d& normal)
{
	const double length = normal.stableNorm();
	return std::isfinite(length) && length > 0.0 ? Eigen::Vector3d(normal / length)
	                                             : Eigen::Vector3d::UnitZ();
}

// From the raw point its kept point was taken from.
bool facesAway(const Eigen::Matrix3Xd& rawNormals, const PreparedCloud& prepared, Index raw)
{
	const Index source = prepared.source[prepared.representative[raw]];
	return source != raw && rawNormals.col(raw).dot(rawNormals.col(source)) < 0.0;
}

double scalarOf(const RawCurvatures& values, CurvatureScalar scalar, Index i)
{
	const double k1 = values.k1[i], k2 = values.k2[i];
	switch (scalar) {
	case CurvatureScalar::Mean:
		return 0.5 * (k1 + k2);
	case CurvatureScalar::Gaussian:
		return k1 * k2;
	case CurvatureScalar::K1:
		return k1;
	case CurvatureScalar::K2:
		return k2;
	case CurvatureScalar::Curvedness:
		return curvedness(k1, k2);
	case CurvatureScalar::ShapeIndex:
		return shapeIndex(k1, k2);
	case CurvatureScalar::Confidence:
		return values.confidence[i];
	}
	return 0.0;
}

} // namespace

Eigen::Vector3d normalForRaw(
	const Eigen::Vector3d&  normal,
	const Eigen::Matrix3Xd& rawNormals,
	const PreparedCloud&    prepared,
	Index                   raw)
{
	return facesAway(rawNormals, prepared, raw) ? Eigen::Vector3d(-normal) : normal;
}

RawCurvatures rawCurvatures(
	const Eigen::Matrix3Xd&  rawNormals,
	const PreparedCloud&     prepared,
	const CurvatureField&    field,
	const std::vector<char>& umbilic)
{
	const auto    n = static_cast<Index>(rawNormals.cols());
	RawCurvatures values;
	for (Eigen::VectorXd* v :
	     {&values.k1,
	      &values.k2,
	      &values.error,
	      &values.radius,
	      &values.confidence,
	      &values.feature})
		v->setZero(n);
	values.d1.resize(3, n);
	values.d2.resize(3, n);
	values.status.assign(n, PointStatus::Invalid);

	for (Index i = 0; i < n; ++i) {
		Eigen::Vector3d normal = unitNormal(rawNormals.col(i));
		Eigen::Vector3d d      = Eigen::Vector3d::Zero();
		if (const Index r = prepared.representative[i]; r >= 0) {
			// A duplicate seen from the other side: its curvatures change sign and so trade places.
			const bool            flipped = facesAway(rawNormals, prepared, i);
			const Eigen::Vector3d surface =
				normalForRaw(prepared.cloud.normals.col(r), rawNormals, prepared, i);
			if (!(normal.dot(surface) > AgreementCosine))
				normal = surface;
			d                    = flipped ? field.d2.col(r) : field.d1.col(r);
			values.k1[i]         = (flipped ? -field.k2[r] : field.k1[r]) / prepared.diagonal;
			values.k2[i]         = (flipped ? -field.k1[r] : field.k2[r]) / prepared.diagonal;
			values.error[i]      = field.error[r] / prepared.diagonal;
			values.radius[i]     = field.radius[r] * prepared.diagonal;
			values.confidence[i] = field.confidence[r];
			values.feature[i]    = field.feature[r];
			values.status[i]     = field.status[r] == PointStatus::Ok && umbilic[r]
			                           ? PointStatus::Umbilic
			                           : field.status[r];
		}
		const Eigen::Vector3d d1 = tangentNear(d, normal);
		values.d1.col(i)         = d1;
		values.d2.col(i)         = normal.cross(d1);
	}
	return values;
}

Eigen::VectorXd scalarsOf(const RawCurvatures& values, CurvatureScalar scalar)
{
	Eigen::VectorXd scalars(values.k1.size());
	for (Index i = 0; i < static_cast<Index>(scalars.size()); ++i)
		scalars[i] = scalarOf(values, scalar, i);
	return scalars;
}

std::pair<double, double>
rampRange(const Eigen::VectorXd& values, const std::vector<PointStatus>& status)
{
	std::vector<double> estimates;
	for (std::size_t i = 0; i < status.size(); ++i)
		if (status[i] != PointStatus::Invalid && status[i] != PointStatus::TooFewNeighbors)
			estimates.push_back(values[i]);
	if (estimates.empty())
		return {0.0, 0.0};
	std::sort(estimates.begin(), estimates.end());
	const std::size_t last = estimates.size() - 1;
	return {estimates[last / 10], estimates[last - last / 10]};
}

} // namespace curvature_lines
