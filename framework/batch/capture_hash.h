// A hash of the files that a case of a golden suite reads as its capture.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "framework/batch/golden_case.h"

namespace aftershade {

/// Remembers what it read: cases share captures. [one thread at a time]
class CaptureHasher {
public:
    /// 32 hexadecimal digits over the capture's document and the files of the case's frames, with their roles
    /// and sub-frames, but without the neighbours that some effects read. "" where one cannot be read.
    std::string hash(const GoldenCase& test);

private:
    const std::string& content_of(const std::filesystem::path& file);

    std::map<std::filesystem::path, std::string> contents_;
};

}  // namespace aftershade
