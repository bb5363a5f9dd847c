#include "framework/scene/gltf_document.h"

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/path_bounds.h"
#include "framework/scene/gltf_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

namespace aftershade::scene {

namespace fs = std::filesystem;

namespace {

// What tinygltf opens besides the file itself: buffers, and images before it hands them on.

bool file_exists(const std::string& path, void*) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

/// "a%20b" is "a b" (RFC 3986).
std::string without_percents(const std::string& uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned value = 0;
        const char *first = uri.data() + i + 1, *last = first + 2;
        if (uri[i] == '%' && i + 2 < uri.size() && std::from_chars(first, last, value, 16).ptr == last) {
            text += char(value);
            i += 2;
        } else {
            text += uri[i];
        }
    }
    return text;
}

/// tinygltf 2.7 takes a plus sign for a blank, which URIs of files do not mean (RFC 3986). Where the loader
/// goes on with a file of such a name, read_files_with_plus_signs() reads the right one. The loader refuses
/// plus signs in names of folders, and a buffer if a file with blanks beside it has another size.
std::string with_plus_signs(const std::string& path, void*) {
    if (file_exists(path, nullptr) || path.find(' ') == path.npos) return path;
    const fs::path wanted(path);
    std::error_code fault;
    for (fs::directory_iterator at(wanted.parent_path(), fault), end; !fault && at != end;
         at.increment(fault)) {
        std::string name = at->path().filename().string();
        std::replace(name.begin(), name.end(), '+', ' ');
        if (name == wanted.filename().string()) return at->path().string();
    }
    return path;
}

/// `folder` is the mesh's own: what it names may not bring other files into a scene.
bool read_whole_file(std::vector<unsigned char>* bytes, std::string* error, const std::string& path,
                     void* folder) {
    std::string fault = out_of_bounds(path, *static_cast<const std::string*>(folder));
    const std::string text = fault.empty() ? read_regular_file(path, kMaxGltfBytes, fault) : "";
    if (!fault.empty()) fault = path + ": " + fault;
    bytes->assign(text.begin(), text.end());
    if (!fault.empty() && error) *error += fault;
    return fault.empty();
}

bool refuse_to_write(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
}

/// From 2.9 on the loader asks for a file's size first; read_whole_file() bounds it.
[[maybe_unused]] bool file_size(std::size_t* bytes, std::string* error, const std::string& path, void*) {
    std::error_code fault;
    *bytes = std::size_t(fs::file_size(path, fault));
    if (fault && error) *error += fault.message();
    return !fault;
}

/// A template, for what this version of tinygltf does not have.
template <typename Callbacks>
Callbacks callbacks_in(std::string& folder) {
    Callbacks callbacks{};
    callbacks.FileExists = file_exists;
    callbacks.ExpandFilePath = with_plus_signs;
    callbacks.ReadWholeFile = read_whole_file;
    callbacks.WriteWholeFile = refuse_to_write;
    if constexpr (requires { callbacks.GetFileSizeInBytes; }) callbacks.GetFileSizeInBytes = file_size;
    callbacks.user_data = &folder;
    return callbacks;
}

/// Without `keeps` images are left. Those of bufferViews always are, whose bounds tinygltf does not check.
bool take_image(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes,
                int size, void* keeps) {
    if (keeps && image->bufferView == -1) image->image.assign(bytes, bytes + size);
    return true;
}

/// One line, as our messages are.
std::string one_line(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text.substr(0, 400);
}

std::string folder_of(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path().string() : ".";
}

/// The files that URIs with plus signs name, in place of what the loader found.
void read_files_with_plus_signs(tinygltf::Model& model, const fs::path& path, bool keeps_images) {
    std::string folder = folder_of(path);
    const auto read = [&](const std::string& uri, std::vector<unsigned char>& bytes) {
        std::string fault;
        if (!uri.starts_with("data:") && uri.find('+') != uri.npos)
            read_whole_file(&bytes, &fault, folder + "/" + without_percents(uri), &folder);
        return fault;
    };
    for (tinygltf::Buffer& buffer : model.buffers) {
        const std::size_t bytes = buffer.data.size();
        if (const std::string fault = read(buffer.uri, buffer.data); !fault.empty()) fail_gltf(path, fault);
        if (buffer.data.size() < bytes)
            fail_gltf(path, fmt::format("{} has {} bytes, its byteLength is {}", buffer.uri,
                                        buffer.data.size(), bytes));
    }
    // An image that is not there is a fault of the material that needs it.
    for (tinygltf::Image& image : model.images)
        if (keeps_images && image.bufferView == -1) read(image.uri, image.image);
}

/// Extensions that change how the geometry is stored or placed, and that are not read.
void check_extensions(const fs::path& path, const tinygltf::Model& model) {
    for (const std::string& name : model.extensionsRequired) {
        const bool harmless = name == "KHR_mesh_quantization" || name == "KHR_lights_punctual" ||
                              name.starts_with("KHR_materials_") || name.starts_with("KHR_texture_") ||
                              name.starts_with("EXT_texture_");
        if (!harmless)
            fail_gltf(path,
                      fmt::format("needs the extension '{}', which is not read: export without it", name));
    }
}

}  // namespace

void fail_gltf(const fs::path& path, const std::string& what) {
    throw Error(ErrorKind::usage, path.string() + ": " + what);
}

tinygltf::Model load_gltf(const fs::path& path, bool keeps_images) {
    std::string fault;
    const std::string text = read_regular_file(path, kMaxGltfBytes, fault);
    const std::span bytes(reinterpret_cast<const unsigned char*>(text.data()), text.size());
    if (fault.empty()) fault = check_gltf_bytes(bytes);
    if (!fault.empty()) fail_gltf(path, fault);
    const bool binary = is_binary_gltf(bytes);

    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(take_image, keeps_images ? &keeps_images : nullptr);
    std::string folder = folder_of(path);
    loader.SetFsCallbacks(callbacks_in<tinygltf::FsCallbacks>(folder));
    const unsigned size = unsigned(bytes.size());
    tinygltf::Model model;
    std::string error;
    std::string warning;
    bool read = false;
    try {
        read = binary ? loader.LoadBinaryFromMemory(&model, &error, &warning, bytes.data(), size, folder)
                      : loader.LoadASCIIFromString(&model, &error, &warning, text.data(), size, folder);
    } catch (const std::exception& exception) {
        error += exception.what();
    }
    if (!read) fail_gltf(path, "cannot be read as glTF: " + one_line(error));
    if (!model.asset.version.starts_with("2."))
        fail_gltf(path, fmt::format("is glTF of version '{}', 2.0 is read", model.asset.version));
    check_extensions(path, model);
    read_files_with_plus_signs(model, path, keeps_images);
    return model;
}

std::string gltf_file_fault(const fs::path& path, const std::string& uri) {
    std::string folder = folder_of(path), fault;
    std::vector<unsigned char> unused;
    const std::string file = folder + "/" + without_percents(uri);
    const bool read = read_whole_file(&unused, &fault, file, &folder);
    const std::string remedy = R"( (put it there, or give the object a "material" of the scene))";
    if (read && unused.empty()) return file + " is empty" + remedy;
    if (read) return file + " is there, but the URI is not escaped; write % as %25";
    return file_exists(file, nullptr) ? fault : fault + remedy;
}

}  // namespace aftershade::scene
