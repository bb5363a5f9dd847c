// One EXR file as one list of channels, whichever parts and views they lie in.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "framework/capture/deep_part.h"
#include "framework/file/exr_file.h"
#include "framework/image/image.h"

namespace aftershade {

/// The channels of one view of a file under names without the view: "forward.u" for "forward.left.u" of a
/// single-part multi-view file, and for "forward.u" in a part whose view is "left". A channel whose name
/// another part of the view has already taken is called "<part>.<channel>". Channels that belong to no view
/// are in every view. The name of a part is the layer of those of its channels that name none: "depth.Z" for
/// "Z" of the part "depth.main" in the view "main". Only the colour's part keeps "R", "G", "B" and "A", which
/// go by the layer's name as well. [one thread at a time]
class FrameFile {
public:
    /// `view` empty: the default view, the first that the file names. Deep parts are reduced to
    /// `deep_layers`. Throws Error(ErrorKind::capture): not readable, no such view (the message lists those
    /// there are).
    FrameFile(const std::filesystem::path& path, const ReadLimits& limits, const std::string& view,
              int deep_layers = 1);
    FrameFile(const FrameFile&) = delete;
    FrameFile& operator=(const FrameFile&) = delete;

    const std::filesystem::path& path() const { return file_.path(); }
    const std::vector<std::string>& views() const { return views_; }  ///< empty where the file names none
    const std::string& view() const { return view_; }
    /// The view's channels, the display window and metadata of the part that holds its colour (else the first
    /// part), completed by the other parts' metadata, and that part's data window.
    const ExrPart& merged() const { return merged_; }
    const ExrFile& file() const { return file_; }

    /// Parts with an R, G and B of their own beside the one that is the picture, where no name says which is.
    std::vector<std::string> other_color_parts() const;

    Window window_of(const std::string& channel) const;
    PixelType type_of(const std::string& channel) const;
    const std::string& compression_of(const std::string& channel) const;
    /// The metadata of the part that has the channel.
    const ExrMetadata& metadata_of(const std::string& channel) const;

    /// Interleaved in the order given, over `grid`; pixels that a channel's own window does not cover are
    /// `outside`. `how` is for channels of deep parts.
    Image read_floats(std::span<const std::string> channels, const Window& grid, float outside,
                      const DeepRead& how = {}) const;
    Image read_uints(std::span<const std::string> channels, const Window& grid,
                     const DeepRead& how = {}) const;
    /// The part that a channel lies in, where it is deep; nullptr where it is flat.
    DeepPart* deep_part_of(const std::string& channel) const;
    /// The coverage of the samples in the deep part that has the channel.
    Image read_deep_alpha(const std::string& channel, const Window& grid, const DeepRead& how) const;
    /// Channels as read_floats or read_uints will request them.
    struct Request {
        std::vector<std::string> channels;
        ComponentType type = ComponentType::float32;
    };
    /// Unpacks them together: see ExrFile::prefetch.
    void prefetch(std::span<const Request> requests) const;
    /// RGBA of a part stored as luminance (and chroma), over `grid`. `luminance` is the name of its Y
    /// channel.
    Image read_luminance_chroma(const std::string& luminance, const Window& grid) const;

private:
    struct Stored {
        int part = 0;
        std::string name;  ///< in the part
    };
    bool is_in_view(const ExrPart& part) const;
    int find_color_part() const;
    void add_part(int index, int color_part);
    void add_channel(int index, const ExrChannel& channel, std::string name, const std::string& layer);
    void choose_view(const std::string& wanted);
    void describe(int hero_part);
    const Stored& stored(const std::string& channel) const { return stored_.at(channel); }
    const ExrPart& part_of(const std::string& channel) const {
        return file_.parts()[std::size_t(stored(channel).part)];
    }

    ExrFile file_;
    std::vector<std::string> views_;
    std::string view_;
    ExrPart merged_;
    std::map<std::string, Stored> stored_;
    std::map<int, std::unique_ptr<DeepPart>> deep_;  // by part
};

}  // namespace aftershade
