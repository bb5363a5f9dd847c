// Variants of the shipped shaders that mean the same draw the same bits.
//
// A small sample runs with the suite; AFTERSHADE_METAMORPHIC=500 makes that many variants
// (scripts/check metamorphic).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "framework/document/units.h"
#include "framework/render/renderer.h"
#include "tests/every_effect.h"
#include "tests/glsl/shader_variant.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

constexpr int kUsualVariants = 6;
// Below it a test would say little: a variant that changes nothing cannot differ.
constexpr int kLeastSites = 3;
// Where a tap's position moves by its last bit, beside lights that are 1e4 times as bright as what is around
// them.
constexpr double kRounding = 1e-3;

bool is_shader(const fs::path& path) {
    const std::string extension = path.extension();
    return extension == ".glsl" || extension == ".frag" || extension == ".comp" || extension == ".vert";
}

/// Of the operations on floats: as a compiler likes it, or as it is written.
enum class Order { free, kept };

/// The shipped effects and glsl/ in a folder of their own, whose shaders can be rewritten. The host's own
/// shaders stay: no effect's text reaches them.
class ShippedShaders {
public:
    explicit ShippedShaders(Order order) : order_(order) {
        for (const char* part : {"effects", "glsl"})
            for (const auto& entry : fs::recursive_directory_iterator(kRoot / part)) {
                if (!entry.is_regular_file()) continue;
                const fs::path name = fs::relative(entry.path(), kRoot);
                const bool shader = is_shader(name), json = name.extension() == ".json";
                if (!shader && !json) continue;
                fs::create_directories((folder_.path() / name).parent_path());
                write_text(folder_.path() / name, read_text(entry.path()));
                if (shader && *std::next(name.begin()) != "host" && name.filename() != "fullscreen.vert")
                    texts_[name] = order == Order::kept ? ShaderText(read_text(entry.path())).made_precise()
                                                        : read_text(entry.path());
            }
        for (const auto& [name, text] : texts_) global_.merge(ShaderText(text).global_names());
    }

    /// Rewrites every file that one effect may see; the number of places. Nothing rewritten: the shipped
    /// text.
    int rewrite(const std::string& effect, const Rewrites& rewrites, const std::string& one, unsigned seed) {
        std::mt19937 random(seed);
        int sites = 0;
        for (const auto& [name, text] : texts_) {
            const bool seen = *name.begin() == "glsl" || *std::next(name.begin()) == effect;
            if (!seen) continue;
            std::string changed = text;
            int here = 0;
            if (rewrites.any()) changed = ShaderText(text).rewritten(rewrites, global_, random, here);
            if (here > 0 || order_ == Order::kept) changed = with_prelude(changed, variant_prelude(one));
            if (*name.begin() != "glsl") sites += here;
            write_text(folder_.path() / name, changed);
        }
        return sites;
    }

    const fs::path& path() const { return folder_.path(); }

private:
    Order order_;
    TemporaryFolder folder_;
    std::map<fs::path, std::string> texts_;
    std::set<std::string> global_;
};

using Images = std::map<std::string, Image>;

/// "" where every bit is the same.
std::string first_difference(const Images& a, const Images& b) {
    if (a.empty() || a.size() != b.size()) return "other images";
    for (const auto& [role, image] : a) {
        const Image& other = b.at(role);
        for (std::size_t i = 0; i < image.floats().size(); ++i)
            if (std::memcmp(&image.floats()[i], &other.floats()[i], sizeof(float)) != 0)
                return role + ", value " + std::to_string(i) + ": " + format_number(image.floats()[i]) +
                       " and " + format_number(other.floats()[i]);
    }
    return "";
}

/// Of values up to 1 absolute, of others relative; infinite where one of two is no finite number.
double largest_difference(const Images& a, const Images& b) {
    double largest = 0;
    for (const auto& [role, image] : a)
        for (std::size_t i = 0; i < image.floats().size(); ++i) {
            const double x = image.floats()[i], y = b.at(role).floats()[i];
            if (x == y || (std::isnan(x) && std::isnan(y))) continue;
            if (!std::isfinite(x) || !std::isfinite(y)) return std::numeric_limits<double>::infinity();
            largest = std::max(largest, std::abs(x - y) / std::max(1.0, std::abs(x)));
        }
    return largest;
}

/// Draws shipped and rewritten effects.
class Stage {
public:
    Stage(gpu::Context& context, Order order) : context_(context), shaders_(order) {}

    ShippedShaders& shaders() { return shaders_; }

