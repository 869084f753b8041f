#include "razor/scene/toml_table.h"

#include "razor/scene/error.h"
#include "razor/scene/nearest.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace razor {
namespace {

std::string_view type_name(const toml::node& node) {
    switch (node.type()) {
    case toml::node_type::table:
        return "a table";
    case toml::node_type::array:
        return "an array";
    case toml::node_type::string:
        return "text";
    case toml::node_type::integer:
        return "a whole number";
    case toml::node_type::floating_point:
        return "a number";
    case toml::node_type::boolean:
        return "true or false";
    default:
        return "a date or time";
    }
}

std::string described(const toml::node& node) {
    const toml::array* const array = node.as_array();
    return array == nullptr ? std::string(type_name(node)) : fmt::format("an array of {}", array->size());
}

} // namespace

void fail_at(std::string_view file_name, const toml::source_region& where, std::string_view message) {
    throw UserError(fmt::format("{}:{}:{}: {}", printable(file_name, 1000), where.begin.line,
                                where.begin.column, message));
}

TomlTable::TomlTable(const toml::table* table, std::string_view name, std::string_view file_name)
    : table_(table), name_(name), file_name_(file_name) {}

bool TomlTable::has(std::string_view key) const {
    return table_ != nullptr && table_->contains(key);
}

std::vector<std::string> TomlTable::keys() const {
    std::vector<std::string> result;
    if (table_ != nullptr) {
        for (const auto& [key, value] : *table_) {
            result.emplace_back(key.str());
        }
    }
    return result;
}

const toml::node* TomlTable::find(std::string_view key) {
    if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) {
        asked_.emplace_back(key);
    }
    return table_ == nullptr ? nullptr : table_->get(key);
}

std::string TomlTable::full(std::string_view key) const {
    return name_.empty() ? std::string(key) : fmt::format("{}.{}", name_, key);
}

double TomlTable::checked(const toml::node& node, std::string_view what, Range range) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value) {
        fail_at(file_name_, node.source(),
                fmt::format("{} is {}; write a number from {} to {}", what, type_name(node), range.least,
                            range.most));
    }
    if (!(*value >= range.least && *value <= range.most)) {
        fail_at(file_name_, node.source(),
                fmt::format("{} = {} is out of range; write a number from {} to {}", what, *value,
                            range.least, range.most));
    }
    return *value;
}

double TomlTable::number(std::string_view key, double preset, Range range) {
    const toml::node* const node = find(key);
    return node == nullptr ? preset : checked(*node, full(key), range);
}

int TomlTable::checked_whole(const toml::node& node, std::string_view what, Range range) const {
    if (!node.is_integer()) {
        fail_at(file_name_, node.source(),
                fmt::format("{} is {}; write a whole number from {} to {}", what, type_name(node),
                            range.least, range.most));
    }
    return static_cast<int>(checked(node, what, range));
}

int TomlTable::whole(std::string_view key, int preset, Range range) {
    const toml::node* const node = find(key);
    return node == nullptr ? preset : checked_whole(*node, full(key), range);
}

std::pair<int, int> TomlTable::whole_pair(std::string_view key, std::pair<int, int> preset, Range range) {
    const toml::node* const node = find(key);
    if (node == nullptr) {
        return preset;
    }
    const toml::array* const array = node->as_array();
    if (array == nullptr || array->size() != 2) {
        fail_at(file_name_, node->source(),
                fmt::format("{} is {}; write two whole numbers [a, b]", full(key), described(*node)));
    }
    return {checked_whole((*array)[0], full(key), range), checked_whole((*array)[1], full(key), range)};
}

std::optional<std::array<int, 4>> TomlTable::four_whole(std::string_view key, Range range) {
    const toml::node* const node = find(key);
    if (node == nullptr) {
        return std::nullopt;
    }
    const toml::array* const array = node->as_array();
    if (array == nullptr || array->size() != 4) {
        fail_at(file_name_, node->source(),
                fmt::format("{} is {}; write four whole numbers [a, b, c, d]", full(key), described(*node)));
    }
    std::array<int, 4> result{};
    for (std::size_t i = 0; i < 4; ++i) {
        result[i] = checked_whole((*array)[i], full(key), range);
    }
    return result;
}

