#include "framework/golden/golden_approve.h"

#include <algorithm>
#include <list>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/input_files.h"
#include "framework/base/lfs_pointer.h"
#include "framework/base/scratch_folder.h"
#include "framework/base/side_file.h"
#include "framework/golden/capture_hash.h"
#include "framework/golden/case_trace.h"
#include "framework/golden/golden_store.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

bool same_bits(const fs::path& a, const fs::path& b) {
    CompareRules rules;
    rules.flip_choice = FlipChoice::none;
    rules.ssim = false;
    rules.threads = 1;
    rules.nan_equal = true;
    return has_equal_bits(compare_files(a, b, rules));
}

/// Approved images of a case, whatever their frames.
std::vector<ApprovedImage> approved_of(const GoldenCase& test, const GoldenEnvironment& own) {
    std::vector<ApprovedImage> all;
    std::error_code unreadable;
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(test.goldens, unreadable))
        for (const std::string& stem : test.image_stems())
            if (const auto frame = approved_frame(entry.path().filename().string(), stem))
                names.push_back(golden_image_name(stem, *frame));
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    for (const std::string& name : names)
        for (ApprovedImage& image : approved_images(test.goldens, name, own)) all.push_back(std::move(image));
    return all;
}

/// Files beside their goldens under other names, until all are renamed.
class Staging {
public:
    void add_image(const fs::path& target, const fs::path& image) {
        files_.emplace_back(path_below(target.parent_path(), target.filename())).copy_from(image);
    }
    void add_text(const fs::path& target, const std::string& text) {
        AtomicFile& file = files_.emplace_back(path_below(target.parent_path(), target.filename()));
        // The inner file is renamed to the staged one; both are whole or not there.
        write_text_file(file.temporary_path(), text);
    }
    /// In the order added: an image before its sidecar, which knows the image's hash and is not believed
    /// beside another.
    void commit() {
        for (AtomicFile& file : files_) file.commit();
    }

private:
    std::list<AtomicFile> files_;
};

class Approver {
public:
    Approver(const GoldenSuite& suite, const GoldenApproveOptions& options, GoldenApproval& approval)
        : suite_(suite), options_(options), approval_(approval), inputs_(suite_inputs(suite, false)) {}

    void take(GoldenCaseResult& result, const TracedCase& traced, CaseTracer& tracer) {
        const std::scoped_lock lock(mutex_);
        // All of them before anything is staged: a fault of one keeps the case's goldens.
        std::vector<Approved> approved;
        for (const RenderedImage& image : traced.rendered.images)
            approved.push_back(approved_images(result.test->goldens, image.name, options_.run.environment));
        for (const Approved& images : approved)
            for (const ApprovedImage& image : images)
                if (const std::string fault = lfs_fault(image.file); !fault.empty())
                    throw Error(ErrorKind::capture, image.file.string() + ": " + fault);
        refuse(result, traced.rendered.images, approved);
        if (result.verdict > Verdict::warning) return;
        std::error_code failure;
        fs::create_directories(result.test->goldens, failure);
        if (failure) throw Error(ErrorKind::output, result.test->goldens.string() + ": " + failure.message());
        for (std::size_t i = 0; i < approved.size(); ++i) {
            const RenderedImage& image = traced.rendered.images[i];
            CaseOrigin origin = tracer.parts(*result.test, image.frame).origin;
            if (const auto steps = traced.steps.find(image.frame); steps != traced.steps.end())
                origin.steps = steps->second;
            take(*result.test, image, approved[i], result.sources, std::move(origin));
        }
    }
    /// The store first: what is there too many is in nobody's way, and what is missing would be lost.
    void commit(const std::atomic<bool>& interrupt) {
        const GoldenStore store(suite_.store, suite_.folder(), options_.run.render.timeout);
        std::set<std::string> kept;
        for (const auto& [digest, file] : kept_) kept.insert(digest);
        for (const std::string& digest : store.lacking(kept, interrupt)) prepare_push(kept_.at(digest));
        store.push(pushed_, to_push_.path(), interrupt);
        staging_.commit();
    }

private:
    using Approved = std::vector<ApprovedImage>;
    static Approved::const_iterator find_equal(const Approved& approved, const RenderedImage& image) {
        return std::ranges::find_if(
            approved, [&](const ApprovedImage& other) { return same_bits(other.file, image.file); });
    }

