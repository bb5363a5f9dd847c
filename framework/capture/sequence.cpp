#include "framework/capture/sequence.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/base/text.h"
#include "framework/capture/capture_grammar.h"
#include "framework/document/document.h"
#include "framework/document/grammar_reader.h"
#include "framework/image/role.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

/// The paths in the pattern's folder as the pattern begins them: a path in normal form would not match the
/// text of "shots//f_####.exr".
std::vector<std::string> paths_beside(const FramePattern& pattern) {
    const std::string prefix = pattern.text().substr(0, pattern.text().rfind('/') + 1);
    std::vector<std::string> paths;
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(prefix.empty() ? "." : prefix, failure))
        paths.push_back(prefix + entry.path().filename().string());
    return paths;
}

/// A sequence is its numbers: a frame whose own file is not there is read from the one whose number is padded
/// in another way (998 to 1001, -0001), or whose extension is in another case. Throws
/// Error(ErrorKind::capture) where there are two of these, or where `padding_decides` is false and two files
/// have one number.
FramePattern pattern_on_disk(FramePattern pattern, bool padding_decides) {
    std::map<int, std::vector<std::string>> paths;
    for (const std::string& path : paths_beside(pattern))
        if (const auto frame = pattern.number_in(path)) paths[*frame].push_back(path);
    for (auto& [frame, found] : paths) {
        if (padding_decides && std::ranges::find(found, pattern.path(frame)) != found.end()) continue;
        std::ranges::sort(found);
        if (found.size() > 1)
            throw Error(ErrorKind::capture, "frame " + std::to_string(frame) + " is both " + found[0] +
                                                " and " + found[1] + "; move one of them away");
        if (found[0] != pattern.path(frame)) pattern.name_otherwise(frame, std::move(found[0]));
    }
    return pattern;
}

/// A file that has this very name, else what the marks in it stand for.
FramePattern file_or_pattern(const std::string& text) {
    std::error_code failure;
    return fs::is_regular_file(text, failure) ? FramePattern::of_file(text)
                                              : pattern_on_disk(FramePattern(text), true);
}

std::map<std::string, FramePattern> read_role_files(const grammar::Reader& reader, const fs::path& folder) {
    std::map<std::string, FramePattern> result;
    if (const Node* files = reader.find("files"))
        for (const Member& member : files->members)
            if (find_role(member.key) && member.value.is_string())
                result.insert_or_assign(member.key, file_or_pattern((folder / member.value.string).string()));
    return result;
}

LayerSource read_layer(const grammar::Reader& reader, const fs::path& folder) {
    LayerSource layer;
    layer.role_files = read_role_files(reader, folder);
    if (reader.has("frames")) layer.files = file_or_pattern((folder / reader.text("frames")).string());
    else if (const auto color = layer.role_files.find(kColorRole); color != layer.role_files.end())
        layer.files = color->second;
    if (const Node* channels = reader.find("channels")) layer.channels = read_decodings(*channels);
    for (const auto& [key, value] :
         {std::pair{"profile", &layer.profile}, {"view", &layer.view}, {"layer", &layer.layer}})
        if (reader.has(key)) *value = reader.text(key);
    if (reader.has("alpha")) layer.alpha_is_opaque = reader.text("alpha") == kOpaqueAlpha;
    layer.is_held_out = reader.boolean("holdout");
    return layer;
}

void read_frames(const grammar::Reader& reader, const fs::path& folder, Sequence& sequence,
                 Diagnostics& diagnostics) {
    sequence.role_files = read_role_files(reader, folder);
    // Without a main file the colour's own file takes its place.
    if (reader.has("frames")) sequence.files = file_or_pattern((folder / reader.text("frames")).string());
    else if (sequence.role_files.contains(kColorRole)) sequence.files = sequence.role_files.at(kColorRole);
    for (const grammar::Reader& layer : reader.objects("layers"))
        sequence.layers.push_back(read_layer(layer, folder));
    // Where each layer has files of its own, those in front stand for the capture's.
    if (sequence.files.text().empty() && !sequence.layers.empty() && sequence.layers.front().files)
        sequence.files = *sequence.layers.front().files;
    if (!reader.has("range")) return;
    const auto numbers = *parse_frame_range(reader.text("range"));
    if (numbers.size() > 1 && reader.has("frames") && !sequence.files.has_frame() &&
        sequence.role_files.empty())
        diagnostics.error(
            reader.place("range"),
            "'range' has " + std::to_string(numbers.size()) +
                " frames but 'frames' names one file; write the frame number as ####, %04d or @");
    else sequence.frames = numbers;
}

