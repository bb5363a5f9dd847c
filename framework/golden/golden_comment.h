// What a review shows of a report of a golden suite: a comment in Markdown with thumbnails, annotations,
// SARIF.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace aftershade {

struct GoldenCommentOptions {
    std::string report_url;    ///< of the report's page; "": the comment has no link to it
    std::string pictures_url;  ///< of the folder that the report's files can be read from; "": no thumbnails
    std::size_t rows = 20;     ///< cases in the table
};

/// Texts of one report. [value type]
struct GoldenComment {
    std::string
        markdown;  ///< at most 60,000 bytes; its first line marks the suite, so that a program finds it again
    std::string annotations;  ///< GitHub's workflow commands, a line for each case that is not the same
    std::string sarif;        ///< SARIF 2.1.0
};

/// Reads `report`/report.json. With a `pictures_url` writes `report`/thumbnails.png: reference, test and
/// difference of the first images of the table. Throws Error(ErrorKind::capture) for a faulty report,
/// Error(ErrorKind::output).
GoldenComment comment_on(const std::filesystem::path& report, const GoldenCommentOptions& options);

}  // namespace aftershade
