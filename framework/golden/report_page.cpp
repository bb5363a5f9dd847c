#include "framework/golden/report_page.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/open_file.h"
#include "framework/base/side_file.h"
#include "framework/compare/layer_file.h"
#include "framework/golden/report_pictures.h"
#include "framework/image/false_color.h"

namespace aftershade {

// Made by CMake out of report_page/.
std::string_view report_page_html();
std::string_view report_page_style();
std::string_view report_page_script();

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::uintmax_t kMaxPictureBytes = std::uintmax_t(512) * 1024 * 1024;

std::string hex_color(const DisplayColor& color) {
    const auto byte = [&](std::size_t c) { return std::lround(std::clamp(color[c], 0.0f, 1.0f) * 255); };
    return fmt::format("#{:02x}{:02x}{:02x}", byte(0), byte(1), byte(2));
}

/// The colours that the program's own pictures have.
Json palette() {
    Json ramp = Json::array(), diverging = Json::array();
    for (int i = 0; i < 256; ++i) {
        ramp.push_back(hex_color(ramp_color(float(i) / 255)));
        diverging.push_back(hex_color(diverging_color(float(i) / 127.5f - 1)));
    }
    return {{"ramp", ramp},
            {"diverging", diverging},
            {"nan", hex_color(pixel_fault_color(PixelFault::nan))},
            {"infinite", hex_color(pixel_fault_color(PixelFault::infinite))},
            {"negative", hex_color(pixel_fault_color(PixelFault::negative))},
            {"nothing_hit", hex_color(kNothingHitColor)}};
}

/// Texts that the page's elements hold, by number, within a limit.
class Store {
public:
    explicit Store(std::uint64_t limit_bytes) : limit_bytes_(limit_bytes) {}

    /// The number; null where it does not fit.
    Json add(std::string text) {
        if (text.size() > room_bytes()) return nullptr;
        bytes_ += text.size();
        texts_.push_back(std::move(text));
        return texts_.size() - 1;
    }
    std::size_t size() const { return texts_.size(); }
    const std::vector<std::string>& texts() const { return texts_; }
    std::uint64_t room_bytes() const { return limit_bytes_ - bytes_; }
    /// Forgets what was added since there were `count`.
    void shrink_to(std::size_t count) {
        for (; texts_.size() > count; texts_.pop_back()) bytes_ -= texts_.back().size();
    }
    std::string elements() const {
        std::string html;
        for (std::size_t i = 0; i < texts_.size(); ++i)
            html += fmt::format("<script type=\"text/plain\" id=\"data-{}\">{}</script>\n", i, texts_[i]);
        return html;
    }

private:
    std::uint64_t limit_bytes_, bytes_ = 0;
    std::vector<std::string> texts_;
};

/// One file's pixels of a layer.
struct StoredLayer {
    LayerInfo info;
    PagePixels pixels;
};

std::vector<StoredLayer> read_layers(OpenFile exr) {
    const LayerFile file(std::move(exr));
    file.prefetch();
    std::vector<StoredLayer> layers;
    for (const LayerInfo& info : file.layers())
        layers.push_back({info, page_pixels(file.read(info, info.channels))});
    return layers;
}

Json json_of(const StoredLayer& layer, const Json& data) {
    const Window& window = layer.info.data_window;
    return {{"data", data},
            {"type", layer.pixels.type},
            {"channels", layer.info.channels},
            {"x", window.min_x},
            {"y", window.min_y},
            {"width", window.max_x - window.min_x + 1},
            {"height", window.max_y - window.min_y + 1}};
}

/// Nothing is to be seen. Bits may be equal where a verdict is worse: NaN is no number to approve.
bool is_as_approved(const Json& image) {
    return image.at("bits_equal") == true && image.at("verdict") == "same";
}

/// Whether two stored layers have the same values at the same places.
bool is_equal(const StoredLayer& a, const StoredLayer& b) {
    return a.pixels.text == b.pixels.text && json_of(a, nullptr) == json_of(b, nullptr);
}

/// Adds to the page what it shows of the images of one report.
class PageImages {
public:
    PageImages(fs::path report, Store& store) : report_(std::move(report)), store_(store) {}

