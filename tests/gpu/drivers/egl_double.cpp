// A libEGL.so.1 that lists the devices of $EGL_DOUBLE_DEVICES, one after each ';':
// KIND,CARD,RENDER_NODE,UUID,CUDA with KIND gpu, broken or software, and empty fields for what it lacks. All
// draw by Mesa's software device of the EGL at $EGL_DOUBLE_REAL. The index of each device that gets a context
// is appended to $EGL_DOUBLE_LOG.
#include <dlfcn.h>
#include <glad/egl.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

// glad's names for its own table.
#undef eglGetProcAddress
#undef eglGetError
#undef eglQueryString
#undef eglGetPlatformDisplay
#undef eglInitialize
#undef eglBindAPI
#undef eglChooseConfig
#undef eglCreateContext
#undef eglDestroyContext
#undef eglMakeCurrent
#undef eglGetCurrentContext
#undef eglGetCurrentDisplay
#undef eglGetCurrentSurface
#undef eglQueryAPI
#undef eglQueryContext

#define EXPORT extern "C" __attribute__((visibility("default")))

namespace {

struct Device {
    int index = 0;
    std::string kind, card, node, uuid, cuda, extensions;
};

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

std::vector<Device> read_devices() {
    std::vector<Device> devices;
    std::istringstream list(variable("EGL_DOUBLE_DEVICES"));
    for (std::string text; std::getline(list, text, ';');) {
        Device device;
        device.index = int(devices.size());
        std::istringstream fields(text);
        for (std::string* field : {&device.kind, &device.card, &device.node, &device.uuid, &device.cuda})
            std::getline(fields, *field, ',');
        if (!device.card.empty()) device.extensions += "EGL_EXT_device_drm ";
        if (!device.node.empty()) device.extensions += "EGL_EXT_device_drm_render_node ";
        if (!device.uuid.empty()) device.extensions += "EGL_EXT_device_persistent_id ";
        if (!device.cuda.empty()) device.extensions += "EGL_NV_device_cuda ";
        if (device.kind == "software") device.extensions += "EGL_MESA_device_software ";
        devices.push_back(device);
    }
    return devices;
}

std::vector<Device>& devices() {
    static std::vector<Device> list = read_devices();
    return list;
}

template <typename Function>
Function real(const char* name) {
    static void* const library = dlopen(std::getenv("EGL_DOUBLE_REAL"), RTLD_NOW | RTLD_LOCAL);
    return reinterpret_cast<Function>(dlsym(library, name));
}

template <typename Function>
Function real_extension(const char* name) {
    return reinterpret_cast<Function>(real<PFNEGLGETPROCADDRESSPROC>("eglGetProcAddress")(name));
}

EGLDisplay real_display() {
    std::array<EGLDeviceEXT, 64> list{};
    EGLint count = 0;
    real_extension<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT")(EGLint(list.size()), list.data(), &count);
    const auto text = real_extension<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    for (EGLint i = 0; i < count; ++i)
        if (std::strstr(text(list[std::size_t(i)], EGL_EXTENSIONS), "EGL_MESA_device_software"))
            return real<PFNEGLGETPLATFORMDISPLAYPROC>("eglGetPlatformDisplay")(EGL_PLATFORM_DEVICE_EXT,
                                                                               list[std::size_t(i)], nullptr);
    return EGL_NO_DISPLAY;
}

EGLDisplay display() {
    static const EGLDisplay one = real_display();
    return one;
}

std::mutex mutex;
std::map<EGLContext, const Device*> owners;
thread_local const Device* current = nullptr;
thread_local EGLDisplay current_display = nullptr;

const unsigned char* gl_string(unsigned int name) {
    using GetString = const unsigned char* (*)(unsigned int);
    constexpr unsigned int kRenderer = 0x1F01;
    if (name == kRenderer && current && current->kind != "software")
        return reinterpret_cast<const unsigned char*>("Simulated card");
    return real_extension<GetString>("glGetString")(name);
}

EGLBoolean query_devices(EGLint most, EGLDeviceEXT* found, EGLint* count) {
    *count = 0;
    for (Device& device : devices()) {
        if (found && *count >= most) break;
        if (found) found[*count] = &device;
        ++*count;
    }
    return EGL_TRUE;
}

const char* device_string(EGLDeviceEXT handle, EGLint name) {
    const auto& device = *static_cast<const Device*>(handle);
    if (name == EGL_EXTENSIONS) return device.extensions.c_str();
    if (name == 0x3233) return device.card.c_str();
    return name == 0x3377 ? device.node.c_str() : nullptr;
}

EGLBoolean device_attrib(EGLDeviceEXT handle, EGLint name, EGLAttrib* value) {
    const auto& device = *static_cast<const Device*>(handle);
    if (name != 0x323A || device.cuda.empty() || device.cuda == "hidden") return EGL_FALSE;
    *value = std::atoi(device.cuda.c_str());
    return EGL_TRUE;
}

EGLBoolean device_binary(EGLDeviceEXT handle, EGLint name, EGLint most, void* value, EGLint* bytes) {
    const auto& device = *static_cast<const Device*>(handle);
    *bytes = EGLint(device.uuid.size() / 2);
    if (name != 0x335C || *bytes > most) return EGL_FALSE;
    for (std::size_t i = 0; i < device.uuid.size() / 2; ++i)
        static_cast<unsigned char*>(value)[i] =
            static_cast<unsigned char>(std::stoi(device.uuid.substr(2 * i, 2), nullptr, 16));
    return EGL_TRUE;
}

template <typename Function>
__eglMustCastToProperFunctionPointerType as_procedure(Function function) {
    return reinterpret_cast<__eglMustCastToProperFunctionPointerType>(function);
}

}  // namespace