std::optional<Sequence> read_capture_document(const fs::path& path, Diagnostics& diagnostics) {
    const auto node = read_document(path, diagnostics);
    if (!node) return std::nullopt;
    if (node->find("steps") && !node->find("frames")) {
        diagnostics.error(node->place,
                          "is a look, and this place takes a capture; the look comes before the capture");
        return std::nullopt;
    }
    const int errors_before = diagnostics.error_count();
    grammar::check(*node, capture_block(), diagnostics);
    const grammar::Reader reader(*node, capture_block());
    Sequence sequence;
    read_frames(reader, path.parent_path(), sequence, diagnostics);
    sequence.fps = reader.number("fps");
    sequence.profile = reader.text("profile");
    sequence.view = reader.text("view");
    sequence.layer = reader.text("layer");
    sequence.color_space = reader.text("color_space");
    sequence.alpha_is_opaque = reader.text("alpha") == kOpaqueAlpha;
    if (const Node* channels = reader.find("channels")) sequence.channels = read_decodings(*channels);
    if (const auto camera = reader.object("camera")) sequence.camera = read_camera(*camera);
    if (reader.has("lights")) sequence.lights.emplace();
    for (const grammar::Reader& light : reader.objects("lights"))
        sequence.lights->push_back(read_light(light));
    if (const auto matte = reader.object("cryptomatte"))
        sequence.cryptomatte = CryptomatteChoice{matte->text("layer"), matte->texts("mask")};
    if (const Node* objects = reader.find("objects"))
        for (const Member& object : objects->members)
            sequence.objects[object.key] = std::uint32_t(object.value.integer);
    if (const Node* cuts = reader.find("cuts"))
        for (const Node& cut : cuts->items) sequence.cuts.push_back(int(cut.integer));
    sequence.subframes = int(reader.integer("subframes"));
    sequence.deep_layers = int(reader.integer("deep_layers"));
    if (diagnostics.error_count() > errors_before) return std::nullopt;
    return sequence;
}

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// "a." of "a.0998.exr" and of "a.-0001.exr", "film-" of "film-0001.exr": what stands before the last number.
std::size_t begin_of_number(const std::string& name, std::size_t last_digit) {
    std::size_t first = last_digit;
    while (first > 0 && is_digit(name[first - 1])) --first;
    const bool is_signed = first > 0 && name[first - 1] == '-' &&
                           (first == 1 || !std::isalnum(static_cast<unsigned char>(name[first - 2])));
    return is_signed ? first - 1 : first;
}

/// Files of one sequence: the marks that most of their numbers need, and how many they are.
struct FolderSequence {
    std::map<std::size_t, int> digits;
    std::map<std::string, int> extensions;
    int count = 0;

    std::string extension() const {
        return std::ranges::max_element(extensions, {}, [](const auto& one) { return one.second; })->first;
    }
};

