// Fingerprints and the few latest estimates.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature_cache.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "curvature_estimate.h"
#include "curvature_field.h"
#include "layer_conversion.h"
#include "layer_curvature.h"
#include "point_cloud.h"
#include "progress.h"
#include "raw_curvatures.h"

namespace curvature_lines {

namespace {

// Enough for a chain of filters on two layers, each before and after its normals were corrected.
constexpr std::size_t maxEntries = 4;
// Of all entries but the latest: about half a gigabyte, as an estimate takes half a kilobyte per point (measured).
constexpr Index maxPoints = 1000000;

// 64-bit hash of a sequence of doubles: each is multiplied in by 2^64 over the golden ratio (Knuth's multiplicative
// hashing), and its high bits are folded into the low ones. The start is the fraction of pi, an arbitrary number.
class Fingerprint {
public:
	void add(double value)
	{
		std::uint64_t word;
		std::memcpy(&word, &value, sizeof word);
		m_hash = (m_hash ^ word) * 0x9e3779b97f4a7c15ULL;
		m_hash ^= m_hash >> 32;
	}
	void add(const Eigen::Matrix3Xd& values)
	{
		for (Eigen::Index i = 0; i < values.size(); ++i)
			add(values.data()[i]);
	}
	std::uint64_t value() const { return m_hash; }

private:
	std::uint64_t m_hash = 0x243f6a8885a308d3ULL;
};

std::uint64_t fingerprint(const LayerPoints& points)
{
	Fingerprint print;
	print.add(points.positions);
	print.add(points.normals);
	return print.value();
}

// As a filter writes them, but for the status of umbilics.
RawCurvatures valuesOf(const LayerPoints& points, const CurvatureEstimate& estimate)
{
	const std::vector<char> umbilic(estimate.field.size(), 0);
	return rawCurvatures(points.normals, estimate.prepared, estimate.field, umbilic);
}

} // namespace

CurvatureEstimate::CurvatureEstimate(
	const LayerPoints& points, const EstimateOptions& options, const Progress& progress) :
		prepared(prepareCloud(points.positions, points.normals)),
		index(prepared.cloud, options.neighborhood),
		field(estimateCurvature(index, options.curvature, progress))
{
	if (options.curvature.scaleMode == ScaleMode::Adaptive)
		prepared.cloud.normals = surfaceNormals(field);
}

void CurvatureEstimate::adoptNormals(LayerPoints& points)
{
	Eigen::Matrix3Xd corrected = points.normals;
	for (Index i = 0; i < points.size(); ++i)
		if (const Index r = prepared.representative[i]; r >= 0)
			corrected.col(i) =
				normalForRaw(field.correctedNormals.col(r), points.normals, prepared, i)
					.cast<Scalarm>()
					.cast<double>();
	points.normals = corrected;
	for (Index r = 0; r < field.size(); ++r)
		prepared.cloud.normals.col(r) = points.normals.col(prepared.source[r]).normalized();
	makeTangent(prepared.cloud.normals, field);
}

std::shared_ptr<const CurvatureEstimate>
CurvatureCache::find(std::uint64_t points, const EstimateOptions& options)
{
	const std::lock_guard<std::mutex> lock(m_mutex);
	for (const Entry& entry : m_entries)
		if (entry.points == points && entry.options == options)
			return entry.estimate;
	return nullptr;
}

std::shared_ptr<const CurvatureEstimate> CurvatureCache::estimate(
	const LayerPoints& points, const EstimateOptions& options, const Progress& progress)
{
	const std::uint64_t print = fingerprint(points);
	if (auto known = find(print, options))
		return known;
	auto made = std::make_shared<const CurvatureEstimate>(points, options, progress);
	store({print, options, made});
	return made;
}

std::shared_ptr<const CurvatureEstimate> CurvatureCache::estimateAndCorrect(
	LayerPoints& points, const EstimateOptions& options, const Progress& progress)
{
	const bool twice = options.curvature.scaleMode == ScaleMode::Paper;
	auto       first =
		std::make_shared<CurvatureEstimate>(points, options, progress.sub(0, twice ? 0.5 : 1, ""));
	first->adoptNormals(points);
	if (twice)
		return estimate(points, options, progress.sub(0.5, 1, ""));
	// A new estimate from these normals would differ in the last digits: this one answers for the layer it
	// was written to, but for no options.
	store({fingerprint(points), std::nullopt, first});
	return first;
}

LayerCurvature
CurvatureCache::ofLayer(const MeshModel& layer, const LayerPoints& points, const Progress& progress)
{
	const std::uint64_t print = fingerprint(points);
	LayerCurvature      result;
	result.estimate    = carriedBy(layer, points, print);
	const bool carried = result.estimate != nullptr;
	if (!carried)
		result.estimate = find(print, EstimateOptions());
	result.reused = result.estimate != nullptr;
	if (!result.reused)
		result.estimate = estimate(points, {}, progress);

	const CurvatureEstimate& estimate = *result.estimate;
	result.ownDirections = carried && !carriesDirections(layer, points, valuesOf(points, estimate));
	if (!result.ownDirections) {
		result.field = {result.estimate, &estimate.field};
		return result;
	}
	auto field = std::make_shared<CurvatureField>(estimate.field);
	adoptDirections(
		readDirections(layer, points, estimate.prepared), estimate.prepared.cloud.normals, *field);
	result.field = field;
	return result;
}

std::shared_ptr<const CurvatureEstimate>
CurvatureCache::carriedBy(const MeshModel& layer, const LayerPoints& points, std::uint64_t print)
{
	const std::lock_guard<std::mutex> lock(m_mutex);
	for (const Entry& entry : m_entries)
		if (entry.points == print &&
		    carriesCurvature(layer, points, valuesOf(points, *entry.estimate)))
			return entry.estimate;
	return nullptr;
}

void CurvatureCache::store(const Entry& entry)
{
	const std::lock_guard<std::mutex> lock(m_mutex);
	m_entries.push_front(entry);
	Index total = 0, kept = 0;
	for (auto e = m_entries.begin(); e != m_entries.end(); ++e, ++kept) {
		total += e->estimate->prepared.cloud.size();
		if (kept > 0 && (kept >= static_cast<Index>(maxEntries) || total > maxPoints)) {
			m_entries.erase(e, m_entries.end());
			break;
		}
	}
}

} // namespace curvature_lines
