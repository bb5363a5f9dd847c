// One frame of images by role, with its camera; and sequences of them on disk.
//
// Roles and their units are those of docs/conventions.md: "color" (scene-linear RGBA, premultiplied), "depth"
// (m along the view axis, +infinity where nothing was hit), "velocity" and "velocity_next" (px a frame, +y
// down), "irradiance", "albedo", "specular", "emission" (RGB), "normal", "position" (XYZ, world, m),
// "object_id" (uint32), "mask" (0 to 1), and "aov:<name>" (1 to 4 channels, passed through).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "aftershade/export.h"
#include "aftershade/gl.h"
#include "aftershade/image.h"

namespace aftershade::host {

class Access;
class Host;

/// Row by row, acting on column vectors: clip = matrix * world.
using Matrix4 = std::array<double, 16>;

/// The known values of the camera. Unknown values stay empty, and parameters then take their defaults. Values
/// outside a range are Error(usage).
struct Camera {
    std::optional<double> focus_distance_m{};   ///< from 0.001; along the view axis
    std::optional<double> focal_length_mm{};    ///< from 0.1
    std::optional<double> sensor_width_mm{};    ///< from 0.1; as wide as the display window
    std::optional<double> f_number{};           ///< from 0.01
    std::optional<double> blades{};             ///< from 0; 0 is a disk
    std::optional<double> rotation_deg{};       ///< of the aperture
    std::optional<double> shutter_angle_deg{};  ///< from 0; 360 is the whole frame
    std::optional<double> near_m{}, far_m{};    ///< from 0; planes of a stored depth
    std::string lens_model{};                   ///< "thin" or "pinhole"; "": not known
    /// View space: right-handed, looks along -z, y up, m. Finite.
    std::optional<Matrix4> camera_from_world{};
    /// Projective; x right and y up from -1 to 1 over the display window. Finite.
    std::optional<Matrix4> ndc_from_world{};
    /// The samples' offset from the pixels' centres, px, +y down.
    std::optional<std::array<double, 2>> jitter_px{};
};

enum class LightKind { point, directional, area };

struct Light {
    LightKind kind = LightKind::point;
    std::string name{};
    std::array<double, 3> position_m{};  ///< world; of an area light its centre; not of a directional one
    std::array<double, 3> direction{};   ///< unit length, the way the light shines; not of a point
    std::array<double, 2> size_m{};      ///< of an area light
    /// RGB: W/sr of a point, W/m^2 across a directional light, W/(m^2 sr) of an area light.
    std::array<double, 3> intensity{};
};

/// How files of captures are read. Defaults are those of `aftershade run`.
struct CaptureOptions {
    std::string profile = "auto";      ///< conventions of the producer: an id, or "auto" to detect it
    std::string view{};                ///< of a multi-view file; "": the first
    std::string layer{};               ///< of a file with several; "": the first
    std::string color_space = "auto";  ///< of the stored colours: auto, rec709, acescg, ap0, rec2020, p3d65
    bool alpha_is_opaque = false;      ///< the stored alpha of color means nothing: it is read as 1
    std::vector<std::string> roles{};  ///< to read; empty: every role that the file has
    int scale_divisor = 1;             ///< read at 1/this of the size; from 1 to 64
};

/// One frame. Copies share their pixels until one of them changes. [value type: changes need the caller's
/// lock; renders and reads on several threads at once do not]
class AFTERSHADE_API Capture {
public:
    /// A frame without images; its data and display windows are 0, 0, width, height. Throws Error(usage) for
    /// sides that are not from 1 to 65536 px.
    Capture(int width, int height);
    /// Reads one frame: an EXR file, or the first frame of a capture.json, pattern or folder. Throws
    /// Error(usage) for unknown profiles, roles and colour spaces, Error(document) for faults in capture.json
    /// and profiles, Error(capture) for files that cannot be read or exceed the host's limits. [the host's
    /// thread]
    static Capture read(const Host& host, const std::filesystem::path& path,
                        const CaptureOptions& options = {});
    Capture(const Capture&) noexcept;
    Capture& operator=(const Capture&) noexcept;
    ~Capture();

