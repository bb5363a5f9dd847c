// docs/writing.md: phrases that public text does without.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;
const fs::path kRoot = AFTERSHADE_SOURCE_DIR;

struct Phrase {
    std::string_view words;
    std::string_view instead;
};

/// In lower case, one space between words.
constexpr Phrase kPhrases[] = {
    {"anew", "again, restart"},
    {"are asked", "are requested, are read"},
    {"are taken for", "are assumed to be"},
    {"asks", "reads, needs, requests"},
    {"be asked", "be requested, be read"},
    {"go on", "continue, resume"},
    {"goes on", "continues, resumes"},
    {"going on", "continuing"},
    {"is asked", "is requested, is read"},
    {"is taken for", "is assumed to be"},
    {"knows", "has, contains, lists"},
    {"mean harm", "are malicious"},
    {"means harm", "is malicious"},
    {"mend", "repair, correct, fix"},
    {"mended", "repaired, corrected, fixed"},
    {"mends", "repairs, corrects, fixes"},
    {"nobody", "no process, no pass, no one"},
    {"shall", "must, does"},
    {"so many", "this many, a number of"},
    {"stranger", "an untrusted source"},
    {"strangers", "untrusted sources"},
    {"tells", "shows, prints, names"},
    {"that there are", "leave it out"},
    {"that there is", "leave it out"},
    {"told", "printed, reported, set"},
    {"was asked", "was requested"},
    {"went on", "continued"},
    {"were asked", "were requested"},
    {"whom", "which object, which user"},
    {"without more", "by default"},
};

struct Text {
    std::string place;
    std::string text;
};

/// The string literals of a C++ source that are more than a word, neighbours joined; with `comments`, its
/// comments too, adjacent lines joined.
class CppTexts {
public:
    CppTexts(std::string place, const std::string& source, bool comments)
        : place_(std::move(place)), source_(source), has_comments_(comments) {}

    std::vector<Text> read() {
        while (at_ < source_.size()) {
            if (starts("//")) comment();
            else if (starts("/*")) skip_past("*/", has_comments_);
            else if (starts("R\"")) raw_literal();
            else if (source_[at_] == '"') literal();
            else if (source_[at_] == '\'' && !is_digit_separator()) skip_character();
            else other();
        }
        flush();
        return std::move(texts_);
    }

private:
    bool starts(std::string_view word) const { return source_.compare(at_, word.size(), word) == 0; }
    bool is_digit_separator() const { return at_ > 0 && std::isalnum((unsigned char)source_[at_ - 1]) != 0; }

    void take(std::string_view text, char kind) {
        if (kind != kind_) flush();
        kind_ = kind;
        text_ += text;
    }
    void flush() {
        const std::size_t first = std::min(text_.find_first_not_of(' '), text_.size());
        const bool is_sentence = text_.find(' ', first) != std::string::npos;
        if (is_sentence) texts_.push_back({place_ + ":" + std::to_string(line_), text_});
        text_.clear();
        kind_ = 0;
    }
    void comment() {
        const std::size_t end = std::min(source_.find('\n', at_), source_.size());
        if (has_comments_) take(std::string_view(source_).substr(at_ + 2, end - at_ - 2), '/');
        at_ = end;
    }
    void skip_past(std::string_view end, bool keep) {
        const std::size_t close = std::min(source_.find(end, at_ + 2), source_.size());
        if (keep) take(std::string_view(source_).substr(at_ + 2, close - at_ - 2), '*');
        at_ = std::min(close + end.size(), source_.size());
    }
    void raw_literal() {
        const std::size_t open = source_.find('(', at_);
        const std::string end = ")" + source_.substr(at_ + 2, open - at_ - 2) + "\"";
        const std::size_t close = std::min(source_.find(end, open), source_.size());
        take(std::string_view(source_).substr(open + 1, close - open - 1), '"');
        at_ = std::min(close + end.size(), source_.size());
    }
    void literal() {
        std::string text;
        for (++at_; at_ < source_.size() && source_[at_] != '"' && source_[at_] != '\n'; ++at_) {
            const bool is_escape = source_[at_] == '\\' && at_ + 1 < source_.size();
            text += is_escape ? (source_[++at_] == 'n' ? ' ' : source_[at_]) : source_[at_];
        }
        ++at_;
        take(text, '"');
    }
    void skip_character() {
        at_ += 1;
        while (at_ < source_.size() && source_[at_] != '\'' && source_[at_] != '\n')
            at_ += source_[at_] == '\\' ? 2 : 1;
        ++at_;
    }
    void other() {
        if (source_[at_] == '\n') ++line_;
        if (std::isspace((unsigned char)source_[at_]) == 0) flush();
        ++at_;
    }

