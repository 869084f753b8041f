#include "razor/program/study/checks.h"

#include "razor/scene/nearest.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace razor {

using analysis::toml_text;
using analysis::Value;

std::string wrong_word(std::string_view key, const Value& value, const std::vector<std::string_view>& words) {
    const auto* text = std::get_if<std::string>(&value);
    if (text == nullptr)
        return fmt::format("{} is no text; write it in quotes", key);
    if (words.empty() || std::find(words.begin(), words.end(), *text) != words.end())
        return "";
    return fmt::format("{} = {} is not possible; write one of {}", key, toml_text(value),
                       fmt::join(words, ", "));
}

std::string wrong_whole(std::string_view key, const Value& value, double least, double most) {
    const auto* number = std::get_if<std::int64_t>(&value);
    const bool right =
        number != nullptr && static_cast<double>(*number) >= least && static_cast<double>(*number) <= most;
    return right ? ""
                 : fmt::format("{} = {} is not possible; write a whole number from {} to {}", key,
                               toml_text(value), least, most);
}

std::string wrong_number(std::string_view key, Value& value, double least, double most) {
    if (const auto* const integer = std::get_if<std::int64_t>(&value))
        value = static_cast<double>(*integer);
    const auto* const real = std::get_if<double>(&value);
    const bool right = real != nullptr && *real >= least && *real <= most;
    return right ? ""
                 : fmt::format("{} = {} is not possible; write a number from {} to {}", key, toml_text(value),
                               least, most);
}

std::string no_setting(std::string_view key, const std::vector<std::string_view>& known) {
    const std::string_view near = meant(key, known);
    return near.empty()
               ? fmt::format("unknown setting {}; there are {}", printable(key), fmt::join(known, ", "))
               : fmt::format("unknown setting {}; did you mean {}?", printable(key), near);
}

} // namespace razor
