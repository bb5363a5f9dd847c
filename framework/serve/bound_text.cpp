#include "framework/serve/bound_text.h"

#include <utility>

#include "framework/document/document.h"

namespace aftershade::serve {

std::shared_ptr<BoundText> bind_text(const std::string& text, const std::filesystem::path& path,
                                     const std::shared_ptr<EffectRegistry>& effects, Diagnostics& faults) {
    const auto node = parse_document(text, path.string(), faults);
    auto look = node ? parse_look(*node, faults) : std::nullopt;
    if (!look) return nullptr;
    auto bound = std::make_shared<BoundText>();
    bound->text = text;
    bound->effects = effects;
    bound->look = std::move(*look);
    bound->pipeline = bind_pipeline(bound->look, *effects, {}, faults);
    return bound;
}

}  // namespace aftershade::serve
