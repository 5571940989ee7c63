// The C interface that analytic_surfaces.py calls. Coordinates are N rows of x, y, z.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "analytic_surfaces.h"

#define SAMPLE_DATA_EXPORT extern "C" __attribute__((visibility("default")))

using namespace curvature_lines::samples;

namespace {

// Memory of the caller, one row per point.
struct TruthBuffers {
	double *footPoints, *normals, *d1, *d2;          // N x 3
	double *k1, *k2, *rimDistance, *featureDistance; // N
};

template<typename Matrix, typename Scalar>
void copyTo(const Matrix& from, Scalar* to)
{
	std::copy(from.data(), from.data() + from.size(), to);
}

void copyTruth(const AnalyticSurface& shape, const GroundTruth& truth, const TruthBuffers& to)
{
	copyTo(truth.footPoints, to.footPoints);
	copyTo(truth.normals, to.normals);
	copyTo(truth.d1, to.d1);
	copyTo(truth.d2, to.d2);
	copyTo(truth.k1, to.k1);
	copyTo(truth.k2, to.k2);
	for (Eigen::Index i = 0; i < truth.k1.size(); ++i) {
		to.rimDistance[i]     = shape.rimDistance(truth.footPoints.col(i));
		to.featureDistance[i] = shape.featureDistance(truth.footPoints.col(i));
	}
}

const AnalyticSurface* find(const char* name)
{
	const auto& names = surfaceNames();
	return std::find(names.begin(), names.end(), name) == names.end() ? nullptr : &surface(name);
}

} // namespace

// The name at a position of the list, null beyond its end.
SAMPLE_DATA_EXPORT const char* samples_surface_name(int position)
{
	const auto& names  = surfaceNames();
	const bool  inside = position >= 0 && position < static_cast<int>(names.size());
	return inside ? names[position].c_str() : nullptr;
}

// corners: lower and upper corner of the bounding box, 6 numbers. False for an unknown name.
SAMPLE_DATA_EXPORT bool samples_surface_properties(
	const char* name, double* corners, bool* closed, int* eulerCharacteristic)
{
	const AnalyticSurface* shape = find(name);
	if (!shape)
		return false;
	copyTo(shape->boundingBox().min(), corners);
	copyTo(shape->boundingBox().max(), corners + 3);
	*closed              = shape->closed();
	*eulerCharacteristic = shape->eulerCharacteristic();
	return true;
}

SAMPLE_DATA_EXPORT bool
samples_project(const char* name, int count, const double* points, const TruthBuffers* truth)
{
	const AnalyticSurface* shape = find(name);
	if (!shape)
		return false;
	copyTruth(
		*shape, groundTruth(*shape, Eigen::Map<const Eigen::Matrix3Xd>(points, 3, count)), *truth);
	return true;
}

// Null for a request that makes no sense. To be given back to samples_release().
SAMPLE_DATA_EXPORT SampleCloud* samples_generate(
	const char*   name,
	int           points,
	double        noise,
	double        farOutliers,
	double        nearOutliers,
	std::uint64_t seed,
	bool          regular)
{
	try {
		return new SampleCloud(
			generate({name, points, noise, farOutliers, nearOutliers, seed, regular}));
	}
	catch (const std::invalid_argument&) {
		return nullptr;
	}
}

SAMPLE_DATA_EXPORT int samples_size(const SampleCloud* cloud)
{
	return static_cast<int>(cloud->label.size());
}

SAMPLE_DATA_EXPORT void samples_copy(
	const SampleCloud*  cloud,
	const char*         name,
	double*             positions,
	int*                label,
	const TruthBuffers* truth)
{
	copyTo(cloud->positions, positions);
	copyTo(cloud->label, label);
	copyTruth(surface(name), *cloud, *truth);
}

SAMPLE_DATA_EXPORT void samples_release(SampleCloud* cloud)
{
	delete cloud;
}
