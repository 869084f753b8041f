// Values as TOML writes them.
#pragma once

#include <fmt/format.h>
#include <glm/vec3.hpp>

#include <string>
#include <string_view>

namespace razor {

std::string toml_text(std::string_view text);

/// TOML wants a point or an exponent in a real number; the shortest digits that read back as the same value.
template <typename Real> std::string toml_number(Real value) {
    std::string text = fmt::format("{}", value + Real{0}); // + 0: no negative zero
    if (text.find_first_of(".e") == std::string::npos) {
        text += ".0";
    }
    return text;
}

inline std::string toml_value(double value) {
    return toml_number(value);
}
inline std::string toml_value(float value) {
    return toml_number(value);
}
template <typename Real, glm::qualifier q> std::string toml_value(const glm::vec<3, Real, q>& v) {
    return fmt::format("[{}, {}, {}]", toml_number(v.x), toml_number(v.y), toml_number(v.z));
}

} // namespace razor
