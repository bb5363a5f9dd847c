// What the targets check inputs with, and where their files lie.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <string_view>

#include "framework/base/error.h"
#include "framework/document/document.h"
#include "tests/fuzz/targets.h"
#include "tests/temporary_folder.h"

namespace aftershade::fuzz {

namespace fs = std::filesystem;

inline const fs::path kSources = AFTERSHADE_SOURCE_DIR;

[[noreturn]] inline void broken(const char* promise) {
    std::fprintf(stderr, "broken promise: %s\n", promise);
    std::abort();
}

inline const fs::path& work_folder() {
    static const test::TemporaryFolder folder;
    return folder.path();
}

inline fs::path file_of(const char* name, std::string_view bytes) {
    fs::path path = work_folder() / name;
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
    return path;
}

/// Calls `read`; a refusal must be an Error with a message, and name no code that means our own fault.
template <class Read>
void refused_or_read(Read read) {
    try {
        read();
    } catch (const Error& error) {
        if (std::strlen(error.what()) == 0) broken("a refusal has a message");
        if (error.kind() != ErrorKind::capture && error.kind() != ErrorKind::usage)
            broken("a document or a file of the user is at fault, and nothing else");
    } catch (const std::bad_alloc&) {
        broken("sizes are limited before anything is allocated");
    }
}

/// Parses the document, and hands it on if it is JSON.
template <class Read>
void document(const char* name, std::string_view bytes, Read read) {
    Diagnostics faults;
    const fs::path file = file_of(name, bytes);
    const auto node = read_document(file, faults);
    if (!node && !faults.has_errors()) broken("what is not read has a fault");
    if (node) refused_or_read([&] { read(*node, file, faults); });
    for (const Diagnostic& fault : faults.all())
        if (fault.message.empty()) broken("a fault has a message");
}

// The targets of each file.
std::span<const Target> picture_targets();
std::span<const Target> document_targets();
std::span<const Target> message_targets();

}  // namespace aftershade::fuzz
