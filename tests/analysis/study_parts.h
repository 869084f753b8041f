// A study that tests make up, of a program that knows a few settings.
#pragma once

#include "analysis/study/study_file.h"

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace analysis {

/// Settings `scene`, `lod` (texts) and `mesh` (a file), `samples` (whole, 1 to 100), `edge` and `l2.size`
/// (numbers above 0).
inline Vocabulary test_vocabulary() {
    Vocabulary out;
    out.kind = "test";
    out.figures = {"seconds", "error", "off"};
    out.of_references = {"off"};
    out.files = {"mesh"};
    out.wrong = [](std::string_view key, Value& value) -> std::string {
        if (key == "scene" || key == "lod" || key == "mesh")
            return std::holds_alternative<std::string>(value) ? ""
                                                              : fmt::format("{} is no text; quote it", key);
        if (key == "samples") {
            const auto* whole = std::get_if<std::int64_t>(&value);
            return whole != nullptr && *whole >= 1 && *whole <= 100 ? ""
                                                                    : "samples out of range; write 1 to 100";
        }
        if (key == "edge" || key == "l2.size") {
            if (const auto* whole = std::get_if<std::int64_t>(&value))
                value = static_cast<double>(*whole);
            const auto* real = std::get_if<double>(&value);
            return real != nullptr && *real > 0 ? "" : fmt::format("{} is not above 0; write a number", key);
        }
        return fmt::format("unknown setting {}; did you mean samples?", key);
    };
    return out;
}

inline Study test_study(std::string_view text, bool full = false) {
    return parse_study(text, "test.toml", test_vocabulary(), full);
}

} // namespace analysis
