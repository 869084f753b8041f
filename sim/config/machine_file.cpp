#include "sim/config/machine_file.h"

#include "sim/config/error.h"
#include "sim/config/parameters.h"

#include <fmt/core.h>
#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace sim {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t largest_file = std::size_t{1} << 20; // bytes
constexpr int most_files = 64;                             // read for one machine
constexpr const char* give_one = "give a machine file, such as configs/machines/tiny.toml";

[[noreturn]] void fail(const std::string& file, const toml::source_region& where,
                       const std::string& message) {
    throw ConfigError(fmt::format("{}:{}:{}: {}", file, where.begin.line, where.begin.column, message));
}

struct Text {
    std::string text, wrong; // why there is none
};

Text read_file(const std::string& file) {
    std::error_code ignored;
    if (fs::is_directory(file, ignored))
        return {"", fmt::format("is a folder; {}", give_one)};
    std::ifstream in(file, std::ios::binary);
    std::string text(largest_file + 1, '\0');
    if (!in || (!in.read(text.data(), static_cast<std::streamsize>(text.size())) && !in.eof()))
        return {"", fmt::format("cannot be read; {}", give_one)};
    text.resize(static_cast<std::size_t>(in.gcount()));
    if (text.size() > largest_file)
        return {"",
                fmt::format("is larger than {} bytes, as no machine file is; {}", largest_file, give_one)};
    if (text.find_first_not_of(" \t\r\n") == std::string::npos)
        return {"", fmt::format("is empty; {}", give_one)};
    return {std::move(text), ""};
}

std::string first_line(std::string_view text) {
    return std::string(text.substr(0, text.find('\n')));
}

std::string_view line_of(std::string_view text, std::size_t line) {
    for (; line > 1 && !text.empty(); --line) {
        const std::size_t end = text.find('\n');
        text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    }
    return text.substr(0, text.find('\n'));
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
    return fmt::format("{} must be {}", p.key,
                       std::holds_alternative<ChoiceKind>(p.kind) || std::holds_alternative<TextKind>(p.kind)
                           ? "a word in quotes"
                           : "a number");
}

/// What is wrong with a key that stands where sections stand.
std::string no_section(std::string_view key) {
    for (const Parameter& p : parameters())
        if (p.key.substr(0, p.key.find('.')) == key)
            return fmt::format("{0} is a section; write [{0}] above its keys", key);
    return fmt::format("unknown key {}; keys stand in sections, the nearest known one is {}", key,
                       nearest_key(key));
}

/// Reads files over each other.
class Reader {
public:
    explicit Reader(const std::string& file) : folder_(fs::path(file).parent_path()) {
        machine_.name = fs::path(file).filename().string();
        machine_.origins.resize(parameters().size());
    }

    void apply(const std::string& text, const std::string& file) {
        const toml::table root = parse(text, file);
        chain_.push_back(file);
        if (const toml::node* parent = root.get("inherit"))
            inherit(file, *parent);
        if (const toml::node* counts = root.get("calibration"))
            name_calibration(file, *counts);
        for (bool first : {true, false}) // first what sets others, in whatever section
            for (const auto& [key, value] : root) {
                if (key.str() == "inherit" || key.str() == "calibration")
                    continue;
                if (!value.is_table())
                    fail(file, key.source(), no_section(key.str()));
                apply_section(std::string(key.str()), *value.as_table(), text, file, first);
            }
        chain_.pop_back();
    }

    /// Where its key sets others, or sets itself alone, as `first` says.
    void override(const std::string& setting, bool first);

    MachineDescription finish() &&;

private:
    void inherit(const std::string& file, const toml::node& parent);
    void name_calibration(const std::string& file, const toml::node& counts);
    void inherit_one(const std::string& file, const toml::node& parent);
    void apply_section(const std::string& name, const toml::table& section, const std::string& text,
                       const std::string& file, bool first);
    void set_origin(const Parameter& p, const Origin& origin);
    Origin& origin(const Parameter& p) {
        return machine_.origins[static_cast<std::size_t>(&p - parameters().data())];
    }

    MachineDescription machine_;
    fs::path folder_;
    std::vector<std::string> chain_; // the file being read, behind those that inherit it
    int files_ = 0;
};

void Reader::inherit(const std::string& file, const toml::node& parent) {
    const toml::array* several = parent.as_array();
    if (several == nullptr)
        return inherit_one(file, parent);
    for (const toml::node& one : *several)
        inherit_one(file, one);
}

void Reader::inherit_one(const std::string& file, const toml::node& parent) {
    const auto name = parent.value_exact<std::string>();
    if (!name || name->empty())
        fail(file, parent.source(),
             "inherit must be the name of a machine file in quotes, or a list of such");
    const std::string path = (fs::path(file).parent_path() / *name).string();
    std::error_code ignored;
    for (std::size_t i = 0; i < chain_.size(); ++i)
        if (fs::equivalent(chain_[i], path, ignored)) {
            std::string circle;
            for (; i < chain_.size(); ++i)
                circle += fs::path(chain_[i]).filename().string() + " -> ";
            fail(file, parent.source(),
                 fmt::format("files inherit from each other in a circle, {}{}; take one `inherit` out",
                             circle, fs::path(path).filename().string()));
        }
    if (++files_ > most_files)
        fail(file, parent.source(),
             fmt::format("more than {} files are inherited; put some together", most_files));
    const Text other = read_file(path);
    if (!other.wrong.empty())
        fail(file, parent.source(), fmt::format("inherits {}, which {}", path, other.wrong));
    machine_.files.push_back(path);
    apply(other.text, path);
}

