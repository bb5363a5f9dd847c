// A config of OpenColorIO, and the transforms that requests ask of it. Empty where the library is absent.
#pragma once

#ifdef AFTERSHADE_HAS_OPENCOLORIO
#include <OpenColorIO/OpenColorIO.h>

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "framework/color/color_request.h"

namespace aftershade {

namespace ocio = OCIO_NAMESPACE;

struct OcioConfig {
    ocio::ConstConfigRcPtr config;
    std::string name;            ///< for messages
    std::filesystem::path file;  ///< "" for the built-in one
};

/// As in ColorRequest::path.
std::variant<OcioConfig, ColorFault> open_config(std::string path);
ColorNames names_of(const OcioConfig& config);
/// The config's space of ACES2065-1; "" where it has none.
std::string ap0_space(const ocio::Config& config);

/// Before OpenColorIO has made the transform faster. Throws ocio::Exception, for which fault_of_config().
std::variant<ocio::ConstProcessorRcPtr, ColorFault> processor_of(const OcioConfig& config,
                                                                 const ColorRequest& request);
ColorFault fault_of_config(const OcioConfig& config, const ocio::Exception& error);

/// A LUT that a config names outside of its folder and its search path; "" where there is none.
std::filesystem::path escaped_file(const OcioConfig& config, const std::vector<std::filesystem::path>& files);

/// OpenColorIO's messages have lines, and each is one sentence or more.
std::string one_line(const std::string& text);

}  // namespace aftershade
#endif
