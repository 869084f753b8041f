// What is wrong with a setting of a study, as every program says it.
#pragma once

#include "analysis/study/settings.h"

#include <string>
#include <string_view>
#include <vector>

namespace razor {

/// What is wrong with a value that must be one of the words (any, if there are none), as "cause; mend", or an
/// empty text.
std::string wrong_word(std::string_view key, const analysis::Value& value,
                       const std::vector<std::string_view>& words);
/// ... a whole number in a range.
std::string wrong_whole(std::string_view key, const analysis::Value& value, double least, double most);
/// ... a number in a range, which becomes a real one.
std::string wrong_number(std::string_view key, analysis::Value& value, double least, double most);

/// "unknown setting X; did you mean Y?", or which there are.
std::string no_setting(std::string_view key, const std::vector<std::string_view>& known);

} // namespace razor
