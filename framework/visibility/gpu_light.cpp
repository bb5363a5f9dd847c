#include "framework/visibility/gpu_light.h"

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "framework/visibility/bands.h"
#include "framework/visibility/light_scene.h"
#include "framework/visibility/world_buffers.h"

namespace aftershade {
std::string_view visibility_shade_shader();        // shade.comp with alpha_off.glsl
std::string_view visibility_shade_alpha_shader();  // and with alpha_on.glsl
std::string_view visibility_resolve_shader();      // resolve.comp
}  // namespace aftershade

namespace aftershade::visibility {

using glm::vec4;
using gpu::Access;

namespace {

struct ShadeSettings {
    glm::mat4 world_from_camera{1};
    vec4 ambient{0};
    glm::vec2 size_px{0};
    float px_per_tangent = 0;
    std::uint32_t id_count = 0;
    std::uint32_t surface_count = 0;
    std::uint32_t light_count = 0;
    std::uint32_t unused[2] = {};
};

struct ResolveSettings {
    vec4 background{0};
    std::uint32_t pixel_count = 0;
    std::uint32_t sample_count = 0;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

/// What one run of the passes has room for.
struct Room {
    std::size_t ids = 0;     ///< shading samples
    std::size_t pixels = 0;  ///< of a band
    std::size_t samples = 0;
};

/// Two passes: the light of some shading samples, and what it adds to the pixels of a band.
class LightGraph {
public:
    LightGraph(Passes& passes, const scene::SceneRenderer& renderer, const scene::ShadingGrids& grids,
               const Room& room, std::size_t max_buffer_bytes)
        : passes_(passes),
          scene_path_(renderer.scene().path.string()),
          scene_(make_light_surfaces(renderer.scene(), grids)),
          world_(graph_, renderer,
                 {.light = true, .tangents_at = &grids.reference(), .max_bytes = max_buffer_bytes}),
          executor_(executor_of(passes, make_graph(room))) {
        shade_.world_from_camera = glm::mat4(grids.reference().camera.world_from_camera);
        shade_.ambient = with(renderer.scene().ambient, double(renderer.scene().ambient_rays));
        shade_.size_px = {renderer.width_px(), renderer.height_px()};
        shade_.px_per_tangent = float(renderer.pixels_per_tangent(grids.reference().camera));
        shade_.surface_count = std::uint32_t(scene_.surfaces.size());
        shade_.light_count = std::uint32_t(renderer.scene().lights.size());
        world_.set(executor_);
        world_.set_moments(executor_, kShade, {grids.world()});
        set(executor_, surfaces_, scene_.surfaces);
    }

    /// `ids` are those of the shadings from address `first`.
    void shade(std::span<const std::uint32_t> ids, std::size_t first) {
        shade_.id_count = resolve_.count = std::uint32_t(ids.size());
        resolve_.first = std::uint32_t(first);
        std::vector<std::uint32_t> words = scene_.starts;
        words.insert(words.end(), ids.begin(), ids.end());
        set(executor_, ids_, words);
        executor_.set_uniforms(kShade, 0, bytes_of(shade_));
        passes_.run(executor_, {kShade, kShade + 1});
        check_loops(executor_, unfinished_, scene_path_);
    }

    /// RGB of the band's pixels, without what other slices add.
    std::vector<vec4> resolve(std::span<const std::uint32_t> addresses, int samples,
                              const glm::dvec3& background) {
        resolve_.background = vec4(glm::vec3(background), 0);
        resolve_.sample_count = std::uint32_t(samples);
        resolve_.pixel_count = std::uint32_t(addresses.size()) / resolve_.sample_count;
        set(executor_, addresses_, addresses);
        executor_.set_uniforms(kResolve, 0, bytes_of(resolve_));
        passes_.run(executor_, {kResolve, kResolve + 1});
        return values_of<vec4>(executor_, means_);
    }

private:
    static constexpr int kShade = 0, kResolve = 1;

