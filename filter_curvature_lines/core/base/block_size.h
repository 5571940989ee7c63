// How many values the sums over the points of a neighbourhood take at a time.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace curvature_lines {

// The same on every processor, whatever the width of its registers: so the order in which values are added, and
// with it the result, does not depend on the machine. Arrays that are read in blocks end with a padding up to a
// whole number of them.
constexpr int blockSize = 4;

} // namespace curvature_lines
