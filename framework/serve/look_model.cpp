#include "framework/serve/look_model.h"

#include <utility>

#include <nlohmann/json.hpp>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/base/path_bounds.h"
#include "framework/effect/description.h"
#include "framework/look/look_schema.h"
#include "framework/serve/file_name.h"
#include "framework/serve/look_edits.h"
#include "framework/serve/look_state.h"

namespace aftershade::serve {

namespace {

/// Enough for a day's work; of a text of 1 MiB it would be 4 GiB, so its bytes are bounded too.
constexpr std::size_t kMaxTexts = 4096, kMaxTextBytes = std::size_t(16) << 20;

/// Drawn where the look has had faults from the start.
constexpr const char* kNoSteps = R"({ "aftershade": 1, "steps": [] })";

/// What a look without a file begins with.
constexpr const char* kEmptyLook = "{\n  \"aftershade\": 1,\n  \"steps\": []\n}\n";

std::size_t bytes_of(const std::vector<std::string>& texts) {
    std::size_t bytes = 0;
    for (const std::string& text : texts) bytes += text.size();
    return bytes;
}

/// The look's beginning for a step that is not there.
Place place_of_step(const Look& look, const std::string& step) {
    for (const LookStep& one : look.steps)
        if (one.name == step) return one.place;
    return {look.file, 1, 1};
}

}  // namespace

LookModel::LookModel(std::filesystem::path path, FindEffects find_effects, bool read_only,
                     std::vector<std::filesystem::path> folders, File file)
    : find_effects_(std::move(find_effects)),
      read_only_(read_only),
      folders_(std::move(folders)),
      path_(std::move(path)),
      file_(file),
      effects_(find_effects_()) {
    std::string text =
        file_ == File::there ? read_text_file(path_, ErrorKind::usage, kMaxDocumentBytes) : kEmptyLook;
    saved_text_ = text;
    texts_.push_back(std::move(text));
    adopt(binding_of(texts_[at_], Origin::disk));
    if (bound_) return;
    Diagnostics none;
    const auto capture_alone = bind_text(kNoSteps, path_, effects_, none);
    capture_alone->effects_revision = effects_revision_;
    bound_ = capture_alone;
}

std::string LookModel::why_not(const std::filesystem::path& file) const {
    const std::filesystem::path resolved = resolved_path(file);
    if (is_shader_name(resolved))
        return "is a shader, which pages can write, so that a look cannot read anything else from it (give "
               "the file another ending)";
    if (named_on_disk_.contains(file)) return "";
    std::vector<std::filesystem::path> folders(folders_.begin(), folders_.end());
    if (file_ != File::unnamed) folders.push_back(path_.parent_path());
    // Nothing of what lies elsewhere, such as where its links lead, goes to the page.
    if (has_detour(file, folders))
        return "goes through a folder outside those that a page may read (leave the detour out" +
               advice(", or allow the folder with ", Option::allow_path, "", "") + ")";
    if (named_on_disk_.contains(resolved)) return "";
    for (const auto& folder : folders)
        if (out_of_bounds(file, folder).empty()) return "";
    return "lies outside the folders that a page may read: those of the look, the capture and the effects "
           "(move it there" +
           advice(", or allow its folder with ", Option::allow_path, "", "") + ")";
}

/// A text on disk is of who has the disk, and not of a page: its files may be named from then on.
LookModel::Binding LookModel::binding_of(const std::string& text, Origin origin) {
    Binding binding;
    std::vector<std::string> files;
    const FileRule rule([&](const std::filesystem::path& file) {
        if (origin == Origin::disk) named_on_disk_.insert({file, resolved_path(file)});
        std::string reason = why_not(file);
        if (reason.empty()) files.push_back(resolved_path(file).string());
        else if (binding.refused.empty()) binding.refused = "'" + file.string() + "' " + reason;
        return reason;
    });
    binding.bound = bind_text(text, path_, effects_, binding.faults);
    if (binding.bound) binding.bound->files = std::move(files);
    return binding;
}

void LookModel::adopt(Binding binding) {
    faults_ = std::move(binding.faults);
    if (!binding.bound) return;
    if (!undrawable_.reason.empty() && binding.bound->text == undrawable_text_)
        faults_.error(place_of_step(binding.bound->look, undrawable_.step), undrawable_.reason);
    binding.bound->effects_revision = effects_revision_;
    binding.bound->revision = revision_;
    if (!faults_.has_errors()) bound_ = std::move(binding.bound);
}

void LookModel::bind() {
    adopt(binding_of(texts_[at_], Origin::page));
}

void LookModel::drawn(const std::string& text, std::uint64_t effects_revision) {
    const std::lock_guard lock(mutex_);
    if (bound_ && bound_->text == text && bound_->effects_revision == effects_revision) drawn_ = bound_;
}

void LookModel::give_up(const std::string& text, std::uint64_t effects_revision, const Undrawable& why) {
    const std::lock_guard lock(mutex_);
    if (!bound_ || bound_->text != text || bound_->effects_revision != effects_revision) return;
    // Shaders are read from disk, so a picture from before a change of the effects cannot be drawn again.
    if (drawn_ && (drawn_->text == text || drawn_->effects_revision != effects_revision_)) drawn_.reset();
    bound_ = drawn_;
    undrawable_text_ = text;
    undrawable_ = why;
    ++revision_;
    bind();
}

std::shared_ptr<const BoundText> LookModel::bound() const {
    const std::lock_guard lock(mutex_);
    return bound_;
}

std::string LookModel::text() const {
    const std::lock_guard lock(mutex_);
    return texts_[at_];
}

void LookModel::change(std::string text, Binding binding) {
    texts_.resize(at_ + 1);
    texts_.push_back(std::move(text));
    ++at_;
    while (texts_.size() > 2 && (texts_.size() > kMaxTexts || bytes_of(texts_) > kMaxTextBytes)) {
        texts_.erase(texts_.begin());
        --at_;
    }
    ++revision_;
    adopt(std::move(binding));
}

std::string LookModel::with_edits(const nlohmann::ordered_json& edits) const {
    if (!edits.is_array()) throw Refusal{400, "'edits' is a list"};
    std::string text = texts_[at_];
    for (const auto& edit : edits) {
        try {
            text = edited(text, edit);
        } catch (const Error& error) {
            throw Refusal{400, error.what()};
        }
        if (text.size() > kMaxDocumentBytes)
            throw Refusal{413, "the look would be longer than 1 MiB, the most that a look may be"};
    }
    return text;
}

void LookModel::edit(std::uint64_t revision, const nlohmann::ordered_json& edits) {
    const std::lock_guard lock(mutex_);
    if (revision != revision_)
        throw Refusal{409,
                      "the look was changed elsewhere meanwhile; make the change again (it is for revision " +
                          std::to_string(revision) + ", the look is at " + std::to_string(revision_) + ")"};
    std::string text = with_edits(edits);
    if (text == texts_[at_]) return;
    Binding binding = binding_of(text, Origin::page);
    if (!binding.refused.empty()) throw Refusal{403, binding.refused};
    change(std::move(text), std::move(binding));
}

std::shared_ptr<const BoundText> LookModel::tried(const nlohmann::ordered_json& edits) {
    const std::lock_guard lock(mutex_);
    Binding binding = binding_of(with_edits(edits), Origin::page);
    if (!binding.refused.empty()) throw Refusal{403, binding.refused};
    for (const Diagnostic& fault : binding.faults.all())
        if (fault.severity == Severity::error) throw Refusal{409, fault.message};
    if (!binding.bound) throw Refusal{409, "the text is not a look"};
    binding.bound->effects_revision = effects_revision_;
    return binding.bound;
}

void LookModel::capture_changed() {
    const std::lock_guard lock(mutex_);
    ++revision_;
    bind();
}

void LookModel::undo() {
    const std::lock_guard lock(mutex_);
    if (at_ == 0) throw Refusal{409, "there is nothing to undo"};
    --at_;
    ++revision_;
    bind();
}

void LookModel::redo() {
    const std::lock_guard lock(mutex_);
    if (at_ + 1 == texts_.size()) throw Refusal{409, "there is nothing to redo"};
    ++at_;
    ++revision_;
    bind();
}

std::filesystem::path LookModel::saved_path() const {
    const std::lock_guard lock(mutex_);
    if (file_ != File::there) throw Refusal{409, "the look has no file yet: save it first"};
    return path_;
}

void LookModel::save(const std::string& name) {
    const std::lock_guard lock(mutex_);
    if (read_only_)
        throw Refusal{403, "the look is not written: the program runs with " + spelled(Option::read_only)};
    if (!name.empty() && file_ != File::unnamed)
        throw Refusal{409, "the look is " + path_.string() + ", and keeps this name"};
    const std::filesystem::path path =
        file_ == File::unnamed ? new_path(path_.parent_path(), name, ".json", "the look") : path_;
    if (!replace_text_file(path, file_ == File::there ? saved_text_ : "", texts_[at_]))
        throw Refusal{409, path.string() +
                               " was changed by another program; nothing was written (export the look, or "
                               "undo to the saved one, and the page reads the file)"};
    path_ = path;
    file_ = File::there;
    saved_text_ = texts_[at_];
    saved_revision_ = revision_;
    is_gone_ = false;
    file_fault_.clear();
}

void LookModel::follow_file() {
    const std::lock_guard lock(mutex_);
    if (file_ != File::there) return;
    std::error_code failure;
    is_gone_ =
        std::filesystem::symlink_status(path_, failure).type() == std::filesystem::file_type::not_found;
    std::string fault;
    std::string on_disk = read_regular_file(path_, kMaxDocumentBytes, fault);
    file_fault_ = is_gone_ ? "" : fault;
    if (is_gone_ || !fault.empty() || texts_[at_] != saved_text_ || on_disk == saved_text_) return;
    saved_text_ = on_disk;
    Binding binding = binding_of(on_disk, Origin::disk);
    change(std::move(on_disk), std::move(binding));
}

nlohmann::ordered_json LookModel::revisions() const {
    const std::lock_guard lock(mutex_);
    return {{"revision", revision_},
            {"effects_revision", effects_revision_},
            {"saved_revision", saved_revision()},
            {"file_fault", file_fault_},
            {"path", path_.string()}};
}

/// That of the text on disk; null where no text is.
nlohmann::ordered_json LookModel::saved_revision() const {
    if (is_gone_) return nullptr;
    return texts_[at_] == saved_text_ ? revision_ : saved_revision_;
}

std::uint64_t LookModel::revision() const {
    const std::lock_guard lock(mutex_);
    return revision_;
}

void LookModel::reload_effects() {
    std::shared_ptr<EffectRegistry> effects = find_effects_();
    const std::lock_guard lock(mutex_);
    effects_ = std::move(effects);
    undrawable_text_.clear();
    undrawable_ = {};
    ++effects_revision_;
    ++revision_;
    bind();
}

std::uint64_t LookModel::effects_revision() const {
    const std::lock_guard lock(mutex_);
    return effects_revision_;
}

std::string LookModel::effects_json() const {
    const std::lock_guard lock(mutex_);
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const std::string& id : effects_->ids()) {
        Diagnostics faults;
        const EffectManifest* manifest = effects_->find(id, faults);
        if (manifest && !faults.has_errors())
            list.push_back(nlohmann::ordered_json::parse(describe_json(*manifest)));
    }
    return list.dump();
}

