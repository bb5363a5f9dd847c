#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <array>

#include "bind.h"
#include "convert.h"
#include "host_lock.h"

namespace aftershade::python {

namespace {

using namespace nb::literals;
namespace fs = std::filesystem;

using Box = std::array<int, 4>;  ///< x, y, width, height

Box box_of(const api::Window& window) {
    return {window.x, window.y, window.width, window.height};
}
api::Window window_of(const Box& box) {
    return {box[0], box[1], box[2], box[3]};
}

api::CaptureOptions capture_options(const std::string& profile, const std::string& view,
                                    const std::string& layer, const std::string& color_space,
                                    bool alpha_is_opaque, const std::vector<std::string>& roles,
                                    int scale_divisor) {
    return {profile, view, layer, color_space, alpha_is_opaque, roles, scale_divisor};
}

}  // namespace

void bind_capture(nb::module_& module) {
    nb::class_<api::CaptureOptions>(module, "CaptureOptions")
        .def(nb::new_(&capture_options), "profile"_a, "view"_a, "layer"_a, "color_space"_a,
             "alpha_is_opaque"_a, "roles"_a, "scale_divisor"_a);
    nb::class_<api::Capture>(module, "Capture")
        .def(nb::init<int, int>(), "width"_a, "height"_a)
        .def_static(
            "read",
            [](const HostPointer& host, const fs::path& path, const api::CaptureOptions& options) {
                return host->call([&] { return api::Capture::read(host->host, path, options); });
            },
            "host"_a, "path"_a, "options"_a)
        .def("copy", [](const api::Capture& self) { return api::Capture(self); })
        .def(
            "set_image",
            [](api::Capture& self, const std::string& role, const InputArray& pixels) {
                self.set_image(role, view_from(pixels));
            },
            "role"_a, "pixels"_a)
        .def("remove_image", &api::Capture::remove_image, "role"_a)
        .def(
            "image",
            [](const api::Capture& self, const std::string& role) { return array_from(self.image(role)); },
            "role"_a)
        .def("has_image", &api::Capture::has_image, "role"_a)
        .def_prop_ro("roles", &api::Capture::roles)
        .def_prop_rw("frame", &api::Capture::frame, &api::Capture::set_frame)
        .def_prop_ro("data_window", [](const api::Capture& self) { return box_of(self.data_window()); })
        .def_prop_ro("display_window", [](const api::Capture& self) { return box_of(self.display_window()); })
        .def(
            "set_windows",
            [](api::Capture& self, const Box& data, const Box& display) {
                self.set_windows(window_of(data), window_of(display));
            },
            "data"_a, "display"_a)
        .def_prop_rw("pixel_aspect", &api::Capture::pixel_aspect, &api::Capture::set_pixel_aspect)
        .def_prop_rw("scale", &api::Capture::scale, &api::Capture::set_scale)
        .def_prop_rw("color_space", &api::Capture::color_space, &api::Capture::set_color_space)
        .def_prop_rw(
            "camera", [](const api::Capture& self) { return camera_to(self.camera()); },
            [](api::Capture& self, const nb::dict& fields) { self.set_camera(camera_from(fields)); })
        .def_prop_ro("profile", &api::Capture::profile)
        .def_prop_ro("path", &api::Capture::path)
        .def_prop_ro("notes", &api::Capture::notes);
    nb::class_<SequenceOfHost>(module, "Sequence")
        .def_static(
            "open",
            [](const HostPointer& host, const fs::path& path, const api::CaptureOptions& options) {
                return SequenceOfHost{
                    host, host->call([&] { return api::Sequence::open(host->host, path, options); })};
            },
            "host"_a, "path"_a, "options"_a)
        .def_prop_ro("frames", [](const SequenceOfHost& self) { return self.sequence.frames(); })
        .def_prop_ro("fps", [](const SequenceOfHost& self) { return self.sequence.fps(); })
        .def_prop_ro("subframes", [](const SequenceOfHost& self) { return self.sequence.subframes(); })
        .def_prop_ro("cuts", [](const SequenceOfHost& self) { return self.sequence.cuts(); })
        .def(
            "read",
            [](const SequenceOfHost& self, int frame, int subframe) {
                const nb::gil_scoped_release released;
                return self.sequence.read(frame, subframe);
            },
            "frame"_a, "subframe"_a = 0);
}

}  // namespace aftershade::python
