#include "analysis/study/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace analysis {
namespace {

std::string number_text(double value) {
    if (std::isnan(value))
        return "nan";
    if (std::isinf(value))
        return value > 0 ? "inf" : "-inf";
    std::string text = fmt::format("{}", value + 0.0); // + 0: no negative zero
    if (text.find_first_of(".e") == std::string::npos)
        text += ".0";
    return text;
}

/// A basic string of TOML.
std::string quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            out += fmt::format("\\{}", c);
        else if (static_cast<unsigned char>(c) < 0x20 || c == '\x7f')
            out += fmt::format("\\u{:04X}", static_cast<unsigned char>(c));
        else
            out += c;
    }
    return out + "\"";
}

bool is_bare(std::string_view key) {
    return !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
               c == '-';
    });
}

} // namespace

std::string toml_text(const Value& value) {
    if (const auto* flag = std::get_if<bool>(&value))
        return *flag ? "true" : "false";
    if (const auto* whole = std::get_if<std::int64_t>(&value))
        return fmt::format("{}", *whole);
    if (const auto* real = std::get_if<double>(&value))
        return number_text(*real);
    return quoted(std::get<std::string>(value));
}

std::string plain_text(const Value& value) {
    if (const auto* text = std::get_if<std::string>(&value))
        return *text;
    if (const auto* real = std::get_if<double>(&value))
        return fmt::format("{}", *real + 0.0);
    return toml_text(value);
}

std::optional<double> number_of(const Value& value) {
    if (const auto* whole = std::get_if<std::int64_t>(&value))
        return static_cast<double>(*whole);
    if (const auto* real = std::get_if<double>(&value))
        return *real;
    return {};
}

std::string toml_text(const Settings& settings) {
    std::string out;
    for (const auto& [key, value] : settings)
        out += fmt::format("{} = {}\n", is_bare(key) ? key : quoted(key), toml_text(value));
    return out;
}

Settings overlaid(Settings settings, const Settings& over) {
    for (const auto& [key, value] : over)
        settings.insert_or_assign(key, value);
    return settings;
}

} // namespace analysis
