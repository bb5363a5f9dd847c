// A shader's text with the author's line of each of its own.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace aftershade {

/// A name that many lines share: a shader with its includes has thousands. [safe to copy between threads]
class FileName {
public:
    FileName(std::string name) : name_(std::make_shared<const std::string>(std::move(name))) {}
    FileName(const char* name) : FileName(std::string(name)) {}
    const std::string& text() const { return *name_; }

private:
    std::shared_ptr<const std::string> name_;
};

struct SourceLine {
    FileName file;  ///< "<generated>" for the host's own lines
    int line = 0;
};

struct ShaderSource {
    std::string text;
    std::vector<SourceLine> lines;  ///< of text, from its first
};

}  // namespace aftershade