    graph::FrameGraph make_graph(const Room& room) {
        surfaces_ = graph_.import_buffer("surfaces", room_for(scene_.surfaces));
        ids_ = graph_.import_buffer("ids", {(scene_.starts.size() + room.ids) * sizeof(std::uint32_t)});
        graph::Pass shade =
            passes_.pass("visibility.shade",
                         world_.has_alpha() ? visibility_shade_alpha_shader() : visibility_shade_shader(),
                         group_count(room.ids));
        const auto light = graph_.create_buffer("light", {room.ids * sizeof(vec4)});
        shade.uniforms = {{0, bytes_of(shade_)}};
        world_.add_to(shade);
        shade.buffers.push_back({ids_, 2, Access::read});
        shade.buffers.push_back({surfaces_, 3, Access::read});
        shade.buffers.push_back({light, 6, Access::write});
        const std::size_t shaded = shade.buffers.size() - 1;
        const graph::Written written = add_with_loops(graph_, std::move(shade));
        unfinished_ = written.buffers.back();

        addresses_ = graph_.import_buffer("addresses", {room.pixels * room.samples * sizeof(std::uint32_t)});
        graph::Pass resolve =
            passes_.pass("visibility.resolve", visibility_resolve_shader(), group_count(room.pixels));
        resolve.uniforms = {{0, bytes_of(resolve_)}};
        resolve.buffers = {{addresses_, 0, Access::read},
                           {written.buffers[shaded], 1, Access::read},
                           {graph_.create_buffer("means", {room.pixels * sizeof(vec4)}), 2, Access::write}};
        means_ = graph_.add_pass(std::move(resolve)).buffers.back();
        graph_.keep(means_);
        return std::move(graph_);
    }

    Passes& passes_;
    std::string scene_path_;
    LightSurfaces scene_;
    graph::FrameGraph graph_;  // until the executor has it
    WorldBuffers world_;
    ShadeSettings shade_;
    ResolveSettings resolve_;
    graph::BufferHandle surfaces_, ids_, addresses_, means_, unfinished_;
    graph::Executor executor_;  // made of all the above
};

void add(Image& color, int first_row, int rows, const std::vector<vec4>& means) {
    const std::size_t pixels = std::size_t(color.width()) * std::size_t(rows);
    const std::size_t first = std::size_t(color.width()) * std::size_t(first_row);
    for (std::size_t i = 0; i < pixels; ++i)
        for (std::size_t c = 0; c < 3; ++c) color.floats()[(first + i) * 4 + c] += means[i][int(c)];
}

}  // namespace

Image resolve_light(Passes& passes, const scene::SceneRenderer& renderer, const scene::ShadingGrids& grids,
                    std::span<const std::uint32_t> ids, const scene::SampleIds& addresses,
                    std::size_t max_buffer_bytes) {
    const auto width = std::size_t(addresses.width_px), count = std::size_t(addresses.samples);
    const Bands bands(addresses.width_px, addresses.height_px,
                      width * std::max(count * sizeof(std::uint32_t), sizeof(vec4)), 1, max_buffer_bytes);
    const std::size_t most = std::min(max_buffer_bytes / sizeof(vec4), std::size_t(kGroup) * kMaxGroups);
    const std::size_t slice = std::clamp(ids.size(), std::size_t(1), most);
    LightGraph graph(passes, renderer, grids, {slice, width * std::size_t(bands.rows), count},
                     max_buffer_bytes);
    Image color(addresses.width_px, addresses.height_px, 4);
    std::size_t first = 0;
    do {
        graph.shade(ids.subspan(first, std::min(slice, ids.size() - first)), first);
        const glm::dvec3 background = first == 0 ? renderer.scene().background : glm::dvec3(0);
        bands.for_each([&](int row, int rows) {
            const auto of_band =
                addresses.ids.subspan(std::size_t(row) * width * count, std::size_t(rows) * width * count);
            add(color, row, rows, graph.resolve(of_band, addresses.samples, background));
        });
        first += slice;
    } while (first < ids.size());
    for (std::size_t i = 3; i < color.floats().size(); i += 4) color.floats()[i] = 1;
    return color;
}

}  // namespace aftershade::visibility
