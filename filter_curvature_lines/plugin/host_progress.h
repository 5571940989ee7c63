// MeshLab's progress callback behind core's Progress: on the main thread, at most ten times a
// second, never backwards, and a refusal cancels the stage.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <wrap/callback.h>

#include "progress.h"

namespace curvature_lines {

// `callback` may be null.
Progress hostProgress(vcg::CallBackPos* callback);

} // namespace curvature_lines
