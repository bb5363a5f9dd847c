#include "framework/file/frame_stream.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <span>
#include <utility>

#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/file/png_file.h"
#include "framework/file/quantized.h"

namespace aftershade {

namespace {

std::string standard_output() {
    return spelled(Option::output, "-");
}

template <class Unsigned>
std::string raw_bytes(const Image& display, int channels) {
    static_assert(std::endian::native == std::endian::little, "the formats of 16 bits are little-endian");
    std::string bytes(std::size_t(display.width()) * std::size_t(display.height()) * std::size_t(channels) *
                          sizeof(Unsigned),
                      '\0');
    char* to = bytes.data();
    for (int y = 0; y < display.height(); ++y)
        for (int x = 0; x < display.width(); ++x)
            for (int c = 0; c < channels; ++c, to += sizeof(Unsigned)) {
                const float value = c < display.channels() ? display.at(x, y, c) : 1.0f;
                const Unsigned number = quantized<Unsigned>(value);
                std::memcpy(to, &number, sizeof number);
            }
    return bytes;
}

std::string frame_bytes(StreamFormat format, const Image& display, const ColorEncoding& encoding,
                        const std::string& name) {
    switch (format) {
        case StreamFormat::rgb24: return raw_bytes<std::uint8_t>(display, 3);
        case StreamFormat::rgba: return raw_bytes<std::uint8_t>(display, 4);
        case StreamFormat::rgb48le: return raw_bytes<std::uint16_t>(display, 3);
        case StreamFormat::rgba64le: return raw_bytes<std::uint16_t>(display, 4);
        case StreamFormat::png: break;
    }
    return encode_png(name, display, {}, {.display = encoding, .bits = encoding.is_hdr() ? 16 : 8});
}

/// "24", "23.98", "30000/1001".
std::string rate_text(double frames_per_second) {
    const double whole = std::round(frames_per_second * 1.001);
    constexpr double kRounding = 0.001;  // 23.976 and 29.97 are how people write them
    const bool is_ntsc = frames_per_second != std::round(frames_per_second) &&
                         std::abs(whole / 1.001 - frames_per_second) < kRounding;
    return is_ntsc ? fmt::format("{:.0f}/1001", whole * 1000) : fmt::format("{}", frames_per_second);
}

}  // namespace

const std::vector<std::string>& stream_format_names() {
    static const std::vector<std::string> names{"rgb24", "rgba", "rgb48le", "rgba64le", "png"};
    return names;
}

std::optional<StreamFormat> find_stream_format(std::string_view name) {
    const auto& names = stream_format_names();
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == name) return StreamFormat(int(i));
    return std::nullopt;
}

std::string ffmpeg_input_options(StreamFormat format, int width, int height, double frames_per_second) {
    const std::string rate = rate_text(frames_per_second);
    if (format == StreamFormat::png) return "-f image2pipe -c:v png -framerate " + rate;
    return fmt::format("-f rawvideo -pixel_format {} -video_size {}x{} -framerate {}",
                       stream_format_names()[std::size_t(format)], width, height, rate);
}

FrameStream FrameStream::of_standard_output(StreamFormat format) {
    const std::string name = standard_output();
    if (isatty(STDOUT_FILENO))
        throw Error(ErrorKind::usage, name +
                                          ": standard output is a terminal, which cannot show frames; pipe "
                                          "them into a program or a file");
    std::fflush(stdout);
    Descriptor descriptor(fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
    if (descriptor.get() < 0 || dup2(STDERR_FILENO, STDOUT_FILENO) < 0)
        throw Error(ErrorKind::output, name + ": standard output cannot be used: " + std::strerror(errno));
    return into(std::move(descriptor), format, name);
}

FrameStream FrameStream::into(Descriptor pipe, StreamFormat format, std::string name) {
    std::signal(SIGPIPE, SIG_IGN);
    return {std::move(pipe), format, std::move(name)};
}

Error FrameStream::fault(const std::string& what) const {
    return {ErrorKind::output, name_ + ": " + what};
}

void FrameStream::write(int frame, const Image& display, const ColorEncoding& encoding) {
    if (width_ > 0 && (display.width() != width_ || display.height() != height_))
        throw fault(
            fmt::format("frame {} has {} x {} px, but the frames before it have {} x {}; "
                        "stream frames of one size, or write files",
                        frame, display.width(), display.height(), width_, height_));
    width_ = display.width();
    height_ = display.height();
    send(frame_bytes(format_, display, encoding, name_));
    ++frames_;
}

void FrameStream::send(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t sent = ::write(descriptor_.get(), bytes.data(), bytes.size());
        if (sent >= 0) bytes.remove_prefix(std::size_t(sent));
        else if (errno == EPIPE)
            throw fault(
                fmt::format("the program that reads the frames has ended, after {} whole {}; "
                            "its own messages have the reason",
                            frames_, frames_ == 1 ? "frame" : "frames"));
        else if (errno != EINTR)
            throw fault(
                (name_ == standard_output() ? "standard output" : "the program that reads the frames") +
                std::string(" cannot be written: ") + std::strerror(errno));
    }
}

}  // namespace aftershade
