// Decoupled sampling: counts against sets and closed forms, pictures against light at every sample.
#include "framework/scene/visibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <numbers>
#include <set>
#include <unordered_set>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "framework/base/error.h"
#include "framework/scene/triangulate.h"
#include "tests/scene/scene_text.h"
#include "tests/scene/with_samples.h"

namespace aftershade::scene {
namespace {

VisibilityPicture picture_of(const Scene& scene, int frame, const VisibilitySettings& settings,
                             int threads = 2) {
    const Scene triangles = triangulated(scene);
    const SceneRenderer renderer(triangles, scene.width_px, scene.height_px, threads);
    return render_visibility(renderer, frame, settings);
}

double psnr_db(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.floats().size(); ++i)
        sum += std::pow(double(a.floats()[i]) - double(b.floats()[i]), 2);
    return 10 * std::log10(double(a.floats().size()) / sum);
}

/// A plane of 256 x 128 px that lies on the pixels of a picture of 384 x 192, moved by `motion_px` while the
/// shutter is open, with a CoC of `coc_px` across.
Scene sheet(const glm::dvec2& motion_px, double coc_px) {
    // 100 px a metre at 3.84 m; focus at half of it, so that the CoC's radius is 100 px times the aperture's.
    const double f_number = coc_px > 0 ? 0.036 / (2 * coc_px / 2 / 100) : 1000;
    const glm::dvec2 step_m = 2.0 * motion_px / 100.0;
    return scene_of(fmt::format(R"({{ "aftershade": 1, "size": [384, 192], "ambient": 0.5,
        "camera": {{ "position": [0, 0, 0], "target": [0, 0, -1], "focal_length": 36, "focus_distance": 1.92,
                     "f_number": {} }},
        "shutter": {{ "angle": 180 }}, "materials": {{ "grey": {{ "albedo": 0.5, "specular": 0 }} }},
        "objects": [ {{ "shape": "plane", "size": [2.56, 1.28], "material": "grey",
          "position": {{ "keys": {{ "0": [{}, {}, -3.84], "2": [{}, {}, -3.84] }} }} }} ] }})",
                                f_number, -step_m.x, -step_m.y, step_m.x, step_m.y));
}

TEST(ShadingSamples, HaveTheMeanAlbedoOfTheirCells) {
    Scene scene = sheet({0, 0}, 0);
    // Checks of half a pixel by one: each pixel has as much of both.
    scene.materials[0].albedo = glm::dvec3(0.8);
    scene.materials[0].albedo_2 = glm::dvec3(0.2);
    scene.materials[0].checker_cells = {512, 128};
    const Image color = picture_of(scene, 1, with_samples(4)).color;
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 256; ++x) {
            if (std::abs(x - 2 * y) < 4 || std::abs(256 - x - 2 * y) < 4)
                continue;  // the triangles' common edge
            ASSERT_NEAR(color.at(64 + x, 32 + y, 0), 0.5 * 0.5, 1e-6) << x << ", " << y;
        }
}

/// Cells of the sheet's two triangles: all of them, and those of the diagonal a second time.
constexpr double kSheetCells = 256 * 128 + 256;
constexpr double kSheetPixels = 256 * 128;

struct TracedSheet {
    std::vector<std::uint32_t> ids;
    SampleIds samples() const { return {ids, 384, 192, 64}; }
};

TracedSheet traced(const Scene& scene) {
    const Scene triangles = triangulated(scene);
    const SceneRenderer renderer(triangles, 384, 192, 2);
    const ShadingGrids grids(renderer, 1, {});
    return {trace_ids(renderer, grids, 1, with_samples(64))};
}

