// One frame in memory: images by role, camera and metadata.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "framework/capture/cryptomatte.h"
#include "framework/capture/deep_layers.h"
#include "framework/capture/light.h"
#include "framework/capture/profile.h"
#include "framework/capture/sequence.h"
#include "framework/file/exr_file.h"
#include "framework/file/stored_colors.h"
#include "framework/image/camera.h"
#include "framework/image/color_space.h"
#include "framework/image/image.h"
#include "framework/image/non_finite.h"
#include "framework/image/role.h"

namespace aftershade {

class DeepPart;
class FrameFile;

/// The header of one frame, read before its pixels: what it has, and where.
struct CaptureHeader {
    int frame = 0;         ///< its number in the output
    int source_frame = 0;  ///< the number that it was read under; another where a missing frame is held
    std::filesystem::path path;
    std::string profile;                ///< id
    std::string profile_reason;         ///< why: "chosen by name", "attribute BlenderMultiChannel"
    std::string view;                   ///< of a multi-view file
    std::string layer;                  ///< that the roles are taken from; "" where the file has none
    std::vector<std::string> layers;    ///< to choose from, by the profile
    std::vector<std::string> notes;     ///< on what was chosen for the user, in whole sentences
    std::vector<std::string> warnings;  ///< on what may be wrong in the file, in whole sentences
    /// Differences from the first frame of the capture, by which CaptureReader reads.
    std::vector<std::string> differences;
    bool keeps_alpha = false;  ///< opaque pictures of it have an alpha, too: those of the capture are alike
    Window data_window;        ///< colour's: the working grid
    Window display_window;
    float pixel_aspect = 1;
    int layer_count = 1;              ///< of a deep capture, and of capture.json's "layers"
    std::vector<RoleId> layer_roles;  ///< "layer1:depth": what can be read of layers, front to back
    std::vector<std::string> roles;   ///< that can be read, sorted
    std::map<std::string, std::vector<std::string>> role_channels;  ///< the stored channels of each
    /// For each role whose channels no document names: the first channel of every other set that fits it.
    std::map<std::string, std::vector<std::string>> other_channels;
    /// Roles that the main file does not store as they are: from files of their own, luminance, Cryptomatte.
    std::set<std::string> derived_roles;
    std::map<std::string, std::string> remedies;  ///< of the profile: settings that write a role
    /// By role that cannot be read: what is there of it, and what is missing, in whole sentences.
    std::map<std::string, std::string> half_there;
    std::vector<std::string> channels;   ///< of the file, in this view
    Chromaticities primaries = kRec709;  ///< of the colours as they are in memory
    StoredColors stored_colors;          ///< of the colours as they are in the file
    Camera camera;                       ///< capture.json's, completed by the file's metadata
    std::vector<CaptureLight> lights;    ///< capture.json's, else those of the file's metadata
    ExrMetadata metadata;
};

/// One frame. Every image has the size of the data window, the working grid.
struct Capture {
    CaptureHeader header;
    std::map<RoleId, Image> images;  ///< by role
    std::size_t pixels_without_motion =
        0;  ///< of velocity: filled, from the camera where that is known, else with 0
    bool motion_from_camera = false;
    /// Pixels with light and an albedo below the floor, where irradiance is light divided by the albedo.
    std::size_t pixels_below_albedo_floor = 0;
    /// For a deep capture: the reduction of its samples, and the number of layers.
    std::optional<DeepReduction> deep;
    int deep_layers = 0;
    /// By role, as they were read; filled by whoever looks for them (framework/run/nan_policy.h).
    std::map<RoleId, NonFinitePixels> non_finite;
};

/// Other sources of a role that a frame lacks.
struct RoleElsewhere {
    std::vector<std::string> profiles;  ///< ids
    std::vector<std::string> layers;
};

/// One channel as the file stores it.
struct StoredChannel {
    std::string name;
    PixelType type = PixelType::half;
    Image image;  ///< over the working grid
};

/// Opens frames of a sequence, by the number in the file's name: Sequence::file_number(). Every frame is read
/// as the first that can be read of Sequence::whole and Sequence::frames: by its profile, in its view, from
/// its layer and its channels where the frame has them, and into its colour space. CaptureHeader::differences
/// lists the differences. A frame without that view or layer is Error(ErrorKind::capture). Each of a
/// capture's layers has a first frame of its own. [read() and read_header() may be called from several
/// threads]
class CaptureReader {
public:
    /// `sequence` must outlive the reader.
    CaptureReader(const Sequence& sequence, std::vector<Profile> profiles, ReadLimits limits);
    ~CaptureReader();

