// Where a parameter's value comes from, and what its file says of how well it is known.
#pragma once

#include <string>
#include <string_view>

namespace sim {

/// What a comment behind a value says: `known (SOURCE): remark` or `assumed: remark`; the remark may be
/// missing.
struct Mark {
    enum Kind { none, known, assumed } kind = none;
    std::string source; // of what is known
    std::string remark; // of unmarked comments: all of it
};
/// Of a comment without its `#`.
Mark read_mark(std::string_view comment);
/// What stands behind `#` in a line, from this column (counted from 0) on, which lies behind its value.
std::string_view comment_behind(std::string_view line, std::size_t column);

struct Origin {
    enum Layer { preset, file, setting } layer = preset; // the later one wins
    std::string file_name;                               // relative to the folder of the machine's file
    int line = 0;
    std::string comment;     // behind the value
    bool by_another = false; // it came with another parameter that was set, as with a preset

    /// "default", "tiny.toml:4" or "-g".
    std::string place() const;
};

} // namespace sim