std::string LookModel::schema_json() const {
    const std::lock_guard lock(mutex_);
    std::vector<const EffectManifest*> manifests;
    for (const std::string& id : effects_->ids()) {
        Diagnostics faults;
        const EffectManifest* manifest = effects_->find(id, faults);
        if (manifest && !faults.has_errors()) manifests.push_back(manifest);
    }
    return look_schema(manifests);
}

bool LookModel::has_effect(const std::string& effect) const {
    const std::lock_guard lock(mutex_);
    return effects_->contains(effect);
}

EffectFiles LookModel::files_of(const std::string& effect) const {
    const std::lock_guard lock(mutex_);
    return effect_files(*effects_, effect, read_only_);
}

std::filesystem::path LookModel::folder() const {
    const std::lock_guard lock(mutex_);
    return path_.parent_path();
}

nlohmann::ordered_json LookModel::state(const CaptureHeader& header) const {
    const std::lock_guard lock(mutex_);
    nlohmann::ordered_json state;
    state["look"] = {{"path", path_.string()},
                     {"name", path_.filename().string()},
                     {"folder", path_.parent_path().string()},
                     {"has_file", file_ == File::there},
                     {"is_gone", is_gone_},
                     {"has_name", file_ != File::unnamed}};
    state["capture"] = nullptr;
    state["read_only"] = read_only_;
    state["revision"] = revision_;
    state["effects_revision"] = effects_revision_;
    state["saved_revision"] = saved_revision();
    state["file_fault"] = file_fault_;
    state["can_undo"] = at_ > 0;
    state["can_redo"] = at_ + 1 < texts_.size();
    state["text"] = texts_[at_];
    Diagnostics faults = faults_;
    if (!file_fault_.empty())
        faults.warning({path_}, "what is on disk was not taken over: " + file_fault_ +
                                    "; the text is the one read before (make the file a readable look of at "
                                    "most 1 MiB)");
    state["faults"] = faults_json(faults);
    state["has_picture"] = bound_ != nullptr;
    state["is_capture_alone"] = bound_ && bound_->text == kNoSteps && texts_[at_] != kNoSteps;
    const bool is_bound = bound_ && bound_->revision == revision_;
    state["steps"] = steps_json(texts_[at_], is_bound ? bound_.get() : nullptr, *effects_, header);
    return state;
}

}  // namespace aftershade::serve
