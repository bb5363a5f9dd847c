// `run` over several frames: what is current is left alone (framework/run/resumable_run.h).
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "cli/cli11.h"
#include "framework/base/error.h"
#include "framework/batch/process_codes.h"
#include "framework/run/resumable_run.h"

namespace aftershade::cli {

struct ResumeArguments {
    bool resume = false;
    bool overwrite = false;
    bool dry_run = false;
    bool no_journal = false;
    int checkpoint_frames = 10;

    /// Whether a run of this many frames keeps a journal and leaves out what is current.
    bool keeps_journal(std::size_t frames) const { return !no_journal && (frames > 1 || resume); }
};

void add_resume_options(CLI::App& app, ResumeArguments& arguments);

/// What of the run's other options decides how it resumes.
struct ResumeNeeds {
    std::string everything;   ///< the option that needs every frame rendered; "" for none
    bool last_frame = false;  ///< an option needs the last frame rendered
    bool says = true;         ///< what is left out, on stderr
    std::function<void(const ResumableRun&)> planned = {};  ///< called before the first frame
};

/// Renders what is not current, by `render`, under locks of the outputs; or says what it would do, with
/// --dry-run. Throws Error(ErrorKind::output) where another run holds an output.
ExitCode run_resumable(const ResumeArguments& arguments, const ResumeNeeds& needs,
                       const FingerprintSource& source, const CaptureReader& reader,
                       const std::function<ExitCode(const RunOptions&, const RunHooks&)>& render);

}  // namespace aftershade::cli
