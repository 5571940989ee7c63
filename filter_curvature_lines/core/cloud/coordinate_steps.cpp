// Values of a coordinate, and the gaps between them.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "coordinate_steps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include <Eigen/Core>

#include "point_cloud.h"
#include "quantile.h"

namespace curvature_lines {

namespace {

// An axis is stepped when this share of the points have their coordinate in common with another point, and there are so
// few values. The flat base of a statue or the faces of a cube are less than the first.
constexpr double sharedByMost = 0.9;
constexpr double mostValues   = 0.125; // over points
// Usual gap in spacings. Finer steps do no harm: the least deviation of a voter is as large. Coarser ones are no noise but
// sheets of their own, as in a block of slices.
constexpr double finestStep = 0.2, coarsestStep = 3.0;
constexpr double widestCell =
	1.5; // usual gaps: a value beyond a hole in the data is not rounded from so far

// Distinct values of one coordinate, ascending, and the place of each point's value among them.
struct Values {
	std::vector<double>      value;
	std::vector<std::size_t> count;

	explicit Values(std::vector<double> coordinates)
	{
		std::sort(coordinates.begin(), coordinates.end());
		for (const double x : coordinates)
			if (value.empty() || x != value.back()) {
				value.push_back(x);
				count.push_back(1);
			}
			else
				++count.back();
	}
	std::size_t placeOf(double x) const
	{
		return static_cast<std::size_t>(
			std::lower_bound(value.begin(), value.end(), x) - value.begin());
	}
	std::size_t countAt(std::size_t place) const { return place < count.size() ? count[place] : 0; }
	// From 0, the lower end of the interval that is rounded to the value at a place, to 1: where the share `random` of its
	// points is below. The density goes evenly from end to end, at each the mean of the two intervals that meet there: in
	// the tail of a distribution most points are at the inner end.
	double placeInCell(std::size_t place, double random) const
	{
		const auto   own   = double(countAt(place));
		const double lower = own + (place > 0 ? double(countAt(place - 1)) : 0.0);
		const double upper = own + double(countAt(place + 1));
		const double root  = std::sqrt(lower * lower + random * (upper * upper - lower * lower));
		return random * (lower + upper) / (lower + root);
	}
	// Gap below the value at a place; below the first, that above it.
	double gapBelow(std::size_t place) const
	{
		const std::size_t upper = std::max<std::size_t>(place, 1);
		return value[upper] - value[upper - 1];
	}
};

// The usual gap, or 0 where the coordinates are not rounded to steps that matter.
double usualStep(const Values& values, std::size_t points, double spacing)
{
	if (values.value.size() < 2 || double(values.value.size()) > mostValues * double(points))
		return 0.0;
	std::size_t         shared = 0;
	std::vector<double> gaps; // of each point
	gaps.reserve(points);
	for (std::size_t k = 0; k < values.value.size(); ++k) {
		shared += values.count[k] > 1 ? values.count[k] : 0;
		gaps.insert(gaps.end(), values.count[k], values.gapBelow(k));
	}
	const double usual = medianInPlace(gaps);
	const bool   steps = double(shared) >= sharedByMost * double(points) &&
	                   usual >= finestStep * spacing && usual <= coarsestStep * spacing;
	return steps ? usual : 0.0;
}

// A number in [0, 1) that the bits of the coordinates determine.
double randomOf(const Eigen::Vector3d& p, std::uint64_t axis)
{
	std::uint64_t state = 0x9e3779b97f4a7c15ULL * (axis + 1); // golden ratio, as in Weyl sequences
	for (const double x : {p.x(), p.y(), p.z()}) {
		std::uint64_t bits = 0;
		std::memcpy(&bits, &x, sizeof bits);
		state ^= bits;
		state *= 0xbf58476d1ce4e5b9ULL; // an odd factor and a shift mix all bits down
		state ^= state >> 29;
		state *= 0x94d049bb133111ebULL;
		state ^= state >> 32;
	}
	return static_cast<double>(state >> 11) * 0x1.0p-53;
}

} // namespace

SpreadCoordinates spreadOverSteps(const Eigen::Matrix3Xd& positions, double spacing)
{
	SpreadCoordinates result;
	result.positions = positions;
	const auto n     = static_cast<std::size_t>(positions.cols());
	for (int axis = 0; axis < 3; ++axis) {
		std::vector<double> coordinates(n);
		for (std::size_t i = 0; i < n; ++i)
			coordinates[i] = positions(axis, static_cast<Index>(i));
		const Values values(coordinates);
		const double usual = usualStep(values, n, spacing);
		if (!(usual > 0.0))
			continue;
		result.steps[axis] = usual;
		for (std::size_t i = 0; i < n; ++i) {
			const std::size_t place = values.placeOf(coordinates[i]);
			const double      below = std::min(values.gapBelow(place), widestCell * usual);
			const double      above = std::min(
                values.gapBelow(std::min(place + 1, values.value.size() - 1)), widestCell * usual);
			const auto   column = static_cast<Index>(i);
			const double random = randomOf(positions.col(column), static_cast<std::uint64_t>(axis));
			result.positions(axis, column) +=
				0.5 * ((below + above) * values.placeInCell(place, random) - below);
		}
	}
	return result;
}

} // namespace curvature_lines