    Images draw(const std::string& effect, const Values& values) {
        EffectRegistry effects({shaders_.path() / "effects"});
        Diagnostics diagnostics;
        const EffectManifest* manifest = effects.find(effect, diagnostics);
        const auto node = parse_document(look_of(effect, values), "look", diagnostics);
        const auto look = node ? parse_look(*node, diagnostics) : std::nullopt;
        const Pipeline pipeline = look ? bind_pipeline(*look, effects, {}, diagnostics) : Pipeline{};
        if (!manifest || diagnostics.has_errors()) throw std::runtime_error(faults_of(diagnostics));
        const Capture capture = with_aovs(*manifest, small_capture()),
                      before = with_aovs(*manifest, capture_before());
        FrameInputs frame;
        frame.capture = &capture;
        frame.neighbours[-1] = &before;
        PipelineRenderer renderer(context_, pipeline, shaders_.path());
        return renderer.render(frame, {"color", "display", "irradiance", "velocity"}, false).images;
    }
    /// Of the shipped text; drawn once for each look.
    const Images& shipped(const std::string& effect, const Values& values) {
        const auto [entry, is_new] = shipped_.try_emplace(look_of(effect, values));
        if (is_new) {
            shaders_.rewrite(effect, {}, "1.0", 0);
            entry->second = draw(effect, values);
        }
        return entry->second;
    }

private:
    gpu::Context& context_;
    ShippedShaders shaders_;
    std::map<std::string, Images> shipped_;
};

/// One or two of the rewrites, or all.
Rewrites some_rewrites(std::mt19937& random) {
    Rewrites rewrites;
    bool* const all[] = {&rewrites.wrap, &rewrites.identity, &rewrites.dead,
                         &rewrites.loop, &rewrites.rename,   &rewrites.reorder};
    if (random() % 4 == 0) {
        for (bool* one : all) *one = true;
        return rewrites;
    }
    for (int i = 0; i < 2; ++i) *all[random() % std::size(all)] = true;
    return rewrites;
}

std::string text_of(const Rewrites& rewrites) {
    std::string text;
    for (const auto& [name, is_on] :
         {std::pair{" wrap", rewrites.wrap}, std::pair{" identity", rewrites.identity},
          std::pair{" dead", rewrites.dead}, std::pair{" loop", rewrites.loop},
          std::pair{" rename", rewrites.rename}, std::pair{" reorder", rewrites.reorder}})
        if (is_on) text += name;
    return text;
}

struct Variant {
    unsigned seed = 0;
    std::string effect;
    Values values;
    Rewrites rewrites;

    std::string text() const {
        return "seed " + std::to_string(seed) + ":" + text_of(rewrites) + " of " + look_of(effect, values);
    }
};

Variant variant_of(unsigned seed) {
    static const std::vector<std::string> ids = registry().ids();
    std::mt19937 random(seed);
    Variant variant{seed, ids[seed % ids.size()], {}, {}};
    Diagnostics diagnostics;
    const EffectManifest* manifest = registry().find(variant.effect, diagnostics);
    if (!manifest->params.empty() && random() % 2 == 0) {
        const ParamSpec& spec = manifest->params[random() % manifest->params.size()];
        const std::vector<ParamValue> extremes = extremes_of(spec);
        if (!extremes.empty()) variant.values[spec.name] = extremes[random() % extremes.size()];
    }
    variant.rewrites = some_rewrites(random);
    return variant;
}

/// Calls `visit` with the shipped images and the variant's, until `count` variants were drawn.
template <class Visit>
void draw_variants(Stage& stage, int count, const Visit& visit) {
    int drawn = 0, sites = 0;
    std::set<std::string> effects;
    for (unsigned seed = 1; drawn < count && int(seed) <= 20 * count; ++seed) {
        const Variant variant = variant_of(seed);
        try {
            const Images& expected = stage.shipped(variant.effect, variant.values);
            const int here = stage.shaders().rewrite(variant.effect, variant.rewrites, "1.0", seed);
            if (here < kLeastSites) continue;
            ++drawn, sites += here, effects.insert(variant.effect);
            visit(variant, expected, stage.draw(variant.effect, variant.values));
        } catch (const std::exception& error) {
            ADD_FAILURE() << variant.text() << ": " << error.what();
        }
    }
    EXPECT_EQ(drawn, count);
    std::cout << drawn << " variants of " << effects.size() << " effects, rewritten in " << sites
              << " places\n";
}

int variants_wanted() {
    const char* wanted = std::getenv("AFTERSHADE_METAMORPHIC");
    return wanted ? int(parse_number(wanted).value()) : kUsualVariants;
}

TEST(Metamorphic, VariantsOfTheShippedShadersDrawTheSameBits) {
    gpu::Context context(backends().front());
    Stage stage(context, Order::kept);
    draw_variants(stage, variants_wanted(), [](const Variant& variant, const Images& a, const Images& b) {
        EXPECT_EQ(first_difference(a, b), "") << variant.text();
    });
}