/// The pattern that most *.exr files of a folder share: their names with the last group of digits left open.
FramePattern pattern_of_folder(const fs::path& folder, const std::string& argument,
                               Diagnostics& diagnostics) {
    std::map<std::pair<std::string, std::string>, FolderSequence> sequences;  // by what is around the number
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(folder, failure)) {
        const std::string name = entry.path().filename().string();
        const std::size_t last = entry.path().stem().string().find_last_of("0123456789");
        if (lower_case(entry.path().extension().string()) != ".exr" || last == std::string::npos ||
            name.starts_with('.'))
            continue;
        const std::size_t first = begin_of_number(name, last);
        const std::string extension = entry.path().extension().string();
        const std::string end = name.substr(last + 1, name.size() - last - 1 - extension.size());
        FolderSequence& found = sequences[{name.substr(0, first), end}];
        ++found.extensions[extension];
        ++found.count;
        ++found.digits[last + 1 - first];
    }
    if (sequences.empty())
        throw Error(ErrorKind::capture, folder.string() + ": holds no numbered .exr files");
    const auto most =
        std::ranges::max_element(sequences, {}, [](const auto& one) { return one.second.count; });
    // The fewest digits pad no number beyond what it has, but for numbers that are padded in several ways.
    const std::size_t width = most->second.digits.begin()->first;
    const std::string text = (folder / (most->first.first + (width == 1 ? "%d" : std::string(width, '#')) +
                                        most->first.second + most->second.extension()))
                                 .string();
    if (std::ranges::count(sequences, most->second.count, [](const auto& one) { return one.second.count; }) >
        1)
        throw Error(ErrorKind::capture,
                    folder.string() + ": holds several sequences; name one by its pattern, such as " + text);
    if (sequences.size() > 1) {
        const auto other = sequences.begin() == most ? std::next(most) : sequences.begin();
        diagnostics.warning(
            {argument}, "only " + fs::path(text).filename().string() + " of the folder is read, not " +
                            other->first.first + std::string(other->second.digits.begin()->first, '#') +
                            other->first.second + other->second.extension() + " (name a pattern to choose)");
    }
    return pattern_on_disk(FramePattern(text), false);
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

/// " (there is f.EXR)": of the same name in another case; "" for none.
std::string other_spelling_of(const fs::path& file) {
    std::error_code failure;
    const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
    for (const auto& entry : fs::directory_iterator(folder, failure))
        if (lower_case(entry.path().filename().string()) == lower_case(file.filename().string()))
            return " (there is " + entry.path().filename().string() + ")";
    return "";
}

void find_missing_range(Sequence& sequence, const std::string& argument) {
    sequence.frames_declared = !sequence.frames.empty() || !sequence.files.has_frame();
    if (!sequence.frames.empty()) return;
    if (sequence.files.has_frame()) {
        sequence.frames = whole_frames(find_frames(sequence.files), sequence.subframes);
        if (sequence.frames.empty())
            throw Error(ErrorKind::capture,
                        argument + ": no file fits the pattern " + sequence.files.text() +
                            (sequence.subframes > 1 ? ", or no frame has all its " +
                                                          std::to_string(sequence.subframes) + " sub-frames"
                                                    : ""));
        return;
    }
    const fs::path file = sequence.files.text();
    if (std::error_code failure; !fs::exists(file, failure))
        throw Error(ErrorKind::capture, file.string() + ": no such file" + other_spelling_of(file));
    sequence.frames = {frame_in_name(file.stem().string()).value_or(1)};
}

}  // namespace

std::vector<int> find_frames(const FramePattern& pattern) {
    std::vector<int> frames;
    for (const std::string& path : paths_beside(pattern))
        if (const auto frame = pattern.match(path)) frames.push_back(*frame);
    std::sort(frames.begin(), frames.end());
    return frames;
}

void require_some_file(const Sequence& sequence) {
    if (!sequence.files.has_frame() || !sequence.layers.empty()) return;
    const std::vector<int> there = find_frames(sequence.files);
    const auto is_there = [&](int frame) {
        const int first = sequence.file_number(frame), next = sequence.file_number(frame + 1);
        const auto found = std::ranges::lower_bound(there, first);
        return found != there.end() && *found < next;
    };
    if (std::ranges::none_of(sequence.frames, is_there))
        throw Error(ErrorKind::capture,
                    sequence.files.text() + ": no file of the frames " + format_frame_range(sequence.frames) +
                        " is there" + (there.empty() ? "" : "; there are " + format_frame_range(there)));
}