    /// Adds "shown" to the image: {"layers": [...], "picture", "heat_map": text or null, "missing": words}.
    /// "picture" is a small one, for images that pass.
    void add(Json& image) {
        const Json nothing = {
            {"layers", Json::array()}, {"picture", nullptr}, {"heat_map", nullptr}, {"missing", ""}};
        Json shown = nothing;
        const std::size_t before = store_.size();
        try {
            const Json& pictures = image.at("pictures");
            if (!is_as_approved(image)) add_layers(pictures, shown);
            if (image.at("verdict") == "same") shown["picture"] = png(pictures.at("test"));
        } catch (const Error& error) {
            store_.shrink_to(before);
            shown = nothing;
            shown["missing"] = error.what();
        }
        image["shown"] = std::move(shown);
    }

private:
    /// A report may come from a stranger's job: it must not bring other files of this machine into a page,
    /// neither by a path nor by a link.
    OpenFile open(const Json& name) const {
        const auto file = name.get<std::string>();
        std::string fault;
        if (auto opened = open_file_below(report_, file, fault)) return std::move(*opened);
        throw Error(ErrorKind::capture, file + ": " + fault);
    }
    std::vector<StoredLayer> layers_in(const Json& name) const {
        return name.is_string() ? read_layers(open(name)) : std::vector<StoredLayer>{};
    }

    std::uint64_t bytes_of(const Json& name) const { return name.is_string() ? open(name).bytes() : 0; }

    Json png(const Json& name) {
        if (!name.is_string()) return nullptr;
        const std::string bytes = read_report_png(report_, name.get<std::string>());
        return store_.add(base64(std::as_bytes(std::span(bytes))));
    }

    /// Nothing at all of an image that does not fit whole: half of it would look like a difference.
    void add_layers(const Json& pictures, Json& shown) {
        // Base64 of our streams is hardly smaller than the files: what cannot fit need not be packed.
        if (bytes_of(pictures.at("reference_exr")) + bytes_of(pictures.at("test_exr")) > store_.room_bytes())
            return;
        const std::size_t before = store_.size();
        const std::vector<StoredLayer> references = layers_in(pictures.at("reference_exr"));
        const std::vector<StoredLayer> tests = layers_in(pictures.at("test_exr"));
        Json layers = Json::array();
        bool fits = true;
        const auto stored = [&](const StoredLayer& layer) {
            const Json data = store_.add(layer.pixels.text);
            fits &= !data.is_null();
            return json_of(layer, data);
        };
        const auto add = [&](const StoredLayer* reference, const StoredLayer* test) {
            const LayerInfo& info = (reference ? reference : test)->info;
            const bool equal = reference && test && is_equal(*reference, *test);
            Json layer = {{"label", info.label()}, {"role", layer_role_name(info.role)}, {"equal", equal}};
            layer["reference"] = reference ? stored(*reference) : Json(nullptr);
            if (equal) layer["test"] = json_of(*test, layer["reference"]["data"]);
            else layer["test"] = test ? stored(*test) : Json(nullptr);
            layers.push_back(std::move(layer));
        };
        for (const StoredLayer& reference : references) add(&reference, find(tests, reference));
        for (const StoredLayer& test : tests)
            if (!find(references, test)) add(nullptr, &test);
        const Json heat_map = png(pictures.at("heat_map"));
        if (!fits || (heat_map.is_null() && pictures.at("heat_map").is_string())) {
            store_.shrink_to(before);
            return;
        }
        shown["layers"] = std::move(layers);
        shown["heat_map"] = heat_map;
    }

    static const StoredLayer* find(const std::vector<StoredLayer>& layers, const StoredLayer& like) {
        for (const StoredLayer& layer : layers)
            if (layer.info.key() == like.info.key()) return &layer;
        return nullptr;
    }

