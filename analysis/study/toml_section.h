// A table of a study file as it is read: keys that nobody asked for are mistakes, and messages say where.
#pragma once

#include "analysis/study/settings.h"

#include <toml++/toml.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace analysis {

/// Throws StudyError: "file:line:column: message".
[[noreturn]] void fail_at(std::string_view file, const toml::source_region& where, std::string_view message);

/// The document. Throws StudyError.
toml::table parse_toml(std::string_view text, std::string_view file);

/// Puts what `over` holds in the place of what `table` has under the same keys, tables key by key; places in
/// the file stay known. `over` is left without its values.
void lay_over(toml::table& table, toml::table& over);

class TomlSection {
public:
    /// `name` stands for the table in messages; empty for the document.
    TomlSection(const toml::table& table, std::string name, std::string_view file)
        : table_(table), name_(std::move(name)), file_(file) {}

    std::optional<std::string> text(std::string_view key);
    std::string needed_text(std::string_view key);
    int whole(std::string_view key, int preset, int least, int most);
    std::vector<std::string> texts(std::string_view key);
    /// nullptr where there is none.
    const toml::table* table(std::string_view key);
    std::vector<const toml::table*> tables(std::string_view key);
    const toml::table& all() const { return table_; }
    /// Throws StudyError for the first key that no call above asked for.
    void finish() const;
    [[noreturn]] void fail(std::string_view key, std::string_view message) const;

private:
    const toml::node* find(std::string_view key);
    std::string full(std::string_view key) const;

    const toml::table& table_;
    std::string name_;
    std::string_view file_;
    std::vector<std::string> asked_;
};

} // namespace analysis
