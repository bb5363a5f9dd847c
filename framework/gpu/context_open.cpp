// Which backend a context gets, and whether it works.
#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "framework/base/error.h"
#include "framework/base/memory_limit.h"
#include "framework/base/text.h"
#include "framework/gpu/commands.h"
#include "framework/gpu/context.h"
#include "framework/gpu/context_internal.h"
#include "framework/gpu/device.h"
#include "framework/gpu/fork_guard.h"
#include "framework/gpu/texture.h"

namespace aftershade::gpu {

namespace {

// Whether a fresh context renders at all.

constexpr std::array<float, 4> kColour = {-1.5F, 3.25F, 1e6F, 0.1F};

/// glsl/fullscreen.vert to the letter: most passes then find its machine code in the driver's cache.
constexpr const char* kVertex = R"(#version 450 core
// One triangle that covers the target; gl_FragCoord (0.5, 0.5) is texel (0, 0), the top left of the image.
out gl_PerVertex { vec4 gl_Position; };
void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(corner, 0.0, 1.0);
}
)";

/// All of kColour but alpha as literals: llvmpipe takes a millisecond to compile each further value of a
/// block.
std::string fragment_text() {
    return fmt::format(R"(#version 450 core
layout(std140, binding = 0) uniform Block {{ float alpha; }};
layout(location = 0) out vec4 result;
void main() {{ result = vec4({}, {}, {}, alpha) + vec4(gl_FragCoord.xy, 0.0, 0.0); }}
)",
                       kColour[0], kColour[1], kColour[2]);
}

constexpr int kWidth = 3, kHeight = 2;

/// What the shader writes to a channel of a texel; floats hold it exactly.
float expected(int x, int y, int channel) {
    const float place = channel == 0 ? float(x) + 0.5F : channel == 1 ? float(y) + 0.5F : 0.0F;
    return kColour[std::size_t(channel)] + place;
}

/// Draws a colour outside [0, 1] into a float framebuffer and reads it back. Throws Error with what came
/// instead.
void self_test(Context& context) {
    const auto vertex = std::make_shared<const Program>(Program::vertex(context, kVertex, "self-test"));
    Program program = Program::fragment(context, vertex, fragment_text(), "self-test");
    program.use_one_form();
    const Texture target(context, {.width = kWidth, .height = kHeight, .format = TextureFormat::rgba32f},
                         "self-test");
    Buffer block(context, 4 * sizeof(float), "self-test");
    const std::array<float, 4> alpha = {kColour[3]};
    block.write(std::as_bytes(std::span(alpha)));

    const Target targets[] = {{.texture = &target}};
    const BufferBinding uniforms[] = {{&block, 0}};
    draw(context, program, targets, {.uniforms = uniforms});
    const std::vector<float> got = target.read_floats();
    for (std::size_t i = 0; i < got.size(); ++i) {
        const int texel = int(i) / 4;
        if (got[i] == expected(texel % kWidth, texel / kWidth, int(i) % 4)) continue;
        throw Error(ErrorKind::gl,
                    fmt::format("self-test on {}: drew ({}) and the texel's place, read back ({})",
                                context.info().renderer, fmt::join(kColour, ", "), fmt::join(got, ", ")));
    }
}

constexpr std::array kBackends = {Backend::egl, Backend::egl_software, Backend::osmesa};
bool takes(Backend chosen, Backend candidate) {
    return chosen == candidate || chosen == Backend::automatic ||
           (chosen == Backend::software && candidate != Backend::egl);
}
/// What OpenGL must have of the address space. With less, Mesa 22.3 crashes, or waits for threads that it
/// could not start. Runs over one small frame were measured to take 260 to 280 MiB, most of it for LLVM.
constexpr std::uint64_t kContextBytes = 320ull * 1024 * 1024;

struct Reason {
    Backend backend = Backend::automatic;
    std::string text, advice;  ///< advice: of an absent library, "; install ..."
};

/// An Error that keeps its reasons apart, for probe_backends().
class Refusal : public Error {
public:
    /// `other` is a backend that works in place of those refused, so that nothing need be installed.
    Refusal(std::vector<Reason> reasons, std::optional<Backend> other)
        : Error(ErrorKind::gl, text(reasons, other)), reasons_(std::move(reasons)) {}
    const Reason& last() const { return reasons_.back(); }

private:
    static std::string text(std::span<const Reason> reasons, std::optional<Backend> other) {
        std::string result = "no usable GL";
        for (const Reason& reason : reasons)
            result += fmt::format("\n  {}: {}{}", backend_name(reason.backend), reason.text,
                                  other ? "" : reason.advice);
        if (other)
            result +=
                fmt::format("\n  '{}' works here and draws the same bits; '{}' takes whichever is there",
                            backend_name(*other), backend_name(Backend::software));
        return result;
    }

