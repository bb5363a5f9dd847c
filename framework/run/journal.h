// The journal of a folder: one line of JSON for each finished frame, so that a later run can leave out
// current frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/run/fingerprint.h"
#include "framework/run/run_state.h"

namespace aftershade {

struct JournalFile {
    std::string path;  ///< from the folder of the outputs
    std::uint64_t bytes = 0;
    std::int64_t modified_ns = 0;  ///< since 1970
    std::string hash;              ///< content_hash of its bytes
};

struct JournalFrame {
    int frame = 0;
    std::string setup;  ///< hash of the parts that all frames of its run shared
    FrameFingerprint fingerprint;
    std::vector<JournalFile> files;
    double seconds = 0;  ///< from its first read to its last file
};

/// The journal of one output. Lines that are cut off or damaged are passed over: their frames count as not
/// rendered. [several processes may append to one journal]
class Journal {
public:
    /// Reads what is there, which may be nothing. Throws Error(ErrorKind::output) where a journal is there
    /// and cannot be read.
    explicit Journal(RunState state);

    /// The last line of that frame; nullptr without one.
    const JournalFrame* find(int frame) const;
    /// The parts of a setup; nullptr where no line has them.
    const FingerprintParts* setup(const std::string& hash) const;

    /// The line that later frames share: it is appended with the first of them, unless the journal has it.
    /// Makes the folder. Throws Error(ErrorKind::output).
    void begin(const FingerprintParts& setup);
    /// Appends one frame whose files are in place; reads them for their hashes. Throws
    /// Error(ErrorKind::output). [one call at a time]
    void add(int frame, const std::string& setup, const FrameFingerprint& fingerprint,
             const std::vector<std::filesystem::path>& files, double seconds);

    /// Why the files of a frame are not what its line says, as "out_0004.exr is missing"; "" if they are.
    /// `expected` are those that a run would write. A file of the same size and time counts as the same, one
    /// of another time is read.
    std::string fault_of_files(const JournalFrame& frame,
                               const std::vector<std::filesystem::path>& expected) const;

private:
    void read_line(const std::string& line);
    void append(std::string line) const;
    std::string relative(const std::filesystem::path& file) const;

    RunState state_;
    std::map<int, JournalFrame> frames_;
    std::map<std::string, FingerprintParts> setups_;
    std::string setup_line_;  // not yet in the journal
};

}  // namespace aftershade
