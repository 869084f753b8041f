// How traces name places in a program.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace traces {

/// "folder/file:line": files by their name and folder, wherever the project lies.
inline std::string site_name(std::string_view file, std::uint32_t line) {
    std::size_t slash = file.rfind('/');
    if (slash != std::string_view::npos && slash != 0)
        slash = file.rfind('/', slash - 1);
    return std::string(slash == std::string_view::npos ? file : file.substr(slash + 1)) + ':' +
           std::to_string(line);
}

} // namespace traces
