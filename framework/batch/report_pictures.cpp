#include "framework/batch/report_pictures.h"

#include <fstream>
#include <sstream>
#include <utility>

#include "framework/core/atomic_file.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

/// Whoever changed the list, nothing outside the folder is removed.
bool is_plain_name(const std::string& name) {
    return !name.empty() && name != "." && name != ".." && fs::path(name).filename() == name;
}

}  // namespace

ReportPictures::ReportPictures(fs::path folder) : folder_(std::move(folder)) {
    std::error_code failure;
    if (!fs::exists(list(), failure)) return;
    std::istringstream lines(read_text_file(list(), ExitCode::output));
    for (std::string name; std::getline(lines, name);)
        if (is_plain_name(name)) old_.insert(name);
}

fs::path ReportPictures::add(const std::string& name) {
    const std::scoped_lock lock(mutex_);
    if (own_.insert(name).second && !old_.contains(name)) {
        std::ofstream out(list(), std::ios::binary | std::ios::app);
        out << name << "\n";
        out.close();
        if (!out) throw Error(ExitCode::output, list().string() + ": cannot be written");
    }
    return folder_ / name;
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
            throw Error(ExitCode::output, file.string() + ": cannot be removed: " + failure.message());
    }
    write_text_file(list(), names);
    old_.clear();
}

}  // namespace aftershade
