#include "framework/batch/report_pictures.h"

#include <unistd.h>

#include <sstream>
#include <utility>

#include "framework/base/atomic_file.h"
#include "framework/base/side_file.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

constexpr const char* kList = ".pictures";

/// Whoever changed the list, nothing outside the folder is removed.
bool is_plain_name(const std::string& name) {
    return !name.empty() && name != "." && name != ".." && fs::path(name).filename() == name;
}

}  // namespace

ReportPictures::ReportPictures(fs::path folder) : folder_(std::move(folder)) {
    make_folder_below(folder_.parent_path(), folder_.filename());
    constexpr std::uintmax_t kMostBytes = std::uintmax_t(1) << 28;
    std::string fault;
    std::istringstream lines(read_file_below(folder_, kList, kMostBytes, fault));
    if (!fault.empty() && fault != kNoSuchFile)
        throw Error(ErrorKind::output, (folder_ / kList).string() + ": " + fault);
    for (std::string name; std::getline(lines, name);)
        if (is_plain_name(name)) old_.insert(name);
}

fs::path ReportPictures::add(const std::string& name) {
    const std::scoped_lock lock(mutex_);
    if (own_.insert(name).second && !old_.contains(name)) {
        const std::string line = name + "\n";
        std::string fault;
        const auto list = open_file_below(folder_, kList, fault, FileUse::append);
        if (list && write(list->descriptor(), line.data(), line.size()) != ssize_t(line.size()))
            fault = "cannot be written";
        if (!fault.empty()) throw Error(ErrorKind::output, (folder_ / kList).string() + ": " + fault);
    }
    return path_below(folder_, name);
}

void ReportPictures::remove_old() {
    const std::scoped_lock lock(mutex_);
    std::string names;
    for (const std::string& name : own_) names += name + "\n";
    for (const std::string& name : old_) {
        std::error_code failure;
        const fs::path file = folder_ / name;
        if (own_.contains(name) || !fs::is_regular_file(fs::symlink_status(file, failure))) continue;
        fs::remove(file, failure);
        if (failure)
            throw Error(ErrorKind::output, file.string() + ": cannot be removed: " + failure.message());
    }
    write_text_file(path_below(folder_, kList), names);
    old_.clear();
}

}  // namespace aftershade