EXPORT __eglMustCastToProperFunctionPointerType eglGetProcAddress(const char* name) {
    const std::string_view wanted = name;
    if (wanted == "eglQueryDevicesEXT") return as_procedure(query_devices);
    if (wanted == "eglQueryDeviceStringEXT") return as_procedure(device_string);
    if (wanted == "eglQueryDeviceAttribEXT") return as_procedure(device_attrib);
    if (wanted == "eglQueryDeviceBinaryEXT") return as_procedure(device_binary);
    if (wanted == "glGetString") return as_procedure(gl_string);
    return real<PFNEGLGETPROCADDRESSPROC>("eglGetProcAddress")(name);
}
EXPORT EGLint eglGetError() {
    return real<PFNEGLGETERRORPROC>("eglGetError")();
}
EXPORT const char* eglQueryString(EGLDisplay of, EGLint name) {
    if (of == EGL_NO_DISPLAY) return "EGL_EXT_device_base EGL_EXT_platform_device";
    return real<PFNEGLQUERYSTRINGPROC>("eglQueryString")(display(), name);
}
EXPORT EGLDisplay eglGetPlatformDisplay(EGLenum, void* native, const EGLAttrib*) {
    return native;
}
EXPORT EGLBoolean eglInitialize(EGLDisplay of, EGLint* major, EGLint* minor) {
    if (static_cast<const Device*>(of)->kind == "broken") return EGL_FALSE;
    return real<PFNEGLINITIALIZEPROC>("eglInitialize")(display(), major, minor);
}
EXPORT EGLBoolean eglBindAPI(EGLenum api) {
    return real<PFNEGLBINDAPIPROC>("eglBindAPI")(api);
}
EXPORT EGLBoolean eglChooseConfig(EGLDisplay, const EGLint* attributes, EGLConfig* configs, EGLint most,
                                  EGLint* count) {
    return real<PFNEGLCHOOSECONFIGPROC>("eglChooseConfig")(display(), attributes, configs, most, count);
}
EXPORT EGLContext eglCreateContext(EGLDisplay of, EGLConfig config, EGLContext shared,
                                   const EGLint* attributes) {
    const EGLContext made =
        real<PFNEGLCREATECONTEXTPROC>("eglCreateContext")(display(), config, shared, attributes);
    const std::lock_guard lock(mutex);
    owners[made] = static_cast<const Device*>(of);
    if (std::FILE* log = std::fopen(variable("EGL_DOUBLE_LOG").c_str(), "a")) {
        std::fprintf(log, "%d\n", owners[made]->index);
        std::fclose(log);
    }
    return made;
}
EXPORT EGLBoolean eglDestroyContext(EGLDisplay, EGLContext context) {
    return real<PFNEGLDESTROYCONTEXTPROC>("eglDestroyContext")(display(), context);
}
EXPORT EGLBoolean eglMakeCurrent(EGLDisplay of, EGLSurface draw, EGLSurface read, EGLContext context) {
    const std::lock_guard lock(mutex);
    current = context ? owners[context] : nullptr;
    current_display = context ? of : nullptr;
    return real<PFNEGLMAKECURRENTPROC>("eglMakeCurrent")(display(), draw, read, context);
}
EXPORT EGLContext eglGetCurrentContext() {
    return real<PFNEGLGETCURRENTCONTEXTPROC>("eglGetCurrentContext")();
}
EXPORT EGLDisplay eglGetCurrentDisplay() {
    return current_display;
}
EXPORT EGLSurface eglGetCurrentSurface(EGLint which) {
    return real<PFNEGLGETCURRENTSURFACEPROC>("eglGetCurrentSurface")(which);
}
EXPORT EGLenum eglQueryAPI() {
    return real<PFNEGLQUERYAPIPROC>("eglQueryAPI")();
}
EXPORT EGLBoolean eglQueryContext(EGLDisplay, EGLContext context, EGLint name, EGLint* value) {
    return real<PFNEGLQUERYCONTEXTPROC>("eglQueryContext")(display(), context, name, value);
}
