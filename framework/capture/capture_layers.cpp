// Captures of several pictures that lie behind one another: capture.json's "layers", and deep files.
#include <algorithm>
#include <cmath>
#include <utility>

#include "framework/base/error.h"
#include "framework/capture/capture_internal.h"
#include "framework/capture/layer_roles.h"
#include "framework/image/role.h"
#include "framework/image/window.h"

namespace aftershade {

namespace {

// Of what layers in front let through. Below it a held-out layer has too little left to divide by.
constexpr float kLeastLeft = 1.0f / 256;

std::string layer_text(std::size_t index) {
    return "layer " + std::to_string(index + 1);
}

std::string size_text(const Window& window) {
    return std::to_string(window.width()) + " x " + std::to_string(window.height()) + " px";
}

Window united(const Window& a, const Window& b) {
    return {std::min(a.min_x, b.min_x), std::min(a.min_y, b.min_y), std::max(a.max_x, b.max_x),
            std::max(a.max_y, b.max_y)};
}

void require_color(const CaptureHeader& header, std::size_t index) {
    if (std::ranges::find(header.roles, kColorRole) != header.roles.end()) return;
    throw Error(ErrorKind::capture,
                header.path.string() + ": " + layer_text(index) +
                    " has no color, whose alpha says what the layer covers (name its channels "
                    "under \"channels\" of the layer)");
}

void require_same_picture(const CaptureHeader& header, const CaptureHeader& front, std::size_t index) {
    if (header.display_window == front.display_window) return;
    throw Error(ErrorKind::capture,
                header.path.string() + ": " + layer_text(index) + " has a display window of " +
                    size_text(header.display_window) + ", but the first layer, " + front.path.string() +
                    ", has one of " + size_text(front.display_window) +
                    " (render the layers at one size; a crop keeps the whole picture's display "
                    "window)");
}

/// What the layers have together, under the first one's name.
CaptureHeader header_of(const std::vector<CaptureHeader>& layers) {
    CaptureHeader header = layers.front();
    header.layer_count = int(layers.size());
    header.layer_roles.clear();
    header.notes.clear();
    header.warnings.clear();
    header.differences.clear();
    header.keeps_alpha = std::ranges::all_of(layers, &CaptureHeader::keeps_alpha);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        require_color(layers[i], i);
        require_same_picture(layers[i], layers.front(), i);
        header.data_window = united(header.data_window, layers[i].data_window);
        for (const std::string& role : layers[i].roles) {
            header.layer_roles.push_back(RoleId::of_layer(int(i), role));
            if (std::ranges::find(header.roles, role) != header.roles.end()) continue;
            header.roles.push_back(role);
            header.role_channels[role] = layers[i].role_channels.at(role);
        }
        for (const std::string& note : layers[i].notes) header.notes.push_back(layer_text(i) + ": " + note);
        for (const std::string& warning : layers[i].warnings)
            header.warnings.push_back(layer_text(i) + ": " + warning);
        for (const std::string& difference : layers[i].differences)
            header.differences.push_back(layer_text(i) + ": " + difference);
        // No channel of one file is that of the whole picture.
        header.derived_roles.insert(layers[i].roles.begin(), layers[i].roles.end());
    }
    std::ranges::sort(header.roles);
    return header;
}

void fit(Capture& layer, const CaptureHeader& header) {
    for (auto& [role, image] : layer.images) {
        if (kind_of_role(role) == RoleKind::light && layer.header.primaries != header.primaries)
            convert_colors(image, conversion_matrix(layer.header.primaries, header.primaries));
        image = place_in_window(std::move(image), layer.header.data_window, header.data_window,
                                find_role(role)->outside);
    }
}

float alpha_of(const Capture& layer, std::size_t pixel) {
    return std::clamp(layer.images.at(kColorRole).floats()[pixel * 4 + 3], 0.0f, 1.0f);
}

/// Where nothing is left of a pixel, nothing is known of what was cut out.
void undo_holdout(Capture& layer, std::span<const float> left) {
    for (auto& [role, image] : layer.images) {
        if (!is_blended(kind_of_role(role))) continue;
        const std::size_t channels = std::size_t(image.channels());
        const std::span<float> values = image.floats();
        for (std::size_t i = 0; i < values.size(); ++i) {
            const float share = left[i / channels];
            values[i] = share >= kLeastLeft ? values[i] / share : 0;
        }
    }
}

/// By pixel, what the layers in front let through; after the last, what they all do.
std::vector<std::vector<float>> shares_left(std::span<const Capture> layers) {
    const Image& color = layers.front().images.at(kColorRole);
    std::vector<std::vector<float>> left = {
        std::vector<float>(std::size_t(color.width()) * std::size_t(color.height()), 1.0f)};
    for (const Capture& layer : layers) {
        left.push_back(left.back());
        for (std::size_t i = 0; i < left.back().size(); ++i) left.back()[i] *= 1 - alpha_of(layer, i);
    }
    return left;
}

Image blended(std::span<const Capture> layers, std::span<const std::vector<float>> left, const RoleId& role) {
    Image result;
    for (std::size_t k = 0; k < layers.size(); ++k) {
        const auto found = layers[k].images.find(role);
        if (found == layers[k].images.end()) continue;
        const Image& image = found->second;
        const std::size_t channels = std::size_t(image.channels());
        if (result.empty()) result = Image(image.width(), image.height(), image.channels());
        for (std::size_t i = 0; i < image.floats().size(); ++i) {
            const float share = left[k][i / channels];
            // What is hidden may be infinite.
            if (share > 0) result.floats()[i] += share * image.floats()[i];
        }
    }
    return result;
}

/// By pixel, of the layer that shows most; the nearest of equals.
Image picked(std::span<const Capture> layers, std::span<const std::vector<float>> left, const RoleId& role) {
    std::vector<std::pair<const Image*, std::size_t>> candidates;
    for (std::size_t k = 0; k < layers.size(); ++k)
        if (const auto found = layers[k].images.find(role); found != layers[k].images.end())
            candidates.emplace_back(&found->second, k);
    Image result = *candidates.front().first;
    const std::size_t channels = std::size_t(result.channels());
    for (std::size_t pixel = 0; pixel < left.front().size(); ++pixel) {
        const Image* shown = candidates.front().first;
        float most = -1;
        for (const auto& [image, k] : candidates)
            if (const float shows = left[k][pixel] - left[k + 1][pixel]; shows > most)
                most = shows, shown = image;
        if (shown == candidates.front().first) continue;
        for (std::size_t c = 0; c < channels; ++c) {
            if (result.type() == ComponentType::uint32)
                result.uints()[pixel * channels + c] = shown->uints()[pixel * channels + c];
            else result.floats()[pixel * channels + c] = shown->floats()[pixel * channels + c];
        }
    }
    return result;
}

/// Some layers as one picture.
std::map<RoleId, Image> put_over_one_another(std::span<const Capture> layers,
                                             const std::vector<RoleId>& roles) {
    std::map<RoleId, Image> images;
    const std::vector<std::vector<float>> left = shares_left(layers);
    for (const RoleId& role : roles) {
        const bool is_there =
            std::ranges::any_of(layers, [&](const Capture& layer) { return layer.images.contains(role); });
        if (!is_there) continue;
        images[role] =
            is_blended(kind_of_role(role)) ? blended(layers, left, role) : picked(layers, left, role);
    }
    return images;
}

}  // namespace