    /// A failure of the case where something stands against one of its new images.
    void refuse(GoldenCaseResult& result, const std::vector<RenderedImage>& images,
                const std::vector<Approved>& approved) const {
        if (!options_.why_not) return;
        for (std::size_t i = 0; i < images.size(); ++i) {
            if (find_equal(approved[i], images[i]) != approved[i].end()) continue;
            const std::string why = options_.why_not(*result.test, images[i], approved[i]);
            if (why.empty()) continue;
            result.verdict = Verdict::failure;
            result.messages.push_back(images[i].name + ": " + why);
        }
    }

    void take(const GoldenCase& test, const RenderedImage& image, const Approved& approved,
              const GoldenSources& sources, CaseOrigin origin) {
        GoldenSidecar sidecar{options_.run.environment, options_.command, sources, "", "", "",
                              std::move(origin)};
        const auto equal = find_equal(approved, image);
        if (equal != approved.end()) {
            ++approval_.unchanged;
            // A sidecar of another image is what a kill between the two renames leaves.
            if (equal->sidecar_fault) {
                approve(equal->file, equal->file, sidecar);
                approval_.renewed.push_back(sidecar_path(equal->file));
            } else {
                keep_stored(*equal);
                if (options_.renew_sidecars) renew(*equal, sidecar);
            }
            return;
        }
        const fs::path target = target_of(test, image, approved);
        if (const auto input = inputs_.replaced_by(target))
            throw Error(ErrorKind::usage, target.string() + ": would replace the input " + input->string() +
                                              " (choose another folder for 'goldens')");
        staging_.add_image(target, image.file);
        approve(target, image.file, sidecar);
        approval_.written.push_back(target);
        for (const ApprovedImage& other : approved)
            if (other.file != target && (!other.sidecar || other.sidecar->sources.look != sources.look))
                approval_.outdated.push_back(other.file);
    }

    /// The sidecar of a golden whose bytes are those of `image`.
    void approve(const fs::path& golden, const fs::path& image, GoldenSidecar sidecar) {
        sidecar.image_hash = file_hash(image);
        if (!suite_.store.empty()) sidecar.sha256 = prepare_push(image);
        sidecar.approver = options_.approver;
        sidecar.approved = options_.approved;
        staging_.add_text(sidecar_path(golden), sidecar_text(sidecar));
    }

    /// An approved image that its sidecar names; the store may have lost it.
    void keep_stored(const ApprovedImage& approved) {
        if (suite_.store.empty() || !approved.sidecar || approved.sidecar->sha256.empty()) return;
        kept_.emplace(approved.sidecar->sha256, approved.file);
    }

    /// The SHA-256 of the image, of which a copy goes to the store.
    std::string prepare_push(const fs::path& image) {
        const std::string digest = sha256_of_file(image);
        if (digest.empty())
            throw Error(ErrorKind::output,
                        image.string() + ": cannot be read, or has more bytes than a store takes");
        fs::copy_file(image, to_push_.path() / stored_name(digest), fs::copy_options::overwrite_existing);
        pushed_.insert(digest);
        return digest;
    }

    void renew(const ApprovedImage& approved, GoldenSidecar sidecar) {
        sidecar.image_hash = file_hash(approved.file);
        if (!suite_.store.empty()) {
            const bool is_there = approved.sidecar && !approved.sidecar->sha256.empty();
            sidecar.sha256 = is_there ? approved.sidecar->sha256 : prepare_push(approved.file);
        }
        if (approved.sidecar) {
            // Only what the bits depend on; another command is no news.
            const GoldenSidecar& old = *approved.sidecar;
            if (old.environment.equals(sidecar.environment) &&
                old.environment.instructions == sidecar.environment.instructions &&
                old.sources.look == sidecar.sources.look && old.sources.capture == sidecar.sources.capture &&
                old.sources.program == sidecar.sources.program && old.image_hash == sidecar.image_hash &&
                old.origin == sidecar.origin && old.sha256 == sidecar.sha256)
                return;
            // The picture is the one that was looked at then.
            sidecar.approver = old.approver;
            sidecar.approved = old.approved;
        }
        staging_.add_text(sidecar_path(approved.file), sidecar_text(sidecar));
        approval_.renewed.push_back(sidecar_path(approved.file));
    }

