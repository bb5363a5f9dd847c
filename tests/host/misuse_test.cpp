// Wrong use fails by an Error with a kind, a message and a place, and the objects stay usable.
#include <exception>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "aftershade/host.h"
#include "framework/file/exr_file.h"
#include "tests/host/host_setup.h"
#include "tests/temporary_folder.h"

namespace {

using namespace aftershade::host;
using namespace aftershade::test;

/// What a misuse is done to.
struct Bench {
    TemporaryFolder folder;
    Host host{on_software()};
    Look look = host.parse_look(kBlurLook);
    Capture capture = small_capture();
    std::vector<float> pixels = std::vector<float>(48 * 32 * 4, 0.5f);

    ArrayView view(int channels) const { return view_of(pixels, 48, 32, channels); }
};

struct Misuse {
    const char* name;
    std::function<void(Bench&)> act;
    ErrorKind kind;
    const char* message;  ///< a part of it
    const char* place;    ///< a part of Error::file()
    int line = 0;
};

using Kind = ErrorKind;

std::filesystem::path write_odd_channel(const std::filesystem::path& path) {
    const aftershade::Image stored(8, 8, 1);
    aftershade::ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 7, 7};
    const std::vector<aftershade::ExrOutputChannel> channels = {
        {"odd", aftershade::PixelType::float32, &stored, 0}};
    aftershade::write_exr(path, channels, options);
    return path;
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::vector<Misuse> misuses_of_documents() {
    return {
        {"a look that is no JSON",
         [](Bench& b) { b.host.parse_look("{\"aftershade\": 1,\n  \"steps\": [}"); }, Kind::document, "",
         "look text", 2},
        {"an unknown effect",
         [](Bench& b) {
             b.host.parse_look("{\"aftershade\": 1, \"steps\": [\n{\"effect\": \"bokhe\"}]}",
                               {.name = "mine"});
         },
         Kind::document, "did you mean 'bokeh'", "mine", 2},
        {"an effect like no other",
         [](Bench& b) { b.host.parse_look(R"({"aftershade": 1, "steps": [{"effect": "xxxxxxxxxxxxxx"}]})"); },
         Kind::document, "effect_paths names a folder of further effects", "look text", 1},
        {"an unknown parameter in a look",
         [](Bench& b) {
             b.host.parse_look(
                 R"({"aftershade": 1, "steps": [{"effect": "bokeh", "params": {"f_numer": 2}}]})");
         },
         Kind::document, "bokeh has no parameter 'f_numer'", "look text", 1},
        {"a look's file that is not there", [](Bench& b) { b.host.load_look(b.folder / "nothing.json"); },
         Kind::document, "", "nothing.json"},
        {"a folder for a look that is a file",
         [](Bench& b) {
             write_file(b.folder / "look.json", kBlurLook);
             b.host.load_look(b.folder / "look.json", {.folder = b.folder.path()});
         },
         Kind::usage, "names files from its own", "LookOptions::folder"},
        {"a tap that no step has",
         [](Bench& b) { b.host.parse_look(kBlurLook, {.taps = {"bokeh.nothing"}}); }, Kind::document,
         "bokeh has no texture 'nothing'", "bokeh.nothing"},
        {"a variable that the look has not",
         [](Bench& b) {
             b.host.parse_look(kBlurLook, {.variables = {{"focus", 2.0}}});
         },
         Kind::document, "no variable 'focus'", "focus"},
    };
}

std::vector<Misuse> misuses_of_values() {
    return {
        {"a parameter that the step has not", [](Bench& b) { b.look.set("bokeh.f_numer", 2.0); }, Kind::usage,
         "did you mean 'f_number'", "bokeh.f_numer"},
        {"a step that the look has not", [](Bench& b) { b.look.set("boke.f_number", 2.0); }, Kind::usage,
         "did you mean 'bokeh'", "boke.f_number"},
        {"no step at all", [](Bench& b) { b.look.set("f_number", 2.0); }, Kind::usage, "expected step.param",
         "f_number"},
        {"a value out of its range", [](Bench& b) { b.look.set("bokeh.f_number", 0.0); }, Kind::usage,
         "below the minimum", "bokeh.f_number"},
        {"a value of another type", [](Bench& b) { b.look.set("bokeh.f_number", true); }, Kind::usage,
         "bokeh.f_number", "bokeh.f_number"},
        {"a value that is no number", [](Bench& b) { b.look.set("bokeh.f_number", kNaN); }, Kind::usage,
         "not finite", "bokeh.f_number"},
        {"JSON that is none", [](Bench& b) { b.look.set("bokeh.f_number", Json{"{\"keys\": "}); },
         Kind::usage, "", "bokeh.f_number", 1},
        {"asking for an unknown value", [](Bench& b) { b.look.get("bokeh.nothing"); }, Kind::usage,
         "no such parameter", "bokeh.nothing"},
        {"an unknown effect to describe", [](Bench& b) { b.host.effect("bokhe"); }, Kind::usage,
         "did you mean 'bokeh'", "id"},
    };
}

std::vector<Misuse> misuses_of_arrays() {
    return {
        {"a null array",
         [](Bench& b) {
             b.capture.set_image("color", {nullptr, {}, 48, 32, 4});
         },
         Kind::usage, "null", "color"},
        {"an array of another size",
         [](Bench& b) { b.capture.set_image("color", view_of(b.pixels, 32, 48, 4)); }, Kind::usage,
         "32 x 48 px", "color"},
        {"an array that is too short",
         [](Bench& b) { b.capture.set_image("color", view_of(std::span(b.pixels).first(100), 48, 32, 4)); },
         Kind::usage, "has 400 bytes", "color"},
        {"too few channels", [](Bench& b) { b.capture.set_image("color", b.view(3)); }, Kind::usage,
         "has 3 channels; the role has 4", "color"},
        {"a nonsense number of channels", [](Bench& b) { b.capture.set_image("color", b.view(7)); },
         Kind::usage, "7 channels", "color"},
        {"floats for ids", [](Bench& b) { b.capture.set_image("object_id", b.view(1)); }, Kind::usage,
         "holds uint32", "object_id"},
        {"a stride below a row",
         [](Bench& b) {
             b.capture.set_image("color", {b.pixels.data(), ElementType::float32, 48, 32, 4, 16});
         },
         Kind::usage, "row stride of 16 bytes", "color"},
        {"a stride that breaks alignment",
         [](Bench& b) {
             b.capture.set_image("color", {b.pixels.data(), ElementType::float32, 48, 32, 4, 48 * 16 + 2});
         },
         Kind::usage, "not a multiple of 4", "color"},
        {"an array that is not aligned",
         [](Bench& b) {
             const auto* odd = reinterpret_cast<const char*>(b.pixels.data()) + 1;
             b.capture.set_image("color", {odd, ElementType::float32, 48, 32, 4});
         },
         Kind::usage, "not aligned", "color"},
        {"a size of nothing", [](Bench&) { Capture(0, 32); }, Kind::usage, "0 x 32 px", "Capture"},
        {"a size beyond all memory", [](Bench&) { Capture(2'000'000'000, 32); }, Kind::usage,
         "must be from 1 to 65536", "Capture"},
        {"a role that is none", [](Bench& b) { b.capture.set_image("colour", b.view(4)); }, Kind::usage,
         "did you mean 'color'", "colour"},
        {"a role that only effects make", [](Bench& b) { b.capture.set_image("display", b.view(4)); },
         Kind::usage, "only effects make", "display"},
        {"an image that is not there", [](Bench& b) { (void)b.capture.image("albedo"); }, Kind::usage,
         "no image of this role", "albedo"},
        {"floats of an image of ids",
         [](Bench& b) {
             const std::vector<std::uint32_t> ids(48 * 32);
             b.capture.set_image("object_id", view_of(ids, 48, 32));
             (void)b.capture.image("object_id").floats();
         },
         Kind::usage, "uints()", ""},
        {"a camera that cannot be", [](Bench& b) { b.capture.set_camera({.f_number = -2.0}); }, Kind::usage,
         "not a finite number from 0.01", "camera.f_number"},
        {"a window that the images do not fill",
         [](Bench& b) {
             b.capture.set_windows({0, 0, 50, 32}, {0, 0, 50, 32});
         },
         Kind::usage, "the images have 48 x 32", "data window"},
    };
}

std::vector<Misuse> misuses_of_renders() {
    return {
        {"a role that the look needs and the capture lacks",
         [](Bench& b) {
             b.capture.remove_image("depth");
             b.look.render(b.capture);
         },
         Kind::capture, "needs the role 'depth'; the capture has 'color'", "capture"},
        {"a role that the look needs and reading left out",
         [](Bench& b) {
             const std::filesystem::path file = AFTERSHADE_SOURCE_DIR "/scenes/suzanne/gbuffer_0004.exr";
             b.look.render(Capture::read(b.host, file, {.roles = {"color"}}));
         },
         Kind::capture,
         "needs the role 'depth'; the capture has 'color' (render it, or add it to CaptureOptions::roles)",
         "capture"},
        {"a mask of objects where no ids are",
         [](Bench& b) {
             b.host
                 .parse_look(R"({ "aftershade": 1, "steps": [ { "effect": "vignette",
                 "mask": { "object": "ball" } } ] })")
                 .render(b.capture);
         },
         Kind::capture, "the coverage of \"ball\" needs the role 'object_id'", "capture"},
        {"a role that nothing makes", [](Bench& b) { b.look.render(b.capture, {.roles = {"albedo"}}); },
         Kind::capture, "no step makes 'albedo'", "RenderOptions::roles"},
        {"a frame rate of nothing", [](Bench& b) { b.look.render(b.capture, {.fps = 0}); }, Kind::usage,
         "not above 0", "RenderOptions::fps"},
        {"a neighbour of another size",
         [](Bench& b) {
             const Capture other = small_capture(32, 32);
             b.look.session().render(b.capture, {.previous = &other});
         },
         Kind::usage, "not that of the frame", "RenderOptions::previous"},
        {"a texture without a shared context",
         [](Bench& b) {
             b.look.render(b.capture, {.targets = {{"color", {1, 48, 32}}}});
         },
         Kind::usage, "need HostOptions::share", "RenderOptions"},
        {"a stop that was requested",
         [](Bench& b) {
             std::stop_source stop;
             stop.request_stop();
             b.look.render(b.capture, {.stop = stop.get_token()});
         },
         Kind::interrupted, "stop", ""},
        {"NaN that the caller refuses",
         [](Bench& b) {
             b.pixels[5] = float(kNaN);
             b.capture.set_image("color", b.view(4));
             b.look.render(b.capture, {.non_finite = NonFinite::fail});
         },
         Kind::capture, "1 NaN", "color"},
        {"a sub-frame beyond the last", [](Bench& b) { b.look.session().render_subframe(b.capture, 4, 4); },
         Kind::usage, "sub-frame 4 of 4", "index"},
        {"an image that was not given back", [](Bench& b) { (void)b.look.render(b.capture).image("albedo"); },
         Kind::usage, "RenderOptions::roles", "albedo"},
        {"a format that nothing writes",
         [](Bench& b) { b.look.render(b.capture).write(b.folder / "out.tiff"); }, Kind::usage,
         "'.tiff' is not known", "out.tiff"},
        {"a file that cannot be written",
         [](Bench& b) {
             write_file(b.folder / "file", "");
             b.look.render(b.capture).write(b.folder / "file" / "out.exr");
         },
         Kind::output, "", ""},
    };
}

