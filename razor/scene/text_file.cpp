#include "razor/scene/text_file.h"

#include "razor/scene/error.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <memory>
#include <mutex>
#include <new>
#include <set>
#include <system_error>

namespace razor {
namespace {

/// Of this process, by canonical names.
struct Inputs {
    std::mutex mutex;
    std::set<std::filesystem::path> paths;
};
Inputs& inputs() {
    static Inputs all;
    return all;
}

} // namespace

void note_input(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::path name = std::filesystem::canonical(path, error);
    const std::lock_guard lock(inputs().mutex);
    if (!error)
        inputs().paths.insert(name);
}

bool is_input(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::path name = std::filesystem::canonical(path, error);
    const std::lock_guard lock(inputs().mutex);
    return !error && inputs().paths.contains(name);
}

std::string read_text_file(const std::filesystem::path& path, std::string_view kind) {
    const std::string name = printable(path.string(), 1000);
    if (path.empty()) {
        throw UserError(fmt::format("the file name is empty; give {}", kind));
    }
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found) {
        throw UserError(fmt::format("{}: no such file; check the path", name));
    }
    if (status.type() == std::filesystem::file_type::directory) {
        throw UserError(fmt::format("{}: is a directory; give {}", name, kind));
    }
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file) {
        const std::string cause = std::generic_category().message(errno);
        throw UserError(fmt::format("{}: cannot be opened ({}); check its permissions", name, cause));
    }
    std::string text;
    try {
        const auto size = std::filesystem::file_size(path, error);
        if (!error && size <= max_text_file_bytes) {
            text.reserve(static_cast<std::size_t>(size) + 1);
        }
        std::string block(std::size_t{1} << 20, '\0');
        while (const std::size_t count = std::fread(block.data(), 1, block.size(), file.get())) {
            text.append(block, 0, count);
            if (text.size() > max_text_file_bytes) {
                throw UserError(
                    fmt::format("{}: larger than {} GiB; give {}", name, max_text_file_bytes >> 30, kind));
            }
        }
    } catch (const std::bad_alloc&) {
        throw UserError(fmt::format("{}: does not fit in memory; give a smaller file", name));
    }
    if (std::ferror(file.get()) != 0) {
        const std::string cause = std::generic_category().message(errno);
        throw UserError(fmt::format("{}: cannot be read ({}); check the file", name, cause));
    }
    if (text.empty()) {
        throw UserError(fmt::format("{}: is empty; give {}", name, kind));
    }
    note_input(path);
    return text;
}

std::string printable(std::string_view text, std::size_t max_length) {
    std::string result;
    for (const char c : text) {
        if (result.size() >= max_length) {
            return result + "...";
        }
        if (c >= ' ' && c <= '~') {
            result += c;
        } else {
            result += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
        }
    }
    return result;
}

} // namespace razor