void Reader::name_calibration(const std::string& file, const toml::node& counts) {
    const auto name = counts.value_exact<std::string>();
    if (!name || name->empty())
        fail(file, counts.source(),
             "calibration must be the name of a file in quotes, written by analysis/calibration/calibrate.py "
             "-o");
    machine_.calibration = (fs::path(file).parent_path() / *name).string();
    machine_.files.push_back(machine_.calibration);
}

/// Either what sets others, or the rest.
void Reader::apply_section(const std::string& name, const toml::table& section, const std::string& text,
                           const std::string& file, bool first) {
    for (const auto& [key, value] : section) {
        std::string full = fmt::format("{}.{}", name, key.str());
        const Parameter* p = find_parameter(full);
        if (p == nullptr)
            fail(file, key.source(),
                 fmt::format("unknown key {}; the nearest known one is {}", full, nearest_key(full)));
        if (sets_others(*p) != first)
            continue;
        std::string wrong = set(*p, machine_.config, value);
        if (!wrong.empty())
            fail(file, value.source(), wrong);
        const toml::source_position end = value.source().end;
        set_origin(*p, {Origin::file, fs::path(file).lexically_relative(folder_).string(),
                        static_cast<int>(key.source().begin.line),
                        std::string(comment_behind(line_of(text, end.line), end.column - 1))});
    }
}

/// Of the parameter, and of others that it sets.
void Reader::set_origin(const Parameter& p, const Origin& origin) {
    if (sets_others(p))
        for (const Parameter& other : parameters())
            if (std::get<ChoiceKind>(p.kind).sets_key(machine_.config, other.key)) {
                this->origin(other) = origin;
                this->origin(other).by_another = true;
            }
    this->origin(p) = origin;
}

void Reader::override(const std::string& setting, bool first) {
    const std::string where = fmt::format("-g {}", setting);
    const std::size_t equals = setting.find('=');
    const auto trim = [](std::string text) {
        text.erase(0, std::min(text.find_first_not_of(' '), text.size()));
        return text.erase(text.find_last_not_of(' ') + 1);
    };
    const std::string key = trim(setting.substr(0, equals));
    if (equals == std::string::npos || key.empty())
        throw ConfigError(fmt::format("{}: must be of the form section.key=value", where));
    std::string value = trim(setting.substr(equals + 1));
    const Parameter* p = find_parameter(key);
    if (p == nullptr)
        throw ConfigError(
            fmt::format("{}: unknown key {}; the nearest known one is {}", where, key, nearest_key(key)));
    if (sets_others(*p) != first)
        return;
    std::string wrong;
    if (std::holds_alternative<ChoiceKind>(p->kind) || std::holds_alternative<TextKind>(p->kind)) {
        if (value.size() >= 2 && value.front() == '"' && value.back() == '"')
            value = value.substr(1, value.size() - 2);
        wrong = set_text(*p, machine_.config, value);
    } else {
        try {
            const toml::table one = toml::parse(std::string_view("value = " + value));
            wrong = one.size() == 1 ? set(*p, machine_.config, *one.get("value"))
                                    : fmt::format("{} must be one number", key);
        } catch (const toml::parse_error&) {
            wrong = set_text(*p, machine_.config, value);
        }
    }
    if (!wrong.empty())
        throw ConfigError(fmt::format("{}: {}", where, wrong));
    set_origin(*p, {Origin::setting, "", 0, ""});
}

MachineDescription Reader::finish() && {
    try {
        check_consistency(machine_.config, machine_.name);
    } catch (const ConfigError& e) {
        // Say where each parameter of the message stands.
        const std::string message = e.what();
        std::string places;
        for (const Parameter& p : parameters())
            for (std::size_t at = message.find(p.key); at != std::string::npos;
                 at = message.find(p.key, at + 1)) {
                const std::size_t end = at + p.key.size();
                const auto in_a_word = [](char c) { return std::isalnum(c) != 0 || c == '_' || c == '.'; };
                if ((at > 0 && in_a_word(message[at - 1])) ||
                    (end < message.size() && in_a_word(message[end])))
                    continue;
                places += fmt::format("{}{} from {}", places.empty() ? "" : ", ", p.key, origin(p).place());
                break;
            }
        throw ConfigError(places.empty() ? message : fmt::format("{} ({})", message, places));
    }
    return std::move(machine_);
}

} // namespace

MachineDescription describe_machine_text(const std::string& text, const std::string& name,
                                         const std::vector<std::string>& overrides) {
    Reader reader(name);
    reader.apply(text, name);
    for (bool first : {true, false}) // first what sets others
        for (const std::string& setting : overrides)
            reader.override(setting, first);
    return std::move(reader).finish();
}

MachineDescription describe_machine(const std::string& file, const std::vector<std::string>& overrides) {
    const Text text = read_file(file);
    if (!text.wrong.empty())
        throw ConfigError(fmt::format("{}: {}", file.empty() ? "\"\"" : file, text.wrong));
    MachineDescription out = describe_machine_text(text.text, file, overrides);
    out.files.push_back(file);
    return out;
}

Config parse_machine(const std::string& text, const std::string& name,
                     const std::vector<std::string>& overrides) {
    return describe_machine_text(text, name, overrides).config;
}

Config read_machine(const std::string& file, const std::vector<std::string>& overrides) {
    return describe_machine(file, overrides).config;
}

} // namespace sim
