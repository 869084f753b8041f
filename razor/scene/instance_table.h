// Plain text tables of instances, one a line: `file` and numbers, separated by blanks. The files are OBJ
// or PLY files, named relative to the table's folder (without blanks in the name). How many numbers follow
// says what they are:
//
//     file x z turn                   on the ground, turned by so many degrees from x towards z
//                                     (clockwise seen from above, y up)
//     file x y z turn
//     file x y z turn scale
//     file m00 m01 m02 m03 m10 ...    twelve: the rows of a 3 x 4 matrix
//
// Empty lines and what follows a # are passed over.
#pragma once

#include "razor/scene/graph/affine.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace razor {

struct InstanceRow {
    int file = 0; // index into InstanceTable::files
    Transform transform;
    std::int64_t line = 0; // of the table, from 1
};

struct InstanceTable {
    std::vector<std::string> files; // absolute paths, each once, in the order of their first rows
    std::vector<InstanceRow> rows;
};

/// Throws UserError: one line `file:line: cause; mend`.
InstanceTable read_instance_table(const std::filesystem::path& path);

/// The same from text; files are looked for in `folder`, `file_name` is used in messages.
InstanceTable parse_instance_table(std::string_view text, std::string_view file_name,
                                   const std::filesystem::path& folder);

} // namespace razor
