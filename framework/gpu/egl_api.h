// EGL, opened at run time. Internal to framework/gpu.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <glad/egl.h>

#include "framework/gpu/device.h"

namespace aftershade::gpu {

using QueryDeviceBinary = EGLBoolean (*)(EGLDeviceEXT device, EGLint name, EGLint most_bytes, void* value,
                                         EGLint* bytes);  // EGL_EXT_device_persistent_id

/// The entry points used here. glad's own EGL table is global, so only its types are taken.
struct EglApi {
    PFNEGLGETPROCADDRESSPROC get_proc_address;
    PFNEGLGETERRORPROC get_error;
    PFNEGLQUERYSTRINGPROC query_string;
    PFNEGLGETPLATFORMDISPLAYPROC get_platform_display;
    PFNEGLINITIALIZEPROC initialize;
    PFNEGLBINDAPIPROC bind_api;
    PFNEGLCHOOSECONFIGPROC choose_config;
    PFNEGLCREATECONTEXTPROC create_context;
    PFNEGLDESTROYCONTEXTPROC destroy_context;
    PFNEGLMAKECURRENTPROC make_current;
    PFNEGLGETCURRENTCONTEXTPROC get_current_context;
    PFNEGLQUERYCONTEXTPROC query_context;
    PFNEGLQUERYDEVICESEXTPROC query_devices;             // null where there is no EGL_EXT_device_base
    PFNEGLQUERYDEVICESTRINGEXTPROC query_device_string;  // likewise
    PFNEGLQUERYDEVICEATTRIBEXTPROC query_device_attrib;  // likewise
    QueryDeviceBinary query_device_binary;               // likewise; may be null where there is one
};

/// Throws AbsentLibrary, or Error(ErrorKind::gl) where EGL is too old.
EglApi load_egl();
bool has_extension(const char* extensions, std::string_view name);
std::string egl_error_name(EGLint code);

/// EGL's devices in its order, and what it and the system say of them, CUDA_VISIBLE_DEVICES included.
struct EglDevices {
    std::vector<EGLDeviceEXT> handles;
    std::vector<Device> devices;
};
EglDevices egl_devices(const EglApi& egl);

}  // namespace aftershade::gpu
