#include "framework/image/sequence.h"

#include <algorithm>

#include "framework/core/document.h"
#include "framework/core/error.h"
#include "framework/image/color_space.h"
#include "framework/image/role.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

std::vector<int> read_cuts(ObjectReader& reader, Diagnostics& diagnostics) {
    std::vector<int> cuts;
    const Node* list = reader.array("cuts");
    if (!list) return cuts;
    for (const Node& item : list->items) {
        if (item.kind == Node::Kind::integer) cuts.push_back(int(item.integer));
        else
            diagnostics.error(item.place,
                              "'cuts' holds frame numbers, not " + std::string(kind_name(item.kind)));
    }
    return cuts;
}

/// The role of a key of "files" or "channels", or a fault.
bool is_role(const std::string& name, const Place& place, Diagnostics& diagnostics) {
    if (find_role(name)) return true;
    diagnostics.error(place, "'" + name + "' is not a role" + did_you_mean(name, role_names()));
    return false;
}

void read_role_files(const Node& section, const fs::path& folder, Sequence& sequence,
                     Diagnostics& diagnostics) {
    for (const Member& member : section.members) {
        if (!is_role(member.key, member.key_place, diagnostics)) continue;
        if (member.value.is_string())
            sequence.role_files.insert_or_assign(member.key,
                                                 FramePattern((folder / member.value.string).string()));
        else diagnostics.error(member.value.place, "a file must be a string");
    }
}

void read_frames(ObjectReader& reader, const Node& node, const fs::path& folder, Sequence& sequence,
                 Diagnostics& diagnostics) {
    if (const Node* files = reader.object("files")) read_role_files(*files, folder, sequence, diagnostics);
    // Without a main file the colour's own file takes its place.
    const bool has_color_file = sequence.role_files.contains(kColorRole);
    const auto frames = reader.text(
        "frames", has_color_file ? ObjectReader::Presence::optional : ObjectReader::Presence::required);
    if (frames) sequence.files = FramePattern((folder / *frames).string());
    else if (has_color_file) sequence.files = sequence.role_files.at(kColorRole);
    const auto range = reader.text("range");
    if (!range) return;
    const auto numbers = parse_frame_range(*range);
    const Place place = node.find("range")->place;
    if (!numbers) diagnostics.error(place, "'" + *range + "' is not a frame range such as \"1-100x2,120\"");
    else if (numbers->size() > 1 && frames && !sequence.files.has_frame() && sequence.role_files.empty())
        diagnostics.error(
            place, "'range' has " + std::to_string(numbers->size()) +
                       " frames but 'frames' names one file; write the frame number as ####, %04d or @");
    else sequence.frames = *numbers;
}

CryptomatteChoice read_cryptomatte(const Node& node, Diagnostics& diagnostics) {
    ObjectReader reader(node, "'cryptomatte'", diagnostics);
    CryptomatteChoice choice;
    choice.layer = reader.text("layer").value_or("");
    choice.mask = reader.texts("mask");
    reader.finish();
    return choice;
}

std::optional<Sequence> read_capture_document(const fs::path& path, Diagnostics& diagnostics) {
    const auto node = read_document(path, diagnostics);
    if (!node) return std::nullopt;
    const int errors_before = diagnostics.error_count();

    ObjectReader reader(*node, "the capture", diagnostics);
    check_document_version(reader, *node, diagnostics);
    reader.text("$schema");
    Sequence sequence;
    read_frames(reader, *node, path.parent_path(), sequence, diagnostics);
    if (const auto fps = reader.number("fps")) {
        sequence.fps = *fps;
        if (*fps <= 0) diagnostics.error(node->find("fps")->place, "'fps' must be above 0");
    }
    sequence.profile = reader.text("profile").value_or("auto");
    sequence.view = reader.text("view").value_or("");
    std::vector<std::string> spaces = color_space_names();
    spaces.insert(spaces.begin(), "auto");
    sequence.color_space = reader.choice("color_space", spaces).value_or("auto");
    if (const Node* channels = reader.object("channels"))
        for (const Member& member : channels->members)
            if (is_role(member.key, member.key_place, diagnostics))
                sequence.channels[member.key] = parse_role_decoding(member.key, member.value, diagnostics);
    if (const Node* camera = reader.object("camera")) sequence.camera = parse_camera(*camera, diagnostics);
    if (const Node* lights = reader.array("lights")) sequence.lights = parse_lights(*lights, diagnostics);
    if (const Node* matte = reader.object("cryptomatte"))
        sequence.cryptomatte = read_cryptomatte(*matte, diagnostics);
    sequence.cuts = read_cuts(reader, diagnostics);
    if (const auto subframes = reader.integer("subframes")) {
        if (*subframes < 1 || *subframes > 1024)
            diagnostics.error(node->find("subframes")->place, "'subframes' must be from 1 to 1024");
        else sequence.subframes = int(*subframes);
    }
    reader.finish();
    if (diagnostics.error_count() > errors_before) return std::nullopt;
    return sequence;
}