TEST(ShadingCaches, CountWhatSetsOfIdsCount) {
    const TracedSheet sheet_ids = traced(sheet({7, 3}, 5));
    const SampleIds samples = sheet_ids.samples();
    std::unordered_set<std::uint32_t> all;
    std::set<std::array<std::uint32_t, 3>> of_tiles;
    for (std::uint32_t y = 0; y < 192; ++y)
        for (std::uint32_t x = 0; x < 384; ++x)
            for (std::uint32_t i = 0; i < 64; ++i)
                if (const std::uint32_t id = samples.ids[(y * 384 + x) * 64 + i]; id != kNoShading) {
                    all.insert(id);
                    of_tiles.insert({x / 20, y / 20, id});
                }
    const CacheReplay global = replay(samples, {});
    EXPECT_EQ(global.shadings, all.size());
    EXPECT_EQ(replay(samples, {ShadingCache::tile, 20}).shadings, of_tiles.size());
    EXPECT_EQ(replay(samples, {ShadingCache::sorted, 20}).shadings, of_tiles.size());
    double sum = 0;
    for (const float shadings : global.of_pixel) sum += double(shadings);
    EXPECT_NEAR(sum, double(all.size()), 1e-3 * double(all.size()));
}

TEST(ShadingCaches, OfSomeEntriesDropWhatALineOfThemDrops) {
    // In one tile the order of the samples is that of the picture.
    std::vector<std::uint32_t> ids(32 * 32 * 4);
    for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = std::uint32_t((i * 2654435761u >> 7) % 97);
    for (const bool renews : {true, false}) {
        std::deque<std::uint32_t> line;
        std::uint64_t misses = 0;
        for (const std::uint32_t id : ids) {
            const auto found = std::find(line.begin(), line.end(), id);
            if (found == line.end()) ++misses;
            if (found != line.end() && !renews) continue;
            if (found != line.end()) line.erase(found);
            line.push_back(id);
            if (line.size() > 40) line.pop_front();
        }
        const CacheReplay counts =
            replay({ids, 32, 32, 4}, {renews ? ShadingCache::lru : ShadingCache::fifo, 32, 40});
        EXPECT_EQ(counts.shadings, misses) << renews;
        EXPECT_EQ(counts.requests, ids.size());
    }
}

TEST(ShadingCaches, GiveEachSampleAShadingOfItsOwnIdThatTheyHaveNotDropped) {
    std::vector<std::uint32_t> ids(32 * 32 * 4);
    for (std::size_t i = 0; i < ids.size(); ++i)
        ids[i] = i % 11 == 0 ? kNoShading : std::uint32_t((i * 2654435761u >> 7) % 97);
    for (const ShadingCache cache : {ShadingCache::global, ShadingCache::tile, ShadingCache::sorted,
                                     ShadingCache::lru, ShadingCache::fifo}) {
        const CacheReplay replayed = replay({ids, 32, 32, 4}, {cache, 16, 40});
        EXPECT_EQ(replayed.ids.size(), replayed.shadings);
        for (std::size_t i = 0; i < ids.size(); ++i) {
            const std::uint32_t address = replayed.addresses[i];
            ASSERT_EQ(address == kNoShading ? kNoShading : replayed.ids.at(address), ids[i]) << i;
        }
        const std::set<std::uint32_t> distinct(replayed.ids.begin(), replayed.ids.end());
        EXPECT_EQ(distinct.size(), 97);
        EXPECT_EQ(distinct.size() == replayed.ids.size(), cache == ShadingCache::global);
    }
}

TEST(ShadingCaches, OfTilesShadeAgainWhereATrailCrossesThem) {
    // A cell on the pixels that moves by an even number of them crosses m (|cos| + |sin|) / T edges of tiles.
    for (const auto& [motion_px, tile_px] : {std::pair(glm::dvec2(8, 0), 16), {glm::dvec2(8, 8), 32}}) {
        const TracedSheet moved = traced(sheet(motion_px, 0));
        const double expected = kSheetCells * (1 + (motion_px.x + motion_px.y) / tile_px);
        EXPECT_NEAR(double(replay(moved.samples(), {ShadingCache::tile, tile_px}).shadings), expected,
                    0.05 * expected)
            << motion_px.y;
    }
    const TracedSheet blurred = traced(sheet({0, 0}, 8));
    const double across = 8.0 / 32, corners = std::numbers::pi / 4 * across * across;
    const double expected = kSheetCells * (1 + 2 * across + corners);
    EXPECT_NEAR(double(replay(blurred.samples(), {ShadingCache::tile, 32}).shadings), expected,
                0.05 * expected);
}

