#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <thread>

#include "framework/golden/approved_image.h"
#include "tests/cli/golden_suite.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

/// A folder over HTTP on a free port, with the fault that the file `mode` names. Counts what is fetched, and
/// accepts only a token that the file `token` has, where there is one.
constexpr const char* kServer = R"(
import http.server, os, sys, time
root, control = sys.argv[1:]
def setting(name):
    try: return open(os.path.join(control, name)).read().strip()
    except OSError: return ""
class Handler(http.server.BaseHTTPRequestHandler):
    def log_message(self, *words): pass
    def path_of(self): return os.path.join(root, os.path.basename(self.path))
    def answer(self, code, body=b"", length=None):
        self.send_response(code)
        self.send_header("Content-Length", str(len(body) if length is None else length))
        self.end_headers()
        if setting("mode") == "slow":
            for byte in body: self.wfile.write(bytes([byte])); self.wfile.flush(); time.sleep(0.2)
        else: self.wfile.write(body)
    def refused(self):
        token = setting("token")
        if not token or self.headers.get("Authorization") == "Bearer " + token: return False
        self.answer(401)
        return True
    def do_GET(self):
        with open(os.path.join(control, "log"), "a") as log: log.write(self.path + "\n")
        if self.refused(): return
        try: body = open(self.path_of(), "rb").read()
        except OSError: return self.answer(404)
        mode = setting("mode")
        if mode == "silent": return time.sleep(3)
        if mode == "tampered": body = body[:-1] + bytes([body[-1] ^ 1])
        if mode == "short": body = body[:100]
        if mode == "truncated": self.close_connection = True; return self.answer(200, body[:100], len(body))
        self.answer(200, body)
    def do_HEAD(self):
        if not self.refused(): self.answer(200 if os.path.exists(self.path_of()) else 404)
    def do_PUT(self):
        if self.refused(): return
        body = self.rfile.read(int(self.headers["Content-Length"]))
        if setting("mode") == "full": return self.answer(507)
        if setting("mode") != "forgetful": open(self.path_of(), "wb").write(body)
        self.answer(201)
server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
print(server.server_address[1], flush=True)
server.serve_forever()
)";

int free_port() {
    const int socket_ = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    bind(socket_, reinterpret_cast<sockaddr*>(&address), size);
    getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    close(socket_);
    return ntohs(address.sin_port);
}

