#include "framework/serve/json_spans.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "framework/base/error.h"

namespace aftershade::serve {

namespace {

class Scanner {
public:
    explicit Scanner(std::string_view text) : text_(text) {}

    SpanNode value(int depth) {
        constexpr int kDeepest = 100;  // above what parse_document() takes
        at_ = skip_blank(text_, at_);
        if (at_ >= text_.size() || depth > kDeepest) fail();
        SpanNode node;
        node.span.begin = at_;
        if (text_[at_] == '{') object(node, depth);
        else if (text_[at_] == '[') array(node, depth);
        else if (text_[at_] == '"') string();
        else word();
        node.span.end = at_;
        return node;
    }

private:
    [[noreturn]] static void fail() { throw Error(ErrorKind::usage, "the look is not whole JSON"); }

    bool takes(char c) {
        at_ = skip_blank(text_, at_);
        if (at_ >= text_.size() || text_[at_] != c) return false;
        ++at_;
        return true;
    }

    void object(SpanNode& node, int depth) {
        node.kind = SpanNode::Kind::object;
        takes('{');
        if (takes('}')) return;
        do {
            SpanMember member;
            at_ = skip_blank(text_, at_);
            member.key_span.begin = at_;
            string();
            member.key_span.end = at_;
            const auto key = nlohmann::json::parse(member.key_span.of(text_), nullptr, false);
            if (!key.is_string()) fail();  // a control character, or an escape that is none
            member.key = key.get<std::string>();
            if (!takes(':')) fail();
            member.value = value(depth + 1);
            node.members.push_back(std::move(member));
        } while (takes(','));
        if (!takes('}')) fail();
    }

    void array(SpanNode& node, int depth) {
        node.kind = SpanNode::Kind::array;
        takes('[');
        if (takes(']')) return;
        do node.items.push_back(value(depth + 1));
        while (takes(','));
        if (!takes(']')) fail();
    }

    void string() {
        if (at_ >= text_.size() || text_[at_] != '"') fail();
        for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_)
            if (text_[at_] == '\\') ++at_;
        if (at_ >= text_.size()) fail();
        ++at_;
    }

    void word() {
        const std::size_t end = std::min(text_.find_first_of(" \t\r\n,:[]{}\"/", at_), text_.size());
        if (end == at_) fail();
        at_ = end;
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

}  // namespace

const SpanMember* SpanNode::find(std::string_view key) const {
    const auto found = std::ranges::find(members, key, &SpanMember::key);
    return found == members.end() ? nullptr : &*found;
}

SpanNode spans_of(std::string_view text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    Scanner scanner(text);
    if (!text.starts_with(kByteOrderMark)) return scanner.value(0);
    throw Error(ErrorKind::usage,
                "the look begins with a byte order mark; save it without one to edit it here");
}

std::size_t skip_blank(std::string_view text, std::size_t from) {
    for (;;) {
        from = std::min(text.find_first_not_of(" \t\r\n", from), text.size());
        if (text.substr(from, 2) == "//") {
            from = std::min(text.find('\n', from), text.size());
        } else if (text.substr(from, 2) == "/*") {
            const std::size_t end = text.find("*/", from + 2);
            from = end == std::string_view::npos ? text.size() : end + 2;
        } else {
            return from;
        }
    }
}

}  // namespace aftershade::serve
