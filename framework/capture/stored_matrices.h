// Where the camera stands and what it sees, out of a header's matrices. OpenEXR's definition
// (ImfStandardAttributes.h): worldToCamera is left-handed with +z ahead, worldToNDC goes from 0 to 1 over the
// display window with y down, both act on row vectors. Producers keep to parts of it, so the convention of
// each matrix is recognized by what it does.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "framework/file/exr_file.h"
#include "framework/image/camera.h"

namespace aftershade {

struct StoredMatrices {
    std::optional<CameraMatrix> camera_from_world;  ///< as Camera has them
    std::optional<CameraMatrix> ndc_from_world;
    std::string found;  ///< "worldToCamera, +z ahead; worldToNDC, 0 to 1 with y down"; "" for no matrix
    std::string fault;  ///< why a matrix of the header was not taken; "" where each was
    /// The same where the header contradicts itself or is damaged, and not only means something else.
    std::string contradiction;
};

/// Reads worldToCamera, and worldToNDC or worldToScreen (Arnold 7.1 and later); without worldToCamera V-Ray's
/// cameraTransform. Where no projection can be used, it is that of the lens, if `lens` has focal_length and
/// sensor_width. [any thread]
StoredMatrices read_matrices(const ExrPart& part, const Camera& lens);

/// Both matrices by OpenEXR's definition, and aftershade/matrices, which says so: files of Aftershade without
/// that attribute have -z ahead and -1 to 1 with y up.
void add_matrices(const Camera& camera, std::map<std::string, ExrValue>& attributes);

}  // namespace aftershade
