// A mistake in a machine's description: one clear line, exit code 2.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>

namespace sim {

/// what() is one line: file:line:column (or the override), cause, mend. Control characters, which names of
/// files and values may have, come out as question marks.
class ConfigError : public std::runtime_error {
public:
    explicit ConfigError(std::string message) : std::runtime_error(one_line(std::move(message))) {}

private:
    static std::string one_line(std::string text) {
        std::replace_if(
            text.begin(), text.end(), [](char c) { return (c >= 0 && c < ' ') || c == '\x7f'; }, '?');
        return text;
    }
};

} // namespace sim