bool wait_for_port(int port) {
    for (int i = 0; i < 500; ++i) {
        const int socket_ = socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(std::uint16_t(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        const bool open = connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
        close(socket_);
        if (open) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
}

class GoldenStore : public GoldenCommand {
protected:
    void SetUp() override {
        for (const char* part : {"images", "control", "cache"}) fs::create_directories(folder_ / part);
    }

    void use_store(const std::string& store) {
        write_text(folder_ / "golden.json", R"({ "aftershade": 1, "store": ")" + store + R"(", "cases": [
            { "name": "corner", "steps": [ { "effect": "vignette" } ], "capture": "in_####.exr",
              "frames": "1-2" } ] })");
    }
    /// Needs python3 and curl.
    void serve_by_python() {
        if (!fs::exists("/usr/bin/python3") || !fs::exists("/usr/bin/curl"))
            GTEST_SKIP() << "python3 or curl is absent";
        write_text(folder_ / "server.py", kServer);
        server_.emplace(
            std::vector<std::string>{"/usr/bin/python3", (folder_ / "server.py").string(),
                                     (folder_ / "images").string(), (folder_ / "control").string()},
            folder_.path());
        ASSERT_TRUE(server_->wait_for_lines(1));
        port_ = std::stoi(server_->printed());
        use_store(url());
    }
    std::string url() const { return "http://127.0.0.1:" + std::to_string(port_) + "/goldens"; }
    void set_mode(const std::string& mode) { write_text(folder_ / "control/mode", mode); }
    std::size_t fetched() const { return lines_of_text(read_text(folder_ / "control/log")).size(); }

    CommandResult with_cache(std::vector<std::string> words, Environment environment = {}) {
        environment.try_emplace("AFTERSHADE_CACHE", (folder_ / "cache").string());
        return golden(words, environment);
    }
    CommandResult approve_there(const Environment& environment = {}) {
        return with_cache({"approve", "golden.json"}, environment);
    }
    CommandResult run_there(const Environment& environment = {}, const std::string& timeout = "60") {
        return with_cache({"run", "golden.json", "--timeout", timeout}, environment);
    }
    /// As another checkout has it: sidecars alone.
    void remove_images(bool with_cache = true) {
        std::vector<fs::path> images;
        for (const auto& entry : fs::directory_iterator(folder_ / "goldens"))
            if (entry.path().extension() == ".exr") images.push_back(entry.path());
        for (const fs::path& image : images) fs::remove(image);
        if (with_cache) fs::remove_all(folder_ / "cache/goldens");
    }
    std::map<std::string, std::string> sidecars() const {
        auto files = contents(folder_ / "goldens");
        std::erase_if(files, [](const auto& file) { return !file.first.ends_with(".json"); });
        return files;
    }
    /// Approves, forgets the images, runs and approves a change: what each store must do.
    void hold_to_its_promise(const Environment& environment = {}) {
        const CommandResult approved = approve_there(environment);
        ASSERT_EQ(approved.exit_code, 0) << approved.err;
        const auto images = contents(folder_ / "goldens");
        remove_images();
        const CommandResult ran = run_there(environment);
        EXPECT_EQ(ran.exit_code, 0) << ran.err;
        EXPECT_EQ(contents(folder_ / "goldens"), images) << "what was approved, to the byte";
        write_frame(1, 90);
        ASSERT_EQ(approve_there(environment).exit_code, 0);
        remove_images();
        EXPECT_EQ(run_there(environment).exit_code, 0);
        lose_images();
        ASSERT_EQ(approve_there(environment).exit_code, 0);
        remove_images();
        EXPECT_EQ(run_there(environment).exit_code, 0) << "approve gives back what the store has lost";
    }
    /// The store's, of whatever kind it is.
    void lose_images() {
        std::vector<fs::path> images;
        for (const auto& entry : fs::recursive_directory_iterator(folder_ / "images"))
            if (entry.path().extension() == ".exr") images.push_back(entry.path());
        ASSERT_FALSE(images.empty());
        for (const fs::path& image : images) fs::remove(image);
    }

    std::optional<Command> server_;
    int port_ = 0;
};

TEST_F(GoldenStore, KeepsImagesInAFolder) {
    use_store("images");
    hold_to_its_promise();
    for (const auto& [name, bytes] : contents(folder_ / "images")) {
        const CommandResult sum = Command({"/usr/bin/sha256sum", name}, folder_ / "images").wait();
        EXPECT_EQ(sum.out.substr(0, 64) + ".exr", name);
    }
}

TEST_F(GoldenStore, KeepsImagesBehindHttp) {
    serve_by_python();
    if (IsSkipped()) return;
    hold_to_its_promise();
}

TEST_F(GoldenStore, KeepsImagesBehindNginxWithWebDav) {
    if (!fs::exists("/usr/sbin/nginx")) GTEST_SKIP() << "nginx is absent (Debian package nginx-light)";
    port_ = free_port();
    fs::create_directories(folder_ / "images/goldens");
    write_text(folder_ / "nginx.conf", std::string(geteuid() == 0 ? "user root;\n" : "") +
                                           "daemon off; error_log stderr; pid nginx.pid;\nevents {}\nhttp {\n"
                                           "  access_log off; client_body_temp_path body;\n  server { listen "
                                           "127.0.0.1:" +
                                           std::to_string(port_) + "; root " + (folder_ / "images").string() +
                                           "; client_max_body_size 100m; dav_methods PUT; }\n}\n");
    server_.emplace(std::vector<std::string>{"/usr/sbin/nginx", "-p", folder_.path().string(), "-c",
                                             (folder_ / "nginx.conf").string()},
                    folder_.path());
    ASSERT_TRUE(wait_for_port(port_));
    use_store(url());
    hold_to_its_promise();
    server_->send(SIGTERM);
    server_->wait();
}

TEST_F(GoldenStore, KeepsImagesWhereRcloneReaches) {
    if (!fs::exists("/usr/bin/rclone")) GTEST_SKIP() << "rclone is absent (Debian package rclone)";
    port_ = free_port();
    server_.emplace(
        std::vector<std::string>{"/usr/bin/rclone", "serve", "webdav", (folder_ / "images").string(),
                                 "--addr", "127.0.0.1:" + std::to_string(port_), "--dir-cache-time", "0s"},
        folder_.path());
    ASSERT_TRUE(wait_for_port(port_));
    const Environment remote{{"RCLONE_CONFIG_SHARE_TYPE", "webdav"},
                             {"RCLONE_CONFIG_SHARE_URL", "http://127.0.0.1:" + std::to_string(port_)},
                             {"HOME", folder_.path().string()}};
    use_store("rclone:share:a/goldens");
    hold_to_its_promise(remote);
    fs::remove_all(folder_ / "images");
    fs::create_directories(folder_ / "images");
    remove_images();
    const CommandResult missing = run_there(remote);
    EXPECT_EQ(missing.exit_code, 4) << missing.err;
    EXPECT_NE(missing.err.find("not fetched: rclone:share:a/goldens"), std::string::npos) << missing.err;
}

TEST_F(GoldenStore, FetchesFiveHundredImagesOnce) {
    serve_by_python();
    if (IsSkipped()) return;
    SyntheticScene scene{.width = 16, .height = 9, .background = {0.2f, 0.5f, 0.1f}, .background_depth_m = 6};
    for (int frame = 1; frame <= 500; ++frame) {
        scene.points = {{frame % 16, frame / 16 % 9, float(frame)}};
        std::string number = std::to_string(frame);
        number.insert(0, 4 - number.size(), '0');
        write_capture(make_capture(scene, frame), folder_ / ("in_" + number + ".exr"));
    }
    write_text(folder_ / "golden.json", R"({ "aftershade": 1, "store": ")" + url() + R"(", "cases": [
        { "name": "many", "steps": [ { "effect": "vignette" } ], "capture": "in_####.exr",
          "frames": "1-500" } ] })");
    const CommandResult approved = approve_there();
    ASSERT_EQ(approved.exit_code, 0) << approved.err;
    const std::size_t images = contents(folder_ / "images").size();
    EXPECT_GE(images, 490u) << "frames that are equal share an image";
    const auto before = contents(folder_ / "goldens");
    remove_images();
    set_mode("silent");
    write_text(folder_ / "control/log", "");
    EXPECT_EQ(run_there({}, "1").exit_code, 4);
    EXPECT_LE(fetched(), 3u) << "one image and its retries, and not those of each";
    set_mode("");
    write_text(folder_ / "control/log", "");
    EXPECT_EQ(run_there().exit_code, 0);
    EXPECT_EQ(fetched(), images);
    EXPECT_EQ(contents(folder_ / "goldens"), before);
    EXPECT_EQ(run_there().exit_code, 0);
    EXPECT_EQ(fetched(), images) << "the images are beside their sidecars";
    remove_images(false);
    server_->send(SIGKILL);
    EXPECT_EQ(run_there().exit_code, 0) << "another checkout, from the cache, without a network";
    EXPECT_EQ(contents(folder_ / "goldens"), before);
}

