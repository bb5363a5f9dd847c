// Capture in, look, picture out.
//
//     embed LOOK CAPTURE OUTPUT.exr [step.param=number]...
//
// Built by CMake as CMakeLists.txt says, or by hand:
//
//     data=$(pkg-config --variable=datadir aftershade)
//     c++ -std=c++20 embed.cpp -o embed -DDATA_FOLDER="\"$data\"" $(pkg-config --cflags --libs aftershade)
#include <aftershade/host.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

using namespace aftershade::host;

namespace {

void print_parameters(const Look& look) {
    for (const LookParam& param : look.params())
        if (const double* number = std::get_if<double>(&param.value))
            std::printf("%-32s %10g %-4s %s\n", param.name.c_str(), *number, param.info.unit.c_str(),
                        param.info.doc.c_str());
}

void set(Look& look, const std::string& word) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) throw Error(ErrorKind::usage, word + ": expected step.param=number");
    look.set(word.substr(0, equals), std::strtod(word.c_str() + equals + 1, nullptr));
}

/// The picture again, from an array of the program's own instead of a file.
Image render_brighter(Look& look, Capture capture, float factor) {
    const Image color = capture.image("color");
    std::vector<float> brighter(color.floats().begin(), color.floats().end());
    for (float& value : brighter) value *= factor;
    capture.set_image("color", view_of(brighter, color.width(), color.height(), color.channels()));
    return look.render(capture).image("color");
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> words(argv, argv + argc);
    if (words.size() < 4) {
        std::fprintf(stderr, "usage: embed LOOK CAPTURE OUTPUT.exr [step.param=number]...\n");
        return 2;
    }
    try {
        Host host({.data = DATA_FOLDER});
        Look look = host.load_look(words[1]);
        for (std::size_t i = 4; i < words.size(); ++i) set(look, words[i]);
        print_parameters(look);
        const Capture capture = look.read(words[2]);
        const Result result = look.render(capture, {.timed = true});
        result.write(words[3]);
        for (const PassTime& time : result.times())
            std::printf("%8.2f ms  %s\n", time.milliseconds, time.pass.c_str());
        const Comparison difference =
            compare(result.image("color"), render_brighter(look, capture, 1.1f), "color");
        std::printf("%s, %s: a tenth brighter is an RMSE of %g\n", host.gl().renderer.c_str(),
                    words[3].c_str(), difference.layers[0].rmse);
    } catch (const Error& error) {
        std::fprintf(stderr, "%s: %s\n", error_kind_name(error.kind()), error.what());
        return 1;
    }
}