std::string TomlTable::text(std::string_view key, std::string_view preset) {
    const toml::node* const node = find(key);
    if (node == nullptr) {
        return std::string(preset);
    }
    if (!node->is_string()) {
        fail_at(file_name_, node->source(),
                fmt::format("{} is {}; write text in quotes", full(key), type_name(*node)));
    }
    return node->as_string()->get();
}

bool TomlTable::flag(std::string_view key, bool preset) {
    const toml::node* const node = find(key);
    if (node == nullptr) {
        return preset;
    }
    if (!node->is_boolean()) {
        fail_at(file_name_, node->source(),
                fmt::format("{} is {}; write true or false", full(key), type_name(*node)));
    }
    return node->as_boolean()->get();
}

std::pair<double, double> TomlTable::pair(std::string_view key, std::pair<double, double> preset,
                                          Range range) {
    const toml::node* const node = find(key);
    if (node == nullptr) {
        return preset;
    }
    const toml::array* const array = node->as_array();
    if (array == nullptr || array->size() != 2) {
        fail_at(file_name_, node->source(),
                fmt::format("{} is {}; write two numbers [a, b]", full(key), described(*node)));
    }
    return {checked((*array)[0], full(key), range), checked((*array)[1], full(key), range)};
}

/// The array of three of `what` that the key holds; null if the key is missing.
const toml::array* TomlTable::three(std::string_view key, std::string_view what) {
    const toml::node* const node = find(key);
    if (node == nullptr) {
        return nullptr;
    }
    const toml::array* const array = node->as_array();
    if (array == nullptr || array->size() != 3) {
        fail_at(file_name_, node->source(),
                fmt::format("{} is {}; write three {} [a, b, c]", full(key), described(*node), what));
    }
    return array;
}

glm::dvec3 TomlTable::vector(std::string_view key, const glm::dvec3& preset, Range range) {
    const toml::array* const array = three(key, "numbers");
    if (array == nullptr) {
        return preset;
    }
    glm::dvec3 result;
    for (int i = 0; i < 3; ++i) {
        result[i] = checked((*array)[static_cast<std::size_t>(i)], full(key), range);
    }
    return result;
}

glm::ivec3 TomlTable::whole_vector(std::string_view key, const glm::ivec3& preset, Range range) {
    const toml::array* const array = three(key, "whole numbers");
    if (array == nullptr) {
        return preset;
    }
    glm::ivec3 result;
    for (int i = 0; i < 3; ++i) {
        result[i] = checked_whole((*array)[static_cast<std::size_t>(i)], full(key), range);
    }
    return result;
}

std::optional<std::array<std::array<double, 4>, 3>> TomlTable::rows_of_four(std::string_view key,
                                                                            Range range) {
    const toml::node* const node = find(key);
    if (node == nullptr) {
        return std::nullopt;
    }
    constexpr std::string_view mend = "write three rows of four numbers [[a, b, c, d], [...], [...]]";
    const toml::array* const rows = node->as_array();
    if (rows == nullptr || rows->size() != 3) {
        fail_at(file_name_, node->source(), fmt::format("{} is {}; {}", full(key), described(*node), mend));
    }
    std::array<std::array<double, 4>, 3> result{};
    for (std::size_t i = 0; i < 3; ++i) {
        const toml::array* const row = (*rows)[i].as_array();
        if (row == nullptr || row->size() != 4) {
            fail_at(file_name_, (*rows)[i].source(),
                    fmt::format("a row of {} is {}; {}", full(key), described((*rows)[i]), mend));
        }
        for (std::size_t j = 0; j < 4; ++j) {
            result[i][j] = checked((*row)[j], full(key), range);
        }
    }
    return result;
}

