// One native effect at work: parameters, camera and descriptions in, uniforms and tables out.
#pragma once

#include <memory>
#include <string>

#include "framework/base/status.h"
#include "framework/effect/native/native_types.h"

namespace aftershade {

class NativeLibrary;
class NativeRegistry;
struct NativeLibraryEffect;

/// One step's use of a native effect. [one thread at a time; several effects may work at once]
class NativeEffect {
public:
    /// Finds the effect and makes an instance. `status`, which may be null, is notified when the plug-in's
    /// code runs and must outlive the effect. Throws Error(ErrorKind::effect) as NativeRegistry::find does,
    /// or where the plug-in makes no instance.
    NativeEffect(NativeRegistry& registry, NativeDeclaration declaration, std::string step,
                 StatusWriter* status = nullptr);
    /// An effect that `library` offers.
    NativeEffect(std::shared_ptr<NativeLibrary> library, const NativeLibraryEffect& effect,
                 NativeDeclaration declaration, std::string step, StatusWriter* status = nullptr);
    ~NativeEffect();
    NativeEffect(NativeEffect&&) noexcept;
    NativeEffect& operator=(NativeEffect&&) noexcept;

    /// Throws Error(ErrorKind::effect) naming step, library and frame with every fault: what the plug-in
    /// said, names that are not declared, values out of range, declared ones that were not set, an exception.
    /// The effect can be used again afterwards.
    NativeResult prepare(const NativeFrame& frame);
    /// History was dropped. Does nothing where the plug-in takes no notice.
    void reset();
    /// The library's file, for messages.
    const std::string& library() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace aftershade
