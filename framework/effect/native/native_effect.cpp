#include "framework/effect/native/native_effect.h"

#include "framework/base/error.h"
#include "framework/effect/native/native_call.h"
#include "framework/effect/native/native_host.h"
#include "framework/effect/native/native_library.h"
#include "framework/effect/native/native_process.h"

namespace aftershade {

/// The library comes first: it goes last, after the code of `destroy` has run.
struct NativeEffect::Impl {
    std::shared_ptr<NativeLibrary> library;
    NativeDeclaration declaration;
    std::string step;
    StatusWriter* status = nullptr;
    NativeHost host;
    const aftershade_instance* instance = nullptr;  // what calls of the plug-in receive
    aftershade_instance functions{};  // those that this host knows; null where the plug-in is older
    int remote = 0;                   // the instance in another process; 0: in this one

    ~Impl() {
        if (!instance && remote == 0) return;
        const StatusScope scope(status, {step, library->place(), "destroy", {}});
        try {
            if (remote > 0) library->process()->destroy(remote);
            else call_plugin(place() + "destroy", [&] { functions.destroy(instance); });
        } catch (const Error& error) {  // a destructor must not throw
            library->ended(error.what());
        }
    }

    /// "step 'grade': /x/libfoo.so: "
    std::string place() const { return "step '" + step + "': " + library->place() + ": "; }

    [[noreturn]] void fail(const std::string& text) const {
        const std::string& contact = library->contact();
        throw Error(ErrorKind::effect,
                    place() + text + (contact.empty() ? "" : " (contact: " + contact + ")"));
    }

    void create(const NativeLibrary::Effect& effect) {
        const StatusScope scope(status, {step, library->place(), "create", {}});
        if (NativeProcess* const process = library->process()) {
            remote = process->create(library->place(), declaration, step);
            return;
        }
        const aftershade_factory factory = checked_factory(effect.factory, place());
        const aftershade_instance* made = call_plugin(
            place() + "create", [&] { return factory.create(effect.factory, host.get(), step.c_str()); });
        if (!made) {
            const std::string text = host.take_error();
            fail("could not make '" + declaration.effect_id +
                 "': " + (text.empty() ? "no reason given" : text));
        }
        functions = checked_instance(made, place() + "'" + declaration.effect_id + "'");
        instance = made;
    }
};

NativeEffect::NativeEffect(NativeRegistry& registry, NativeDeclaration declaration, std::string step,
                           StatusWriter* status) {
    const NativeRegistry::Entry& entry = registry.find(declaration.effect_id, declaration.effect_version);
    *this = NativeEffect(entry.library, entry.effect, std::move(declaration), std::move(step), status);
}

NativeEffect::NativeEffect(std::shared_ptr<NativeLibrary> library, const NativeLibraryEffect& effect,
                           NativeDeclaration declaration, std::string step, StatusWriter* status)
    : impl_(std::make_unique<Impl>()) {
    impl_->library = std::move(library);
    impl_->declaration = std::move(declaration);
    impl_->step = std::move(step);
    impl_->status = status;
    impl_->create(effect);
}

NativeEffect::~NativeEffect() = default;
NativeEffect::NativeEffect(NativeEffect&&) noexcept = default;
NativeEffect& NativeEffect::operator=(NativeEffect&&) noexcept = default;

NativeResult NativeEffect::prepare(const NativeFrame& frame) {
    Impl& impl = *impl_;
    const StatusScope scope(impl.status, {impl.step, impl.library->place(), "prepare", frame.number});
    if (impl.remote > 0) return impl.library->process()->prepare(impl.remote, frame);
    NativeFaults faults;
    const NativeInput input(frame, faults);
    NativeOutput output(impl.declaration, faults);
    const std::string label =
        "prepare of '" + impl.declaration.effect_id + "', frame " + std::to_string(frame.number);
    const aftershade_status status = call_plugin(impl.place() + label, [&] {
        return impl.functions.prepare(impl.instance, input.get(), output.get());
    });
    const std::string text = impl.host.take_error();
    if (status != AFTERSHADE_OK)
        faults.add(status,
                   text.empty() ? "returned status " + std::to_string(status) + " without a reason" : text);
    else output.require_everything();
    if (!faults.empty()) impl.fail(label + ": " + faults.text());
    NativeResult result = output.take();
    result.log = impl.host.take_log();
    return result;
}

void NativeEffect::reset() {
    Impl& impl = *impl_;
    if (!impl.functions.reset && impl.remote == 0) return;
    const StatusScope scope(impl.status, {impl.step, impl.library->place(), "reset", {}});
    if (impl.remote > 0) return impl.library->process()->reset(impl.remote);
    call_plugin(impl.place() + "reset", [&] { impl.functions.reset(impl.instance); });
}

const std::string& NativeEffect::library() const {
    return impl_->library->place();
}

}  // namespace aftershade