std::optional<Sequence> CaptureReader::front_layer() const {
    return sequence_.layers.empty() ? std::nullopt : std::optional(sequence_of_layer(sequence_, 0));
}

CaptureReader CaptureReader::layer_reader(const Sequence& own, std::size_t layer) const {
    if (!first_) return {own, profiles_, limits_, nullptr};
    std::call_once(first_->layers_once, [&] {
        for (std::size_t i = 0; i < sequence_.layers.size(); ++i)
            first_->layers.push_back(std::make_shared<FirstFrame>());
    });
    return {own, profiles_, limits_, first_->layers[layer]};
}

CaptureHeader CaptureReader::read_layered_header(int frame) const {
    std::vector<CaptureHeader> layers;
    for (std::size_t i = 0; i < sequence_.layers.size(); ++i) {
        const Sequence own = sequence_of_layer(sequence_, i);
        layers.push_back(layer_reader(own, i).read_header(frame));
    }
    return header_of(layers);
}

Capture CaptureReader::read_layered(int frame, std::span<const RoleId> roles) const {
    std::vector<RoleId> wanted = roles_of_any_layer(roles);
    if (std::ranges::find(wanted, kColorRole) == wanted.end()) wanted.emplace_back(kColorRole);
    std::vector<Capture> layers;
    std::vector<CaptureHeader> headers;
    for (std::size_t i = 0; i < sequence_.layers.size(); ++i) {
        const Sequence own = sequence_of_layer(sequence_, i);
        layers.push_back(layer_reader(own, i).read(frame, wanted));
        headers.push_back(layers.back().header);
    }
    Capture capture;
    capture.header = header_of(headers);
    capture.pixels_without_motion = layers.front().pixels_without_motion;
    capture.motion_from_camera = layers.front().motion_from_camera;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        capture.non_finite.merge(layers[i].non_finite);
        capture.pixels_below_albedo_floor += layers[i].pixels_below_albedo_floor;
        fit(layers[i], capture.header);
        if (sequence_.layers[i].is_held_out && i > 0)
            undo_holdout(layers[i], shares_left(std::span(layers).first(i)).back());
    }
    const std::size_t told = std::min(std::size_t(asked_layers(roles)), layers.size());
    capture.images = put_over_one_another(layers, roles_of_layer(roles, -1));
    for (std::size_t i = 0; i < told; ++i) {
        const bool is_last = i + 1 == told;
        const auto from = std::span<const Capture>(layers).subspan(i, is_last ? layers.size() - i : 1);
        for (auto& [role, image] : put_over_one_another(from, roles_of_layer(roles, int(i))))
            capture.images[RoleId::of_layer(int(i), role.name())] = std::move(image);
    }
    return capture;
}