FrameGaps find_gaps(std::span<const int> frames) {
    constexpr std::int64_t kMost = 100'000;
    FrameGaps gaps;
    std::int64_t step = 0;
    for (std::size_t i = 1; i < frames.size(); ++i)
        step = std::gcd(step, std::int64_t(frames[i]) - frames[i - 1]);
    // Two frames alone say nothing of a step.
    if (frames.size() > 2) gaps.step = int(step);
    if (frames.size() < 2) return gaps;
    const std::int64_t span = std::int64_t(frames.back()) - frames.front();
    gaps.count = span / gaps.step + 1 - std::int64_t(frames.size());
    if (gaps.count == 0 || gaps.count > kMost) return gaps;
    for (std::int64_t frame = frames.front(); frame <= frames.back(); frame += gaps.step) {
        gaps.whole.push_back(int(frame));
        if (!std::ranges::binary_search(frames, int(frame))) gaps.missing.push_back(int(frame));
    }
    return gaps;
}

std::optional<fs::path> capture_document(const std::string& argument) {
    const fs::path path = argument;
    // A folder with a capture.json is that capture.
    if (std::error_code failure; fs::exists(path / "capture.json", failure)) return path / "capture.json";
    return path.extension() == ".json" ? std::optional(path) : std::nullopt;
}

std::optional<Sequence> open_sequence(const std::string& argument, Diagnostics& diagnostics) {
    Sequence sequence;
    if (const auto path = capture_document(argument)) {
        if (std::error_code failure; !fs::exists(*path, failure))
            throw Error(ErrorKind::capture, argument + ": no such file");
        auto read = read_capture_document(*path, diagnostics);
        if (!read) return std::nullopt;
        sequence = std::move(*read);
    } else if (std::error_code failure; fs::is_directory(argument, failure)) {
        sequence.files = pattern_of_folder(argument, argument, diagnostics);
    } else {
        sequence.files = file_or_pattern(argument);
    }
    find_missing_range(sequence, argument);
    sequence.whole = sequence.frames;
    return sequence;
}

Sequence sequence_of_layer(const Sequence& sequence, std::size_t index) {
    const LayerSource& layer = sequence.layers[index];
    Sequence own = sequence;
    own.layers.clear();
    if (layer.files || !layer.role_files.empty()) own.role_files = layer.role_files;
    if (layer.files) own.files = *layer.files;
    for (const auto& [role, decoding] : layer.channels) own.channels.insert_or_assign(role, decoding);
    own.profile = layer.profile.value_or(sequence.profile);
    own.view = layer.view.value_or(sequence.view);
    own.layer = layer.layer.value_or(sequence.layer);
    own.alpha_is_opaque = layer.alpha_is_opaque.value_or(sequence.alpha_is_opaque);
    return own;
}

std::vector<fs::path> files_of_sequence(const Sequence& sequence) {
    if (!sequence.layers.empty()) {
        std::vector<fs::path> files;
        for (std::size_t i = 0; i < sequence.layers.size(); ++i)
            std::ranges::move(files_of_sequence(sequence_of_layer(sequence, i)), std::back_inserter(files));
        return files;
    }
    std::set<int> numbers;
    for (const int frame : sequence.frames)
        for (int file = sequence.file_number(frame - 1); file < sequence.file_number(frame + 2); ++file)
            numbers.insert(file);
    std::vector<FramePattern> patterns;
    if (!sequence.files.text().empty()) patterns.push_back(sequence.files);
    for (const auto& [role, pattern] : sequence.role_files) patterns.push_back(pattern);
    std::vector<fs::path> files;
    for (const FramePattern& pattern : patterns) {
        if (!pattern.has_frame()) {
            files.emplace_back(pattern.text());
            continue;
        }
        std::set<int> all = numbers;
        for (const int number : find_frames(pattern)) all.insert(number);
        for (const int number : all) files.emplace_back(pattern.path(number));
    }
    return files;
}

void add_role_file(Sequence& sequence, const std::string& text, Diagnostics& diagnostics) {
    const Place place = option_place(Option::role, text);
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals + 1 == text.size())
        diagnostics.error(place, "expected role=file, such as depth=z.####.exr");
    else if (const std::string role = text.substr(0, equals); !find_role(role) || RoleId(role).layer() >= 0)
        diagnostics.error(place, "'" + role + "' is not a role" + did_you_mean(role, role_names()));
    else sequence.role_files.insert_or_assign(role, file_or_pattern(text.substr(equals + 1)));
}

}  // namespace aftershade
