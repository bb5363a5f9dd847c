// The data of the API's images and captures.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "aftershade/capture.h"
#include "aftershade/host.h"
#include "aftershade/image.h"
#include "framework/capture/capture.h"
#include "framework/image/image.h"

namespace aftershade {
struct FrameResult;
}

namespace aftershade::host {

/// Largest side of the caller's images, and the largest value of HostLimits::max_side_px.
inline constexpr int kMaxSide_px = 65536;

struct Image::Data {
    std::shared_ptr<const aftershade::Image> pixels;
};

struct Capture::Data {
    aftershade::Capture capture;                // of a texture's role the image is empty
    std::map<std::string, GlTexture> textures;  // by role
    double scale = 1;

    bool has_texture(const std::string& role) const { return textures.contains(role); }
};

struct Sequence::Data {
    aftershade::Sequence sequence;
    std::vector<Profile> profiles;
    ReadLimits limits;
    CaptureOptions options;
    std::unique_ptr<CaptureReader> reader;  // refers to `sequence`
};

/// The way from values of the API to what they hold.
class Access {
public:
    static Image image(std::shared_ptr<const aftershade::Image> pixels);
    /// The pixels of an image that has some.
    static const aftershade::Image& pixels(const Image& image) { return *image.data_->pixels; }
    /// Throws Error(usage) for one that was moved from.
    static Host::Data& host(const Host& host);
    static std::shared_ptr<Host::Data> share(const Host& from) {
        host(from);
        return from.data_;
    }
    static const Capture::Data& data(const Capture& capture) { return *capture.data_; }
    static std::shared_ptr<const Capture::Data> share(const Capture& capture) { return capture.data_; }
    static Capture capture(Capture::Data data);
    /// The frame's result in the modules below.
    static const FrameResult& frame(const Result& result);
    static std::shared_ptr<const Sequence::Data> share(const Sequence& sequence) { return sequence.data_; }
    static Sequence sequence(std::shared_ptr<const Sequence::Data> data) { return Sequence(std::move(data)); }
    template <typename Object, typename Data>
    static Object make(Data data) {
        return Object(std::move(data));
    }
};

/// The pixels of an array in the library's layout. Throws Error(usage), naming `what`, where the view makes
/// no sense.
aftershade::Image copy_of(const ArrayView& view, const std::string& what);

/// A sequence as `aftershade run` finds it. `roles` that it reads by name of objects: see
/// aftershade::Sequence::object_names.
std::shared_ptr<const Sequence::Data> open_sequence_data(Host::Data& host, const std::filesystem::path& path,
                                                         const CaptureOptions& options,
                                                         std::vector<std::string> object_names = {});
/// Reads `roles` (empty: all) of a frame that the sequence has.
Capture read_capture(const Sequence::Data& data, int frame, int subframe, const std::vector<RoleId>& roles);

/// Capture::notes().
std::vector<std::string> notes_of(const CaptureHeader& header);

aftershade::Window internal_window(const Window& window);
Window public_window(const aftershade::Window& window);

}  // namespace aftershade::host
