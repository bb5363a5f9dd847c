// What lensfun measured of a lens, as tables of where each pixel's light comes from and how much of it
// arrives.
#include <lensfun/lensfun.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "aftershade_plugin.h"

namespace {

constexpr double kDiagonalOfFullFrameMm = 43.266615;
// With so many along the longer side, a bend that moves a corner by a fiftieth of the width is linear between
// two nodes to 0.003 px of 1920, and a fall-off by two stops to a thousandth.
constexpr int kNodes = 257;

constexpr double kFilterRadiusPx = 2;     // of bend.frag
constexpr double kMostOverscanPx = 4096;  // that set_overscan takes

lfDatabase* database = nullptr;  // read once, by init, and only read after that

struct Settings {
    std::string lens;
    bool adds = true, bends = true, fringes = true, darkens = true;
    double focal_length_mm = 0, sensor_width_mm = 0, f_number = 0, focus_distance_m = 0, scale = 0;

    explicit Settings(const aftershade_frame& frame) {
        const aftershade_params* params = frame.params;
        const char *text = "", *direction = "add";
        params->get_enum(params, "lens", &text);
        params->get_enum(params, "direction", &direction);
        params->get_bool(params, "distortion", &bends);
        params->get_bool(params, "fringes", &fringes);
        params->get_bool(params, "fall_off", &darkens);
        params->get_float(params, "focal_length", &focal_length_mm);
        params->get_float(params, "sensor_width", &sensor_width_mm);
        params->get_float(params, "f_number", &f_number);
        params->get_float(params, "focus_distance", &focus_distance_m);
        params->get_float(params, "scale", &scale);
        if (!*text)
            if (const char* model = frame.metadata->get_text(frame.metadata, "lensModel")) text = model;
        lens = text;
        adds = std::string(direction) == "add";
    }
};

/// A lens may have been measured on several sensors. The best is the smallest that covers this one.
const lfLens& lens_named(const std::string& name, float crop) {
    const lfLens** const found = database->FindLenses(nullptr, nullptr, name.c_str());
    if (!found)
        throw std::runtime_error("lensfun has no lens '" + name +
                                 "'; lensfun.github.io/lenslist lists those that it has");
    constexpr float kSameCrop = 1.02f;  // sensors of one format differ by this much
    const auto is_better = [&](const lfLens& one, const lfLens& other) {
        const bool covers = one.CropFactor <= crop * kSameCrop;
        if (covers != (other.CropFactor <= crop * kSameCrop)) return covers;
        return covers == (one.CropFactor > other.CropFactor);
    };
    const lfLens* best = found[0];
    for (const lfLens* const* lens = found; *lens; ++lens)
        if (std::strcmp((*lens)->Model, found[0]->Model) == 0 && is_better(**lens, *best)) best = *lens;
    lf_free(found);
    return *best;
}

/// The nodes stand on pixel centres 0.5, 0.5 + spacing, ... of the display window.
struct Nodes {
    double spacing;
    int columns, rows;

    Nodes(int width, int height)
        : spacing(std::max(1.0, std::max(width, height) / double(kNodes - 1))),
          columns(int(std::ceil((width - 1) / spacing)) + 1),
          rows(int(std::ceil((height - 1) / spacing)) + 1) {}
};

class LensProfile {
public:
    explicit LensProfile(const aftershade_host* host) : host_(host) {
        instance_.struct_size = sizeof instance_;
        instance_.data = this;
        instance_.destroy = [](const aftershade_instance* self) {
            delete static_cast<LensProfile*>(self->data);
        };
        instance_.prepare = prepare;
    }
    const aftershade_instance* instance() const { return &instance_; }

private:
    static aftershade_status prepare(const aftershade_instance* self, const aftershade_frame* frame,
                                     const aftershade_output* output) noexcept try {
        static_cast<LensProfile*>(self->data)->fill(*frame, *output);
        return AFTERSHADE_OK;
    } catch (const std::exception& exception) {
        const aftershade_host* host = static_cast<LensProfile*>(self->data)->host_;
        host->set_error(host, exception.what());
        return AFTERSHADE_FAILED;
    }

