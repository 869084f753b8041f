// Words for choices, read from scene files.
#pragma once

#include "razor/scene/toml_table.h"
#include "razor/scene/words.h"

#include <algorithm>

namespace razor {

/// What the word at `key` stands for, or `preset` where none is stated.
template <class Value, std::size_t Count>
Value choose(TomlTable& table, std::string_view key, Value preset,
             const std::array<Word<Value>, Count>& choices) {
    std::array<std::string_view, Count> words;
    std::transform(choices.begin(), choices.end(), words.begin(),
                   [](const auto& word) { return word.first; });
    const auto* at =
        std::find_if(choices.begin(), choices.end(), [&](const auto& word) { return word.second == preset; });
    return choices[table.choice(key, static_cast<std::size_t>(at - choices.begin()), words)].second;
}

} // namespace razor
