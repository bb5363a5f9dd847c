#include "framework/look/starting_looks.h"

#include <algorithm>
#include <system_error>

#include "framework/document/document.h"
#include "framework/look/look.h"

namespace aftershade {

std::vector<StartingLook> find_starting_looks(const std::filesystem::path& folder, EffectRegistry& effects,
                                              const CaptureHeader& header) {
    std::vector<StartingLook> looks;
    std::error_code absent;
    for (const auto& entry : std::filesystem::directory_iterator(folder, absent)) {
        if (entry.path().extension() != ".json") continue;
        Diagnostics faults;
        const auto document = read_document(entry.path(), faults);
        const auto look = document ? parse_look(*document, faults) : std::nullopt;
        if (!look) continue;
        const Pipeline pipeline = bind_pipeline(*look, effects, {}, faults);
        if (faults.has_errors()) continue;
        const Node* summary = document->find("summary");
        looks.push_back({entry.path(), summary ? summary->string : "", find_missing_roles(pipeline, header)});
    }
    std::ranges::sort(looks, [](const StartingLook& a, const StartingLook& b) {
        return a.missing.empty() != b.missing.empty() ? a.missing.empty() : a.file < b.file;
    });
    return looks;
}

}  // namespace aftershade
