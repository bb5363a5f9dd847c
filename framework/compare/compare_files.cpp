#include "framework/compare/compare_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>

#include "framework/base/error.h"
#include "framework/compare/layer_pairs.h"
#include "framework/image/window.h"

namespace aftershade {

namespace {

namespace fs = std::filesystem;

constexpr float kNothingHit = std::numeric_limits<float>::infinity();

Window intersection(const Window& a, const Window& b) {
    return {std::max(a.min_x, b.min_x), std::max(a.min_y, b.min_y), std::min(a.max_x, b.max_x),
            std::min(a.max_y, b.max_y)};
}

bool is_empty(const Window& window) {
    return window.width() <= 0 || window.height() <= 0;
}

std::uint64_t area(const Window& window) {
    return is_empty(window) ? 0 : std::uint64_t(window.width()) * std::uint64_t(window.height());
}

std::string text_of(const Window& window) {
    return fmt::format("{} x {} px from ({}, {})", window.width(), window.height(), window.min_x,
                       window.min_y);
}

std::set<std::string> parts_of(const LayerFile& file) {
    std::set<std::string> parts;
    for (const LayerInfo& layer : file.layers()) parts.insert(layer.part);
    return parts;
}

class FileComparison {
public:
    FileComparison(const LayerFile& reference, const LayerFile& test, const CompareRules& rules,
                   const LayerVisitor& visit, Comparison& result)
        : reference_(reference), test_(test), rules_(rules), visit_(visit), result_(result) {}

    void run() {
        check_labels();
        check_areas();
        check_traits();
        const std::vector<const LayerInfo*> pairs = paired_layers(reference_.layers(), test_.layers());
        std::vector<const LayerInfo*> ours, theirs;  // without a pair
        for (std::size_t i = 0; i < pairs.size(); ++i)
            if (!pairs[i]) ours.push_back(&reference_.layers()[i]);
        for (const LayerInfo& layer : test_.layers())
            if (std::ranges::find(pairs, &layer) == pairs.end()) theirs.push_back(&layer);
        name_parts(reference_, ours, test_, "reference");
        name_parts(test_, theirs, reference_, "test image");
        reference_.prefetch();
        test_.prefetch();
        for (std::size_t i = 0; i < pairs.size(); ++i)
            if (pairs[i]) compare(reference_.layers()[i], *pairs[i]);
        for (const LayerInfo* layer : ours) miss(reference_, *layer, "reference");
        for (const LayerInfo* layer : theirs) miss(test_, *layer, "test image");
        if (result_.layers.empty() && result_.faults.empty())
            fault("there is no layer to compare: the roles leave none");
    }

private:
    void fault(std::string text) {
        result_.verdict = std::max(result_.verdict, Verdict::different_size);
        result_.faults.push_back(std::move(text));
    }

    void warn(std::string text) {
        result_.verdict = std::max(result_.verdict, Verdict::warning);
        result_.warnings.push_back(std::move(text));
    }

    void check_traits() {
        const FileTraits &ours = reference_.traits(), &theirs = test_.traits();
        for (const auto& [traits, where] : {std::pair{&ours, "the reference"}, {&theirs, "the test image"}}) {
            for (const std::string& what : traits->left_out)
                warn(fmt::format("not compared: {} in {}", what, where));
            for (const std::string& note : traits->notes) result_.notes.push_back(where + (": " + note));
        }
        for (const CompareArea& area : rules_.areas)
            if (!area.shape.note.empty()) result_.notes.push_back(area.shape.note);
        if (ours.pixel_aspect != theirs.pixel_aspect)
            warn(fmt::format("another pixel aspect: {:.6g} in the reference, {:.6g} in the test image",
                             ours.pixel_aspect, theirs.pixel_aspect));
        if (ours.first_view != theirs.first_view && !ours.first_view.empty() && !theirs.first_view.empty())
            warn(fmt::format(
                "the same names are other views: the first is '{}' in the reference, '{}' in the test "
                "image",
                ours.first_view, theirs.first_view));
        check_objects();
        const auto is_color = [](const LayerInfo& layer) { return is_perceptual(layer.role); };
        if (reference_.format() != test_.format() || ours.colors == theirs.colors ||
            std::ranges::none_of(reference_.layers(), is_color))
            return;
        warn(fmt::format("the same numbers are other colours: {} in the reference, {} in the test image",
                         ours.colors, theirs.colors));
    }

    /// Equal ids in the pixels are other objects where the manifests say so.
    void check_objects() {
        for (const auto& [matte, ours] : reference_.traits().objects) {
            const auto theirs = test_.traits().objects.find(matte);
            if (theirs == test_.traits().objects.end()) continue;
            std::string first;
            int renamed = 0;
            for (const auto& [id, names] : ours) {
                const auto other = theirs->second.find(id);
                if (other == theirs->second.end() || other->second == names || renamed++ > 0) continue;
                first = fmt::format("{:08x} is '{}' in the reference, '{}' in the test image", id,
                                    *names.begin(), *other->second.begin());
            }
            if (renamed > 0)
                warn(fmt::format("the manifests of the Cryptomatte '{}' give {} other names: {}", matte,
                                 renamed == 1 ? "one id" : fmt::format("{} ids", renamed), first));
        }
    }