    std::unique_ptr<lfModifier> modifier_of(const Settings& given, int width, int height) const {
        if (given.lens.empty()) {
            host_->log(host_, AFTERSHADE_LOG_WARNING,
                       "no lens, the picture stays as it is: set 'lens', or write lensModel into the "
                       "capture's file");
            return nullptr;
        }
        const double diagonal_mm = given.sensor_width_mm * std::hypot(1.0, double(height) / width);
        const auto crop = float(kDiagonalOfFullFrameMm / diagonal_mm);
        const lfLens& lens = lens_named(given.lens, crop);
        const int flags = (given.bends ? LF_MODIFY_DISTORTION : 0) | (given.fringes ? LF_MODIFY_TCA : 0) |
                          (given.darkens ? LF_MODIFY_VIGNETTING : 0) |
                          (given.scale != 1 ? LF_MODIFY_SCALE : 0);
        auto modifier = std::make_unique<lfModifier>(&lens, crop, width, height);
        modifier->Initialize(&lens, LF_PF_F32, float(given.focal_length_mm), float(given.f_number),
                             float(given.focus_distance_m), float(given.scale), lens.Type, flags, given.adds);
        return modifier;
    }

    void fill(const aftershade_frame& frame, const aftershade_output& output) const {
        const Settings given(frame);
        const int width = int(frame.display_width_px), height = int(frame.display_height_px);
        const Nodes nodes(width, height);
        const auto modifier = modifier_of(given, width, height);
        std::vector<std::array<float, 4>> red_blue, green_gain;
        double outside_px = 0;
        for (int row = 0; row < nodes.rows; ++row)
            for (int column = 0; column < nodes.columns; ++column) {
                const auto x = float(column * nodes.spacing), y = float(row * nodes.spacing);
                // Where red, green and blue come from; lensfun leaves these alone where nothing moves them.
                std::array<float, 6> from{x, y, x, y, x, y};
                std::array<float, 3> gain{1, 1, 1};
                if (modifier) {
                    modifier->ApplySubpixelGeometryDistortion(x, y, 1, 1, from.data());
                    modifier->ApplyColorModification(gain.data(), x, y, 1, 1, LF_CR_3(RED, GREEN, BLUE), 0);
                }
                for (std::size_t i = 0; i < from.size(); i += 2)
                    outside_px = std::max({outside_px, -double(from[i]), double(from[i]) - (width - 1),
                                           -double(from[i + 1]), double(from[i + 1]) - (height - 1)});
                red_blue.push_back({from[0] - x, from[1] - y, from[4] - x, from[5] - y});
                green_gain.push_back({from[2] - x, from[3] - y, gain[1], 0});
            }
        const auto spacing = float(nodes.spacing);
        output.set_float(&output, "spacing", &spacing, 1);
        const auto set = [&](const char* name, const std::vector<std::array<float, 4>>& table) {
            output.set_table(&output, name, AFTERSHADE_VEC4, std::uint32_t(nodes.columns),
                             std::uint32_t(nodes.rows), table.data(), table.size() * sizeof table[0]);
        };
        set("red_blue", red_blue);
        set("green_gain", green_gain);
        output.set_overscan(&output, int(std::min(std::ceil(outside_px) + kFilterRadiusPx, kMostOverscanPx)));
    }

    const aftershade_host* host_;
    aftershade_instance instance_{};
};

bool load_database(const aftershade_host* host) {
    database = new (std::nothrow) lfDatabase;
    if (database && database->Load() == LF_NO_ERROR) return true;
    host->set_error(host, "lensfun has no database here; install it, on Debian liblensfun-data-v1");
    return false;
}

const aftershade_factory kFactory = {
    sizeof(aftershade_factory), "lens_profile", "1.0.0",
    [](const aftershade_factory*, const aftershade_host* host, const char*) -> const aftershade_instance* {
        return (new LensProfile(host))->instance();
    }};

}  // namespace

const aftershade_library AFTERSHADE_LIBRARY_ENTRY = {
    .struct_size = sizeof(aftershade_library),
    .abi_major = AFTERSHADE_ABI_MAJOR,
    .abi_minor = AFTERSHADE_ABI_MINOR,
    .name = "lens_profile",
    .version = "1.0.0",
    .init = load_database,
    .deinit = [] { delete database; },
    .factory_count = 1,
    .get_factory = [](uint32_t) { return &kFactory; },
    .get_extension = nullptr,
    .contact = "the authors of Aftershade",
};
