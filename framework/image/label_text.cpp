#include "framework/image/label_text.h"

#include <algorithm>
#include <string>
#include <vector>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wconversion"
#include <stb/stb_easy_font.h>
#pragma GCC diagnostic pop

namespace aftershade {

namespace {

/// stb_easy_font has no check of its own: its table ends with '~'.
std::string in_the_font(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c < ' ' || c > '~') c = '?';
    return result;
}

/// stb_easy_font's own vertex layout.
struct Vertex {
    float x, y, z;
    unsigned char color[4];
};

std::string shortened(std::string text, int scale, int max_width_px) {
    if (text_width_px(text) * scale <= max_width_px) return text;
    while (!text.empty() && text_width_px(text + "..") * scale > max_width_px) text.pop_back();
    return text + "..";
}

}  // namespace

int text_width_px(std::string_view text) {
    return stb_easy_font_width(in_the_font(text).data());
}

void draw_text(Image& picture, int x, int y, std::string_view text, int scale, int max_width_px,
               DisplayColor color) {
    std::string line = shortened(in_the_font(text), scale, max_width_px);
    constexpr std::size_t kQuadsPerLetter = 16;  // '@' has the most, 11
    std::vector<Vertex> vertices((line.size() + 1) * kQuadsPerLetter * 4);
    const int quads = stb_easy_font_print(0, 0, line.data(), nullptr, vertices.data(),
                                          int(vertices.size() * sizeof(Vertex)));
    for (int i = 0; i < quads; ++i) {
        const Vertex& first = vertices[std::size_t(i) * 4];
        const Vertex& last = vertices[std::size_t(i) * 4 + 2];
        fill_rectangle(picture, x + int(first.x) * scale, y + int(first.y) * scale,
                       int(last.x - first.x) * scale, int(last.y - first.y) * scale, color);
    }
}

void fill_rectangle(Image& picture, int x, int y, int width, int height, DisplayColor color) {
    const int right = std::min(x + width, picture.width()), bottom = std::min(y + height, picture.height());
    for (int row = std::max(y, 0); row < bottom; ++row)
        for (int column = std::max(x, 0); column < right; ++column)
            for (int c = 0; c < 3; ++c) picture.at(column, row, c) = color[std::size_t(c)];
}

}  // namespace aftershade