/// What a compiler may reorder differs, by no more than rounding makes of it. The script prints the list.
TEST(Metamorphic, VariantsInAnyOrderOfOperationsDifferByRounding) {
    const bool lists = std::getenv("AFTERSHADE_METAMORPHIC") != nullptr;
    gpu::Context context(backends().front());
    Stage stage(context, Order::free);
    int different = 0;
    draw_variants(stage, variants_wanted(), [&](const Variant& variant, const Images& a, const Images& b) {
        if (first_difference(a, b).empty()) return;
        ++different;
        const double largest = largest_difference(a, b);
        if (lists) std::cout << variant.text() << ": " << format_number(largest) << "\n";
        EXPECT_LE(largest, kRounding) << variant.text();
    });
    std::cout << different << " of them differ\n";
}

/// The tests above could pass because rewritten text is not drawn: here a uniform that is not quite 1 must be
/// seen.
TEST(Metamorphic, AVariantThatMeansSomethingElseDrawsOtherBits) {
    gpu::Context context(backends().front());
    Stage stage(context, Order::kept);
    Rewrites rewrites;
    rewrites.identity = true;
    const Images& expected = stage.shipped("vignette", {});
    int changed = 0;
    for (unsigned seed = 1; seed <= 6; ++seed)
        if (stage.shaders().rewrite("vignette", rewrites, "1.001", seed) > 0)
            changed += first_difference(expected, stage.draw("vignette", {})).empty() ? 0 : 1;
    EXPECT_GT(changed, 0);
}

TEST(ShaderVariant, KeepsTheOrderOfOperationsOfFloats) {
    const std::string text = R"(#version 450 core
#include <pass>
struct Sum { vec3 light; float share; };
const float kA = 2.0;
shared float sums[8];
Sum mean(Sum sum, out float share, int count) {
    share = sum.share;
    if (count == 0) return sum;
    for (float i = 0.0; i < 2.0; ++i) sum.light *= i;
    return Sum(sum.light / float(count), 1.0);
}
int twice(int x) { return 2 * x; }
void main() {
    vec3 a = vec3(kA), b;
    int n = twice(3);
    out_color = vec4(a + b, float(n));
    OUT.x = 1.0;
}
)";
    EXPECT_EQ(ShaderText(text).made_precise(), R"(#version 450 core
#include <pass>
struct Sum { vec3 light; float share; };
const float kA = 2.0;
shared precise float sums[8];
Sum mean(precise Sum sum, out precise float share, int count) {
    share = sum.share;
    if (count == 0) { precise Sum meta_result = sum; return meta_result; }
    for (precise float i = 0.0; i < 2.0; ++i) sum.light *= i;
    { precise Sum meta_result = Sum(sum.light / float(count), 1.0); return meta_result; }
}
int twice(int x) { return 2 * x; }
void main() {
    precise vec3 a = vec3(kA), b;
    int n = twice(3);
    out_color = meta_same(vec4(a + b, float(n)));
    OUT.x = meta_same(1.0);
}
)");
}

TEST(ShaderVariant, KeepsWhatTheShaderSays) {
    const std::string text = R"(#version 450 core
#include <pass>
const float kA = 2.0;
const float kB = 3.0;
float half_of(float x) { return 0.5 * x; }
vec3 twice(vec3 v) { float two = 2.0; return two * v; }
void main() {
    float width = half_of(kA), height = kB;
    out_color = vec4(twice(vec3(width)), height);
}
)";
    std::map<std::string, int> found;
    for (unsigned seed = 1; seed < 40; ++seed) {
        std::mt19937 random(seed);
        Rewrites all{true, false, true, true, true, true};
        int sites = 0;
        ShaderText shader(text);
        const std::string variant = shader.rewritten(all, shader.global_names(), random, sites);
        for (const char* part :
             {"return meta_same(0.5 * x);", "if (meta_one < 0.5) return;", "return float(0);", "do {",
              "float other_two = 2.0; return other_two * v;", "const float kB = 3.0;\nconst float kA = 2.0;",
              "float other_width = half_of(kA)"})
            found[part] += variant.find(part) != std::string::npos ? 1 : 0;
        EXPECT_EQ(variant.find("other_kA"), std::string::npos) << "no global is renamed\n" << variant;
        EXPECT_LT(variant.find(" twice("), variant.find("void main")) << "main calls it\n" << variant;
    }
    EXPECT_EQ(found.size(), 7u);
    for (const auto& [part, times] : found) EXPECT_GT(times, 0) << part;
}

}  // namespace
}  // namespace aftershade::test
