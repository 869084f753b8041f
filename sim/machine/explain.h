// One line of meaning for every figure of a JSON report (print_json): its documentation, and what
// `razor-sim explain` prints.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sim {

struct Explanation {
    std::string path; // names from the outermost object in, with dots; [] after an array, * for any name
    std::string unit; // empty: a count, a word or a share
    std::string meaning;
};

/// In the order of the report. Every number and text of every report has exactly one.
const std::vector<Explanation>& explanations();

/// Whether `path` (of a figure, arrays as []) is one that the pattern stands for.
bool explains(const Explanation& e, std::string_view path);

/// Whether `words` are in its path; they may leave out names on the left ("l1.hits", "hits") or on the right
/// ("stack").
bool is_named(const Explanation& e, std::string_view words);
/// Those of which that is true.
std::vector<const Explanation*> find_explanations(std::string_view words);

} // namespace sim
