#include "sim/config/origin.h"

#include <fmt/core.h>

namespace sim {
namespace {

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t\r\n";
    const std::size_t first = text.find_first_not_of(blanks);
    return first == std::string_view::npos ? std::string_view{}
                                           : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// The end of what the parenthesis at `begin` encloses, or npos. Sources may have parentheses of their own.
std::size_t closing(std::string_view text, std::size_t begin) {
    int open = 0;
    for (std::size_t i = begin; i < text.size(); ++i) {
        open += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
        if (open == 0)
            return i;
    }
    return std::string_view::npos;
}

/// What follows a mark: nothing, or a colon and a remark.
bool read_remark(std::string_view rest, Mark& mark) {
    rest = trimmed(rest);
    if (!rest.empty() && rest.front() != ':')
        return false;
    mark.remark = rest.empty() ? "" : trimmed(rest.substr(1));
    return true;
}

} // namespace

Mark read_mark(std::string_view comment) {
    comment = trimmed(comment);
    const Mark unmarked{Mark::none, "", std::string(comment)};
    constexpr std::string_view assumed = "assumed", known = "known";
    Mark mark;
    if (comment.starts_with(assumed)) {
        mark.kind = Mark::assumed;
        return read_remark(comment.substr(assumed.size()), mark) ? mark : unmarked;
    }
    if (!comment.starts_with(known))
        return unmarked;
    const std::string_view rest = trimmed(comment.substr(known.size()));
    if (rest.empty() || rest.front() != '(')
        return unmarked;
    const std::size_t end = closing(rest, 0);
    if (end == std::string_view::npos)
        return unmarked;
    mark.kind = Mark::known;
    mark.source = trimmed(rest.substr(1, end - 1));
    return !mark.source.empty() && read_remark(rest.substr(end + 1), mark) ? mark : unmarked;
}

std::string_view comment_behind(std::string_view line, std::size_t column) {
    const std::size_t hash = line.find('#', column);
    return hash == std::string_view::npos ? std::string_view{} : trimmed(line.substr(hash + 1));
}

std::string Origin::place() const {
    switch (layer) {
    case preset:
        return "default";
    case setting:
        return "-g";
    default:
        return fmt::format("{}:{}", file_name, line);
    }
}

} // namespace sim
