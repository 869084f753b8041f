// Settings of what is measured: names and values, which only the program that measures understands.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace analysis {

using Value = std::variant<bool, std::int64_t, double, std::string>;

/// As TOML writes it: real numbers by the shortest digits that read back as the same, with a point or an
/// exponent.
std::string toml_text(const Value& value);
/// For people and tables: without the quotes of words, whole numbers without a point.
std::string plain_text(const Value& value);

/// Of whole and real numbers.
std::optional<double> number_of(const Value& value);

/// By name, "section.key" of what stands in tables.
using Settings = std::map<std::string, Value>;

/// A line `key = value` for each, in the order of the keys: equal settings are equal text.
std::string toml_text(const Settings& settings);

/// `over` takes the place of what `settings` says of the same keys.
Settings overlaid(Settings settings, const Settings& over);

} // namespace analysis