    /// Frames are read as the first of another capture, of one picture as this one. Call before anything is
    /// read.
    void hold_to_first_of(const CaptureReader& other);
    /// The same decision as that of a reader of this capture, without reading it again. Call before anything
    /// is read.
    void share_first_of(const CaptureReader& other) { first_ = other.first_; }
    /// The first frame's decisions on these roles and on all pictures, as text that changes with them; ""
    /// for a single frame.
    std::string decision(std::span<const RoleId> roles) const;
    /// Whether the frame's main file is there.
    bool has_frame(int frame) const;
    /// Throws Error(ErrorKind::capture): no such file, not readable, no profile.
    CaptureHeader read_header(int frame) const;
    /// Reads the header and the requested roles. A role that the files lack is left out of `images`. A role
    /// of a layer, RoleId::of_layer(), is read where the capture has that layer; the last layer that is read
    /// holds what lies behind it, too. Other roles are of the whole picture: layers put over one another. The
    /// role RoleId::coverage() is the share of each pixel that the objects cover, by the file's Cryptomatte;
    /// without one it is 0 or 1, by object_id. Throws Error(ErrorKind::capture) where objects are requested
    /// by names that the file cannot have.
    Capture read(int frame, std::span<const RoleId> roles) const;
    Capture read(int frame, std::span<const std::string> names) const { return read(frame, role_ids(names)); }

    /// Other profiles that find the role in the frame's channels, and other layers that have it.
    RoleElsewhere find_elsewhere(const CaptureHeader& header, const std::string& role) const;

    /// The Cryptomattes of a frame, and how much of its pixels the objects of one cover; of a capture with
    /// layers those of the first.
    std::vector<CryptomatteLayer> cryptomattes(int frame) const;
    std::vector<ObjectCoverage> cryptomatte_coverage(int frame, const std::string& name) const;
    /// The id of the object that covers most of each pixel, by one of them; 0 for none.
    Image ids_of_cryptomatte(int frame, const std::string& name) const;
    /// The full name of the one that is called `name` or "<layer>.<name>"; with "" of the one that objects
    /// are looked for in. Throws Error(ErrorKind::capture) where there is none, or where several would do.
    std::string cryptomatte_name(int frame, const std::string& name) const;

    /// How the roles of a frame are decoded: its profile's ways, or capture.json's.
    std::map<std::string, RoleDecoding> decodings(int frame) const;

