#include "framework/render/history_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <type_traits>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/base/text.h"

namespace aftershade {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::string_view kMagic = "aftershade-history 1";

template <typename T>
void append(std::vector<std::byte>& bytes, const std::vector<T>& values) {
    static_assert(sizeof(T) == 4 && std::is_trivially_copyable_v<T>);
    const std::size_t at = bytes.size();
    bytes.resize(at + values.size() * sizeof(T));
    std::memcpy(bytes.data() + at, values.data(), values.size() * sizeof(T));
}

std::size_t values_of_level(const gpu::TextureDesc& desc, int level) {
    const auto side = [&](int pixels) { return std::size_t(std::max(1, pixels >> level)); };
    return side(desc.width) * side(desc.height) * std::size_t(gpu::channel_count(desc.format));
}

std::size_t bytes_of_texture(const gpu::TextureDesc& desc) {
    std::size_t count = 0;
    for (int level = 0; level < desc.mips; ++level) count += values_of_level(desc, level);
    return count * std::size_t(desc.layers) * 4;
}

SavedResource read_texture(const gpu::Texture& texture) {
    SavedResource saved{texture.desc(), {}};
    for (int level = 0; level < saved.desc.mips; ++level)
        for (int layer = 0; layer < saved.desc.layers; ++layer) {
            if (gpu::is_integer(saved.desc.format)) append(saved.bytes, texture.read_uints(level, layer));
            else append(saved.bytes, texture.read_floats(level, layer));
        }
    return saved;
}

template <typename T>
void upload_texture(gpu::Texture& texture, const SavedResource& saved) {
    const std::byte* at = saved.bytes.data();
    for (int level = 0; level < saved.desc.mips; ++level)
        for (int layer = 0; layer < saved.desc.layers; ++layer) {
            std::vector<T> values(values_of_level(saved.desc, level));
            std::memcpy(values.data(), at, values.size() * sizeof(T));
            at += values.size() * sizeof(T);
            texture.upload(std::span<const T>(values), layer, level);
        }
}

json camera_json(const Camera& camera) {
    json result = {{"values", camera.values()}, {"lens_model", camera.lens_model}};
    if (camera.camera_from_world) result["camera_from_world"] = *camera.camera_from_world;
    if (camera.ndc_from_world) result["ndc_from_world"] = *camera.ndc_from_world;
    if (camera.jitter_px) result["jitter_px"] = *camera.jitter_px;
    return result;
}

Camera camera_of(const json& document) {
    Camera camera;
    for (const auto& [name, value] : document.at("values").items()) camera.set(name, value.get<double>());
    camera.lens_model = document.at("lens_model").get<std::string>();
    const auto read = [&](const char* key, auto& value) {
        if (document.contains(key)) document.at(key).get_to(value.emplace());
    };
    read("camera_from_world", camera.camera_from_world);
    read("ndc_from_world", camera.ndc_from_world);
    read("jitter_px", camera.jitter_px);
    return camera;
}

json describe(const SavedHistory& history) {
    const Window& w = history.window;
    json resources = json::array();
    for (const auto& [name, saved] : history.resources) {
        const gpu::TextureDesc& desc = saved.desc;
        json entry = {{"name", name}, {"bytes", saved.bytes.size()}};
        if (desc.width > 0)
            entry["texture"] = {{"width", desc.width},
                                {"height", desc.height},
                                {"layers", desc.layers},
                                {"mips", desc.mips},
                                {"format", gpu::texture_format_name(desc.format)}};
        resources.push_back(entry);
    }
    return {{"look", history.look},
            {"fingerprint", history.fingerprint},
            {"frame", history.frame},
            {"window", {w.min_x, w.min_y, w.max_x, w.max_y}},
            {"camera", camera_json(history.camera)},
            {"resources", resources}};
}

void apply(const json& document, SavedHistory& history) {
    history.look = document.at("look").get<std::string>();
    history.fingerprint = document.value("fingerprint", "");
    history.frame = document.at("frame").get<int>();
    const auto window = document.at("window").get<std::array<int, 4>>();
    history.window = {window[0], window[1], window[2], window[3]};
    history.camera = camera_of(document.at("camera"));
}

/// Reads the resources that `document` describes; false where the file is too short or its sum is wrong.
bool read_resources(std::istream& in, std::uintmax_t file_bytes, const json& document, std::uint64_t sum,
                    SavedHistory& history) {
    for (const json& entry : document.at("resources")) {
        SavedResource saved;
        const auto bytes = entry.at("bytes").get<std::uint64_t>();
        if (bytes > file_bytes) return false;
        if (entry.contains("texture")) {
            const json& texture = entry.at("texture");
            const auto format = gpu::parse_texture_format(texture.at("format").get<std::string>());
            if (!format) return false;
            saved.desc = {texture.at("width").get<int>(), texture.at("height").get<int>(), *format,
                          texture.at("layers").get<int>(), texture.at("mips").get<int>()};
            const auto fits = [](int value) { return value >= 1 && value <= 65536; };
            if (!fits(saved.desc.width) || !fits(saved.desc.height) || !fits(saved.desc.layers) ||
                saved.desc.mips < 1 || saved.desc.mips > 17 || bytes_of_texture(saved.desc) != bytes)
                return false;
        }
        saved.bytes.resize(bytes);
        in.read(reinterpret_cast<char*>(saved.bytes.data()), std::streamsize(bytes));
        if (!in) return false;
        sum = fnv1a(saved.bytes, sum);
        history.resources[entry.at("name").get<std::string>()] = std::move(saved);
    }
    std::uint64_t stored = 0;
    in.read(reinterpret_cast<char*>(&stored), sizeof stored);
    return in && stored == sum && in.peek() == std::istream::traits_type::eof();
}

std::string source_text(const InputSource& source, const Pipeline& pipeline) {
    const std::string step = source.step < 0 ? "capture" : pipeline.steps[std::size_t(source.step)].name;
    return step + "." + source.output;
}

}  // namespace