    fs::path report_;
    Store& store_;
};

/// Reports of before there was a page lack keys that it shows.
void check_keys(const Json& report) {
    for (const char* key : {"document", "environment", "counts", "orphans"}) (void)report.at(key);
    for (const Json& test : report.at("cases")) (void)test.at("rerun");
}

/// Lower ranks get the room that there is.
int rank_of(const Json& image) {
    if (is_as_approved(image)) return 3;
    const Json& verdict = image.at("verdict");
    return verdict == "same" ? 2 : verdict == "warning" ? 1 : 0;
}

void add_images(Json& report, const fs::path& folder, Store& store) {
    std::vector<Json*> images;
    for (Json& test : report.at("cases"))
        for (Json& image : test.at("images")) images.push_back(&image);
    std::ranges::stable_sort(images, {}, [](const Json* image) { return rank_of(*image); });
    PageImages page(folder, store);
    for (Json* image : images) page.add(*image);
}

void replace_mark(std::string& html, std::string_view mark, std::string_view text) {
    const std::size_t at = html.find(mark);
    if (at != std::string::npos) html.replace(at, mark.size(), text);
}

/// In an element of a page, "</script>" and "<!--" would end the text.
std::string in_element(const Json& json) {
    std::string text = json.dump(-1, ' ', true, Json::error_handler_t::replace), result;
    for (const char c : text)
        if (c == '<') result += "\\u003c";
        else result += c;
    return result;
}

/// What the page shows of a report; its pictures go to the store.
Json page_data(const fs::path& report, Store& store) {
    Json data;
    with_report(report, [&](Json& read) {
        check_keys(read);
        add_images(read, report, store);
        data = std::move(read);
    });
    data["palette"] = palette();
    return data;
}

/// Nothing is loaded from anywhere; pictures that did not fit lie beside the page. A server sends a policy of
/// its own as a header.
constexpr std::string_view kPolicy =
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
    "script-src 'unsafe-inline'; img-src data: 'self' file:\">\n<link rel=\"icon\" href=\"data:,\">";

}  // namespace

std::string read_report_png(const fs::path& report, const std::string& name) {
    constexpr std::string_view kPngMagic = "\x89PNG\r\n\x1a\n";
    std::string fault;
    std::string bytes = read_file_below(report, name, kMaxPictureBytes, fault);
    if (fault.empty() && !bytes.starts_with(kPngMagic)) fault = "is not a PNG";
    if (!fault.empty()) throw Error(ErrorKind::capture, name + ": " + fault);
    return bytes;
}

ServedReportPage served_report_page() {
    std::string html(report_page_html());
    replace_mark(html, "<!-- policy -->", "<link rel=\"icon\" href=\"/icon.svg\">");
    replace_mark(html, "<!-- style -->", "<link rel=\"stylesheet\" href=\"/page.css\">");
    replace_mark(html, "<!-- data -->", "");
    replace_mark(html, "<!-- script -->", "<script type=\"module\" src=\"/page.js\"></script>");
    return {std::move(html), std::string(report_page_style()), std::string(report_page_script())};
}

Json report_page_data(const fs::path& report, const ReportPageOptions& options) {
    Store store(options.limit_bytes);
    Json data = page_data(report, store);
    return {{"report", std::move(data)}, {"texts", store.texts()}};
}

void write_report_page(const fs::path& report, const fs::path& page, const ReportPageOptions& options) {
    Store store(options.limit_bytes);
    Json data = page_data(report, store);
    std::error_code failure;
    data["folder"] = fs::proximate(report, fs::absolute(page).parent_path(), failure).generic_string();
    std::string html(report_page_html());
    replace_mark(html, "<!-- policy -->", kPolicy);
    replace_mark(html, "<!-- style -->", fmt::format("<style>\n{}</style>", report_page_style()));
    replace_mark(html, "<!-- data -->",
                 fmt::format("<script type=\"application/json\" id=\"report\">{}</script>\n{}",
                             in_element(data), store.elements()));
    replace_mark(html, "<!-- script -->",
                 fmt::format("<script type=\"module\">\n{}</script>", report_page_script()));
    write_text_file(page, html);
}

void with_report(const std::filesystem::path& folder, const std::function<void(Json&)>& use) {
    constexpr std::uintmax_t kMostBytes = std::uintmax_t(1) << 30;
    const std::string file = (folder / "report.json").string();
    std::string fault;
    const std::string text = read_file_below(folder, "report.json", kMostBytes, fault);
    if (!fault.empty()) throw Error(ErrorKind::capture, file + ": " + fault);
    try {
        Json report = Json::parse(text);
        use(report);
    } catch (const Json::exception& error) {
        throw Error(ErrorKind::capture,
                    fmt::format("{}: is not a report of a golden suite: {}", file, error.what()));
    }
}

}  // namespace aftershade