    /// Every channel of the frame's main file, in this view, bit for bit and under its own name; but the
    /// channels of the roles in `changed` hold those images, brought back to the producer's conventions. If
    /// the file stores a role as a sum of layers, the first layer holds the sum. Channels of another data
    /// window are placed in the working grid. Deep channels are flattened. Throws Error(ErrorKind::usage)
    /// where the capture has layers: no file is the whole picture's.
    std::vector<StoredChannel> read_stored_channels(int frame,
                                                    const std::map<std::string, const Image*>& changed) const;

private:
    struct OpenFrame;
    struct RoleSource;
    struct FirstFrame;
    CaptureReader(const Sequence& sequence, std::vector<Profile> profiles, ReadLimits limits,
                  std::shared_ptr<FirstFrame> first);
    std::vector<int> deciding_files() const;
    void decide(const std::vector<int>& files, FirstFrame& first) const;
    /// nullptr where no frame decides for others.
    const FirstFrame* first_frame() const;
    /// A reader of one layer of the capture. `own` must outlive it.
    CaptureReader layer_reader(const Sequence& own, std::size_t layer) const;
    std::unique_ptr<FrameFile> open_file(const std::filesystem::path& path, const std::string& role,
                                         int deep_layers, CaptureHeader& header) const;
    void hold_channels(const std::string& role, const FrameFile& file, std::optional<FoundChannels>& found,
                       RoleDecoding& decoding, CaptureHeader& header) const;
    bool is_named(const std::string& role) const;
    static std::string text_of(const RoleSource& source);
    void compare_sources(OpenFrame& open) const;
    void compare_profile(const ExrPart& part, const CaptureHeader& first, CaptureHeader& header) const;
    void compare_with_first(CaptureHeader& header, const Chromaticities& primaries) const;
    void compare_roles(CaptureHeader& header, std::span<const RoleId> roles) const;
    void compare_depths(CaptureHeader& header) const;
    bool is_held_flat() const;
    OpenFrame open(int frame, int deep_layers = 1) const;
    const Profile& choose_profile(const ExrPart& part, CaptureHeader& header) const;
    void choose_layer(OpenFrame& open) const;
    void take_data_of_other_layer(OpenFrame& open) const;
    void find_roles(OpenFrame& open) const;
    void note_assumed_space(OpenFrame& open) const;
    void note_first_of_parts(OpenFrame& open) const;
    void note_data_read_as_color(OpenFrame& open) const;
    void find_cryptomatte_roles(OpenFrame& open) const;
    std::optional<FoundChannels> find_role_channels(const OpenFrame& open, const FrameFile& file,
                                                    const std::string& role,
                                                    const RoleDecoding& decoding) const;
    std::optional<CryptomatteLayer> find_cryptomatte(const OpenFrame& open,
                                                     std::span<const std::string> objects) const;
    const FrameFile& cryptomatte_file(const OpenFrame& open) const;
    Image read_cryptomatte_role(const OpenFrame& open, RoleKind kind) const;
    Image read_coverage(const OpenFrame& open, const RoleId& role) const;
    void name_numbers(Image& ids) const;
    void require_names(const OpenFrame& open, const Image& ids, std::span<const std::string> names) const;
    void require_albedo(OpenFrame& open) const;
    std::optional<Image> read_added_light(const OpenFrame& open, const RoleSource& source) const;
    static std::vector<RoleId> with_parts_of_irradiance(const OpenFrame& open, std::span<const RoleId> roles);
    Image read_stored_albedo(const OpenFrame& open) const;
    void finish_irradiance(const OpenFrame& open, const RoleSource& source, Image& light,
                           Capture& capture) const;
    void add_role(OpenFrame& open, const std::string& role, const RoleDecoding& decoding) const;
    void find_others(OpenFrame& open, const std::string& role, RoleSource& source) const;
    void warn_of_others(const OpenFrame& open, const std::string& role, const Image& stored,
                        Capture& capture) const;
    bool is_guessed(const OpenFrame& open, const std::string& role) const;
    bool is_unit_in_doubt(const OpenFrame& open, const std::string& role, const Image& stored) const;
    void warn_of_unit(const OpenFrame& open, const std::string& role, const Image& stored,
                      Capture& capture) const;
    void find_colors(OpenFrame& open) const;
    static void find_losses(OpenFrame& open);
    /// Unpacks what read_role will need of these roles.
    void prefetch(const OpenFrame& open, std::span<const RoleId> roles) const;
    Image read_ids(const RoleSource& source, const Window& grid, int layer = -1) const;
    Image read_role(const OpenFrame& open, const std::string& role, const Image* color,
                    Capture& capture) const;
    /// The images of one layer of the frame, or of the whole picture, as `open` says.
    void read_images(OpenFrame& open, std::span<const RoleId> roles, Capture& capture) const;
    /// The first layer as a sequence of its own; nullopt where the capture is one picture.
    std::optional<Sequence> front_layer() const;
    CaptureHeader read_layered_header(int frame) const;
    Capture read_layered(int frame, std::span<const RoleId> roles) const;
    void read_deep_layers(OpenFrame& open, std::span<const RoleId> roles, Capture& capture) const;
    static bool is_deep(const OpenFrame& open, const std::string& role);
    static DeepPart* deep_picture(const OpenFrame& open);
    void read_motion(const OpenFrame& open, const std::string& role, Image& velocity, const Image* color,
                     Capture& capture) const;

    std::map<std::string, Image> encode_role(const OpenFrame& open, const std::string& role,
                                             const Image& canonical) const;

    const Sequence& sequence_;
    std::vector<Profile> profiles_;
    ReadLimits limits_;
    std::shared_ptr<FirstFrame> first_;
};

}  // namespace aftershade
