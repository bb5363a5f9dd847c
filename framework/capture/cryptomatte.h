// Object ids and coverage out of Cryptomatte layers (Friedman and Jones 2015, specification 1.2.0).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "framework/base/error.h"
#include "framework/document/object_keys.h"
#include "framework/image/image.h"

namespace aftershade {

class FrameFile;

/// A Cryptomatte of a file: "cryptomatte/<key>/name" of its header, and its channels "<name>00.R" and so on.
struct CryptomatteLayer {
    std::string name;  ///< "ViewLayer.CryptoObject"
    /// The channels of two ranks each, id, coverage, id, coverage: R, G, B, A, in upper or lower case or in
    /// full (`red`).
    std::vector<std::array<std::string, 4>> ranks;
    std::vector<std::string> object_names;  ///< of its manifest; empty where the file has none
    std::vector<std::uint32_t> object_ids;  ///< of each name: what the manifest says, else its hash
};

/// Objects that a look or a capture.json names and that the file's Cryptomattes do not have.
class UnknownObject : public Error {
public:
    UnknownObject(const std::string& message, std::string object)
        : Error(ErrorKind::capture, message), object_(std::move(object)) {}
    const std::string& object() const { return object_; }  ///< the first of them

private:
    std::string object_;
};

/// Those whose channels are there, by their names' order in the header. A manifest may lie in a file of its
/// own in the folder of the EXR file (manif_file).
std::vector<CryptomatteLayer> find_cryptomattes(const FrameFile& file);
/// Layers that the header names, even without their channels.
std::vector<std::string> declared_cryptomattes(const FrameFile& file);
/// The layer whose name is `name`, or ends in ".<name>"; with "" the only one. Throws
/// Error(ErrorKind::capture) with the names there are.
const CryptomatteLayer& choose_cryptomatte(const std::vector<CryptomatteLayer>& layers,
                                           const std::string& name, const FrameFile& file);

/// The one that has all the objects; of several the one whose name says that it is of objects. `layers` has
/// one at least. Throws Error(ErrorKind::capture) where none has them, or where several do alike.
const CryptomatteLayer& cryptomatte_with(const std::vector<CryptomatteLayer>& layers,
                                         std::span<const std::string> objects, const FrameFile& file);

/// The 32-bit pattern under which an object's name is stored: MurmurHash3_32 with seed 0, its exponent
/// changed where it would read as zero, denormal, infinite or NaN.
std::uint32_t cryptomatte_hash(const std::string& object);

/// The id that stands for an object's name in the pixels of the layer.
std::uint32_t id_of_object(const CryptomatteLayer& layer, const std::string& object);

/// Ids first..last.
struct IdRange {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
    bool operator==(const IdRange&) const = default;
};

/// The ids that the keys stand for, a name by its hash: rising, and a gap between any two.
std::vector<IdRange> id_ranges(std::span<const TableKey> keys);
/// Whether an id lies in one of the ranges that id_ranges() gave.
bool contains(std::span<const IdRange> ranges, std::uint32_t id);

/// Summed coverage of the named objects over all ranks, 0 to 1. Throws Error(ErrorKind::capture): ids stored
/// as half or compressed with loss; a name that the manifest, where there is one, does not have.
Image cryptomatte_mask(const FrameFile& file, const CryptomatteLayer& layer,
                       const std::vector<std::string>& objects, const Window& grid);
/// How much of the grid an object covers.
struct ObjectCoverage {
    std::string name;        ///< of the manifest; the id as eight hexadecimal digits where it has none
    double coverage_px = 0;  ///< summed over all pixels and ranks
};
/// The coverage of all objects of the manifest and all ids in the pixels, the largest first. Throws as
/// cryptomatte_mask does.
std::vector<ObjectCoverage> coverage_of_objects(const FrameFile& file, const CryptomatteLayer& layer,
                                                const Window& grid);

/// The id of rank 0, the object that covers most of the pixel; 0 for none. An object of `named` has the hash
/// of its name, whichever id the manifest gives it.
Image cryptomatte_ids(const FrameFile& file, const CryptomatteLayer& layer, const Window& grid,
                      std::span<const std::string> named = {});

}  // namespace aftershade
