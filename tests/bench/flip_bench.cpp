// FLIP, or SSIM with MS-SSIM, of two files in memory, one line of milliseconds each: flip_bench ldr|hdr|ssim
// REFERENCE TEST RUNS Reading is not counted; the decoding of sRGB is, as in NVIDIA's evaluate().
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <string>

#include "framework/compare/flip.h"
#include "framework/compare/layer_file.h"
#include "framework/compare/perceptual.h"
#include "framework/compare/ssim.h"

int main(int argc, char** argv) {
    using namespace aftershade;
    if (argc != 5) return 64;
    const std::string what = argv[1];
    const LayerFile reference_file(argv[2]), test_file(argv[3]);
    const LayerInfo layer = reference_file.layers().at(0);
    const Image reference = reference_file.read(layer, layer.channels);
    const Image test = test_file.read(layer, layer.channels);
    for (int i = 0; i < std::atoi(argv[4]); ++i) {
        const auto begin = std::chrono::steady_clock::now();
        double figure = 0;
        if (what == "ssim") {
            figure = ssim_figures(reference, test).ssim;
        } else {
            const Image r = linear_rgb(reference, layer.role, 0), t = linear_rgb(test, layer.role, 0);
            figure = what == "hdr" ? hdr_flip(r, t).mean : ldr_flip(r, t).mean;
        }
        const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
        fmt::print("{} {}\n", taken.count(), figure);
    }
}