glm::dvec3 TomlTable::vector_or_number(std::string_view key, const glm::dvec3& preset, Range range) {
    const toml::node* const node = find(key);
    if (node != nullptr && node->is_number()) {
        return glm::dvec3(number(key, 0, range));
    }
    const toml::array* const array = node == nullptr ? nullptr : node->as_array();
    if (node != nullptr && (array == nullptr || array->size() != 3)) {
        fail_at(file_name_, node->source(),
                fmt::format("{} is {}; write a number from {} to {}, or three of them [a, b, c]", full(key),
                            described(*node), range.least, range.most));
    }
    return vector(key, preset, range);
}

std::size_t TomlTable::choice(std::string_view key, std::size_t preset,
                              std::span<const std::string_view> words) {
    const toml::node* const node = find(key);
    if (node == nullptr) {
        return preset;
    }
    if (!node->is_string()) {
        fail_at(
            file_name_, node->source(),
            fmt::format("{} is {}; write one of: {}", full(key), type_name(*node), fmt::join(words, ", ")));
    }
    const std::string& word = node->as_string()->get();
    const auto found = std::find(words.begin(), words.end(), word);
    if (found == words.end()) {
        fail_at(file_name_, node->source(),
                fmt::format("{} '{}' is unknown; {}", full(key), printable(word), or_known(word, words)));
    }
    return static_cast<std::size_t>(found - words.begin());
}

bool TomlTable::is_table(std::string_view key) const {
    return has(key) && table_->get(key)->is_table();
}

TomlTable TomlTable::table(std::string_view key) {
    const toml::node* const node = find(key);
    if (node != nullptr && !node->is_table()) {
        fail_at(file_name_, node->source(),
                fmt::format("{} is {}; write a table [{}]", full(key), type_name(*node), full(key)));
    }
    return {node == nullptr ? nullptr : node->as_table(), full(key), file_name_};
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) {
    std::vector<TomlTable> result;
    const toml::node* const node = find(key);
    if (node == nullptr) {
        return result;
    }
    const toml::array* const array = node->as_array();
    if (array == nullptr) {
        fail_at(file_name_, node->source(),
                fmt::format("{} is {}; write [[{}]]", full(key), type_name(*node), full(key)));
    }
    for (const toml::node& entry : *array) {
        if (!entry.is_table()) {
            fail_at(file_name_, entry.source(),
                    fmt::format("{} holds {}; write [[{}]]", full(key), type_name(entry), full(key)));
        }
        result.emplace_back(entry.as_table(), full(key), file_name_);
    }
    return result;
}

void TomlTable::finish() const {
    if (table_ == nullptr) {
        return;
    }
    std::vector<std::string_view> known; // each once, as asked for
    for (const std::string& key : asked_) {
        if (std::find(known.begin(), known.end(), key) == known.end()) {
            known.emplace_back(key);
        }
    }
    const toml::key* first = nullptr; // in the order of the file, not of the alphabet
    for (auto&& [key, value] : *table_) {
        if (std::find(known.begin(), known.end(), key.str()) == known.end() &&
            (first == nullptr || key.source().begin < first->source().begin)) {
            first = &key;
        }
    }
    if (first != nullptr) {
        fail_at(file_name_, first->source(),
                fmt::format("unknown key '{}'; {}", printable(full(first->str()), 80),
                            or_known(first->str(), known)));
    }
}

std::string_view TomlTable::key_in(std::string_view message, std::initializer_list<std::string_view> keys,
                                   std::string_view otherwise) const {
    for (const std::string_view key : keys) {
        if (!has(key)) {
            continue;
        }
        const std::string text = printable(table_->get(key)->value_or(std::string()));
        if (!text.empty() && (message.find(fmt::format("named '{}'", text)) != std::string_view::npos ||
                              message.find(text + ":") != std::string_view::npos)) {
            return key;
        }
    }
    return otherwise;
}

void TomlTable::fail(std::string_view key, std::string_view message) const {
    if (has(key)) {
        fail_at(file_name_, table_->get(key)->source(), message);
    }
    if (table_ != nullptr) {
        fail_at(file_name_, table_->source(), message);
    }
    throw UserError(fmt::format("{}: {}", printable(file_name_, 1000), message));
}

} // namespace razor