std::vector<Misuse> misuses_of_hosts() {
    return {
        {"no data", [](Bench&) { Host({}); }, Kind::usage, "is empty", "HostOptions::data"},
        {"a data folder that is not there", [](Bench&) { Host({.data = "/nowhere"}); }, Kind::usage,
         "/nowhere", "HostOptions::data"},
        {"limits of nothing",
         [](Bench&) { Host({.data = AFTERSHADE_SOURCE_DIR, .limits = {.max_side_px = 0}}); }, Kind::usage,
         "from 1 to 65536", "HostOptions::limits"},
        {"a device that is not there",
         [](Bench&) {
             Host({.data = AFTERSHADE_SOURCE_DIR, .backend = Backend::egl_software, .device = "card77"}).gl();
         },
         Kind::usage, "device 'card77' is not there; EGL lists 0", "HostOptions::device"},
        {"a closed host",
         [](Bench& b) {
             b.look.render(b.capture);
             b.host.close();
             b.look.render(b.capture);
         },
         Kind::usage, "closed", ""},
        {"another thread",
         [](Bench& b) {
             std::exception_ptr thrown;
             std::thread([&] {
                 try {
                     b.look.render(b.capture);
                 } catch (...) {
                     thrown = std::current_exception();
                 }
             }).join();
             if (thrown) std::rethrow_exception(thrown);
         },
         Kind::usage, "another thread", ""},
        {"a file that is not there", [](Bench& b) { Capture::read(b.host, b.folder / "nothing.exr"); },
         Kind::capture, "nothing.exr", ""},
        {"a file that is no picture",
         [](Bench& b) {
             write_file(b.folder / "text.exr", "no picture");
             Capture::read(b.host, b.folder / "text.exr");
         },
         Kind::capture, "text.exr", ""},
        {"a file whose channels no profile names",
         [](Bench& b) { Capture::read(b.host, write_odd_channel(b.folder / "odd.exr")); }, Kind::capture,
         "(name one with profile, or name the channels of each role", ""},
        {"a file without what the look reads",
         [](Bench& b) {
             b.look.render(b.capture).write(b.folder / "color.exr");
             b.look.render(b.look.read(b.folder / "color.exr"));
         },
         Kind::capture, "needs the role 'depth'", ""},
        {"a history file that is none",
         [](Bench& b) {
             write_file(b.folder / "history", "no history");
             b.look.session().load_history(b.folder / "history");
         },
         Kind::usage, "not a history file of save_history()", ""},
        {"an unknown profile", [](Bench& b) { Capture::read(b.host, "x.exr", {.profile = "blendr"}); },
         Kind::usage, "did you mean 'blender'", "CaptureOptions::profile"},
        {"a frame that the sequence has not",
         [](Bench& b) {
             b.look.render(b.capture).write(b.folder / "f_0001.exr");
             Sequence::open(b.host, b.folder / "f_####.exr").read(7);
         },
         Kind::usage, "no frame 7", "frame"},
        {"images of two sizes to compare",
         [](Bench& b) { compare(view_of(b.pixels, 48, 32, 4), view_of(b.pixels, 32, 48, 4)); }, Kind::usage,
         "32 x 48", "test"},
        {"a tolerance below nothing",
         [](Bench& b) { compare(b.view(4), b.view(4), "color", {.fail = {.limit = -1}}); }, Kind::usage,
         "-1 is not at least 0", "CompareOptions::fail.limit"},
    };
}