TEST(Visibility, ShadesEachCellOfASheetOnceWhateverTheBlur) {
    for (const auto& [motion_px, coc_px] :
         {std::pair(glm::dvec2(0, 0), 0.0), {glm::dvec2(16, 6), 0.0}, {glm::dvec2(0, 0), 16.0}}) {
        const VisibilityReport report = picture_of(sheet(motion_px, coc_px), 1, with_samples(64)).report;
        EXPECT_NEAR(report.rate.of_covered_pixels, kSheetCells / kSheetPixels, 0.01);
        EXPECT_EQ(report.bytes.supersampled, 384u * 192 * 64 * 12);
    }
}

TEST(Visibility, ShowsWhatLightAtEverySampleShowsWhereItHangsOnNeitherViewNorTime) {
    const Scene scene = scene_of(R"({ "aftershade": 1, "size": [160, 90], "ambient": 0.1,
        "camera": { "position": [0, 0, 4], "target": [0, 0, 0], "focus_distance": 3, "f_number": 0.4 },
        "materials": { "red": { "albedo": [0.8, 0.2, 0.1], "specular": 0 },
                       "lamp": { "albedo": 0, "specular": 0, "emission": 0.6 } },
        "objects": [
          { "shape": "sphere", "radius": 0.5, "material": "red",
            "position": { "keys": { "0": [-0.5, 0, 0], "2": [0.3, 0.1, 0] } } },
          { "shape": "box", "size": 0.4, "material": "lamp", "rotation": [20, 30, 0], "position": [0.7, 0, 1] } ],
        "lights": [ { "type": "directional", "position": [1, 2, 3], "intensity": 2, "shadows": false } ] })");
    VisibilitySettings settings = with_samples(32);
    const Image memoised = picture_of(scene, 1, settings).color;
    settings.visibility = Visibility::supersampled;
    const VisibilityPicture plain = picture_of(scene, 1, settings);
    EXPECT_GT(psnr_db(plain.color, memoised), 50);
    EXPECT_DOUBLE_EQ(plain.report.rate.of_covered_pixels, 32);
}

TEST(Visibility, FindsTheSameAmbientLightByFewShadingSamplesAndByAll) {
    Scene scene = scene_of(R"({ "aftershade": 1, "size": [64, 36], "ambient": 0.8, "ambient_rays": 16,
        "camera": { "position": [0, 0.6, 3], "target": [0, 0.2, 0], "focus_distance": 3, "f_number": 0.3 },
        "materials": { "clay": { "albedo": 0.7, "specular": 0 } },
        "objects": [ { "shape": "plane", "size": [6, 6], "rotation": [-90, 0, 0], "material": "clay" },
                     { "shape": "box", "size": [1, 1, 1], "position": [0, 0.5, 0], "rotation": [0, 20, 0],
                       "material": "clay" } ] })");
    VisibilitySettings settings = with_samples(16);
    const VisibilityPicture memoised = picture_of(scene, 1, settings);
    settings.visibility = Visibility::supersampled;
    const VisibilityPicture plain = picture_of(scene, 1, settings);
    EXPECT_LT(memoised.report.shadings * 8, plain.report.shadings);
    EXPECT_GT(psnr_db(memoised.color, plain.color), 38);
    scene.ambient_rays = 0;
    EXPECT_LT(psnr_db(picture_of(scene, 1, settings).color, plain.color), 25);
}

