// `aftershade serve` as a process, over a small capture and a look of two steps.
#pragma once

#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "framework/capture/capture_writer.h"
#include "framework/image/role.h"
#include "tests/cli/command.h"
#include "tests/serve/client.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {

inline const std::string kLook = R"({ "aftershade": 1,
  // by eye
  "steps": [
    { "effect": "vignette" },
    { "effect": "view_transform", "params": { "exposure": 0.5 } }
  ] }
)";

class Serve : public ::testing::Test {
protected:
    /// Before the program starts.
    virtual void change_frames() const {}
    void start(std::vector<std::string> more = {}) {
        SyntheticScene scene{
            .width = 64, .height = 36, .background = {0.1f, 0.2f, 0.4f}, .background_depth_m = 8};
        scene.box = SyntheticBox{4, 6, 16, 12, 5, 2};
        for (int frame = 1; frame <= frames_; ++frame) {
            Capture capture = make_capture(scene, frame);
            if (has_nan_) capture.images.at(kColorRole).at(3, 2, 1) = std::numeric_limits<float>::quiet_NaN();
            capture.header.pixel_aspect = pixel_aspect_;
            write_capture(capture, folder_ / ("in_000" + std::to_string(frame) + ".exr"));
        }
        change_frames();
        if (look_name_ == "look.json") write_text(folder_ / look_name_, look_);
        write_text(folder_ / "secret.txt", "secret");
        std::vector<std::string> words{"serve"};
        if (!look_name_.empty()) words.push_back(look_name_);
        if (capture_.empty()) capture_ = frames_ > 1 ? "in_####.exr" : "in_0001.exr";
        words.insert(words.end(), {capture_, "--backend", "software"});
        words.insert(words.end(), more.begin(), more.end());
        command_.emplace(aftershade_words(words), folder_.path(), environment_);
        ASSERT_TRUE(command_->wait_for_lines(1)) << command_->wait().err;
        const std::string address = command_->printed();
        const std::size_t colon = address.rfind(':'), hash = address.find("/#token=");
        ASSERT_TRUE(address.starts_with("http://127.0.0.1:") && hash != std::string::npos) << address;
        port_ = std::stoi(address.substr(colon + 1, hash - colon - 1));
        token_ = address.substr(hash + 8, 32);
    }

    std::string host() const { return "127.0.0.1:" + std::to_string(port_); }
    Answer ask(const std::string& bytes) const {
        const Client client(port_);
        client.send(bytes);
        return parsed(client.receive());
    }
    std::string head(const std::string& line, const std::string& more = "") const {
        return line + " HTTP/1.1\r\nHost: " + host() + "\r\nX-Aftershade-Token: " + token_ + "\r\n" + more;
    }
    Answer get(const std::string& path) const { return ask(head("GET " + path) + "\r\n"); }
    Answer post(const std::string& path, const std::string& body = "") const {
        return ask(head("POST " + path, "Content-Length: " + std::to_string(body.size()) + "\r\n") + "\r\n" +
                   body);
    }
    Answer set(double value, int step = 1, const char* param = "exposure") const {
        const Json state = get("/api/state").json();
        return post("/api/edit",
                    Json{{"revision", state["revision"]},
                         {"edits", {{{"op", "set"}, {"step", step}, {"param", param}, {"value", value}}}}}
                        .dump());
    }
    Json times(const std::string& query = "") const {
        return Json::parse(get("/api/picture?frame=1" + query).header("X-Aftershade-Times"));
    }
    /// `line` changes the pixel `c`.
    void write_effect(const std::string& id, const std::string& line, const std::string& head = "") const {
        const std::filesystem::path effect = folder_ / "effects" / id;
        std::filesystem::create_directories(effect);
        write_text(effect / "effect.json",
                   R"({ "aftershade": 1, "id": ")" + id + R"(", "version": "1.0.0", "summary": "For a test.",
  "inputs": { "color": { "role": "color", "doc": "Any." } },
  "outputs": { "color": { "role": "color", "doc": "Another." } },
  "passes": [ { "name": "main", "shader": "main.frag", "reads": ["color"], "writes": ["color"] } ] }
)");
        write_text(effect / "main.frag",
                   "#version 450 core\n#include <pass>\n" + head +
                       "void main() {\n    vec4 c = texelFetch(color, ivec2(gl_FragCoord.xy), 0);\n    " +
                       line + "\n    out_color = c;\n}\n");
    }
    /// The process that draws; 0 where there is none.
    pid_t drawer() const {
        const std::string tasks = "/proc/" + std::to_string(command_->process()) + "/task";
        for (const auto& task : std::filesystem::directory_iterator(tasks)) {
            pid_t child = 0;
            if (std::ifstream(task.path() / "children") >> child) return child;
        }
        return 0;
    }
    Answer edit(const Json& edit) const {
        return post("/api/edit",
                    Json{{"revision", get("/api/state").json()["revision"]}, {"edits", {edit}}}.dump());
    }
    int ended_by(int signal) {
        command_->send(signal);
        return command_->wait().exit_code;
    }

    TemporaryFolder folder_;
    std::optional<Command> command_;
    bool has_nan_ = false;
    float pixel_aspect_ = 1;
    int frames_ = 1;
    std::string look_name_ = "look.json";  ///< "": none is named
    std::string capture_;                  ///< "": the frames
    std::string look_ = kLook;
    Environment environment_;
    int port_ = 0;
    std::string token_;
};

}  // namespace aftershade::test