    fs::path target_of(const GoldenCase& test, const RenderedImage& image,
                       const std::vector<ApprovedImage>& approved) const {
        const GoldenEnvironment& own = options_.run.environment;
        if (!approved.empty()) {
            const ApprovedImage& nearest = approved.front();
            if (nearest.key == own.key() || (nearest.sidecar && nearest.sidecar->environment.equals(own)))
                return nearest.file;
        }
        const std::string key = options_.add && !approved.empty() ? "@" + own.key() : "";
        return test.goldens / (image.name + key + ".exr");
    }

    const GoldenSuite& suite_;
    const GoldenApproveOptions& options_;
    GoldenApproval& approval_;
    InputFiles inputs_;
    Staging staging_;
    ScratchFolder to_push_;
    std::set<std::string> pushed_;          ///< digests
    std::map<std::string, fs::path> kept_;  ///< approved images with equal bits, by digest
    std::mutex mutex_;
};

}  // namespace

std::string foreign_goldens(const GoldenSuite& suite, const GoldenRunOptions& options) {
    const bool software = options.environment.software;
    for (const GoldenCase& test : suite.cases) {
        if (!fits_filter(test, options.filters)) continue;
        const ApprovedImage* foreign = nullptr;
        bool has_own_kind = false;
        std::vector<ApprovedImage> approved;
        // A fault of the images is one of their case, which keeps them.
        Verdict verdict = Verdict::same;
        std::vector<std::string> faults;
        with_case_faults(verdict, faults, [&] { approved = approved_of(test, options.environment); });
        for (const ApprovedImage& image : approved) {
            if (!image.sidecar) continue;
            if (image.sidecar->environment.software == software) has_own_kind = true;
            else foreign = &image;
        }
        if (foreign && !has_own_kind)
            return foreign->file.string() + " is of " + foreign->sidecar->environment.renderer + ", a " +
                   (software ? "hardware" : "software") + " renderer; this one is " +
                   options.environment.renderer + ". Use the goldens' --backend, or --any-renderer";
    }
    return "";
}

GoldenApproval approve_goldens(const GoldenSuite& suite, const GoldenApproveOptions& options,
                               const GoldenListener& listener, const std::atomic<bool>& interrupt) {
    GoldenApproval approval;
    Approver approver(suite, options, approval);
    std::vector<const GoldenCase*> cases;
    for (const GoldenCase& test : suite.cases)
        if (fits_filter(test, options.run.filters)) cases.push_back(&test);
    // What cannot be written is known before the cases are drawn.
    std::error_code absent;
    for (const GoldenCase* test : cases)
        if (fs::is_directory(test->goldens, absent))
            prepare_output_folder(path_below(test->goldens, test->stem));
    const std::vector<std::string> looks = look_hashes(cases, options.run.render);
    CaptureHasher captures;
    CaseTracer tracer(options.run.render, suite.folder());
    approval.cases.resize(cases.size());
    std::mutex telling;
    int done = 0;
    for_each_in_folders(cases.size(), options.run.jobs, [&](std::size_t i, const fs::path& work) {
        GoldenCaseResult& result = approval.cases[i];
        result.test = cases[i];
        result.sources = {looks[i], "", options.run.program};
        result.skipped = cases[i]->skip;
        if (interrupt) return;
        if (result.skipped.empty() &&
            !is_unfetched(*cases[i], options.run, result.verdict, result.messages)) {
            result.sources.capture = captures.hash(*cases[i]);
            const TracedCase traced =
                render_traced(*cases[i], tracer.taps(*cases[i]), options.run.render, work, interrupt);
            const RenderedCase& rendered = traced.rendered;
            if (rendered.interrupted) return;
            result.skipped = rendered.absent;
            result.verdict = rendered.verdict;
            result.messages = rendered.messages;
            result.seconds = rendered.seconds;
            if (result.verdict <= Verdict::warning)
                with_case_faults(result.verdict, result.messages,
                                 [&] { approver.take(result, traced, tracer); });
        }
        const std::scoped_lock lock(telling);
        if (listener) listener(result, ++done, int(cases.size()));
    });
    for (const GoldenCaseResult& test : approval.cases)
        approval.verdict = std::max(approval.verdict, test.verdict);
    approval.interrupted = interrupt;
    if (!approval.interrupted) approver.commit(interrupt);
    for (auto* files : {&approval.written, &approval.renewed, &approval.outdated}) std::ranges::sort(*files);
    return approval;
}

}  // namespace aftershade