TEST_F(GoldenStore, FailsClosedWithTheReason) {
    serve_by_python();
    if (IsSkipped()) return;
    ASSERT_EQ(approve_there().exit_code, 0);
    const auto approved = sidecars();
    struct Case {
        std::string mode, reason, timeout;
    };
    for (const auto& [mode, reason, timeout] :
         {Case{"tampered", "its bytes have the SHA-256 ", "60"},
          Case{"short", "its bytes have the SHA-256 ", "60"}, Case{"truncated", " bytes ", "60"},
          Case{"slow", "timed out", "1"}}) {
        SCOPED_TRACE(mode);
        remove_images();
        set_mode(mode);
        const CommandResult result = run_there({}, timeout);
        EXPECT_EQ(result.exit_code, 4) << result.err;
        EXPECT_NE(result.err.find(": not fetched: " + url() + ": "), std::string::npos) << result.err;
        EXPECT_NE(result.err.find(reason), std::string::npos) << result.err;
        EXPECT_EQ(contents(folder_ / "goldens"), approved) << "nothing that is not verified is kept";
        EXPECT_FALSE(fs::exists(folder_ / "cache/goldens") && !fs::is_empty(folder_ / "cache/goldens"));
        const CommandResult again = with_cache({"approve", "golden.json", "--timeout", timeout});
        EXPECT_EQ(again.exit_code, 4) << "what was not seen is not replaced\n" << again.err;
        EXPECT_EQ(contents(folder_ / "goldens"), approved);
    }
    set_mode("");
    for (const auto& [name, bytes] : contents(folder_ / "images")) fs::remove(folder_ / "images" / name);
    const CommandResult missing = run_there();
    EXPECT_EQ(missing.exit_code, 4);
    EXPECT_NE(missing.err.find("404"), std::string::npos) << missing.err;
    server_->send(SIGKILL);
    server_->wait();
    const CommandResult offline = run_there();
    EXPECT_EQ(offline.exit_code, 4);
    EXPECT_NE(offline.err.find("Failed to connect"), std::string::npos) << offline.err;
    EXPECT_EQ(contents(folder_ / "goldens"), approved);
}

