// Multi-part files whose every value a test writes down.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <Imath/ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>

namespace aftershade::test {

struct TestPart {
    std::string name;
    std::string view;
    std::vector<std::string> channels;
    Imath::Box2i data_window;
    float value = 0;
    std::map<std::string, std::string> texts = {};  ///< attributes
};

/// Every pixel of a part holds its value, plus a tenth for each channel.
inline void write_parts(const std::filesystem::path& path, const std::vector<TestPart>& parts) {
    std::vector<Imf::Header> headers;
    for (const TestPart& part : parts) {
        Imf::Header header(Imath::Box2i({0, 0}, {15, 7}), part.data_window);
        header.setName(part.name);
        header.setType(Imf::SCANLINEIMAGE);
        if (!part.view.empty()) header.setView(part.view);
        for (const std::string& channel : part.channels)
            header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
        for (const auto& [name, text] : part.texts) header.insert(name, Imf::StringAttribute(text));
        headers.push_back(header);
    }
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), int(headers.size()));
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Imath::Box2i window = parts[i].data_window;
        const std::size_t width = std::size_t(window.max.x - window.min.x + 1);
        const std::size_t height = std::size_t(window.max.y - window.min.y + 1);
        std::vector<std::vector<float>> planes;
        Imf::FrameBuffer frame;
        for (std::size_t c = 0; c < parts[i].channels.size(); ++c)
            planes.emplace_back(width * height, parts[i].value + 0.1f * float(c));
        for (std::size_t c = 0; c < planes.size(); ++c)
            frame.insert(parts[i].channels[c], Imf::Slice::Make(Imf::FLOAT, planes[c].data(), window));
        Imf::OutputPart output(file, int(i));
        output.setFrameBuffer(frame);
        output.writePixels(int(height));
    }
}

inline const Imath::Box2i kWholePart({0, 0}, {15, 7});

}  // namespace aftershade::test