bool CaptureReader::is_deep(const OpenFrame& open, const std::string& role) {
    const auto found = open.roles.find(role);
    if (found == open.roles.end() || found->second.channels.empty()) return false;
    for (const std::vector<std::string>& layer : found->second.channels)
        for (const std::string& channel : layer)
            if (!channel.empty()) return found->second.file->deep_part_of(channel) != nullptr;
    return false;
}

/// The deep part of color, else of depth.
DeepPart* CaptureReader::deep_picture(const OpenFrame& open) {
    for (const char* role : {kColorRole, kDepthRole}) {
        if (!is_deep(open, role)) continue;
        const RoleSource& source = open.roles.at(role);
        return source.file->deep_part_of(source.channels.front().front());
    }
    return nullptr;
}

void CaptureReader::read_deep_layers(OpenFrame& open, std::span<const RoleId> roles, Capture& capture) const {
    DeepPart* const picture = deep_picture(open);
    if (!picture) return;
    const int layers = open.header.layer_roles.empty() ? 0 : picture->layers();
    for (open.layer = 0; open.layer < layers; ++open.layer) {
        std::vector<RoleId> deep = roles_of_layer(roles, open.layer);
        std::erase_if(deep, [&](const RoleId& role) { return !is_deep(open, role.name()); });
        Capture of_layer;  // what is said of motion and alpha is said of the whole picture
        of_layer.header = open.header;
        read_images(open, deep, of_layer);
        for (auto& [role, image] : of_layer.images)
            capture.images[RoleId::of_layer(open.layer, role.name())] = std::move(image);
    }
    open.layer = -1;
    capture.deep = picture->reduction();
    if (const std::uint64_t nan = capture.deep->nan_pixels; nan > 0) {
        const auto width = std::size_t(picture->width());
        NonFinitePixels& found = capture.non_finite[kDepthRole];
        found.nan = std::size_t(nan);
        found.x = int(capture.deep->first_nan % width), found.y = int(capture.deep->first_nan / width);
    }
    capture.deep_layers = picture->layers();
}

}  // namespace aftershade
