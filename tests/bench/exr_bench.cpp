// Times of reads and writes of OpenEXR files, in milliseconds, for scripts/bench exr: lines of standard input
// are "read FILE CHANNEL..." and "write FILE FROM COMPRESSION"; each is answered by one line.
#include "framework/file/exr_file.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace aftershade {
namespace {

template <class Work>
double time_ms(Work&& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

/// Opening included.
double read_ms(std::istream& words) {
    std::string path;
    words >> path;
    std::vector<std::string> channels;
    for (std::string name; words >> name;) channels.push_back(name);
    return time_ms([&] { ExrFile(path).read_floats(0, channels); });
}

/// R, G and B of another file, as half.
double write_ms(std::istream& words) {
    std::string path, from, compression;
    words >> path >> from >> compression;
    const ExrFile source(from);
    const std::vector<std::string> names = {"R", "G", "B"};
    const Image image = source.read_floats(0, names);
    std::vector<ExrOutputChannel> channels;
    for (int c = 0; c < 3; ++c) channels.push_back({names[std::size_t(c)], PixelType::half, &image, c});
    ExrWriteOptions options;
    options.data_window = options.display_window = source.parts()[0].data_window;
    options.compression = compression;
    return time_ms([&] { write_exr(path, channels, options); });
}

int answer(int threads) {
    set_exr_threads(threads);
    for (std::string line; std::getline(std::cin, line);) {
        std::istringstream words(line);
        std::string verb;
        words >> verb;
        std::cout << fmt::format("{:.3f}", verb == "read" ? read_ms(words) : write_ms(words)) << std::endl;
    }
    return 0;
}

}  // namespace
}  // namespace aftershade

int main(int count, char** arguments) {
    try {
        return aftershade::answer(count > 1 ? std::atoi(arguments[1]) : 2);
    } catch (const std::exception& error) {
        fmt::print(stderr, "exr_bench: {}\n", error.what());
        return 1;
    }
}