TEST_F(GoldenStore, ApprovesNothingThatTheStoreDoesNotKeep) {
    serve_by_python();
    if (IsSkipped()) return;
    ASSERT_EQ(approve_there().exit_code, 0);
    const auto before = contents(folder_ / "goldens");
    write_frame(1, 90);
    for (const char* mode : {"full", "forgetful"}) {
        SCOPED_TRACE(mode);
        set_mode(mode);
        const CommandResult result = approve_there();
        EXPECT_EQ(result.exit_code, 4) << result.err;
        EXPECT_NE(result.err.find("(nothing was approved)"), std::string::npos) << result.err;
        EXPECT_EQ(contents(folder_ / "goldens"), before);
    }
    set_mode("");
    EXPECT_EQ(approve_there().exit_code, 0);
    EXPECT_EQ(run_there().exit_code, 0);
}

TEST_F(GoldenStore, SendsATokenOnlyWhereItBelongs) {
    serve_by_python();
    if (IsSkipped()) return;
    write_text(folder_ / "control/token", "s3cret");
    const std::string root = url().substr(0, url().rfind('/'));
    EXPECT_EQ(approve_there({{"AFTERSHADE_STORE_TOKEN", "s3cret"}}).exit_code, 4) << "no address was named";
    EXPECT_EQ(approve_there(
                  {{"AFTERSHADE_STORE_TOKEN", "s3cret"}, {"AFTERSHADE_STORE_TOKEN_URL", root + "/golden"}})
                  .exit_code,
              4)
        << "the beginning of a name is another address";
    const Environment own{{"AFTERSHADE_STORE_TOKEN", "s3cret"}, {"AFTERSHADE_STORE_TOKEN_URL", root}};
    const CommandResult approved = approve_there(own);
    EXPECT_EQ(approved.exit_code, 0) << approved.err;
    remove_images();
    EXPECT_EQ(run_there().exit_code, 4);
    EXPECT_EQ(run_there(own).exit_code, 0);
}