    /// An area that is nowhere would be left out of nothing, unseen.
    void check_areas() {
        if (reference_.layers().empty()) return;
        for (const CompareArea& area : rules_.areas)
            if (std::string why = fault_of(area, reference_.layers().front().display_window); !why.empty())
                fault(std::move(why));
    }

    void check_labels() {
        std::set<std::string> labels;
        for (const LayerFile* file : {&reference_, &test_})
            for (const LayerInfo& layer : file->layers()) labels.insert(layer.label());
        result_.labels = {labels.begin(), labels.end()};
        for (const auto& [label, role] : rules_.roles)
            if (!labels.contains(label)) result_.unknown_roles.push_back(label);
        for (const auto& [label, levels] : rules_.layers)
            if (!labels.contains(label)) result_.unknown_layers.push_back(label);
    }

    bool is_ignored(const std::string& label) const {
        const auto role = rules_.roles.find(label);
        return role != rules_.roles.end() && !role->second;
    }

    void miss(const LayerFile& file, const LayerInfo& layer, const char* where) {
        if (is_ignored(layer.label())) return result_.ignored.push_back(layer.label());
        if (!missing_parts_.contains(layer.part))
            fault(fmt::format("layer '{}' is only in the {}", layer.label(), where));
        // For the verdict: that a file is damaged says more than that it lacks a layer.
        file.read(layer, layer.channels);
    }

    /// The parts of which no layer has a pair, instead of each of their layers.
    void name_parts(const LayerFile& file, const std::vector<const LayerInfo*>& unpaired,
                    const LayerFile& other, const char* where) {
        for (const std::string& part : parts_of(file)) {
            const auto is_of = [&](const LayerInfo& layer) { return layer.part == part; };
            const auto alone =
                std::ranges::count_if(unpaired, [&](const LayerInfo* at) { return is_of(*at); });
            if (parts_of(other).contains(part) || alone != std::ranges::count_if(file.layers(), is_of))
                continue;
            missing_parts_.insert(part);
            fault(part.empty()
                      ? fmt::format("the {} has one part, the other has {}", where, parts_of(other).size())
                      : fmt::format("part '{}' is only in the {}", part, where));
        }
    }

    std::optional<LayerRole> role_of(const LayerInfo& reference, const LayerInfo& test) {
        const auto given = rules_.roles.find(label_of(reference, test));
        if (given != rules_.roles.end()) return given->second;
        if (reference.role == test.role) return reference.role;
        fault(
            fmt::format("layer '{}' is '{}' in the reference ({}), '{}' in the test image ({}); compare "
                        "like with like, or give it a role for both",
                        reference.label(), layer_role_name(reference.role), reference_.format(),
                        layer_role_name(test.role), test_.format()));
        return std::nullopt;
    }

    /// Names in the reference, and those of the same channels in the test image.
    struct CommonChannels {
        std::vector<std::string> reference, test;
    };
    CommonChannels common_channels(const LayerInfo& reference, const LayerInfo& test) {
        // Of layers with other names the channels' last words are held against each other.
        const auto name_of = [](const std::string& channel) {
            return channel.substr(channel.rfind('.') + 1);  // npos + 1 is 0
        };
        const auto find = [&](const LayerInfo& layer, const std::string& channel) {
            return std::ranges::find(layer.channels, name_of(channel), name_of);
        };
        CommonChannels common;
        for (const std::string& channel : reference.channels) {
            const auto same = find(test, channel);
            if (same == test.channels.end())
                fault(fmt::format("channel '{}' is only in the reference", channel));
            else common.reference.push_back(channel), common.test.push_back(*same);
        }
        for (const std::string& channel : test.channels)
            if (find(reference, channel) == reference.channels.end())
                fault(fmt::format("channel '{}' is only in the test image", channel));
        return common;
    }

    /// That of the reference, but where only the name in the test image has limits or a role of its own.
    std::string label_of(const LayerInfo& reference, const LayerInfo& test) const {
        const std::string ours = reference.label(), theirs = test.label();
        const auto has = [&](const std::string& label) {
            return rules_.roles.contains(label) || rules_.layers.contains(label);
        };
        return has(theirs) && !has(ours) ? theirs : ours;
    }

