#include "razor/scene/models/mtl_map.h"

#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace razor {
namespace {

std::optional<double> to_number(std::string_view word) {
    double value = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc{} || stop != word.data() + word.size() || !std::isfinite(value))
        return std::nullopt;
    return value;
}

/// Takes the first word off.
std::string_view take_word(std::string_view& text) {
    const std::string_view word = text.substr(0, text.find_first_of(" \t"));
    text.remove_prefix(word.size());
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    return word;
}

/// One to three numbers, of which the first two count; the last word of all is the file's name.
void take_numbers(std::string_view& text, glm::vec2& values) {
    for (int i = 0; i < 3; ++i) {
        std::string_view behind = text;
        const std::optional<double> number = to_number(take_word(behind));
        if (!number || behind.empty())
            return;
        if (i < 2)
            values[i] = static_cast<float>(*number);
        text = behind;
    }
}

double take_number(std::string_view& text, std::string_view option) {
    const std::string_view word = take_word(text);
    const std::optional<double> number = to_number(word);
    if (!number || std::abs(*number) > 1e30)
        throw UserError(fmt::format("{} is '{}', not a number; mend it", option, printable(word)));
    return *number;
}

} // namespace

MtlMap parse_mtl_map(std::string_view text, MtlMapUse use, std::int64_t line) {
    MtlMap map;
    map.line = line;
    while (text.starts_with('-')) {
        const std::string_view option = take_word(text);
        const auto pass_over = [&] { map.passed_over.emplace_back(option); };
        if (option == "-s") {
            take_numbers(text, map.scale);
        } else if (option == "-o") {
            take_numbers(text, map.offset);
        } else if (option == "-clamp") {
            map.clamp = take_word(text) == "on";
        } else if (option == "-mm") {
            map.base = take_number(text, option);
            map.gain = take_number(text, option);
            if ((use == MtlMapUse::colour || use == MtlMapUse::scalar) && (map.base != 0 || map.gain != 1))
                pass_over();
        } else if (option == "-bm") {
            map.bump = take_number(text, option);
            if (use != MtlMapUse::bump)
                pass_over();
        } else if (option == "-t") {
            glm::vec2 turbulence{};
            take_numbers(text, turbulence);
            if (turbulence != glm::vec2(0))
                pass_over();
        } else if (option ==
                   "-imfchan") { // heights are red, bumps luminance, which of grey files is the same
            const std::string_view channel = take_word(text);
            const bool same = channel == "l" || (channel == "r" && use != MtlMapUse::bump);
            if ((use == MtlMapUse::bump || use == MtlMapUse::displacement) && !same)
                pass_over();
        } else { // of one value each; how files are filtered is ours to choose
            take_word(text);
            if (option != "-blendu" && option != "-blendv" && option != "-boost" && option != "-cc" &&
                option != "-texres" && option != "-type")
                pass_over();
        }
    }
    map.file = text;
    return map;
}

} // namespace razor
