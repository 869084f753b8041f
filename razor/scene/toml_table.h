// One TOML table being read: typed values with ranges, and at the end an error for every key that nobody
// asked for.
#pragma once

#include "razor/scene/ranges.h"

#include <glm/vec3.hpp>
#include <toml++/toml.h>

#include <array>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace razor {

/// Throws UserError naming `file:line:column`, the cause and the mend.
[[noreturn]] void fail_at(std::string_view file_name, const toml::source_region& where,
                          std::string_view message);

class TomlTable {
public:
    /// `name` says in messages which table it is. `table` may be null: every value is then its default.
    TomlTable(const toml::table* table, std::string_view name, std::string_view file_name);

    const std::string& name() const { return name_; }
    bool stated() const { return table_ != nullptr; }
    bool has(std::string_view key) const;
    /// All that are stated, in order of the alphabet.
    std::vector<std::string> keys() const;

    /// The value of `key`, or `preset` where it is not stated. Throws UserError on a wrong type or a value
    /// out of range.
    double number(std::string_view key, double preset, Range range);
    int whole(std::string_view key, int preset, Range range);
    std::pair<int, int> whole_pair(std::string_view key, std::pair<int, int> preset, Range range);
    /// Four whole numbers, where `key` is stated.
    std::optional<std::array<int, 4>> four_whole(std::string_view key, Range range);
    std::string text(std::string_view key, std::string_view preset);
    bool flag(std::string_view key, bool preset);
    /// Two numbers.
    std::pair<double, double> pair(std::string_view key, std::pair<double, double> preset, Range range);
    /// Three numbers.
    glm::dvec3 vector(std::string_view key, const glm::dvec3& preset, Range range);
    /// Three numbers, or one that stands for all three.
    glm::dvec3 vector_or_number(std::string_view key, const glm::dvec3& preset, Range range);
    /// Three whole numbers.
    glm::ivec3 whole_vector(std::string_view key, const glm::ivec3& preset, Range range);
    /// Three rows of four numbers, where `key` is stated.
    std::optional<std::array<std::array<double, 4>, 3>> rows_of_four(std::string_view key, Range range);
    /// The index of the value in `words`.
    std::size_t choice(std::string_view key, std::size_t preset, std::span<const std::string_view> words);
    bool is_table(std::string_view key) const;
    /// A table inside this one.
    TomlTable table(std::string_view key);
    /// An array of tables.
    std::vector<TomlTable> tables(std::string_view key);

    /// Lists `key` among the known ones in messages.
    void may_have(std::string_view key) { asked_.emplace_back(key); }

    /// Throws UserError for the first key that no call above asked for, naming the nearest that one did.
    void finish() const;

    /// Throws UserError at the place of `key`, or of the table where `key` is not stated.
    [[noreturn]] void fail(std::string_view key, std::string_view message) const;

    /// The one of `keys` whose text a message about a file says: "no clip is named 'run'", or "run.glb: ...";
    /// `otherwise` where it says none.
    std::string_view key_in(std::string_view message, std::initializer_list<std::string_view> keys,
                            std::string_view otherwise) const;

private:
    const toml::node* find(std::string_view key);
    const toml::array* three(std::string_view key, std::string_view what);
    int checked_whole(const toml::node& node, std::string_view what, Range range) const;
    double checked(const toml::node& node, std::string_view what, Range range) const;
    std::string full(std::string_view key) const;

    const toml::table* table_;
    std::string name_, file_name_;
    std::vector<std::string> asked_;
};

} // namespace razor
