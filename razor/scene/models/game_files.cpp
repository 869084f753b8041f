#include "razor/scene/models/game_files.h"

#include <algorithm>
#include <string>
#include <vector>

namespace razor {
namespace {

namespace fs = std::filesystem;

/// What is called so in a folder; of several in other letters the first. Empty: nothing.
fs::path entry_of(const fs::path& folder, const fs::path& name) {
    std::error_code error;
    if (fs::exists(folder / name, error))
        return folder / name;
    std::string found;
    const fs::directory_iterator end;
    for (fs::directory_iterator entry(folder, error); !error && entry != end; entry.increment(error)) {
        std::string there = entry->path().filename().string();
        if (same_but_for_case(there, name.string()) && (found.empty() || there < found))
            found = std::move(there);
    }
    return found.empty() ? fs::path() : folder / found;
}

std::vector<fs::path> names_of(const fs::path& written) {
    constexpr const char* extensions[] = {".tga", ".jpg", ".jpeg", ".png"};
    std::vector<fs::path> names{written};
    for (const char* extension : extensions)
        names.push_back(fs::path(written).replace_extension(extension));
    for (const char* extension : extensions)
        names.push_back(fs::path(written) += extension);
    return names;
}

fs::path find_in(fs::path folder, const fs::path& wanted) {
    for (const fs::path& part : wanted.parent_path())
        if (folder = entry_of(folder, part); folder.empty())
            return {};
    for (const fs::path& name : names_of(wanted.filename())) {
        std::error_code error;
        if (fs::path file = entry_of(folder, name); fs::is_regular_file(file, error))
            return file;
    }
    return {};
}

} // namespace

bool same_but_for_case(std::string_view a, std::string_view b) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [&](char x, char y) { return lower(x) == lower(y); });
}

std::filesystem::path find_game_picture(const std::filesystem::path& folder, std::string_view name) {
    std::string text(name);
    std::replace(text.begin(), text.end(), '\\', '/');
    const fs::path wanted = fs::path(text).relative_path();
    if (wanted.filename().empty())
        return {};
    const fs::path beside = fs::absolute(folder).lexically_normal();
    for (fs::path base = beside;; base = base.parent_path()) {
        if (fs::path file = find_in(base, wanted); !file.empty())
            return file;
        if (!base.has_relative_path())
            return find_in(beside, wanted.filename());
    }
}

} // namespace razor
