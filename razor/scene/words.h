// The words for choices in scene files and on the command line.
#pragma once

#include "razor/scene/scene.h"

#include <array>
#include <span>
#include <string_view>
#include <utility>

namespace razor {

template <typename Value> using Word = std::pair<std::string_view, Value>;

inline constexpr std::array<Word<Scheme>, 2> scheme_words{{
    {"catmark", Scheme::catmull_clark},
    {"bilinear", Scheme::bilinear},
}};

inline constexpr std::array<Word<Lod>, 3> lod_words{{
    {"recursive", Lod::recursive},
    {"discrete", Lod::discrete},
    {"fixed", Lod::fixed},
}};

/// The word for `value`, which must be in the table.
template <typename Value, std::size_t Count>
constexpr std::string_view word_of(const std::array<Word<Value>, Count>& words, Value value) {
    for (const auto& [word, meaning] : words) {
        if (meaning == value) {
            return word;
        }
    }
    return {};
}

} // namespace razor