    std::string place_;
    const std::string& source_;
    const bool has_comments_;
    std::size_t at_ = 0;
    int line_ = 1;  // where the text ends
    char kind_ = 0;
    std::string text_;
    std::vector<Text> texts_;
};

/// " the words of the text in lower case ", without marks; names in code stay one word: "mend_non_finite".
std::string words_of(std::string text) {
    // The value of --on-nan, of the library's and of Python's option.
    for (const std::string_view name :
         {"`mend`", "\"mend\"", "--on-nan mend", "::mend", "mend:", "or mend\n"})
        for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at))
            text.erase(at, name.size());
    std::string words = " ";
    for (const char c : text) {
        const bool is_letter = std::isalnum((unsigned char)c) != 0 || c == '_' || (c & 0x80) != 0;
        if (is_letter) words += char(std::tolower((unsigned char)c));
        else if (words.back() != ' ') words += ' ';
    }
    return words.back() == ' ' ? words : words + " ";
}

/// "is no folder" where "is not a folder" is meant; "there is no" and "is no longer" are English.
bool says_is_no(const std::string& words) {
    static const std::set<std::string> kSound{"longer",  "more",  "less",     "greater",
                                              "smaller", "other", "different"};
    for (const std::string_view verb : {" is no ", " are no ", " was no ", " be no "})
        for (std::size_t at = words.find(verb); at != std::string::npos; at = words.find(verb, at + 1)) {
            const std::size_t next = at + verb.size();
            const std::string after = words.substr(next, words.find(' ', next) - next);
            const bool is_there = words.substr(0, at).ends_with(" there");
            if (!is_there && !kSound.contains(after)) return true;
        }
    return false;
}

void expect_plain(const Text& text) {
    const std::string words = words_of(text.text);
    for (const Phrase& phrase : kPhrases)
        EXPECT_EQ(words.find(" " + std::string(phrase.words) + " "), std::string::npos)
            << text.place << ": '" << phrase.words << "'; write: " << phrase.instead << "\n"
            << text.text;
    EXPECT_FALSE(says_is_no(words)) << text.place << ": 'is no'; write: is not a\n" << text.text;
}

/// The paragraphs of a page or document; those of docs/writing.md that show what not to write are left out.
void expect_plain_paragraphs(const fs::path& file) {
    const std::string name = fs::relative(file, kRoot).string();
    std::istringstream in(read_text(file));
    std::string paragraph;
    int number = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        if (line.starts_with("- Before: ")) continue;
        const bool ends = line.empty() || line.starts_with("|") || line.starts_with("#");
        paragraph += line + "\n";
        if (!ends) continue;
        expect_plain({name + ":" + std::to_string(number), paragraph});
        paragraph.clear();
    }
    expect_plain({name + ":" + std::to_string(number), paragraph});
}

TEST(PublicText, OfPagesAndDocumentsIsPlain) {
    for (const char* page : {"README.md", "CONTRIBUTING.md", "STYLE.md", "SECURITY.md"})
        expect_plain_paragraphs(kRoot / page);
    const std::set<std::string> read{".md", ".json", ".py", ".pyi", ".js", ".html"};
    int files = 0;
    for (const char* folder : {"docs", "effects", "glsl", "profiles", "scenes", "python/aftershade",
                               "framework/golden/report_page", "examples"})
        for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
            if (!entry.is_regular_file() || !read.contains(entry.path().extension().string())) continue;
            expect_plain_paragraphs(entry.path());
            ++files;
        }
    EXPECT_GT(files, 150);
}

TEST(PublicText, OfMessagesAndHeadersIsPlain) {
    int texts = 0;
    for (const char* folder : {"cli", "framework"})
        for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
            const std::string extension = entry.path().extension().string();
            if (extension != ".h" && extension != ".cpp") continue;
            const std::string source = read_text(entry.path());
            const std::string place = fs::relative(entry.path(), kRoot).string();
            for (const Text& text : CppTexts(place, source, extension == ".h").read()) {
                expect_plain(text);
                ++texts;
            }
        }
    EXPECT_GT(texts, 3000);
}

TEST(PublicText, IsReadFromLiteralsAndComments) {
    const std::string source =
        "/// One\n/// two.\nint a = 1'000;\nconst char* b = \"three \"\n  \"is \\\"no\\\" four\"; "
        "char c = '\"';\nauto d = R\"(five\nsix)\";\n";
    std::vector<std::string> found;
    for (const Text& text : CppTexts("a.h", source, true).read()) found.push_back(words_of(text.text));
    EXPECT_EQ(found, (std::vector<std::string>{" one two ", " three is no four "}));
    EXPECT_TRUE(says_is_no(found[1]));
    EXPECT_FALSE(says_is_no(words_of("there is no folder, and it is no longer here")));
}

}  // namespace
}  // namespace aftershade::test
