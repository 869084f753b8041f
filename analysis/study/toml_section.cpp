#include "analysis/study/toml_section.h"

#include "analysis/study/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace analysis {
namespace {

/// Fit for a line.
std::string shown(std::string_view text) {
    std::string out(text.substr(0, 200));
    std::replace_if(
        out.begin(), out.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == '\x7f'; },
        '?');
    return out;
}

} // namespace

void fail_at(std::string_view file, const toml::source_region& where, std::string_view message) {
    throw StudyError(
        fmt::format("{}:{}:{}: {}", shown(file), where.begin.line, where.begin.column, shown(message)));
}

toml::table parse_toml(std::string_view text, std::string_view file) {
    try {
        return toml::parse(text, file);
    } catch (const toml::parse_error& error) {
        const std::string_view told = error.description();
        fail_at(file, error.source(),
                fmt::format("not TOML: {}; mend this line", told.substr(0, told.find('\n'))));
    }
}

void lay_over(toml::table& table, toml::table& over) {
    for (auto&& entry : over) {
        const toml::key& key = entry.first; // named anew: lambdas cannot hold structured bindings in clang
        toml::node& value = entry.second;
        toml::table* const own = table.get_as<toml::table>(key.str());
        if (toml::table* const inner = value.as_table(); inner != nullptr && own != nullptr) {
            lay_over(*own, *inner);
            continue;
        }
        // Erased first: the key takes its new place with it.
        table.erase(key.str());
        value.visit([&](auto&& concrete) { table.insert_or_assign(key, std::move(concrete)); });
    }
}

const toml::node* TomlSection::find(std::string_view key) {
    asked_.emplace_back(key);
    return table_.get(key);
}

std::string TomlSection::full(std::string_view key) const {
    return name_.empty() ? std::string(key) : fmt::format("{}.{}", name_, key);
}

std::optional<std::string> TomlSection::text(std::string_view key) {
    const toml::node* const node = find(key);
    if (node == nullptr)
        return {};
    if (!node->is_string())
        fail(key, fmt::format("{} is no text; write it in quotes", full(key)));
    return node->as_string()->get();
}

std::string TomlSection::needed_text(std::string_view key) {
    const std::optional<std::string> found = text(key);
    if (!found || found->empty())
        fail(key, fmt::format("there is no {}; write {} = \"...\"", full(key), key));
    return *found;
}

int TomlSection::whole(std::string_view key, int preset, int least, int most) {
    const toml::node* const node = find(key);
    if (node == nullptr)
        return preset;
    const auto value = node->is_integer() ? node->value<std::int64_t>() : std::nullopt;
    if (!value || *value < least || *value > most)
        fail(key, fmt::format("{} is {}; write a whole number from {} to {}", full(key),
                              value ? "out of range" : "no whole number", least, most));
    return static_cast<int>(*value);
}

std::vector<std::string> TomlSection::texts(std::string_view key) {
    const toml::node* const node = find(key);
    if (node == nullptr)
        return {};
    const toml::array* const array = node->as_array();
    std::vector<std::string> out;
    if (array != nullptr)
        for (const toml::node& one : *array)
            if (one.is_string())
                out.push_back(one.as_string()->get());
    if (array == nullptr || out.size() != array->size())
        fail(key, fmt::format("{} is no list of texts; write [\"a\", \"b\"]", full(key)));
    return out;
}

const toml::table* TomlSection::table(std::string_view key) {
    const toml::node* const node = find(key);
    if (node != nullptr && !node->is_table())
        fail(key, fmt::format("{} is no table; write [{}] above its keys", full(key), full(key)));
    return node == nullptr ? nullptr : node->as_table();
}

std::vector<const toml::table*> TomlSection::tables(std::string_view key) {
    const toml::node* const node = find(key);
    if (node == nullptr)
        return {};
    std::vector<const toml::table*> out;
    if (const toml::array* const array = node->as_array())
        for (const toml::node& one : *array)
            if (one.is_table())
                out.push_back(one.as_table());
    if (out.empty() || out.size() != node->as_array()->size())
        fail(key, fmt::format("{} is no list of tables; write [[{}]] above the keys of each", full(key),
                              full(key)));
    return out;
}

void TomlSection::finish() const {
    for (const auto& [key, value] : table_)
        if (std::find(asked_.begin(), asked_.end(), key.str()) == asked_.end())
            fail_at(file_, key.source(),
                    fmt::format("unknown key {}; there are {}", full(key.str()), fmt::join(asked_, ", ")));
}

void TomlSection::fail(std::string_view key, std::string_view message) const {
    const toml::node* const node = table_.get(key);
    fail_at(file_, node == nullptr ? table_.source() : node->source(), message);
}

} // namespace analysis
