#include "framework/gpu/egl_api.h"

#include <array>

#include <dlfcn.h>
#include <fmt/format.h>

#include "framework/base/error.h"
#include "framework/gpu/platform.h"

namespace aftershade::gpu {
namespace {

constexpr EGLint kDrmDeviceFile = 0x3233;  // EGL_EXT_device_drm
constexpr EGLint kDrmRenderNode = 0x3377;  // EGL_EXT_device_drm_render_node
constexpr EGLint kCudaDevice = 0x323A;     // EGL_NV_device_cuda
constexpr EGLint kDeviceUuid = 0x335C;     // EGL_EXT_device_persistent_id
constexpr EGLint kRenderer = 0x335F;       // EGL_EXT_device_query_name

void* egl_library() {
    static void* const handle = open_library({"libEGL.so.1"}, "libegl1");
    return handle;
}

template <typename Function>
void load(Function& function, const char* name) {
    void* address = dlsym(egl_library(), name);
    if (!address) throw Error(ErrorKind::gl, fmt::format("libEGL.so.1 has no {}; EGL 1.5 is needed", name));
    function = reinterpret_cast<Function>(address);
}

Device device_of(const EglApi& egl, EGLDeviceEXT handle, int index) {
    Device device;
    device.index = index;
    const char* extensions = egl.query_device_string(handle, EGL_EXTENSIONS);
    const auto text = [&](const char* extension, EGLint name, std::string& value) {
        if (!has_extension(extensions, extension)) return;
        if (const char* said = egl.query_device_string(handle, name)) value = said;
    };
    text("EGL_EXT_device_drm", kDrmDeviceFile, device.card);
    text("EGL_EXT_device_drm_render_node", kDrmRenderNode, device.render_node);
    text("EGL_EXT_device_query_name", kRenderer, device.renderer);
    device.is_software = has_extension(extensions, "EGL_MESA_device_software");
    device.has_cuda = has_extension(extensions, "EGL_NV_device_cuda");
    EGLAttrib cuda = -1;
    if (device.has_cuda && egl.query_device_attrib && egl.query_device_attrib(handle, kCudaDevice, &cuda) &&
        cuda >= 0)
        device.cuda = int(cuda);
    std::array<unsigned char, 16> uuid{};
    EGLint bytes = 0;
    if (has_extension(extensions, "EGL_EXT_device_persistent_id") && egl.query_device_binary &&
        egl.query_device_binary(handle, kDeviceUuid, EGLint(uuid.size()), uuid.data(), &bytes) &&
        bytes == EGLint(uuid.size()))
        device.uuid = uuid_text(uuid, device.has_cuda);
    return device;
}

}  // namespace

bool has_extension(const char* extensions, std::string_view name) {
    const std::string padded = fmt::format(" {} ", extensions ? extensions : "");
    return padded.find(fmt::format(" {} ", name)) != std::string::npos;
}

EglApi load_egl() {
    EglApi egl{};
    load(egl.get_proc_address, "eglGetProcAddress");
    load(egl.get_error, "eglGetError");
    load(egl.query_string, "eglQueryString");
    load(egl.get_platform_display, "eglGetPlatformDisplay");
    load(egl.initialize, "eglInitialize");
    load(egl.bind_api, "eglBindAPI");
    load(egl.choose_config, "eglChooseConfig");
    load(egl.create_context, "eglCreateContext");
    load(egl.destroy_context, "eglDestroyContext");
    load(egl.make_current, "eglMakeCurrent");
    load(egl.get_current_context, "eglGetCurrentContext");
    load(egl.query_context, "eglQueryContext");
    const char* client = egl.query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const bool enumerates = has_extension(client, "EGL_EXT_device_base") ||
                            (has_extension(client, "EGL_EXT_device_enumeration") &&
                             has_extension(client, "EGL_EXT_device_query"));
    if (enumerates && has_extension(client, "EGL_EXT_platform_device")) {
        egl.query_devices =
            reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(egl.get_proc_address("eglQueryDevicesEXT"));
        egl.query_device_string =
            reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(egl.get_proc_address("eglQueryDeviceStringEXT"));
        egl.query_device_attrib =
            reinterpret_cast<PFNEGLQUERYDEVICEATTRIBEXTPROC>(egl.get_proc_address("eglQueryDeviceAttribEXT"));
        egl.query_device_binary =
            reinterpret_cast<QueryDeviceBinary>(egl.get_proc_address("eglQueryDeviceBinaryEXT"));
    }
    return egl;
}

std::string egl_error_name(EGLint code) {
    switch (code) {
        case EGL_NOT_INITIALIZED: return "EGL_NOT_INITIALIZED";
        case EGL_BAD_ACCESS: return "EGL_BAD_ACCESS";
        case EGL_BAD_ALLOC: return "EGL_BAD_ALLOC";
        case EGL_BAD_ATTRIBUTE: return "EGL_BAD_ATTRIBUTE";
        case EGL_BAD_CONFIG: return "EGL_BAD_CONFIG";
        case EGL_BAD_CONTEXT: return "EGL_BAD_CONTEXT";
        case EGL_BAD_DISPLAY: return "EGL_BAD_DISPLAY";
        case EGL_BAD_MATCH: return "EGL_BAD_MATCH";
        case EGL_BAD_PARAMETER: return "EGL_BAD_PARAMETER";
        default: return fmt::format("EGL error 0x{:04x}", code);
    }
}

EglDevices egl_devices(const EglApi& egl) {
    EglDevices found;
    EGLint count = 0;
    if (!egl.query_devices || !egl.query_devices(0, nullptr, &count) || count <= 0) return found;
    found.handles.resize(std::size_t(count));
    egl.query_devices(count, found.handles.data(), &count);
    found.handles.resize(std::size_t(count));
    for (std::size_t i = 0; i < found.handles.size(); ++i)
        found.devices.push_back(device_of(egl, found.handles[i], int(i)));
    complete_devices(found.devices, "/");
    return found;
}

std::vector<Device> list_devices() {
    try {
        return egl_devices(load_egl()).devices;
    } catch (const Error&) {
        return {};
    }
}

}  // namespace aftershade::gpu
