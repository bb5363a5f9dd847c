// A gain from the camera's f-number, in C++: an object behind each instance.
#include <exception>
#include <string>

#include "aftershade_plugin.h"

namespace {

class Adapt {
public:
    Adapt(const aftershade_host* host, const char* step) : host_(host), step_(step) {
        instance_.struct_size = sizeof instance_;
        instance_.data = this;
        instance_.destroy = [](const aftershade_instance* self) { delete static_cast<Adapt*>(self->data); };
        instance_.prepare = prepare;
    }
    const aftershade_instance* instance() const { return &instance_; }

private:
    static aftershade_status prepare(const aftershade_instance* self, const aftershade_frame* frame,
                                     const aftershade_output* output) noexcept try {
        return static_cast<Adapt*>(self->data)->fill(*frame, *output);
    } catch (const std::exception& exception) {
        const aftershade_host* host = static_cast<Adapt*>(self->data)->host_;
        host->set_error(host, exception.what());
        return AFTERSHADE_FAILED;
    }

    aftershade_status fill(const aftershade_frame& frame, const aftershade_output& output) {
        double reference = 1;
        frame.params->get_float(frame.params, "reference_f_number", &reference);
        float gain = 1;
        if (frame.camera->has_f_number) {
            const double ratio = reference / frame.camera->f_number;
            gain = float(ratio * ratio);
        } else {
            const std::string text = step_ + ": the capture has no f-number, the picture stays as it is";
            host_->log(host_, AFTERSHADE_LOG_WARNING, text.c_str());
        }
        return output.set_float(&output, "gain", &gain, 1);
    }

    const aftershade_host* host_;
    std::string step_;
    aftershade_instance instance_{};
};

const aftershade_factory kFactory = {
    sizeof(aftershade_factory), "adapt", "1.0.0",
    [](const aftershade_factory*, const aftershade_host* host,
       const char* step) -> const aftershade_instance* { return (new Adapt(host, step))->instance(); }};

}  // namespace

const aftershade_library AFTERSHADE_LIBRARY_ENTRY = {
    .struct_size = sizeof(aftershade_library),
    .abi_major = AFTERSHADE_ABI_MAJOR,
    .abi_minor = AFTERSHADE_ABI_MINOR,
    .name = "adapt_cpp",
    .version = "1.0.0",
    .init = nullptr,
    .deinit = nullptr,
    .factory_count = 1,
    .get_factory = [](uint32_t) { return &kFactory; },
    .get_extension = nullptr,
    .contact = "the authors of Aftershade",
};
