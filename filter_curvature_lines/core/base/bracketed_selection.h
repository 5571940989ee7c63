// Selection by rank where about the right value is known beforehand, as from one step of a re-weighting to the
// next. In std::nth_element the processor mispredicts every second comparison; here values are sorted out without
// a branch until few are left for it. The result is the same, whatever the guess.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace curvature_lines {

// Of the values that count, those in [low, high].
struct ValueBracket {
	double      low, high;
	std::size_t counted = 0, below = 0, inside = 0;

	bool holds(std::size_t rank) const // and the next
	{
		return rank >= below && std::min(rank + 1, counted - 1) < below + inside;
	}
};

// Of the valueAt(k) >= 0, k < n; those inside are left in `values`.
template<class ValueAt>
ValueBracket
bracketValues(int n, const ValueAt& valueAt, double low, double high, std::vector<double>& values)
{
	std::size_t counted = 0, below = 0, inside = 0;
	values.resize(std::max<std::size_t>(values.size(), n));
	for (int k = 0; k < n; ++k) {
		const double value = valueAt(k);
		counted += value >= 0.0;
		below += (value >= 0.0) & (value < low);
		values[inside] = value;
		inside += (value >= low) & (value <= high);
	}
	return {low, high, counted, below, inside};
}

// To the slices of the bracket that hold the rank and the next one.
inline void narrow(ValueBracket& bracket, std::size_t rank, std::vector<double>& values)
{
	constexpr int slices   = 16;
	const double  perValue = double(slices) / (bracket.high - bracket.low);
	if (!(perValue < std::numeric_limits<double>::infinity()))
		return;
	const auto sliceOf = [&](double value) {
		return std::min(int((value - bracket.low) * perValue), slices - 1);
	};
	std::size_t held[slices] = {};
	for (std::size_t k = 0; k < bracket.inside; ++k)
		++held[sliceOf(values[k])];
	int first = 0;
	while (bracket.below + held[first] <= rank)
		bracket.below += held[first++];
	int         last = first;
	std::size_t kept = held[first];
	while (bracket.below + kept < std::min(rank + 2, bracket.counted))
		kept += held[++last];
	kept = 0;
	for (std::size_t k = 0; k < bracket.inside; ++k) {
		const double value = values[k];
		const int    slice = sliceOf(value);
		values[kept]       = value;
		kept += (slice >= first) & (slice <= last);
	}
	bracket.inside = kept;
}

struct Selected {
	double value = -1.0, next = -1.0; // the next in order; of the largest value, itself
};

// Of the valueAt(k) >= 0, k < n, the one of rank rankOf(how many there are); negative if there are none.
template<class ValueAt, class RankOf>
Selected selectNear(
	double guess, int n, const ValueAt& valueAt, const RankOf& rankOf, std::vector<double>& scratch)
{
	constexpr double      spread = 1.6, away = 4.0;
	constexpr int         moves = 2;
	constexpr std::size_t few   = 32;
	ValueBracket bracket = bracketValues(n, valueAt, guess / spread, guess * spread, scratch);
	if (bracket.counted == 0)
		return {};
	const std::size_t rank = rankOf(bracket.counted);
	for (int move = 0; move < moves && !bracket.holds(rank); ++move)
		bracket =
			rank < bracket.below
				? bracketValues(n, valueAt, bracket.low / away, bracket.low * spread, scratch)
				: bracketValues(n, valueAt, bracket.high / spread, bracket.high * away, scratch);
	if (!bracket.holds(rank))
		bracket = bracketValues(n, valueAt, 0.0, std::numeric_limits<double>::infinity(), scratch);
	else if (bracket.inside > few)
		narrow(bracket, rank, scratch);
	const auto end = scratch.begin() + bracket.inside,
			   at  = scratch.begin() + (rank - bracket.below);
	std::nth_element(scratch.begin(), at, end);
	return {*at, at + 1 < end ? *std::min_element(at + 1, end) : *at};
}

// The value below which `share` of them lie.
template<class ValueAt>
double quantileNear(
	double guess, int n, const ValueAt& valueAt, double share, std::vector<double>& scratch)
{
	const auto rankOf = [share](std::size_t count) {
		return static_cast<std::size_t>(share * double(count));
	};
	return selectNear(guess, n, valueAt, rankOf, scratch).value;
}

} // namespace curvature_lines
