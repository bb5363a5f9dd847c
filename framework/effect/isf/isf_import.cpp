// A folder of an effect from an ISF file.
#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

#include "framework/base/atomic_file.h"
#include "framework/base/path_bounds.h"
#include "framework/base/text.h"
#include "framework/effect/isf/isf_effect.h"
#include "framework/effect/isf/isf_file.h"
#include "framework/effect/isf/isf_nodes.h"
#include "framework/effect/manifest/manifest_reader.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

Json as_json(const Node& node) {
    switch (node.kind) {
        case Node::Kind::null: return nullptr;
        case Node::Kind::boolean: return node.boolean;
        case Node::Kind::integer: return node.integer;
        case Node::Kind::number: return node.number;
        case Node::Kind::string: return node.string;
        case Node::Kind::array: {
            Json list = Json::array();
            for (const Node& item : node.items) list.push_back(as_json(item));
            return list;
        }
        case Node::Kind::object: break;
    }
    Json object = Json::object();
    for (const Member& member : node.members) object[member.key] = as_json(member.value);
    return object;
}

constexpr std::uintmax_t kMaxPictureBytes = 1u << 30;

}  // namespace

std::string json_of(const Node& node) {
    return as_json(node).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::vector<fs::path> import_isf(const fs::path& path, const fs::path& folder, IsfSpace space,
                                 Diagnostics& diagnostics) {
    const auto file = read_isf(path, diagnostics);
    if (!file) return {};
    const fs::path from = path.parent_path();
    const std::string id = folder.filename().string();
    const IsfEffect effect = effect_of_isf(*file, id, space);
    if (!parse_manifest(effect.manifest, from, diagnostics, {}, ForeignEffect{path, effect.shaders}))
        return {};
    std::set<std::string> copies{path.filename().string()};
    if (!file->vertex_file.empty()) copies.insert(file->vertex_file);
    for (const auto& [name, text] : effect.shaders) copies.erase(name);
    for (const IsfImport& import : file->imports) copies.insert(import.path);
    for (const std::string& name : copies)
        if (const std::string why = out_of_bounds(from / name, from); !why.empty())
            diagnostics.error({path.string()}, (from / name).string() + " " + why);
    if (diagnostics.has_errors()) return {};
    AtomicFolder made(folder);
    std::vector<fs::path> files;
    const auto write = [&](const std::string& name, const std::string& text) {
        fs::create_directories((made.temporary_path() / name).parent_path());
        write_text_file(made.temporary_path() / name, text);
        files.push_back(folder / name);
    };
    write("effect.json", json_of(effect.manifest));
    for (const auto& [name, text] : effect.shaders) write(name, text);
    for (const std::string& name : copies)
        write(name, read_text_file(from / name, ErrorKind::usage, kMaxPictureBytes));
    made.commit();
    return files;
}

}  // namespace aftershade