TEST_F(GoldenStore, TakesASuiteWithImagesOfItsOwn) {
    use_store("images");
    const std::string with_store = read_text(folder_ / "golden.json");
    std::string without = with_store;
    write_text(folder_ / "golden.json", without.erase(without.find(R"("store")"), 18));
    ASSERT_EQ(approve_there().exit_code, 0);
    EXPECT_TRUE(contents(folder_ / "images").empty());
    write_text(folder_ / "golden.json", with_store);
    EXPECT_EQ(run_there().exit_code, 0) << "images in the tree stay valid";
    ASSERT_EQ(with_cache({"approve", "golden.json", "--renew-sidecars"}).exit_code, 0);
    EXPECT_EQ(contents(folder_ / "images").size(), 1u) << "both frames have the same bytes";
    remove_images();
    EXPECT_EQ(run_there().exit_code, 0);
}

TEST_F(GoldenStore, RefusesHostileSuites) {
    for (const char* store :
         {"", "-o/tmp/x", "file:///etc", "ftp://host/x", "http://", "http://user:secret@host/x",
          "https://host/x?y=", "https://host/x y", "https://host/x\\\"", "rclone:", "rclone::local:/etc",
          "rclone::sftp,ssh=id:", "rclone:share,ssh=id:x", "rclone:-x:y", "C:/x"}) {
        SCOPED_TRACE(store);
        use_store(store);
        const CommandResult result = approve_there();
        EXPECT_EQ(result.exit_code, 64) << result.err;
        EXPECT_NE(result.err.find("rclone:REMOTE:PATH"), std::string::npos) << result.err;
    }
    const TemporaryFolder elsewhere;
    for (const std::string& store :
         {elsewhere.path().string(), std::string("../"), std::string("a/../../x")}) {
        SCOPED_TRACE(store);
        use_store(store);
        const CommandResult result = approve_there();
        EXPECT_EQ(result.exit_code, 4) << result.err;
        EXPECT_NE(result.err.find("--allow-path"), std::string::npos) << result.err;
    }
    fs::create_directory_symlink(elsewhere.path(), folder_ / "link");
    use_store("link");
    EXPECT_EQ(approve_there().exit_code, 4);
    EXPECT_TRUE(contents(elsewhere.path()).empty());
    use_store(elsewhere.path().string());
    EXPECT_EQ(with_cache({"approve", "golden.json", "--allow-path", elsewhere.path().string()}).exit_code, 0);
}

TEST_F(GoldenStore, WritesNothingThroughLinks) {
    use_store("images");
    ASSERT_EQ(approve_there().exit_code, 0);
    const TemporaryFolder elsewhere;
    write_text(elsewhere / "mine", "mine");
    remove_images();
    fs::create_symlink(elsewhere / "mine", image("corner.color.0001"));
    EXPECT_EQ(run_there().exit_code, 4);
    fs::remove(image("corner.color.0001"));
    for (const auto& [name, bytes] : contents(folder_ / "images")) {
        fs::remove(folder_ / "images" / name);
        fs::create_symlink(elsewhere / "mine", folder_ / "images" / name);
    }
    remove_images();
    EXPECT_EQ(run_there().exit_code, 4) << "an image of the store that is a link";
    EXPECT_EQ(read_text(elsewhere / "mine"), "mine");
    // A sidecar names contents, and no place.
    const fs::path sidecar = sidecar_path(image("corner.color.0001"));
    Json json = Json::parse(read_text(sidecar));
    json["sha256"] = "../../../../" + elsewhere.path().string() + "/mine";
    write_text(sidecar, json.dump());
    remove_images();
    const CommandResult result = run_there();
    EXPECT_GE(result.exit_code, 2) << result.err;
    EXPECT_EQ(contents(elsewhere.path()).size(), 1u);
}

}  // namespace
}  // namespace aftershade::test
