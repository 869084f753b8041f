// Texts of a trace, made smaller by zstd.
#pragma once

#include <string>
#include <string_view>

namespace traces {

std::string pack(std::string_view text);
/// Throws Error: "`place`: `what` is damaged ...".
std::string unpack(const std::string& bytes, const char* what, const std::string& place);

} // namespace traces
