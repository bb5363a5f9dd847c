// A hash of the files that a case of a golden suite reads as its capture.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <string>

#include "framework/golden/golden_case.h"

namespace aftershade {

/// The capture's document, the profiles that may read it, and the files of this one frame; empty where the
/// capture cannot be read.
std::set<std::filesystem::path> capture_files(const GoldenCase& test, int frame);

/// Remembers what it read: cases share captures. [thread-safe]
class CaptureHasher {
public:
    /// 32 hexadecimal digits over the capture's document, the profiles that may read it, and the files of the
    /// case's frames and of their neighbours, with roles, sub-frames and layers. "" where one cannot be read.
    std::string hash(const GoldenCase& test);

private:
    const std::string& content_of(const std::filesystem::path& file);

    std::map<std::filesystem::path, std::string> contents_;
    std::mutex mutex_;
};

}  // namespace aftershade
