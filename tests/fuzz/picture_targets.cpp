// Pictures, meshes and tables.
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "framework/capture/capture.h"
#include "framework/capture/profile.h"
#include "framework/file/exr_file.h"
#include "framework/file/hdr_file.h"
#include "framework/file/jpeg_file.h"
#include "framework/file/png_file.h"
#include "framework/image/lut.h"
#include "framework/image/role.h"
#include "framework/scene/gltf_model.h"
#include "tests/fuzz/target_checks.h"

namespace aftershade::fuzz {

namespace {

constexpr ReadLimits kSmall{.max_side_px = 1024, .max_image_bytes = 8 * 1024 * 1024};

void exr(std::string_view bytes) {
    const fs::path file = file_of("in.exr", bytes);
    refused_or_read([&] {
        const ExrFile exr_file(file, kSmall);
        for (std::size_t part = 0; part < exr_file.parts().size(); ++part)
            for (const ExrChannel& channel : exr_file.parts()[part].channels)
                refused_or_read([&] {
                    const std::vector<std::string> one{channel.name};
                    if (exr_file.parts()[part].is_deep()) exr_file.read_deep(int(part), one);
                    else exr_file.read_floats(int(part), one);
                });
    });
}

void capture_file(std::string_view bytes) {
    static const std::vector<Profile> profiles = [] {
        Diagnostics faults;
        return read_profiles(kSources / "profiles", faults);
    }();
    Sequence sequence;
    sequence.files = FramePattern::of_file(file_of("in.exr", bytes).string());
    sequence.cryptomatte = CryptomatteChoice{"", {}};
    for (const bool with_matte : {false, true}) {
        if (!with_matte) sequence.cryptomatte.reset();
        else sequence.cryptomatte = CryptomatteChoice{"", {"Cube"}};
        std::vector<RoleId> roles = role_ids(role_names());
        for (const char* role : {kColorRole, kDepthRole, kObjectIdRole})
            roles.push_back(RoleId::of_layer(2, role));
        refused_or_read([&] { CaptureReader(sequence, profiles, kSmall).read(1, roles); });
    }
}

void png(std::string_view bytes) {
    const fs::path file = file_of("in.png", bytes);
    refused_or_read([&] { read_png(file); });
}

void jpeg(std::string_view bytes) {
    const fs::path file = file_of("in.jpg", bytes);
    refused_or_read([&] { read_jpeg(file); });
}

void hdr(std::string_view bytes) {
    const fs::path file = file_of("in.hdr", bytes);
    refused_or_read([&] { read_hdr(file); });
}

void cube(std::string_view bytes) {
    Diagnostics faults;
    const auto lut = parse_lut(bytes, "in.cube", faults);
    if (lut.has_value() == faults.has_errors()) broken("a table is read, or has faults");
}

void gltf(std::string_view bytes) {
    const fs::path file = file_of(bytes.starts_with("glTF") ? "in.glb" : "in.gltf", bytes);
    refused_or_read([&] { scene::read_gltf_model(file); });
}

/// Three bytes say the size and the compression, the rest are the pixels' bits, halves and floats in turn.
void round_trip(std::string_view bytes) {
    if (bytes.size() < 3) return;
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i % bytes.size()]); };
    const int width = 1 + byte(0) % 40, height = 1 + byte(1) % 40;
    constexpr const char* kLossless[] = {"none", "rle", "zips", "zip", "piz"};
    Image image(width, height, 2);
    for (std::size_t i = 0; i < image.floats().size(); ++i) {
        const std::uint32_t bits = std::uint32_t(byte(3 + 4 * i)) | std::uint32_t(byte(4 + 4 * i)) << 8 |
                                   std::uint32_t(byte(5 + 4 * i)) << 16 |
                                   std::uint32_t(byte(6 + 4 * i)) << 24;
        std::memcpy(&image.floats()[i], &bits, sizeof bits);
    }
    const fs::path file = work_folder() / "out.exr";
    const std::vector<ExrOutputChannel> channels = {{"a", PixelType::float32, &image, 0},
                                                    {"b", PixelType::float32, &image, 1}};
    ExrWriteOptions options;
    options.data_window = {byte(2), -int(byte(2)), int(byte(2)) + width - 1, height - 1 - int(byte(2))};
    options.display_window = options.data_window;
    options.compression = kLossless[byte(2) % std::size(kLossless)];
    write_exr(file, channels, options);
    const Image read = ExrFile(file).read_floats(0, std::vector<std::string>{"a", "b"});
    if (read.floats().size_bytes() != image.floats().size_bytes() ||
        std::memcmp(read.floats().data(), image.floats().data(), image.floats().size_bytes()) != 0)
        broken("what is written is read to the bit");
}

constexpr Target kPictureTargets[] = {
    {"exr", "in.exr", exr},   {"capture_file", "in.exr", capture_file},
    {"png", "in.png", png},   {"hdr", "in.hdr", hdr},
    {"jpeg", "in.jpg", jpeg}, {"cube", "in.cube", cube},
    {"gltf", "in.glb", gltf}, {"round_trip", "in.bin", round_trip},
};

}  // namespace

std::span<const Target> picture_targets() {
    return kPictureTargets;
}

}  // namespace aftershade::fuzz
