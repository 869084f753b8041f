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
/// The same of words that name elements, as comparisons of reports do, or other names where the path has *:
/// "cores.0.stack.idle", "bandwidth.L1.utilisation". A name of the path's own must be among them.
bool is_named_within(const Explanation& e, std::string_view words);
/// Those of which that is true.
std::vector<const Explanation*> find_explanations(std::string_view words);

} // namespace sim