    std::vector<Reason> reasons_;
};

/// The other software backend, which draws the same bits, if it works here.
std::optional<Backend> other_software_backend(Backend refused) {
    if (refused != Backend::egl_software && refused != Backend::osmesa) return std::nullopt;
    const Backend other = refused == Backend::osmesa ? Backend::egl_software : Backend::osmesa;
    try {
        const Context::Impl context(other);
        return other;
    } catch (const Error&) {
        return std::nullopt;
    }
}

}  // namespace

std::vector<BackendReport> probe_backends() {
    std::vector<BackendReport> reports;
    std::vector<std::string> advice;
    for (Backend backend : kBackends) {
        BackendReport& report = reports.emplace_back();
        report.backend = backend;
        advice.emplace_back();
        try {
            report.info = Context(backend).info();
            report.usable = true;
        } catch (const Refusal& refusal) {
            report.reason = refusal.last().text;
            advice.back() = refusal.last().advice;
        }
    }
    Context::Impl::release_current();
    const bool has_software = std::ranges::any_of(
        reports, [](const BackendReport& report) { return report.usable && report.info.software; });
    for (std::size_t i = 0; i < reports.size(); ++i)
        if (!advice[i].empty())
            reports[i].reason += has_software && reports[i].backend != Backend::egl
                                     ? "; not needed, the other software backend draws the same bits"
                                     : advice[i];
    return reports;
}

Context::Context(const SharedEglContext& shared) {
    require_not_forked();
    require_address_space(kContextBytes, "OpenGL");
    impl_ = std::make_unique<Impl>(shared);
    self_test(*this);
}

Context::Context(SiblingOf other) {
    require_not_forked();
    Context::Impl::release_current();
    const Impl& sibling = *other.context.impl_;
    impl_ = std::make_unique<Impl>(sibling, sibling.platform->sibling());
}

Context::Context(const GlChoice& choice, SelfTest when) {
    const Backend backend = choice.backend;
    const bool is_named = names_one_device(choice.device);
    require_not_forked();
    // Mesa does not check every allocation: better refused here than a crash in there.
    require_address_space(kContextBytes, "OpenGL");
    std::vector<Reason> reasons;
    for (Backend candidate : kBackends) {
        if (!takes(backend, candidate)) continue;
        try {
            impl_ = std::make_unique<Impl>(GlChoice(candidate, choice.device));
            impl_->is_untested = true;
            if (when == SelfTest::now || backend == Backend::automatic || !impl_->info.software) test_once();
            if (backend == Backend::automatic && !reasons.empty() && impl_->info.software && !is_named)
                impl_->info.hardware_fault =
                    fmt::format("{}: {}", backend_name(reasons.front().backend), reasons.front().text);
            return;
        } catch (const Error& error) {
            impl_.reset();
            if (error.kind() == ErrorKind::memory || error.kind() == ErrorKind::usage) throw;
            const auto* absent = dynamic_cast<const AbsentLibrary*>(&error);
            reasons.push_back({candidate, error.what(), absent ? absent->advice() : ""});
        }
    }
    throw Refusal(std::move(reasons), is_named ? std::nullopt : other_software_backend(backend));
}

void Context::test_once() {
    if (!impl_->is_untested) return;
    impl_->is_untested = false;  // it draws
    try {
        self_test(*this);
    } catch (...) {
        impl_->is_untested = true;
        throw;
    }
}

bool Context::zeroes_new_textures() {
    if (!impl_->info.software) return false;
    if (!impl_->zeroes_textures) {
        // Small enough that the allocator gives what the first one had to the second one.
        const TextureDesc desc{.width = 32, .height = 32, .format = TextureFormat::rgba32f};
        const std::vector<float> ones(std::size_t(4 * desc.width * desc.height), 1.0F);
        Texture(*this, desc, "ones").upload(ones);
        finish();
        const std::vector<float> found = Texture(*this, desc, "new").read_floats();
        impl_->zeroes_textures = std::ranges::all_of(found, [](float value) { return value == 0; });
    }
    return *impl_->zeroes_textures;
}

}  // namespace aftershade::gpu
