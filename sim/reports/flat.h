// A report as figures by name: "l2.misses", "phases.traverse.instructions".
#pragma once

#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <string_view>

namespace sim {

/// All numbers below `value`; those in arrays of things that have names ("phase", "part", "structure") by
/// these, of others by their places.
std::map<std::string, double> flat_numbers(const nlohmann::json& value, std::string_view prefix = {});

/// Everything below `value` that is no table or array, as it is written: numbers, words, texts.
std::map<std::string, std::string> flat_words(const nlohmann::json& value, std::string_view prefix = {});

} // namespace sim
