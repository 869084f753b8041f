// A point of a study as it is measured and kept: a text that says all that its result depends on, and the
// name that this text has among files.
#pragma once

#include "analysis/study/study_file.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace analysis {

struct Point {
    Settings settings;
    std::string rival; // whose it is; empty: the program's own
    /// All that the result depends on, with every default filled in, in TOML as the program that measures
    /// writes it: the library looks for nothing in it.
    std::string body;
    std::string name;       // see point_name()
    std::string impossible; // why the point cannot be measured; empty: nothing is known against it
};

/// The text that a body says under a key that is in no table; empty: none.
std::string stated(std::string_view body, std::string_view key);

/// Of a text: 32 hexadecimal digits, a UUID of version 5 (SHA-1, RFC 4122), equal for equal texts on all
/// machines.
std::string point_name(std::string_view body);

/// Text that stands for a point's whole configuration. Throws any std::exception where it has none: the point
/// is then kept as impossible, with what it says.
using Resolve = std::function<std::string(const Point& point)>;

/// All points of a study in its order, rivals' behind its own; of those with equal bodies the first.
std::vector<Point> resolve_points(const Study& study, const Resolve& resolve);

/// nullptr where there is none of that name.
const Rival* find_rival(const Study& study, std::string_view name);

} // namespace analysis
