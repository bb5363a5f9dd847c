#include "framework/scene/gltf_values.h"

#include "framework/scene/gltf_bytes.h"

namespace aftershade::scene {

namespace {

std::uint32_t index_in(const unsigned char* bytes, int component) {
    if (component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return *bytes;
    std::uint16_t narrow = 0;
    std::uint32_t wide = 0;
    if (component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) std::memcpy(&narrow, bytes, sizeof(narrow));
    else std::memcpy(&wide, bytes, sizeof(wide));
    return component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? narrow : wide;
}

}  // namespace

GltfValues::GltfValues(const std::filesystem::path& path, const tinygltf::Model& model, int index,
                       std::string what, std::initializer_list<int> types)
    : path_(path), what_(std::move(what)) {
    if (index < 0 || std::size_t(index) >= model.accessors.size())
        fault(fmt::format("accessor {} is not there, the file has {}", index, model.accessors.size()));
    const tinygltf::Accessor& accessor = model.accessors[std::size_t(index)];
    if (std::find(types.begin(), types.end(), accessor.type) == types.end())
        fault(fmt::format("accessor {} has the wrong type for it", index));
    component_ = accessor.componentType;
    normalized_ = accessor.normalized;
    count_ = accessor.count;
    const int component_bytes = tinygltf::GetComponentSizeInBytes(std::uint32_t(component_));
    const int components = tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type));
    if (component_bytes <= 0 || components <= 0)
        fault(fmt::format("accessor {} has a component type that cannot be", index));
    Layout all{fmt::format("accessor {}", index), accessor.bufferView, accessor.byteOffset, count_,
               std::size_t(component_bytes * components)};
    if (accessor.bufferView != -1) bytes_ = range(model, all);
    stride_ = accessor.bufferView != -1 ? all.stride : all.bytes;
    if (accessor.bufferView == -1 || accessor.sparse.isSparse) replace_some(model, accessor, all);
}

/// The bytes from the first value on.
std::span<const unsigned char> GltfValues::range(const tinygltf::Model& model, Layout& layout) const {
    const auto& [name, view_index, offset, count, bytes, stride] = layout;
    if (view_index < 0 || std::size_t(view_index) >= model.bufferViews.size())
        fault(
            fmt::format("bufferView {} is not there, the file has {}", view_index, model.bufferViews.size()));
    const tinygltf::BufferView& view = model.bufferViews[std::size_t(view_index)];
    if (view.buffer < 0 || std::size_t(view.buffer) >= model.buffers.size())
        fault(fmt::format("buffer {} is not there, the file has {}", view.buffer, model.buffers.size()));
    const tinygltf::Buffer& buffer = model.buffers[std::size_t(view.buffer)];
    if (stride == 0) layout.stride = view.byteStride == 0 ? bytes : view.byteStride;
    if (stride < bytes) fault(fmt::format("{} has a component type or a stride that cannot be", name));
    if (view.byteOffset > buffer.data.size() || view.byteLength > buffer.data.size() - view.byteOffset)
        fault(
            fmt::format("bufferView {} ends outside its buffer of {} bytes", view_index, buffer.data.size()));
    const std::size_t limit = view.byteLength;
    const bool is_inside = count == 0 || (offset <= limit && limit - offset >= bytes &&
                                          (limit - offset - bytes) / stride >= count - 1);
    if (!is_inside)
        fault(fmt::format("the {} values of {} end outside its bufferView of {} bytes", count, name, limit));
    return std::span(buffer.data).subspan(view.byteOffset, limit).subspan(std::min(offset, limit));
}

/// glTF 2.0, 3.6.2.3: zeros without a bufferView, and the values that a sparse accessor has in their place.
void GltfValues::replace_some(const tinygltf::Model& model, const tinygltf::Accessor& accessor,
                              const Layout& all) {
    if (count_ > kMaxGltfBytes / all.bytes)
        fault(fmt::format("{} has {} values, more than {} bytes", all.name, count_, kMaxGltfBytes));
    // Zeros cost a file nothing, and the corners of the triangles that a mesh may have are no more than
    // these.
    constexpr std::size_t kMostZeros = 12'000'000;
    if (accessor.bufferView == -1 && count_ > kMostZeros)
        fault(
            fmt::format("{} has {} values and no bufferView; the limit is {}", all.name, count_, kMostZeros));
    own_.resize(count_ * all.bytes);
    for (std::size_t i = 0; i < count_ && !bytes_.empty(); ++i)
        std::memcpy(&own_[i * all.bytes], &bytes_[i * stride_], all.bytes);
    bytes_ = own_;
    stride_ = all.bytes;
    if (!accessor.sparse.isSparse) return;
    const auto& sparse = accessor.sparse;
    const int component = sparse.indices.componentType;
    if (component != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
        component != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        component != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
        fault(fmt::format("component type {} is not allowed for indices (use an unsigned integer type)",
                          component));
    // Signed in some versions of the loader.
    if (std::int64_t(sparse.count) < 0 || std::int64_t(sparse.indices.byteOffset) < 0 ||
        std::int64_t(sparse.values.byteOffset) < 0)
        fault(all.name + " has sparse values with a negative count or byteOffset");
    const auto count = std::size_t(sparse.count);
    const auto index_bytes = std::size_t(tinygltf::GetComponentSizeInBytes(std::uint32_t(component)));
    Layout at{"the sparse indices of " + all.name,
              sparse.indices.bufferView,
              std::size_t(sparse.indices.byteOffset),
              count,
              index_bytes,
              index_bytes};
    Layout of{"the sparse values of " + all.name,
              sparse.values.bufferView,
              std::size_t(sparse.values.byteOffset),
              count,
              all.bytes,
              all.bytes};
    const auto indices = range(model, at), values = range(model, of);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t index = index_in(&indices[i * index_bytes], component);
        if (index >= count_)
            fault(fmt::format("sparse index {} is {}, out of range of {} values", i, index, count_));
        std::memcpy(&own_[index * all.bytes], &values[i * all.bytes], all.bytes);
    }
}

}  // namespace aftershade::scene
