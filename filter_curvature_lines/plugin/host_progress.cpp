// Throttling of the host's callback. Progress already promises the calling thread.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_progress.h"

#include <algorithm>
#include <chrono>
#include <memory>

#include "progress.h"

namespace curvature_lines {

namespace {

// Hosts redraw at every call, see progress.h.
constexpr auto interval = std::chrono::milliseconds(100);

} // namespace

Progress hostProgress(vcg::CallBackPos* callback)
{
	if (callback == nullptr)
		return {};

	using Clock = std::chrono::steady_clock;
	struct State {
		Clock::time_point last    = Clock::now() - std::chrono::hours(1);
		int               percent = 0;
	};
	// Shared, because Progress is copied for every sub-stage.
	auto state = std::make_shared<State>();
	return Progress([state, callback](double fraction, const char* what) {
		const auto now = Clock::now();
		if (now - state->last < interval)
			return true;
		state->last    = now;
		state->percent = std::max(state->percent, static_cast<int>(100.0 * fraction));
		return callback(state->percent, what);
	});
}

} // namespace curvature_lines
