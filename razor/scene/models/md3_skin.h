// Skins of Quake III models: lines `surface,path of a picture`. Of tags, which they list too, the path is
// empty.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace razor {

struct Md3SkinLine {
    std::string surface, picture; // without blanks around; the picture is not empty
    std::int64_t line = 0;        // counted from 1
};

/// Lines without a path, empty ones and comments (`//`) are passed over. Throws UserError "file:line: cause;
/// mend".
std::vector<Md3SkinLine> parse_md3_skin(std::string_view text, std::string_view file_name);

} // namespace razor
