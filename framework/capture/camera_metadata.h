// The camera and the lights out of a file's header.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "framework/capture/light.h"
#include "framework/capture/profile.h"
#include "framework/file/exr_file.h"
#include "framework/image/camera.h"

namespace aftershade {

/// The profile's own attributes first, then OpenEXR's standard ones (focus, aperture, effectiveFocalLength or
/// nominalFocalLength, which is what stands on the lens,
/// sensorOverallDimensions; the matrices as stored_matrices.h has them) and aftershade/camera/<field>. Values
/// that are not positive where the field must be are taken as not known: producers write 0 for that. Where a
/// lens distinguishes the conventions of matrices, that of `known` comes before the header's. Where the
/// angles of the header's lens and of its matrices differ by more than 1 %, the sensor width follows the
/// matrices.
Camera camera_of_metadata(const ExrPart& part, const Profile& profile, const Camera& known = {});

/// Attributes that should give a field of the camera that `known` lacks, and are below 0, not a number, or
/// more than 1 % from one that gives it; a lens that shows another angle than the matrices; matrices that are
/// none. In whole sentences.
std::vector<std::string> camera_faults(const ExrPart& part, const Profile& profile, const Camera& known);

/// The way back: aftershade/camera/..., OpenEXR's own focus, aperture and nominalFocalLength, both matrices,
/// aftershade/jitter_px and aftershade/lights, each where it is known.
void add_attributes(const Camera& camera, const std::vector<CaptureLight>& lights,
                    std::map<std::string, ExrValue>& attributes);

/// The attribute aftershade/lights; none where there is no such text. Throws Error(ErrorKind::capture) that
/// begins with `path` where the text is not a list of lights.
std::vector<CaptureLight> lights_of_metadata(const ExrMetadata& metadata, const std::filesystem::path& path);

}  // namespace aftershade
