#include "razor/scene/numbered_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

namespace razor {
namespace {

/// Where the number comes: its begin and length, and how many digits at least; length 0: nowhere.
struct Place {
    std::size_t begin = 0, length = 0;
    int digits = 1;
};

Place find_number(std::string_view name) {
    for (std::size_t begin = name.find('%'); begin != std::string_view::npos;
         begin = name.find('%', begin + 1)) {
        std::size_t end = begin + 1;
        int digits = 1;
        if (end + 1 < name.size() && name[end] == '0' && name[end + 1] >= '1' && name[end + 1] <= '9') {
            digits = name[end + 1] - '0';
            end += 2;
        }
        if (end < name.size() && name[end] == 'd') {
            return {begin, end + 1 - begin, digits};
        }
    }
    return {};
}

} // namespace

bool has_number(std::string_view name) {
    return find_number(name).length != 0;
}

std::string numbered(std::string_view name, int number) {
    const Place at = find_number(name);
    if (at.length == 0) {
        return std::string(name);
    }
    return fmt::format("{}{:0{}}{}", name.substr(0, at.begin), number, at.digits,
                       name.substr(at.begin + at.length));
}

std::string without_number(std::string_view name) {
    const Place at = find_number(name);
    std::string rest = std::string(name.substr(0, at.begin)) + std::string(name.substr(at.begin + at.length));
    rest.erase(rest.find_last_not_of("_-.") + 1);
    return rest;
}

std::vector<int> numbers_there(const std::string& name) {
    const std::filesystem::path path(name);
    const std::string leaf = path.filename().string();
    const Place at = find_number(leaf);
    if (at.length == 0) {
        return {};
    }
    std::vector<int> numbers;
    std::error_code error;
    const auto folder = path.parent_path().empty() ? std::filesystem::path(".") : path.parent_path();
    for (auto entry = std::filesystem::directory_iterator(folder, error);
         !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
        const std::string file = entry->path().filename().string();
        int number = -1;
        if (file.size() <= at.begin ||
            std::from_chars(file.data() + at.begin, file.data() + file.size(), number).ec != std::errc() ||
            number < 0 || numbered(leaf, number) != file) {
            continue;
        }
        numbers.push_back(number);
    }
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

} // namespace razor
