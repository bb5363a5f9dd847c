#include "framework/compare/layer_pairs.h"

#include <algorithm>
#include <set>
#include <string>
#include <string_view>

namespace aftershade {

namespace {

enum class Names { whole, within_parts };

/// The part's name without its view: "forward" of "forward_left".
std::string name_without_view(const LayerInfo& layer) {
    std::string base = layer.part;
    if (!base.ends_with(layer.view) || base.size() < layer.view.size() + 2) return base;
    base.resize(base.size() - layer.view.size());
    if (std::string_view("._-").find(base.back()) == std::string_view::npos) return layer.part;
    base.pop_back();
    return base;
}

/// What a file of one part may have before the last word of the layer's channels. A view's name stands before
/// the layer's or behind it.
std::set<std::string> prefixes_of(const LayerInfo& layer, Names names) {
    const auto joined = [](const std::string& a, const std::string& b) {
        return a.empty() || b.empty() ? a + b : a + "." + b;
    };
    std::set<std::string> prefixes;
    if (layer.part.empty() || !layer.name.empty() || names == Names::within_parts)
        prefixes.insert(layer.name);
    if (!layer.part.empty()) prefixes.insert(joined(layer.part, layer.name));
    if (layer.view.empty()) return prefixes;
    const std::string base = name_without_view(layer);
    for (const std::string& name : {layer.name, base, joined(base, layer.name)})
        prefixes.insert({joined(layer.view, name), joined(name, layer.view)});
    prefixes.insert(joined(base, layer.name));
    return prefixes;
}

/// What a file of one part may call the layer's channels.
std::set<std::string> names_of(const LayerInfo& layer, Names names) {
    std::vector<std::string> words;
    for (const std::string& channel : layer.channels)
        words.push_back(channel.substr(channel.rfind('.') + 1));  // npos + 1 is 0
    std::ranges::sort(words);
    std::set<std::string> result;
    for (const std::string& prefix : prefixes_of(layer, names)) {
        std::string all = prefix;
        for (const std::string& word : words) all += "\n" + word;
        result.insert(std::move(all));
    }
    return result;
}

bool have_common(const std::set<std::string>& a, const std::set<std::string>& b) {
    return std::ranges::any_of(a, [&](const std::string& name) { return b.contains(name); });
}

class Pairing {
public:
    Pairing(std::span<const LayerInfo> reference, std::span<const LayerInfo> test)
        : reference_(reference), test_(test), found_(reference.size(), nullptr) {}

    std::vector<const LayerInfo*> run() {
        for (std::size_t i = 0; i < reference_.size(); ++i) {
            const auto match = std::ranges::find(test_, reference_[i].key(), &LayerInfo::key);
            if (match != test_.end()) take(i, *match);
        }
        while (pair_by(Names::whole) || (one_has_one_part() && pair_by(Names::within_parts))) {
        }
        return found_;
    }

private:
    void take(std::size_t reference, const LayerInfo& test) {
        found_[reference] = &test;
        taken_.insert(&test);
    }

    bool one_has_one_part() const {
        const auto is_unnamed = [](const LayerInfo& layer) { return layer.part.empty(); };
        return std::ranges::all_of(reference_, is_unnamed) || std::ranges::all_of(test_, is_unnamed);
    }

    /// Only where no other layer fits on either side. Whether there was any.
    bool pair_by(Names names) {
        std::vector<std::vector<const LayerInfo*>> fitting(reference_.size());
        std::multiset<const LayerInfo*> wanted;
        for (std::size_t i = 0; i < reference_.size(); ++i) {
            if (found_[i]) continue;
            const std::set<std::string> ours = names_of(reference_[i], names);
            for (const LayerInfo& test : test_)
                if (!taken_.contains(&test) && have_common(ours, names_of(test, names)))
                    fitting[i].push_back(&test), wanted.insert(&test);
        }
        bool any = false;
        for (std::size_t i = 0; i < reference_.size(); ++i)
            if (fitting[i].size() == 1 && wanted.count(fitting[i].front()) == 1)
                take(i, *fitting[i].front()), any = true;
        return any;
    }

    std::span<const LayerInfo> reference_, test_;
    std::vector<const LayerInfo*> found_;
    std::set<const LayerInfo*> taken_;
};

}  // namespace

std::vector<const LayerInfo*> paired_layers(std::span<const LayerInfo> reference,
                                            std::span<const LayerInfo> test) {
    return Pairing(reference, test).run();
}

}  // namespace aftershade
