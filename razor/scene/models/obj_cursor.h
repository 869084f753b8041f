// Walks over OBJ text: words of a statement, numbers, lines, continuations (`\` before a line's end).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace razor {

class ObjCursor {
public:
    ObjCursor(std::string_view text, std::string_view file_name);

    /// Whether any text is left.
    bool at_end() const { return at_ == end_; }
    /// Skips blanks and continuations; whether the statement (not the text) ends here. A comment ends a
    /// statement.
    bool at_statement_end();
    /// Skips the rest of the statement, comment and line end included. A `\` at a comment's end does not
    /// continue it.
    void next_statement();
    /// The current line, from 1.
    std::int64_t line() const { return line_; }

    /// The next word of the statement, up to a blank; empty at the statement's end.
    std::string_view word();
    /// All that is left of the statement, without blanks around it: names may hold some.
    std::string_view rest();
    /// The next word as a finite number. `what` names it in messages: "x of v".
    double number(std::string_view what);
    /// The next word as a whole number.
    std::int64_t integer(std::string_view what);

    /// Throws UserError "file:line: message" for the given line.
    [[noreturn]] void fail_at(std::int64_t line, std::string_view message) const;
    [[noreturn]] void fail(std::string_view message) const { fail_at(line_, message); }

    /// `word` as a finite number; throws naming `what`.
    double to_number(std::string_view word, std::string_view what) const;
    std::int64_t to_integer(std::string_view word, std::string_view what) const;

private:
    void skip_line_end();

    const char* at_;
    const char* end_;
    std::int64_t line_ = 1;
    std::string file_name_;
};

} // namespace razor
