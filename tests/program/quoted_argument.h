// A word for the shell, whatever it holds.
#pragma once

#include <string>

namespace razor {

inline std::string quoted_argument(const std::string& text) {
    std::string result = "'";
    for (const char c : text) {
        result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return result + "'";
}

} // namespace razor
