// Graphs without programs: compiling one draws nothing.
#pragma once

#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "framework/graph/frame_graph.h"

namespace aftershade::graph {

/// For a program that outlives the graph.
inline std::shared_ptr<const gpu::Program> kept_by_caller(const gpu::Program& program) {
    return {std::shared_ptr<void>(), &program};
}

inline const gpu::TextureDesc kFull{.width = 64, .height = 36, .format = gpu::TextureFormat::rgba32f};
inline const gpu::TextureDesc kHalf{.width = 32, .height = 18, .format = gpu::TextureFormat::rgba32f};
inline const gpu::TextureDesc kOneChannel{.width = 64, .height = 36, .format = gpu::TextureFormat::r32f};
inline const gpu::TextureDesc kIds{.width = 64, .height = 36, .format = gpu::TextureFormat::r32ui};
inline const gpu::TextureDesc kPyramid{
    .width = 64, .height = 36, .format = gpu::TextureFormat::r32f, .mips = 3};
inline const gpu::TextureDesc kArray{
    .width = 64, .height = 36, .format = gpu::TextureFormat::r32f, .layers = 2};
constexpr std::uint64_t kFullBytes = 64 * 36 * 16;

inline Pass pass_named(std::string name, PassKind kind, std::initializer_list<TextureHandle> reads = {}) {
    Pass pass{.name = std::move(name), .kind = kind};
    for (const TextureHandle handle : reads)
        pass.reads.push_back({.texture = handle, .binding = int(pass.reads.size())});
    return pass;
}

struct Graph : FrameGraph {
    std::vector<TextureHandle> draws(const std::string& name, std::initializer_list<TextureHandle> reads,
                                     std::initializer_list<TextureHandle> targets) {
        Pass pass = pass_named(name, PassKind::draw, reads);
        for (const TextureHandle handle : targets) pass.targets.push_back({handle});
        return add_pass(std::move(pass)).targets;
    }
    TextureHandle draw(const std::string& name, std::initializer_list<TextureHandle> reads,
                       TextureHandle target) {
        return draws(name, reads, {target}).front();
    }
    TextureHandle draw_at(const std::string& name, std::initializer_list<TextureHandle> reads,
                          Target target) {
        Pass pass = pass_named(name, PassKind::draw, reads);
        pass.targets = {target};
        return add_pass(std::move(pass)).targets.front();
    }
    TextureHandle blend(const std::string& name, std::initializer_list<TextureHandle> reads,
                        TextureHandle target) {
        Pass pass = pass_named(name, PassKind::draw, reads);
        pass.targets = {{target}};
        pass.blend = gpu::Blend::add;
        return add_pass(std::move(pass)).targets.front();
    }
    TextureHandle store(const std::string& name, std::initializer_list<TextureHandle> reads,
                        TextureHandle image, gpu::Access access = gpu::Access::write, int level = 0) {
        Pass pass = pass_named(name, PassKind::compute, reads);
        pass.images = {{image, 0, access, level}};
        return add_pass(std::move(pass)).images.front();
    }
    BufferHandle compute(const std::string& name, std::initializer_list<BufferHandle> reads,
                         BufferHandle written, gpu::Access access = gpu::Access::write) {
        Pass pass = pass_named(name, PassKind::compute);
        pass.buffers = {{written, 0, access}};
        for (const BufferHandle handle : reads)
            pass.buffers.push_back({handle, int(pass.buffers.size()), gpu::Access::read});
        return add_pass(std::move(pass)).buffers.front();
    }
    TextureHandle clear(const std::string& name, Target target) {
        Pass pass = pass_named(name, PassKind::clear);
        pass.targets = {target};
        return add_pass(std::move(pass)).targets.front();
    }
    TextureHandle fresh(const std::string& name, const gpu::TextureDesc& desc = kFull) {
        return create_texture(name, desc);
    }
    TextureHandle cleared(const std::string& name, const gpu::TextureDesc& desc = kFull) {
        TextureOptions options;
        options.clear = std::array<double, 4>{};
        return create_texture(name, desc, options);
    }
    std::vector<std::string> running() const {
        std::vector<std::string> names;
        for (const int index : compile().passes) names.push_back(pass(index).name);
        return names;
    }
};

using Names = std::vector<std::string>;

/// The message of the GraphError that `action` throws; empty where it throws none.
template <typename Action>
std::string fault_of(Action action) {
    try {
        action();
    } catch (const GraphError& error) {
        return error.what();
    }
    return {};
}

inline int slot(const CompiledGraph& compiled, TextureHandle handle) {
    return compiled.slot_of_texture[std::size_t(handle.texture)];
}
inline int slot(const CompiledGraph& compiled, BufferHandle handle) {
    return compiled.slot_of_buffer[std::size_t(handle.buffer)];
}

}  // namespace aftershade::graph
