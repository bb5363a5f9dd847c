// Decisions about the images of a golden suite: what a review, a comment or a commit says, and who may say
// it.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "framework/base/diagnostics.h"

namespace aftershade {

/// An image as a reviewer saw it. Hashes are those of file_hash (approved_image.h).
struct SeenImage {
    std::string name;       ///< "lamps.color.0001"
    std::string test;       ///< hash of the new image
    std::string reference;  ///< hash of the approved image beside it; "" where there was none

    bool operator==(const SeenImage&) const = default;
};

struct GoldenDecision {
    std::string test;  ///< a case's name; a glob as --filter takes it where nothing was seen
    bool approves = false;
    bool adds = false;                ///< beside the images of other renderers, as `approve --add`
    std::string note;                 ///< why
    std::string by;                   ///< "Ada <ada@example.org>", or a name alone
    std::vector<SeenImage> images{};  ///< empty: it is about any image that the case draws
    bool is_written = false;          ///< the approved images are in the suite

    bool operator==(const GoldenDecision&) const = default;
};

/// Longer texts are faults: a note is read on a page, and a name stands in a sidecar.
inline constexpr std::size_t kMostNoteBytes = 2000, kMostNameBytes = 200;

/// Why a text cannot be a name in a decision, without a subject: "has 300 bytes; the most is 200"; "" where
/// it can.
std::string fault_of_name(std::string_view text);

/// decisions.json. Faults go to `diagnostics`.
std::vector<GoldenDecision> parse_decisions(std::string_view text, const std::string& file,
                                            Diagnostics& diagnostics);
nlohmann::ordered_json json_of(const GoldenDecision& decision);
std::string decisions_text(const std::vector<GoldenDecision>& decisions);

/// Those of a commit's message: a line "golden: approve bloom/* lens" approves the cases that these globs
/// fit.
std::vector<GoldenDecision> decisions_of_message(std::string_view message, const std::string& author);

/// Who may approve which cases.
struct GoldenApprovers {
    struct Entry {
        std::vector<std::string> cases;  ///< globs
        std::vector<std::string> who;    ///< email addresses, or names for those who give none
    };
    std::vector<Entry> entries;

    /// `by` as in GoldenDecision: its address counts where it has one, else the whole text.
    bool may(const std::string& by, const std::string& test) const;
};

/// approvers.json. Faults go to `diagnostics`.
GoldenApprovers read_approvers(const std::filesystem::path& file, Diagnostics& diagnostics);

}  // namespace aftershade