void expect_error(const Misuse& misuse, Bench& bench) {
    try {
        misuse.act(bench);
        ADD_FAILURE() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_STREQ(error_kind_name(error.kind()), error_kind_name(misuse.kind)) << error.what();
        EXPECT_NE(error.message().find(misuse.message), std::string::npos) << error.what();
        EXPECT_FALSE(error.message().empty());
        EXPECT_NE(error.file().find(misuse.place), std::string::npos) << error.what();
        EXPECT_EQ(error.line(), misuse.line) << error.what();
        // No words of the command line.
        for (const char* word : {"--", "-o "})
            EXPECT_EQ(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
}

/// After each misuse the look still gives the bits that it gave before.
void expect_misuses(const std::vector<Misuse>& misuses) {
    auto bench = std::make_unique<Bench>();
    const Image expected = bench->look.render(bench->capture).image("color");
    for (const Misuse& misuse : misuses) {
        SCOPED_TRACE(misuse.name);
        expect_error(misuse, *bench);
        if (bench->host.is_closed()) bench = std::make_unique<Bench>();
        bench->capture = small_capture();
        bench->pixels.assign(bench->pixels.size(), 0.5f);
        EXPECT_TRUE(same_bits(bench->look.render(bench->capture).image("color"), expected));
    }
}

TEST(HostMisuse, OfDocumentsNamesTheirLines) {
    expect_misuses(misuses_of_documents());
}
TEST(HostMisuse, OfValuesNamesTheParameterAndLeavesTheLookAsItWas) {
    expect_misuses(misuses_of_values());
}
TEST(HostMisuse, OfArraysNamesTheRole) {
    expect_misuses(misuses_of_arrays());
}
TEST(HostMisuse, OfRendersNamesTheOption) {
    expect_misuses(misuses_of_renders());
}
TEST(HostMisuse, OfHostsNamesTheOption) {
    expect_misuses(misuses_of_hosts());
}

TEST(HostMisuse, EveryFaultComesAtOnce) {
    Host host(on_software());
    try {
        host.parse_look(
            R"({"aftershade": 1, "steps": [{"effect": "bokhe"}, {"effect": "bloom", "bad": 1}]})");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.diagnostics().size(), 2u) << error.what();
    }
}

}  // namespace
