// SIGINT and SIGTERM as a flag that the work looks at between frames.
#pragma once

#include <atomic>

namespace aftershade::cli {

/// Installs the handlers. The first signal sets the flag; a second one ends the process at once, leaving no
/// partial file because files appear by rename. The same one within 0.3 s counts as the first.
const std::atomic<bool>& watch_for_interrupt();

}  // namespace aftershade::cli