    /// Copies an image of the caller's; replaces one of that role, or its texture. Throws Error(usage) where
    /// the role is unknown or made by effects only, the size is not that of the data window, or type,
    /// channels, stride or size_bytes do not fit.
    void set_image(const std::string& role, const ArrayView& pixels);
    /// An image that lies in a texture of HostOptions::share. It is checked and read when a frame is
    /// rendered. Throws Error(usage) as set_image().
    void set_texture(const std::string& role, const GlTexture& texture);
    /// Throws Error(usage) if the capture has no image of that role.
    void remove_image(const std::string& role);

    /// The image of a role. Throws Error(usage) if the capture has none, or if it is a texture.
    Image image(const std::string& role) const;
    bool has_image(const std::string& role) const noexcept;
    std::vector<std::string> roles() const;  ///< of images and textures, sorted

    /// Consecutive frames have consecutive numbers; any int. A capture from arrays has the number 1 until
    /// set_frame(), a file the number in its name.
    int frame() const noexcept;
    void set_frame(int frame);

    Window data_window() const noexcept;     ///< of the images
    Window display_window() const noexcept;  ///< of the whole picture, which the camera sees
    /// Moves the data window and sets the display window. Throws Error(usage) where a side is below 1 or
    /// above 65536 px, or the data window has another size than the images.
    void set_windows(const Window& data, const Window& display);

    /// Width of a pixel over its height, which round shapes are measured by. 1 at first; of a file its own.
    double pixel_aspect() const noexcept;
    /// Throws Error(usage) for values outside 0.01 to 100.
    void set_pixel_aspect(double aspect);

    /// Size of the frame's pixels relative to those that values in px refer to: 0.5 for a frame at half the
    /// size. 1 at first; of a file 1 / CaptureOptions::scale_divisor.
    double scale() const noexcept;
    /// Throws Error(usage) for values that are not above 0 and at most 64.
    void set_scale(double scale);

    /// Primaries of the colours: rec709 (at first, of arrays), acescg, ap0, rec2020, p3d65; "" for others of
    /// a file.
    std::string color_space() const;
    /// Throws Error(usage) for another name.
    void set_color_space(const std::string& name);

    Camera camera() const;
    /// Throws Error(usage) naming every value outside its range.
    void set_camera(const Camera& camera);
    std::vector<Light> lights() const;
    void set_lights(const std::vector<Light>& lights);

    std::string profile() const;  ///< id of the profile that the frame was read by; "": arrays
    std::string path() const;     ///< of the file; "": arrays
    /// In whole sentences: what reading chose for the caller, what may be wrong in the file, and what it has
    /// otherwise than the first frame of its sequence, which decides how all are read.
    std::vector<std::string> notes() const;

    struct AFTERSHADE_LOCAL Data;  ///< what the library keeps; no part of the API

private:
    friend class Access;
    explicit Capture(std::shared_ptr<Data> data);
    Data& own();
    std::shared_ptr<Data> data_;
};

/// Ordered frames on disk: a capture.json, a bare EXR file, a pattern such as frame_####.exr, or a folder.
/// [value type; thread-safe]
class AFTERSHADE_API Sequence {
public:
    /// Looks for the frames; reads no pixels. Throws as Capture::read. [the host's thread]
    static Sequence open(const Host& host, const std::filesystem::path& path,
                         const CaptureOptions& options = {});
    Sequence(const Sequence&) noexcept;
    Sequence& operator=(const Sequence&) noexcept;
    ~Sequence();

    std::vector<int> frames() const;  ///< their numbers, in the order to be rendered
    double fps() const noexcept;      ///< frames a second
    int subframes() const noexcept;   ///< captures that make up a frame; 1: no sub-frames
    std::vector<int> cuts() const;    ///< frames that begin a shot

    /// Reads one frame as the sequence's first that can be read: by its profile, from its layer and channels,
    /// into its colour space. Throws Error(usage) where the sequence has no such frame or sub-frame (from 0),
    /// Error(capture) where it cannot be read or lacks that layer. [thread-safe: a program may read ahead]
    Capture read(int frame, int subframe = 0) const;

    struct AFTERSHADE_LOCAL Data;  ///< what the library keeps; no part of the API

private:
    friend class Access;
    explicit Sequence(std::shared_ptr<const Data> data);
    std::shared_ptr<const Data> data_;
};

}  // namespace aftershade::host
