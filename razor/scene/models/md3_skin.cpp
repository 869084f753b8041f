#include "razor/scene/models/md3_skin.h"

#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace razor {
namespace {

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t\r";
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
    return text.substr(0, text.find_last_not_of(blanks) + 1);
}

} // namespace

std::vector<Md3SkinLine> parse_md3_skin(std::string_view text, std::string_view file_name) {
    std::vector<Md3SkinLine> lines;
    for (std::int64_t number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = trimmed(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (line.empty() || line.starts_with("//"))
            continue;
        const std::size_t comma = line.find(',');
        const std::string_view surface = trimmed(line.substr(0, comma));
        if (comma == std::string_view::npos || surface.empty())
            throw UserError(fmt::format("{}:{}: '{}' is not of the form surface,picture; mend it",
                                        printable(file_name, 1000), number, printable(line)));
        if (const std::string_view picture = trimmed(line.substr(comma + 1)); !picture.empty())
            lines.push_back({std::string(surface), std::string(picture), number});
    }
    return lines;
}

} // namespace razor
