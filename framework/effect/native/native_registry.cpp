// NativeRegistry: which library offers which effect.
#include <algorithm>
#include <cstdlib>

#include "framework/base/diagnostics.h"
#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/effect/native/native_library.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

std::string places_searched(const std::vector<fs::path>& folders) {
    if (folders.empty())
        return "; no plug-in folder is given (" + spelled(Option::plugin_path) + ", AFTERSHADE_PLUGIN_PATH)";
    std::string text = "; searched ";
    for (const fs::path& folder : folders)
        text += (&folder == &folders.front() ? "" : ", ") + folder.string();
    return text;
}

}  // namespace

NativeRegistry::NativeRegistry(std::vector<fs::path> folders, std::span<const StaticNativeLibrary> linked,
                               StatusWriter* status, std::shared_ptr<NativeProcess> process)
    : folders_(std::move(folders)),
      linked_(linked.begin(), linked.end()),
      status_(status),
      process_(std::move(process)) {}

const NativeRegistry::Entry& NativeRegistry::find(const std::string& id, const std::string& version) {
    load();
    const auto found = entries_.find(id);
    if (found == entries_.end()) {
        std::string text =
            "no library offers native code for the effect '" + id + "'" + places_searched(folders_);
        text += did_you_mean(id, ids());
        for (const std::string& refusal : refusals_) text += "\n  refused: " + refusal;
        throw Error(ErrorKind::effect, text);
    }
    const std::vector<Entry>& entries = found->second;
    if (entries.size() > 1) {
        std::string text =
            "the effect '" + id + "' is offered by " + std::to_string(entries.size()) + " libraries:";
        for (const Entry& entry : entries) text += " " + entry.library->place() + ",";
        text.back() = ';';
        throw Error(ErrorKind::effect, text + " leave one of them in the plug-in folders");
    }
    const Entry& entry = entries.front();
    if (entry.effect.version != version)
        throw Error(ErrorKind::effect, entry.library->place() + ": the native code of '" + id +
                                           "' is version " + entry.effect.version +
                                           ", its effect.json is version " + version +
                                           "; install the two from one build");
    return entry;
}

std::vector<std::string> NativeRegistry::ids() {
    load();
    std::vector<std::string> ids;
    for (const auto& [id, entries] : entries_) ids.push_back(id);
    return ids;
}

void NativeRegistry::require_ends() {
    std::string first;
    for (const auto& [id, entries] : entries_)
        for (const Entry& entry : entries)
            if (const std::string fault = entry.library->take_end_fault(); first.empty()) first = fault;
    if (!first.empty()) throw Error(ErrorKind::effect, first);
}

void NativeRegistry::load() {
    if (loaded_) return;
    for (const fs::path& folder : folders_)
        if (!fs::is_directory(folder))
            throw Error(ErrorKind::usage, folder.string() + ": no such folder of plug-ins (" +
                                              spelled(Option::plugin_path) + ", AFTERSHADE_PLUGIN_PATH)");
    loaded_ = true;
    for (const StaticNativeLibrary& library : linked_) add(NativeLibrary::adopt(library));
    for (const fs::path& folder : folders_) load_folder(folder);
}

void NativeRegistry::load_folder(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.is_regular_file() && entry.path().extension() == ".so") files.push_back(entry.path());
    std::sort(files.begin(), files.end());  // messages do not depend on the file system's order
    for (const fs::path& file : files) {
        // A folder that is given twice, or a link to a file of another one, offers nothing twice.
        if (!loaded_files_.insert(fs::canonical(file)).second) continue;
        const StatusScope scope(status_, {"", file.string(), "load", {}});
        try {
            add(process_ ? NativeLibrary::open_in(process_, file) : NativeLibrary::open(file));
        } catch (const Error& error) {
            refusals_.emplace_back(error.what());
        }
    }
}

void NativeRegistry::add(const std::shared_ptr<NativeLibrary>& library) {
    for (const NativeLibrary::Effect& effect : library->effects())
        entries_[effect.id].push_back({library, effect});
}

std::vector<fs::path> native_search_path(std::vector<fs::path> given) {
    const char* variable = std::getenv("AFTERSHADE_PLUGIN_PATH");
    const std::string text = variable ? variable : "";
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find(':', begin), text.size());
        if (end > begin) given.emplace_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return given;
}

}  // namespace aftershade
