#include "sim/config/machine_file.h"

#include "sim/config/error.h"
#include "sim/config/parameters.h"

#include <fmt/core.h>
#include <toml++/toml.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace sim {
namespace {

constexpr int inheritance_limit = 16;

[[noreturn]] void fail(const std::string& file, const toml::source_region& where,
                       const std::string& message) {
    throw ConfigError(fmt::format("{}:{}:{}: {}", file, where.begin.line, where.begin.column, message));
}

std::string read_file(const std::string& file) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored))
        throw ConfigError(
            fmt::format("{}: is a folder; give a machine file, such as configs/machines/tiny.toml", file));
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    if (!in || !(text << in.rdbuf()))
        throw ConfigError(
            fmt::format("{}: cannot be read; give a machine file, such as configs/machines/tiny.toml", file));
    return text.str();
}

std::string first_line(std::string_view text) {
    return std::string(text.substr(0, text.find('\n')));
}

toml::table parse(const std::string& text, const std::string& name) {
    try {
        return toml::parse(std::string_view(text), std::string_view(name));
    } catch (const toml::parse_error& e) {
        fail(name, e.source(), fmt::format("not TOML: {}", first_line(e.description())));
    }
}

/// What is wrong with the value, or an empty string.
std::string set(const Parameter& p, Config& config, const toml::node& value) {
    if (auto i = value.value_exact<std::int64_t>())
        return set_integer(p, config, *i);
    if (auto d = value.value_exact<double>())
        return set_real(p, config, *d);
    if (auto s = value.value_exact<std::string>())
        return set_text(p, config, *s);
    return fmt::format("{} must be a number or a word in quotes", p.key);
}

void apply_section(Config& config, const std::string& name, const toml::table& section,
                   const std::string& file) {
    for (const auto& [key, value] : section) {
        std::string full = fmt::format("{}.{}", name, key.str());
        const Parameter* p = find_parameter(full);
        if (p == nullptr)
            fail(file, key.source(),
                 fmt::format("unknown key {}; the nearest known one is {}", full, nearest_key(full)));
        std::string wrong = set(*p, config, value);
        if (!wrong.empty())
            fail(file, value.source(), wrong);
    }
}

void apply(Config& config, const std::string& text, const std::string& file, int depth) {
    toml::table root = parse(text, file);
    if (const toml::node* parent = root.get("inherit")) {
        auto other = parent->value_exact<std::string>();
        if (!other)
            fail(file, parent->source(), "inherit must be the name of a machine file in quotes");
        if (depth == inheritance_limit)
            fail(file, parent->source(), "files inherit from each other in a circle (or more than 16 deep)");
        std::string path = (std::filesystem::path(file).parent_path() / *other).string();
        apply(config, read_file(path), path, depth + 1);
    }
    for (const auto& [key, value] : root) {
        if (key.str() == "inherit")
            continue;
        if (!value.is_table())
            fail(file, key.source(),
                 fmt::format("unknown key {}; keys stand in sections, the nearest known one is {}", key.str(),
                             nearest_key(key.str())));
        apply_section(config, std::string(key.str()), *value.as_table(), file);
    }
}

void apply_override(Config& config, const std::string& setting) {
    std::string where = fmt::format("-g {}", first_line(setting));
    std::size_t equals = setting.find('=');
    if (equals == std::string::npos || equals == 0)
        throw ConfigError(fmt::format("{}: must be of the form section.key=value", where));
    std::string key = setting.substr(0, equals);
    std::string value = setting.substr(equals + 1);
    const Parameter* p = find_parameter(key);
    if (p == nullptr)
        throw ConfigError(
            fmt::format("{}: unknown key {}; the nearest known one is {}", where, key, nearest_key(key)));
    std::string wrong;
    if (std::holds_alternative<ChoiceKind>(p->kind)) {
        wrong = set_text(*p, config, value);
    } else {
        try {
            toml::table one = toml::parse(std::string_view("value = " + value));
            wrong = set(*p, config, *one.get("value"));
        } catch (const toml::parse_error&) {
            wrong = fmt::format("{} is \"{}\"; it must be a number", key, first_line(value));
        }
    }
    if (!wrong.empty())
        throw ConfigError(fmt::format("{}: {}", where, wrong));
}

} // namespace

Config parse_machine(const std::string& text, const std::string& name,
                     const std::vector<std::string>& overrides) {
    Config config;
    apply(config, text, name, 0);
    for (const std::string& setting : overrides)
        apply_override(config, setting);
    check_consistency(config, name);
    return config;
}

Config read_machine(const std::string& file, const std::vector<std::string>& overrides) {
    return parse_machine(read_file(file), file, overrides);
}

std::string print_machine(const Config& config) {
    std::string out, section;
    for (const Parameter& p : parameters()) {
        std::size_t dot = p.key.find('.');
        if (p.key.substr(0, dot) != section) {
            section = p.key.substr(0, dot);
            out += fmt::format("{}[{}]\n", out.empty() ? "" : "\n", section);
        }
        std::string setting = fmt::format("{} = {}", p.key.substr(dot + 1), print_value(p, config));
        out += fmt::format("{:<44} # {}{}{}\n", setting, p.unit, p.unit.empty() ? "" : ": ", p.meaning);
    }
    return out;
}

} // namespace sim
