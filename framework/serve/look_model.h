// The look that a page works on: its text with undo and redo, and what it means, or why it means nothing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "framework/base/diagnostics.h"
#include "framework/capture/capture.h"
#include "framework/effect/registry.h"
#include "framework/look/look.h"
#include "framework/look/pipeline.h"
#include "framework/serve/effect_files.h"
#include "framework/serve/http_message.h"
#include "framework/serve/look_state.h"

namespace aftershade::serve {

/// Why a text cannot be drawn.
struct Undrawable {
    std::string reason;
    std::string step{};  ///< of the look, at which it is; "" where that is not known
};

/// [any thread]
class LookModel {
public:
    using FindEffects = std::function<std::shared_ptr<EffectRegistry>()>;
    enum class File {
        there,
        fresh,   ///< the first save makes it
        unnamed  ///< the first save names it, and makes it in the path's folder
    };

    /// Reads the file; a look without one has no steps. Throws Error(ErrorKind::usage) where it cannot be
    /// read. Edits may name files of the look's folder once it has a name, of `folders`, and of those of
    /// --allow-path, and each file that the look on disk names.
    LookModel(std::filesystem::path path, FindEffects find_effects, bool read_only,
              std::vector<std::filesystem::path> folders = {}, File file = File::there);

    /// Throws Refusal before the look has a file.
    std::filesystem::path saved_path() const;
    /// The last text without faults, bound; nullptr before there was one.
    std::shared_ptr<const BoundText> bound() const;

    // Each throws Refusal.
    void edit(std::uint64_t revision, const nlohmann::ordered_json& edits);
    void undo();
    void redo();
    /// Writes the file, whole or not at all; `name` is that of a look without one. A file that was not the
    /// look's before is never replaced. Throws Error(ErrorKind::output) too.
    void save(const std::string& name = "");
    /// What the text would be after these edits, which are not made. Throws Refusal for its faults, too.
    std::shared_ptr<const BoundText> tried(const nlohmann::ordered_json& edits);
    /// Counts a change of what the look is seen on.
    void capture_changed();

    /// Takes over what another program wrote to the file, as one step of undo, faults and all, where the text
    /// here is saved. A file that cannot be read, or is longer than a look may be, is a warning of the state.
    /// Where the file is gone, the text counts as not saved.
    void follow_file();
    /// {"revision", "effects_revision", "saved_revision", "file_fault", "path"}: whether a page has to read
    /// the state again.
    nlohmann::ordered_json revisions() const;
    /// Counts the changes of the text and of the effects.
    std::uint64_t revision() const;

    /// A whole picture of the text came.
    void drawn(const std::string& text, std::uint64_t effects_revision);
    /// The text cannot be drawn: it counts as faulty until the effects are read again, and the last one that
    /// was drawn takes its place. Nothing happens where the effects were read again meanwhile.
    void give_up(const std::string& text, std::uint64_t effects_revision, const Undrawable& why);

    /// Reads all effects again: what is bound from now on is bound to those.
    void reload_effects();
    /// Counts reload_effects().
    std::uint64_t effects_revision() const;
    /// JSON: what `describe --json` gives for each effect without faults.
    std::string effects_json() const;
    /// JSON Schema of looks with these effects.
    std::string schema_json() const;
    bool has_effect(const std::string& effect) const;
    bool is_read_only() const { return read_only_; }
    /// Throws Refusal 404 where there is no such effect.
    EffectFiles files_of(const std::string& effect) const;

    /// What the page shows of the look; values are those of the frame `header` stands for.
    nlohmann::ordered_json state(const CaptureHeader& header) const;
    std::string text() const;
    /// Of the look, with a file or without.
    std::filesystem::path folder() const;

private:
    struct Binding {
        std::shared_ptr<BoundText> bound;
        Diagnostics faults;
        std::string refused;  ///< the first file that may not be named, and why
    };
    enum class Origin { page, disk };

    Binding binding_of(const std::string& text, Origin origin);
    std::string why_not(const std::filesystem::path& file) const;
    void adopt(Binding binding);
    void bind();
    void change(std::string text, Binding binding);
    nlohmann::ordered_json saved_revision() const;

    std::string with_edits(const nlohmann::ordered_json& edits) const;

    FindEffects find_effects_;
    bool read_only_;
    std::vector<std::filesystem::path> folders_;

    mutable std::mutex mutex_;  // of what follows
    std::filesystem::path path_;
    File file_;
    std::set<std::filesystem::path> named_on_disk_;  // resolved
    std::shared_ptr<EffectRegistry> effects_;
    std::uint64_t effects_revision_ = 1;
    std::vector<std::string> texts_;
    std::size_t at_ = 0;  // of texts_
    std::string saved_text_;
    bool is_gone_ = false;    // another program removed the file
    std::string file_fault_;  // why what another program wrote is not taken over
    std::uint64_t revision_ = 1;
    std::uint64_t saved_revision_ = 1;
    Diagnostics faults_;
    std::shared_ptr<const BoundText> bound_;
    std::shared_ptr<const BoundText> drawn_;  // the last one of which a whole picture came
    std::string undrawable_text_;             // given up
    Undrawable undrawable_;                   // without a reason: no text was
};

}  // namespace aftershade::serve