    void compare(const LayerInfo& reference, const LayerInfo& test) {
        const std::string label = label_of(reference, test);
        if (is_ignored(label)) return result_.ignored.push_back(label);
        const std::optional<LayerRole> role = role_of(reference, test);
        if (!role) return;
        LayerComparison comparison;
        comparison.label = label;
        comparison.role = *role;
        const CommonChannels common = common_channels(reference, test);
        comparison.channels = common.reference;
        if (comparison.channels.empty()) return;
        if (reference.type != test.type) {
            fault(fmt::format("layer '{}' holds {} in the reference, {} in the test image", comparison.label,
                              reference.type == ComponentType::uint32 ? "integers" : "floats",
                              test.type == ComponentType::uint32 ? "integers" : "floats"));
            return;
        }
        comparison.stored = reference.stored.coarser(test.stored);
        compare_windows(reference, test, comparison);
        LayerImages images;
        if (!is_empty(comparison.window)) {
            images.reference = read(reference_, reference, common.reference, comparison);
            images.test = read(test_, test, common.test, comparison);
            images.reference_primaries = reference_.traits().primaries;
            images.test_primaries = test_.traits().primaries;
            images.reference_display = reference_.traits().display;
            images.test_display = test_.traits().display;
            images.areas = pixel_areas(rules_.areas, comparison.window, reference.display_window,
                                       rules_.difference_rules(comparison.label));
            compare_layer(images, rules_, comparison);
            if (comparison.differences.pixels == 0)
                fault(fmt::format(
                    "layer '{}': every pixel is left out, so that nothing is compared; leave less "
                    "out, or the layer by its role 'ignore'",
                    comparison.label));
        } else {
            reference_.read(reference, comparison.channels);
            test_.read(test, common.test);
        }
        result_.verdict = std::max(result_.verdict, comparison.verdict);
        if (visit_) visit_(comparison, images);
        for (std::optional<FlipResult>* flip : {&comparison.ldr_flip, &comparison.hdr_flip})
            if (*flip) (*flip)->error = Image();
        comparison.ssim_map = Image();
        result_.layers.push_back(std::move(comparison));
    }

    Image read(const LayerFile& file, const LayerInfo& layer, const std::vector<std::string>& channels,
               const LayerComparison& comparison) const {
        const float outside = comparison.role == LayerRole::depth ? kNothingHit : 0;
        return place_in_window(file.read(layer, channels), layer.data_window, comparison.window, outside);
    }

    void compare_windows(const LayerInfo& reference, const LayerInfo& test, LayerComparison& comparison) {
        const auto say = [&](std::string reason) {
            comparison.verdict = Verdict::different_size;
            comparison.reasons.push_back(std::move(reason));
        };
        if (!(reference.display_window == test.display_window))
            say(fmt::format("different display window: {} in the reference, {} in the test image",
                            text_of(reference.display_window), text_of(test.display_window)));
        comparison.window = intersection(reference.data_window, test.data_window);
        const std::uint64_t common = area(comparison.window);
        comparison.absent_in_reference = area(test.data_window) - common;
        comparison.absent_in_test = area(reference.data_window) - common;
        if (reference.data_window == test.data_window) return;
        if (const auto both = hull(reference.data_window, test.data_window);
            rules_.fill_outside && both && reference.display_window == test.display_window) {
            comparison.window = *both;
            return;
        }
        say(fmt::format("different size: {} in the reference, {} in the test image",
                        text_of(reference.data_window), text_of(test.data_window)));
    }

    /// nullopt where it would be larger than a file may be.
    std::optional<Window> hull(const Window& a, const Window& b) const {
        const Window both = {std::min(a.min_x, b.min_x), std::min(a.min_y, b.min_y),
                             std::max(a.max_x, b.max_x), std::max(a.max_y, b.max_y)};
        const auto fits = [&](int first, int last) {
            return std::int64_t(last) - first < rules_.limits.max_side_px;
        };
        if (!fits(both.min_x, both.max_x) || !fits(both.min_y, both.max_y)) return std::nullopt;
        return both;
    }

    const LayerFile& reference_;
    const LayerFile& test_;
    const CompareRules& rules_;
    const LayerVisitor& visit_;
    Comparison& result_;
    std::set<std::string> missing_parts_;
};

std::optional<LayerFile> open(const fs::path& path, const CompareRules& rules, Comparison& result) {
    try {
        return LayerFile(path, rules.limits);
    } catch (const Error& error) {
        result.verdict = Verdict::file_error;
        result.faults.push_back(error.what());
        return std::nullopt;
    }
}

}  // namespace

Comparison compare_files(const fs::path& reference, const fs::path& test, const CompareRules& rules,
                         const LayerVisitor& visit) {
    Comparison result;
    result.reference = reference;
    result.test = test;
    const std::optional<LayerFile> first = open(reference, rules, result);
    const std::optional<LayerFile> second = open(test, rules, result);
    if (!first || !second) return result;
    try {
        FileComparison(*first, *second, rules, visit, result).run();
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::capture) throw;  // of the visitor
        result.verdict = Verdict::file_error;
        result.faults.push_back(error.what());
    }
    return result;
}

}  // namespace aftershade
