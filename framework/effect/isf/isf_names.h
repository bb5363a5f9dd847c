// Names of ours for what an ISF file names. Internal to framework/effect/isf.
#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "framework/effect/isf/isf_types.h"

namespace aftershade {

/// Hosts have these variables of each image: _inputImage_imgRect and so on.
inline constexpr std::array<const char*, 3> kImageWords = {"_imgRect", "_imgSize", "_flip"};

/// The identifiers of the file's shaders, without their comments.
struct IsfWords {
    explicit IsfWords(const IsfFile& file);
    std::set<std::string> all;
    std::set<std::string> macros;  ///< that the file defines
    /// Whether a shader names the image, or one of kImageWords of it.
    bool has_image(const std::string& name) const;
    bool has_derivative() const;
};

class IsfNames {
public:
    IsfNames(const IsfFile& file, const IsfWords& words);

    const std::string& of(const std::string& isf_name) const { return names_.at(isf_name); }
    const std::map<std::string, std::string>& all() const { return names_; }
    /// A further name, which shaders of the host alone have.
    std::string make(const std::string& wanted) { return unique(wanted, true, ""); }

private:
    std::string unique(const std::string& wanted, bool is_global, const std::string& isf_name);

    const IsfWords& words_;
    std::map<std::string, std::string> names_;
    std::set<std::string> taken_;
};

/// Names of an enum's values, one for each label.
std::vector<std::string> names_of_labels(const std::vector<std::string>& labels);

}  // namespace aftershade
