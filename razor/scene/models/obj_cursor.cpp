#include "razor/scene/models/obj_cursor.h"

#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <system_error>

namespace razor {
namespace {

bool is_line_end(char c) {
    return c == '\n' || c == '\r';
}
bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

} // namespace

ObjCursor::ObjCursor(std::string_view text, std::string_view file_name)
    : at_(text.data()), end_(text.data() + text.size()), file_name_(printable(file_name, 1000)) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) {
        at_ += byte_order_mark.size();
    }
}

void ObjCursor::skip_line_end() {
    at_ += *at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n' ? 2 : 1;
    ++line_;
}

bool ObjCursor::at_statement_end() {
    while (at_ != end_) {
        if (is_blank(*at_)) {
            ++at_;
        } else if (*at_ == '\\' && at_ + 1 != end_ && is_line_end(at_[1])) {
            ++at_;
            skip_line_end();
        } else {
            return is_line_end(*at_) || *at_ == '#';
        }
    }
    return true;
}

void ObjCursor::next_statement() {
    bool comment = false;
    while (at_ != end_ && !is_line_end(*at_)) {
        comment = comment || *at_ == '#';
        if (!comment && *at_ == '\\' && at_ + 1 != end_ && is_line_end(at_[1])) {
            ++at_;
            skip_line_end();
        } else {
            ++at_;
        }
    }
    if (at_ != end_) {
        skip_line_end();
    }
}

std::string_view ObjCursor::word() {
    if (at_statement_end()) {
        return {};
    }
    const char* const first = at_;
    while (at_ != end_ && !is_blank(*at_) && !is_line_end(*at_)) {
        if (*at_ == '\\' && at_ + 1 != end_ && is_line_end(at_[1])) {
            break;
        }
        ++at_;
    }
    return {first, static_cast<std::size_t>(at_ - first)};
}

std::string_view ObjCursor::rest() {
    if (at_statement_end()) {
        return {};
    }
    const char* const first = at_;
    const char* last = at_; // behind what is no blank
    while (at_ != end_ && !is_line_end(*at_) && !(*at_ == '#' && is_blank(at_[-1]))) {
        if (!is_blank(*at_++)) {
            last = at_;
        }
    }
    return {first, static_cast<std::size_t>(last - first)};
}

double ObjCursor::number(std::string_view what) {
    const std::string_view text = word();
    if (text.empty()) {
        fail(fmt::format("{} is missing; write a number", what));
    }
    return to_number(text, what);
}

std::int64_t ObjCursor::integer(std::string_view what) {
    const std::string_view text = word();
    if (text.empty()) {
        fail(fmt::format("{} is missing; write a whole number", what));
    }
    return to_integer(text, what);
}

double ObjCursor::to_number(std::string_view word, std::string_view what) const {
    const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
    double value = 0;
    const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool whole = stop == digits.data() + digits.size() && !digits.empty();
    if (error == std::errc::result_out_of_range && whole) {
        value = std::strtod(std::string(digits).c_str(), nullptr); // 0 or subnormal, or infinite
    } else if (error != std::errc{} || !whole || (digits.data() != word.data() && digits.starts_with('-'))) {
        fail(fmt::format("{} is '{}', not a number; mend it", what, printable(word)));
    }
    if (!std::isfinite(value)) {
        fail(fmt::format("{} is '{}', not a finite number; mend it", what, printable(word)));
    }
    return value;
}

std::int64_t ObjCursor::to_integer(std::string_view word, std::string_view what) const {
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc::result_out_of_range) {
        fail(fmt::format("{} is {}, out of range; mend it", what, printable(word)));
    }
    if (error != std::errc{} || stop != word.data() + word.size()) {
        fail(fmt::format("{} is '{}', not a whole number; mend it", what, printable(word)));
    }
    return value;
}

void ObjCursor::fail_at(std::int64_t line, std::string_view message) const {
    throw UserError(fmt::format("{}:{}: {}", file_name_, line, message));
}

} // namespace razor
