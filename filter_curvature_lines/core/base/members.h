// The members of a struct as a tuple: options are compared so, member by member, with none forgotten.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <tuple>

namespace curvature_lines {

// References to all members, in order. `count` is how many there are: a struct that gains or loses one does not
// compile until whoever changed it has changed the count, too.
template<std::size_t count, class Struct>
auto members(const Struct& s)
{
	static_assert(count == 2 || count == 3 || count == 9, "add a line for structs of this size");
	if constexpr (count == 2) {
		const auto& [a, b] = s;
		return std::tie(a, b);
	}
	else if constexpr (count == 3) {
		const auto& [a, b, c] = s;
		return std::tie(a, b, c);
	}
	else {
		const auto& [a, b, c, d, e, f, g, h, i] = s;
		return std::tie(a, b, c, d, e, f, g, h, i);
	}
}

} // namespace curvature_lines