void SavedHistory::take_from(const graph::Executor::History& history) {
    for (const auto& [name, texture] : history.textures) resources[name] = read_texture(*texture);
    for (const auto& [name, buffer] : history.buffers) resources[name] = {{}, buffer->read()};
}

std::string SavedHistory::give_to(const graph::Executor::History& history) const {
    for (const auto& [name, texture] : history.textures) {
        const auto saved = resources.find(name);
        if (saved == resources.end() || !(saved->second.desc == texture->desc())) return name;
        if (gpu::is_integer(texture->desc().format)) upload_texture<std::uint32_t>(*texture, saved->second);
        else upload_texture<float>(*texture, saved->second);
    }
    for (const auto& [name, buffer] : history.buffers) {
        const auto saved = resources.find(name);
        if (saved == resources.end() || saved->second.bytes.size() != buffer->size()) return name;
        buffer->write(saved->second.bytes);
    }
    return "";
}

std::string history_identity(const Pipeline& pipeline) {
    std::string text;
    for (const PipelineStep& step : pipeline.steps) {
        text += "step " + step.name + ": effect " + step.manifest->id + " " + step.manifest->version + "\n";
        for (const auto& [input, source] : step.inputs)
            text += step.name + "." + input + " takes " + source_text(source, pipeline) + "\n";
        for (const auto& [name, value] : step.values)
            text += step.name + "." + name + " = " + format_source(value) + "\n";
        text += step.name + ".mix = " + format_source(step.mix) + (step.mask ? ", masked\n" : "\n");
    }
    return text;
}

std::string difference_of_identities(const std::string& saved, const std::string& now) {
    std::istringstream saved_lines(saved), now_lines(now);
    for (;;) {
        std::string a, b;
        const bool has_a = bool(std::getline(saved_lines, a)), has_b = bool(std::getline(now_lines, b));
        if (!has_a && !has_b) return "";
        if (a != b || has_a != has_b)
            return "saved: " + (has_a ? a : "nothing more") + "; now: " + (has_b ? b : "nothing more");
    }
}

std::string window_text(const Window& window) {
    return std::to_string(window.width()) + "x" + std::to_string(window.height()) + " at (" +
           std::to_string(window.min_x) + ", " + std::to_string(window.min_y) + ")";
}

void write_history(const fs::path& path, const SavedHistory& history) {
    AtomicFile file(path);
    errno = 0;
    std::ofstream out(file.temporary_path(), std::ios::binary);
    const std::string head = describe(history).dump();
    out << kMagic << "\n" << head << "\n";
    std::uint64_t sum = fnv1a(head);
    for (const auto& [name, saved] : history.resources) {
        out.write(reinterpret_cast<const char*>(saved.bytes.data()), std::streamsize(saved.bytes.size()));
        sum = fnv1a(saved.bytes, sum);
    }
    out.write(reinterpret_cast<const char*>(&sum), sizeof sum);
    out.close();
    if (!out)
        throw Error(ErrorKind::output,
                    path.string() + ": cannot be written: " + std::strerror(errno ? errno : EIO));
    file.commit();
}

SavedHistory read_history(const fs::path& path) {
    const auto refuse = [&](const std::string& why) {
        return Error(ErrorKind::usage, path.string() + ": " + why);
    };
    std::error_code failure;
    // A pipe would wait for a writer.
    if (fs::exists(path, failure) && !fs::is_regular_file(path, failure))
        throw refuse("this history is not a regular file");
    const std::uintmax_t file_bytes = fs::file_size(path, failure);
    std::ifstream in(path, std::ios::binary);
    if (failure || !in) throw refuse("this history cannot be read");
    std::string magic, head;
    std::getline(in, magic);
    if (magic != kMagic) throw refuse("this is not a history file of " + spelled(Option::history_out));
    std::getline(in, head);
    SavedHistory history;
    history.path = path;
    try {
        const json document = json::parse(head);
        apply(document, history);
        const std::uint64_t sum = fnv1a(head);
        if (!read_resources(in, file_bytes, document, sum, history))
            throw refuse("this history is damaged; write it again with " + spelled(Option::history_out));
    } catch (const json::exception&) {
        throw refuse("this history is damaged; write it again with " + spelled(Option::history_out));
    }
    return history;
}

}  // namespace aftershade