TEST(Visibility, TakesTheSamplesOfTheTruth) {
    Scene scene = shipped_scene("bats");
    scene.width_px = 96;
    scene.height_px = 54;
    VisibilitySettings settings = with_samples(4);
    settings.visibility = Visibility::supersampled;
    TruthSettings truth;
    truth.kinds = {true, true, true};
    truth.method = TruthMethod::interleaved;
    truth.samples = 4;
    const Image expected = SceneRenderer(scene, 96, 54, 2).render_truth(6, truth);
    const Image found = picture_of(scene, 6, settings).color;
    EXPECT_TRUE(std::equal(expected.floats().begin(), expected.floats().end(), found.floats().begin()));
}

TEST(Visibility, IsTheSameWithAnyCache) {
    Scene scene = shipped_scene("panes");
    scene.width_px = 64;
    scene.height_px = 36;
    scene.ambient_rays = 4;
    for (const Transparency transparency : {Transparency::stochastic, Transparency::lists}) {
        VisibilitySettings settings = with_samples(8);
        settings.transparency.transparency = transparency;
        const VisibilityPicture all = picture_of(scene, 4, settings);
        settings.cache.entries = 16;
        for (const ShadingCache cache :
             {ShadingCache::tile, ShadingCache::sorted, ShadingCache::lru, ShadingCache::fifo}) {
            settings.cache.cache = cache;
            const VisibilityPicture found = picture_of(scene, 4, settings);
            EXPECT_GT(found.report.shadings, all.report.shadings);
            EXPECT_TRUE(std::equal(all.color.floats().begin(), all.color.floats().end(),
                                   found.color.floats().begin()));
        }
    }
}

TEST(Visibility, IsTheSameOnAnyNumberOfThreads) {
    Scene scene = shipped_scene("toys");
    scene.width_px = 120;
    scene.height_px = 68;
    VisibilitySettings settings = with_samples(64);
    settings.grid.anisotropic = true;
    settings.cache.cache = ShadingCache::tile;
    const VisibilityPicture one = picture_of(scene, 4, settings, 1);
    for (const int threads : {2, 5}) {
        const VisibilityPicture many = picture_of(scene, 4, settings, threads);
        EXPECT_EQ(many.report.shadings, one.report.shadings);
        EXPECT_TRUE(
            std::equal(one.color.floats().begin(), one.color.floats().end(), many.color.floats().begin()));
    }
}

double rate_of_bats(const Scene& bats, int samples) {
    return picture_of(bats, 6, with_samples(samples)).report.rate.of_covered_pixels;
}

TEST(Visibility, ShadesBatsOfTinyTrianglesAtMostFourTimesAPixel) {
    Scene bats = shipped_scene("bats");
    const double few = rate_of_bats(bats, 8), many = rate_of_bats(bats, 64);
    EXPECT_LE(many, 4.0);
    EXPECT_LE(many, 1.5 * few);
    const double at_27 = rate_of_bats(bats, 27);
    bats.camera.f_number /= 4;
    EXPECT_NEAR(rate_of_bats(bats, 27) / at_27, 1, 0.2);
    bats.camera.f_number = 1000;
    bats.camera.shutter_angle_deg = 360;
    EXPECT_NEAR(rate_of_bats(bats, 27) / at_27, 1, 0.2);
}

TEST(Visibility, ShadesWhatIsBlurredMoreCoarselyAndLooksAsItDid) {
    Scene toys = shipped_scene("toys");
    toys.width_px = 240;
    toys.height_px = 135;
    const Scene triangles = triangulated(toys);
    const SceneRenderer renderer(triangles, 240, 135, 2);
    TruthSettings truth;
    truth.kinds = {true, true, true};
    truth.method = TruthMethod::interleaved;
    truth.seed = 5;
    const Image expected = renderer.render_truth(4, truth);
    VisibilitySettings settings = with_samples(64);
    const VisibilityPicture even = render_visibility(renderer, 4, settings);
    settings.grid.anisotropic = true;
    const VisibilityPicture coarse = render_visibility(renderer, 4, settings);
    EXPECT_LE(double(coarse.report.shadings), 0.8 * double(even.report.shadings));
    EXPECT_GE(psnr_db(expected, coarse.color), psnr_db(expected, even.color) - 0.5);
}

