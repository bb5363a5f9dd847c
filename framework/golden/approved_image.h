// Approved images on disk: <case>.<output>.<frame>.exr, <case>.<output>.<frame>@<key>.exr for further
// renderers, and beside each a sidecar .json that records what made it.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "framework/compare/compare_files.h"
#include "framework/gpu/context.h"

namespace aftershade {

/// What a step gave, for one frame.
struct StepHashes {
    std::string step;
    std::map<std::string, std::string> outputs;  ///< hash of the pixels, by output
    bool operator==(const StepHashes&) const = default;
};

/// As a sidecar keeps it; hashes have 16 hexadecimal digits. Older sidecars have none of it.
struct CaseOrigin {
    std::map<std::string, std::string> files;   ///< hash, by name: "effects/bloom/tent.glsl"
    std::map<std::string, std::string> values;  ///< "bloom.radius": "40", as a document writes it
    std::vector<StepHashes> steps;              ///< in the look's order
    bool operator==(const CaseOrigin&) const = default;
};

/// Adds its keys to a sidecar: files, values, steps.
void add_origin(const CaseOrigin& origin, nlohmann::ordered_json& sidecar);
/// The keys of a sidecar, which may be hostile.
CaseOrigin origin_of(const nlohmann::ordered_json& sidecar);

/// The environment that pictures depend on besides the look and the capture. The same input gives the same
/// bits on one renderer, Mesa and LLVM, on every processor with the same instructions, by any maker.
struct GoldenEnvironment {
    std::string backend;   ///< software GL is one, whichever library opens it
    std::string renderer;  ///< GL_RENDERER
    std::string version;   ///< GL_VERSION
    std::string cpu;       ///< "model name" of /proc/cpuinfo
    bool software = false;
    /// The processor instructions that change bits of a software renderer, as in "x86-64 with FMA"; "" in
    /// older sidecars.
    std::string instructions = {};

    std::string mesa() const;  ///< "22.3.6"; "" of other drivers
    std::string llvm() const;  ///< "15.0.6"; "" where the renderer names none
    /// Names a renderer in files: "llvmpipe-22.3.6-x86-64-with-fma".
    std::string key() const;
    /// Bits must be the same.
    bool equals(const GoldenEnvironment& other) const { return difference(other).empty(); }
    /// Why bits may differ from those of `other`: "Mesa 25.0.7 instead of 22.3.6"; "" where they must not.
    std::string difference(const GoldenEnvironment& other) const;
};

GoldenEnvironment environment_of(const gpu::ContextInfo& info);
/// backend, renderer, version, mesa, llvm, cpu, instructions, software.
nlohmann::ordered_json json_of(const GoldenEnvironment& environment);

/// Hashes of a picture's sources; "" for an unknown one.
struct GoldenSources {
    std::string look;     ///< hash of the look, its effects and plug-ins (bound_case.h)
    std::string capture;  ///< hash of the capture's files and profiles (capture_hash.h)
    std::string program;  ///< version of Aftershade
};

/// The origin of an approved image. Older ones have renderer, version, cpu and backend only.
struct GoldenSidecar {
    GoldenEnvironment environment;
    std::string command;  ///< that approved it
    GoldenSources sources;
    std::string image_hash;     ///< of the image file's bytes: a sidecar of another image says nothing
    std::string approver = {};  ///< who approved it; "" where no one is named
    std::string approved = {};  ///< the day, UTC: "2025-03-14"; "" where it is not known
    CaseOrigin origin = {};
    std::string sha256 = {};  ///< of the image file, which a store has under that name; "" where none has
};

/// Why a sidecar that is there is not believed, and what that is worth.
struct SidecarFault {
    Verdict verdict = Verdict::warning;
    std::string text;  ///< names the file and the remedy
};

struct ApprovedImage {
    std::filesystem::path file;
    std::string key;                       ///< after the '@'; "" of the first
    std::optional<GoldenSidecar> sidecar;  ///< nullopt: absent, or at fault
    std::optional<SidecarFault> sidecar_fault{};
};

/// Approved images by one name ("lamps.color.0001"): that of `own` first (by sidecar, then by key), then the
/// one without a key, then the others by name.
std::vector<ApprovedImage> approved_images(const std::filesystem::path& folder, const std::string& name,
                                           const GoldenEnvironment& own);

/// The frame of a file name "<image_stem>.<frame>.exr" or "<image_stem>.<frame>@<key>.exr".
std::optional<int> approved_frame(const std::string& file_name, const std::string& image_stem);

std::filesystem::path sidecar_path(const std::filesystem::path& image);
/// The SHA-256 that a sidecar names, of an image in a store; "" where it names none, or cannot be read.
/// `fault` says why it cannot.
std::string stored_digest(const std::filesystem::path& folder, const std::string& sidecar,
                          std::string& fault);
std::string sidecar_text(const GoldenSidecar& sidecar);
/// FNV-1a of the file's bytes, 16 hexadecimal digits; "" where it cannot be read.
std::string file_hash(const std::filesystem::path& file);

}  // namespace aftershade