/// The pattern that most *.exr files of a folder share: their names with the last group of digits left open.
FramePattern pattern_of_folder(const fs::path& folder) {
    std::map<std::string, int> counts;
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(folder, failure)) {
        const std::string name = entry.path().filename().string();
        const std::size_t last = entry.path().stem().string().find_last_of("0123456789");
        if (entry.path().extension() != ".exr" || last == std::string::npos || name.starts_with('.'))
            continue;
        std::size_t first = last;
        while (first > 0 && name[first - 1] >= '0' && name[first - 1] <= '9') --first;
        const std::size_t digits = last - first + 1;
        ++counts[name.substr(0, first) + (digits == 1 ? "%d" : std::string(digits, '#')) +
                 name.substr(last + 1)];
    }
    if (counts.empty()) throw Error(ExitCode::capture, folder.string() + ": holds no numbered .exr files");
    const auto most = std::max_element(counts.begin(), counts.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    if (std::count_if(counts.begin(), counts.end(), [&](const auto& c) { return c.second == most->second; }) >
        1)
        throw Error(ExitCode::capture, folder.string() +
                                           ": holds several sequences; name one by its pattern, such as " +
                                           (folder / most->first).string());
    return FramePattern((folder / most->first).string());
}

/// Frames all of whose sub-frames are among `files`, which are sorted.
std::vector<int> whole_frames(const std::vector<int>& files, int subframes) {
    if (subframes == 1) return files;
    std::map<int, int> counts;
    for (const int file : files) ++counts[(file < 0 ? file - subframes + 1 : file) / subframes];
    std::vector<int> frames;
    for (const auto& [frame, count] : counts)
        if (count == subframes) frames.push_back(frame);
    return frames;
}

void find_missing_range(Sequence& sequence, const std::string& argument) {
    sequence.frames_declared = !sequence.frames.empty() || !sequence.files.has_frame();
    if (!sequence.frames.empty()) return;
    if (sequence.files.has_frame()) {
        sequence.frames = whole_frames(find_frames(sequence.files), sequence.subframes);
        if (sequence.frames.empty())
            throw Error(ExitCode::capture,
                        argument + ": no file fits the pattern " + sequence.files.text() +
                            (sequence.subframes > 1 ? ", or no frame has all its " +
                                                          std::to_string(sequence.subframes) + " sub-frames"
                                                    : ""));
        return;
    }
    const fs::path file = sequence.files.text();
    if (std::error_code failure; !fs::exists(file, failure))
        throw Error(ExitCode::capture, file.string() + ": no such file");
    sequence.frames = {frame_in_name(file.stem().string()).value_or(1)};
}

}  // namespace

std::vector<int> find_frames(const FramePattern& pattern) {
    // As it is written: a path in normal form would not match the text of "shots//f_####.exr".
    const std::string prefix = pattern.text().substr(0, pattern.text().rfind('/') + 1);
    const fs::path folder = prefix.empty() ? "." : prefix;
    std::vector<int> frames;
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(folder, failure))
        if (const auto frame = pattern.match(prefix + entry.path().filename().string()))
            frames.push_back(*frame);
    std::sort(frames.begin(), frames.end());
    return frames;
}

std::optional<Sequence> open_sequence(const std::string& argument, Diagnostics& diagnostics) {
    fs::path path = argument;
    Sequence sequence;
    // A folder with a capture.json is that capture.
    if (std::error_code failure; fs::exists(path / "capture.json", failure)) path /= "capture.json";
    if (path.extension() == ".json") {
        if (std::error_code failure; !fs::exists(path, failure))
            throw Error(ExitCode::capture, argument + ": no such file");
        auto read = read_capture_document(path, diagnostics);
        if (!read) return std::nullopt;
        sequence = std::move(*read);
    } else if (std::error_code failure; fs::is_directory(path, failure)) {
        sequence.files = pattern_of_folder(path);
    } else {
        sequence.files = FramePattern(argument);
    }
    find_missing_range(sequence, argument);
    return sequence;
}

void add_role_file(Sequence& sequence, const std::string& text, Diagnostics& diagnostics) {
    const Place place{"--role " + text};
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals + 1 == text.size())
        diagnostics.error(place, "expected role=file, such as depth=z.####.exr");
    else if (is_role(text.substr(0, equals), place, diagnostics))
        sequence.role_files.insert_or_assign(text.substr(0, equals), FramePattern(text.substr(equals + 1)));
}

}  // namespace aftershade