TEST(ShadingGrids, PlaceTheLightOfEveryIdInsideItsOwnTriangle) {
    const Scene toys = triangulated(shipped_scene("toys"));
    const SceneRenderer renderer(toys, 120, 68, 2);
    for (const GridOrigin origin : {GridOrigin::triangle, GridOrigin::picture}) {
        const ShadingGrids grids(renderer, 4, {.origin = origin});
        for (std::uint32_t id = 0; id < grids.id_count(); id += 7) {
            const ShadingPlace place = grids.place_of(id);
            EXPECT_GE(std::min(place.barycentric.x, place.barycentric.y), 0);
            EXPECT_LE(place.barycentric.x + place.barycentric.y, 1 + 1e-9);
            EXPECT_EQ(place.from_behind, id % 2 == 1);
        }
    }
}

TEST(ShadingGrids, RefuseMoreIdsThanASetOf128MiBHolds) {
    // A wall beside the camera and behind it: each triangle may show all over the picture.
    const Scene scene = triangulated(scene_of(R"({ "aftershade": 1, "size": [4096, 4096],
        "camera": { "position": [0, 0, 0], "target": [0, 0, -1] },
        "objects": [ { "shape": "plane", "size": [9, 9], "position": [0, -1, 0], "rotation": [-90, 0, 0] } ] })"));
    const SceneRenderer renderer(scene, 4096, 4096, 1);
    try {
        const ShadingGrids grids(renderer, 1, {.rate = 4});
        FAIL() << grids.id_count();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("choose a lower shading_rate or size"), std::string::npos)
            << error.what();
    }
}

double volume_m3(const Mesh& mesh) {
    double six = 0;
    for (const auto& corner : mesh.triangles)
        six += glm::dot(mesh.vertices[corner[0]].position,
                        glm::cross(mesh.vertices[corner[1]].position, mesh.vertices[corner[2]].position));
    return six / 6;
}

TEST(Triangulated, EnclosesTheVolumeOfTheShape) {
    const Scene scene = triangulated(scene_of(R"({ "aftershade": 1, "camera": {}, "objects": [
        { "shape": "box", "size": [1, 2, 3] }, { "shape": "sphere", "radius": 2 },
        { "shape": "cylinder", "radius": 0.5, "height": 3 }, { "shape": "sphere", "radius": 2 } ] })"));
    ASSERT_EQ(scene.meshes.size(), 3u);
    EXPECT_NEAR(volume_m3(scene.meshes[0]), 6, 1e-12);
    EXPECT_NEAR(volume_m3(scene.meshes[1]) / (32 * std::numbers::pi / 3), 1, 0.005);
    EXPECT_NEAR(volume_m3(scene.meshes[2]) / (0.75 * std::numbers::pi), 1, 0.002);
}

TEST(Triangulated, LooksLikeTheShapes) {
    for (const char* id : {"toys", "wheel", "point_grid"}) {
        const Scene scene = shipped_scene(id), triangles = triangulated(scene);
        TruthSettings settings;
        settings.kinds.antialias = true;
        settings.samples = 4;
        const Image shapes = SceneRenderer(scene, 240, 135, 2).render_truth(3, settings);
        const Image meshes = SceneRenderer(triangles, 240, 135, 2).render_truth(3, settings);
        std::size_t other = 0;
        for (std::size_t i = 0; i < shapes.floats().size(); ++i)
            other += std::abs(shapes.floats()[i] - meshes.floats()[i]) > 0.02f;
        EXPECT_LT(double(other) / double(shapes.floats().size()), 0.005) << id;
    }
}

}  // namespace
}  // namespace aftershade::scene
