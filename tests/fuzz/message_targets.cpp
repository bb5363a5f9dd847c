// What runs leave for each other, and what other processes send.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "framework/base/atomic_file.h"
#include "framework/base/text.h"
#include "framework/effect/native/native_wire.h"
#include "framework/render/history_file.h"
#include "framework/run/journal.h"
#include "framework/serve/http_message.h"
#include "framework/serve/look_edits.h"
#include "tests/fuzz/target_checks.h"

namespace aftershade::fuzz {

namespace {

/// The first line describes resources, the rest are their bytes; the checksum is right.
void history(std::string_view bytes) {
    const std::size_t line = std::min(bytes.find('\n'), bytes.size());
    const std::string_view head = bytes.substr(0, line);
    const std::string_view resources = bytes.substr(std::min(line + 1, bytes.size()));
    const std::uint64_t sum = fnv1a(std::as_bytes(std::span(resources)), fnv1a(head));
    std::string file = "aftershade-history 1\n";
    file.append(head).append("\n").append(resources).append(reinterpret_cast<const char*>(&sum), sizeof sum);
    const fs::path path = file_of("in.history", file);
    refused_or_read([&] { read_history(path); });
}

void journal(std::string_view bytes) {
    const RunState state = run_state((work_folder() / "run/out_####.exr").string());
    fs::create_directories(state.state_folder());
    file_of("run/.aftershade/journal.jsonl", bytes);
    const std::vector<fs::path> expected{work_folder() / "run/out_0001.exr"};
    const Journal read(state);
    if (const JournalFrame* frame = read.find(1)) {
        read.setup(frame->setup);
        // No frame was rendered here.
        if (read.fault_of_files(*frame, expected).empty()) broken("a frame without its files is not current");
    }
}

/// What the process of a plug-in answers may be the plug-in's own.
void plugin(std::string_view bytes) {
    const auto refused = [](const auto& take) {
        try {
            take();
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::effect) broken("a plug-in is at fault, and nothing else");
        }
    };
    refused([&] {
        WireReader in(bytes);
        take_declaration(in);
        in.expect_end();
    });
    refused([&] {
        WireReader in(bytes);
        const NativeResult result = take_result(in);
        in.expect_end();
        WireWriter out;
        put(out, result);
        WireReader again(out.bytes());
        take_result(again);
        again.expect_end();
    });
    refused([&] {
        WireReader in(bytes);
        WireFrame frame;
        take_frame(in, frame);
        in.expect_end();
    });
}

/// As a connection gets its bytes: in pieces of this size.
std::optional<serve::Request> arrived(std::string_view bytes, std::size_t piece, bool& is_refused) {
    serve::Incoming incoming;
    for (; !bytes.empty() && !is_refused && !incoming.is_whole();
         bytes.remove_prefix(std::min(piece, bytes.size()))) {
        const auto refusal = incoming.add(bytes.substr(0, piece));
        if (refusal && refusal->status < 400) broken("a refusal is one");
        is_refused = refusal.has_value();
    }
    return incoming.is_whole() ? std::optional(incoming.take()) : std::nullopt;
}

void http(std::string_view bytes) {
    bool is_refused = false, is_refused_in_pieces = false;
    const auto request = arrived(bytes, std::max<std::size_t>(bytes.size(), 1), is_refused);
    const auto in_pieces = arrived(bytes, bytes.size() / 3 + 1, is_refused_in_pieces);
    if (is_refused != is_refused_in_pieces || request.has_value() != in_pieces.has_value())
        broken("how the bytes are divided decides nothing");
    if (!request) return;
    if (request->body.size() > serve::kMaxBodyBytes) broken("a body is no larger than it may be");
    if (request->path != in_pieces->path || request->body != in_pieces->body)
        broken("how the bytes are divided changes nothing");
    serve::response_bytes(serve::error_response(404, request->path));
}

/// A list of edits, one after the other, of one look.
void edit(std::string_view bytes) {
    using Json = nlohmann::ordered_json;
    constexpr int kDeepest = 80;  // the page server refuses what is nested deeper
    int depth = 0;
    const Json edits = Json::parse(
        bytes,
        [&](int level, Json::parse_event_t, Json&) {
            depth = std::max(depth, level);
            return level <= kDeepest;
        },
        false);
    if (depth > kDeepest || !edits.is_array()) return;
    const auto is_document = [](const std::string& text) {
        Diagnostics faults;
        return text.size() <= kMaxDocumentBytes && parse_document(text, "look.json", faults);
    };
    static const std::string look = read_text_file(kSources / "tests/schema/look.json", ErrorKind::usage);
    std::string text = look;
    for (const Json& each : edits)
        refused_or_read([&] {
            const bool was_document = is_document(text);
            text = serve::edited(text, each);
            // The whole text may be anything, and values may nest too deep together.
            const bool may_be_faulty = each.value("op", "") == "text" || depth > 50;
            if (was_document && !may_be_faulty && text.size() <= kMaxDocumentBytes && !is_document(text))
                broken("what an edit makes of a look is a document");
        });
}

constexpr Target kMessageTargets[] = {
    {"history", "in.history", history}, {"journal", "journal.jsonl", journal}, {"plugin", "in.bin", plugin},
    {"http", "in.http", http},          {"edit", "edits.json", edit},
};

}  // namespace

std::span<const Target> message_targets() {
    return kMessageTargets;
}

}  // namespace aftershade::fuzz
