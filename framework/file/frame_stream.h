// Frames one after the other into a pipe, for a program that makes a video of them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "framework/base/child_process.h"
#include "framework/base/error.h"
#include "framework/image/color_encoding.h"
#include "framework/image/image.h"

namespace aftershade {

/// Named as ffmpeg names them: pixel formats of its `rawvideo`, rows from the top without padding, 16 bits
/// little-endian; `png` is one PNG file behind the other (`image2pipe`).
enum class StreamFormat { rgb24, rgba, rgb48le, rgba64le, png };

const std::vector<std::string>& stream_format_names();
std::optional<StreamFormat> find_stream_format(std::string_view name);

/// The options of ffmpeg before `-i -`: "-f rawvideo -pixel_format rgb24 -video_size 480x270 -framerate 24".
/// Rates of NTSC are written as the fractions that they stand for.
std::string ffmpeg_input_options(StreamFormat format, int width, int height, double frames_per_second);

/// [one thread at a time]
class FrameStream {
public:
    /// Takes standard output for the frames; what this process prints to it from now on goes to standard
    /// error. A reader that has gone is an error of write() then, and no signal. Throws
    /// Error(ErrorKind::usage) where standard output is a terminal.
    static FrameStream of_standard_output(StreamFormat format);

    /// Takes a pipe into a program; `name`, such as "-o film.mp4", begins the messages. A reader that has
    /// gone is an error of write() and no signal from now on.
    static FrameStream into(Descriptor pipe, StreamFormat format, std::string name);

    /// Closes the descriptor.
    ~FrameStream() = default;
    FrameStream(FrameStream&&) noexcept = default;
    FrameStream& operator=(FrameStream&&) = delete;

    /// The display-referred picture of a frame, 3 or 4 float channels, with 1 for an alpha that is not there;
    /// formats without alpha leave it out. Throws Error(ErrorKind::output) where the picture has another size
    /// than the one before, or where the reader has gone. A PNG says how the picture is encoded.
    void write(int frame, const Image& display, const ColorEncoding& encoding = kSrgbDisplay);

private:
    FrameStream(Descriptor descriptor, StreamFormat format, std::string name)
        : descriptor_(std::move(descriptor)), format_(format), name_(std::move(name)) {}
    void send(std::string_view bytes);
    Error fault(const std::string& what) const;

    Descriptor descriptor_;
    StreamFormat format_;
    std::string name_;
    int width_ = 0, height_ = 0;  // of every frame; 0 before the first
    std::size_t frames_ = 0;      // that were written whole
};

}  // namespace aftershade
