// What a picture costs on its way to a renderer and back, in milliseconds of the caller's thread, least of
// some turns: directly and through mapped buffers, as floats and as halfs. Prints JSON.
//
//   transfer_bench BACKEND [WIDTHxHEIGHT ...]     (default: 1920x1080 3840x2160)
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/error.h"
#include "framework/gpu/texture.h"

namespace aftershade {
namespace {

constexpr int kTurns = 12;

double least_ms(const std::function<void()>& prepare, const std::function<void()>& work) {
    double least = std::numeric_limits<double>::infinity();
    for (int turn = 0; turn < kTurns; ++turn) {
        prepare();
        const auto start = std::chrono::steady_clock::now();
        work();
        const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
        if (turn > 0) least = std::min(least, took.count());
    }
    return least;
}

/// Numbers that are halfs, or that are none.
std::vector<float> picture(int width, int height, bool are_halfs) {
    std::vector<float> values(std::size_t(width) * std::size_t(height) * 4);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = float(i % 1021) / 64 + (are_halfs ? 0.0F : 0.1F);
    return values;
}

std::string figures(gpu::Context& context, int width, int height, bool are_halfs) {
    const std::vector<float> values = picture(width, height, are_halfs);
    const gpu::ReadAs as = are_halfs ? gpu::ReadAs::halfs : gpu::ReadAs::stored;
    std::vector<float> back(values.size());
    gpu::Texture texture(context, {.width = width, .height = height}, "picture");
    const auto idle = [&] { context.finish(); };
    const double call = least_ms(idle, [&] { texture.upload(values); });
    const double upload = least_ms(idle, [&] {
        texture.upload(values);
        context.finish();
    });
    const double read = least_ms(idle, [&] { texture.begin_read(4, as).finish(std::span(back)); });
    if (back != values) throw Error(ErrorKind::effect, "the picture came back as another one");
    // As frames of a run: each is collected when the next one was issued.
    std::optional<gpu::TexelRead> open;
    const double frame = least_ms([] {},
                                  [&] {
                                      texture.upload(values);
                                      gpu::TexelRead next = texture.begin_read(4, as);
                                      if (!context.info().maps_transfers) return next.finish(std::span(back));
                                      if (open) open->finish(std::span(back));
                                      open.emplace(std::move(next));
                                  });
    open.reset();
    char text[256];
    std::snprintf(text, sizeof text,
                  R"({"upload_call": %.3f, "upload": %.3f, "readback": %.3f, "overlapped_frame": %.3f})",
                  call, upload, read, frame);
    return text;
}

std::string figures(gpu::Backend backend, const char* way, int width, int height) {
    setenv("AFTERSHADE_TRANSFERS", way, 1);
    gpu::Context context(backend);
    return std::string("{\"floats\": ") + figures(context, width, height, false) +
           ", \"halfs\": " + figures(context, width, height, true) + "}";
}

}  // namespace
}  // namespace aftershade

int main(int count, char** words) try {
    using namespace aftershade;
    const auto backend = count > 1 ? gpu::parse_backend(words[1]) : std::nullopt;
    if (!backend) {
        std::fprintf(stderr, "transfer_bench: the first argument is a backend: %s\n",
                     gpu::backend_names().c_str());
        return 64;
    }
    std::vector<std::string> sizes(words + 2, words + count);
    if (sizes.empty()) sizes = {"1920x1080", "3840x2160"};
    std::string text;
    for (const std::string& size : sizes) {
        int width = 0, height = 0;
        if (std::sscanf(size.c_str(), "%dx%d", &width, &height) != 2 || width < 1 || height < 1) {
            std::fprintf(stderr, "transfer_bench: '%s' is not a size such as 1920x1080\n", size.c_str());
            return 64;
        }
        text += (text.empty() ? "" : ", ") + ("\"" + size + "\": {\"direct\": ") +
                figures(*backend, "direct", width, height) +
                ", \"mapped\": " + figures(*backend, "mapped", width, height) + "}";
    }
    std::printf("{%s}\n", text.c_str());
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "transfer_bench: %s\n", error.what());
    return 1;
}
