// The look that a page works on: its text with undo and redo, and what it means, or why it means nothing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "framework/capture/capture.h"
#include "framework/core/diagnostics.h"
#include "framework/effect/registry.h"
#include "framework/pipeline/look.h"
#include "framework/pipeline/pipeline.h"

namespace aftershade::serve {

/// A text without faults, bound to its effects.
struct BoundText {
    Look look;
    Pipeline pipeline;
    std::uint64_t revision = 0;
};

/// An edit, an undo or a save that cannot be: 409 where the page is behind, else 400.
struct Refusal {
    int status = 400;
    std::string message;
};

/// [any thread]
class LookModel {
public:
    /// Reads the file. `effects` must outlive this. Throws Error(ExitCode::usage) where it cannot be read.
    LookModel(std::filesystem::path path, EffectRegistry& effects, bool read_only);

    const std::filesystem::path& path() const { return path_; }
    /// Of the last text that had no faults; nullptr before there was one.
    std::shared_ptr<const BoundText> bound() const;

    // Each throws Refusal.
    void edit(std::uint64_t revision, const nlohmann::ordered_json& edits);
    void undo();
    void redo();
    /// Writes the file, whole or not at all. Throws Error(ExitCode::output) too.
    void save();

    /// What the page shows of the look; values are those of the frame `header` stands for.
    nlohmann::ordered_json state(const CaptureHeader& header) const;
    std::string text() const;

private:
    void bind();
    void change(std::string text);

    std::filesystem::path path_;
    EffectRegistry& effects_;
    bool read_only_;

    mutable std::mutex mutex_;  // of what follows
    std::vector<std::string> texts_;
    std::size_t at_ = 0;  // of texts_
    std::string saved_text_;
    std::uint64_t revision_ = 1;
    std::uint64_t saved_revision_ = 1;
    Diagnostics faults_;
    std::shared_ptr<const BoundText> bound_;
};

}  // namespace aftershade::serve
