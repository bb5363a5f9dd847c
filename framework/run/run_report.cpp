#include "framework/run/run_report.h"

namespace aftershade {

ExitCode RunReport::exit_code() const {
    if (interrupted) return ExitCode::interrupted;
    const bool any = frames_done + frames_unwritten + frames_current > 0;
    if (failures.empty()) return any ? ExitCode::done : ExitCode::capture;
    return any ? ExitCode::partial : failures.front().code;
}

}  // namespace aftershade
