#include "sim/config/parameters.h"

#include "sim/config/parameter_table.h"
#include "sim/memory/page_tables.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

namespace sim {

const std::array<const char*, class_count> class_names = {
    "integer",        "integer_multiply", "add",    "multiply", "fused",     "divide",  "square_root",
    "compare",        "convert",          "select", "mask",     "broadcast", "shuffle", "reduce",
    "mask_to_scalar", "address",          "branch"};

namespace {

constexpr integer kibi = 1024;

const std::vector<Parameter>& table() {
    static const std::vector<Parameter> rows = make_parameter_table();
    return rows;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j)
        row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row[b.size()];
}

/// How unlike two keys are; a shortened key is nearly as good as a misspelt one.
std::size_t unlikeness(std::string_view known, std::string_view key) {
    return std::min(edit_distance(known, key), 1 + edit_distance(known.substr(0, key.size() + 1), key));
}

/// The words of a choice, and its numbers if it has any, for messages.
std::string choices_of(const ChoiceKind& c) {
    std::string words = fmt::format("\"{}\"", fmt::join(c.choices, "\", \""));
    return c.most_number == 0 ? words : fmt::format("{}, or a number from 1 to {}", words, c.most_number);
}

/// Whether a choice stands at a number.
bool is_number(const std::string& text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

constexpr integer too_large = integer{1} << 62; // for any parameter

/// "2 MiB" as bytes, too_large for more than can be counted, or 0 where the text is not of that form.
integer binary_size(const std::string& text) {
    integer number = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    std::string_view unit(stop, end);
    unit.remove_prefix(std::min(unit.find_first_not_of(' '), unit.size()));
    const integer factor = unit == "KiB"   ? kibi
                           : unit == "MiB" ? kibi * kibi
                           : unit == "GiB" ? kibi * kibi * kibi
                                           : 0;
    if (error == std::errc::result_out_of_range || (factor > 0 && number > too_large / factor))
        return too_large;
    return error == std::errc{} && number > 0 && factor > 0 ? number * factor : 0;
}

std::string with_unit(const Parameter& p) {
    return p.unit.empty() ? "" : " " + p.unit;
}

} // namespace

Config::Config() {
    for (const Parameter& p : table()) {
        if (const auto* k = std::get_if<IntegerKind>(&p.kind))
            k->at(*this) = k->preset;
        else if (const auto* r = std::get_if<RealKind>(&p.kind))
            r->at(*this) = r->preset;
        else if (const auto* c = std::get_if<ChoiceKind>(&p.kind))
            c->at(*this) = c->choices.front();
        else if (const auto* t = std::get_if<TextKind>(&p.kind))
            t->at(*this) = t->preset;
    }
}

unsigned Config::cache_levels() const {
    unsigned level = 1;
    while (level < most_levels && cache(level).size_bytes != 0)
        ++level;
    return level;
}

integer Config::cores_sharing(unsigned level) const {
    const std::string& share = cache(level).share;
    return level == 0 || share == "core" ? 1
           : share == "tile"             ? chip.cores
           : share == "chip"             ? all_cores()
                                         : std::stoll(share);
}

integer Config::cores_sharing_tlb() const {
    return tlb.second_share == "core"   ? 1
           : tlb.second_share == "tile" ? chip.cores
                                        : std::stoll(tlb.second_share);
}

integer TlbConfig::table_levels() const {
    const auto page_bits = static_cast<integer>(std::countr_zero(static_cast<std::uint64_t>(page_bytes)));
    return (address_bits - page_bits + PageTables::bits - 1) / PageTables::bits;
}

bool Config::beyond_tiles(unsigned level) const {
    return level != 0 && (cache(level).share == "chip" || cores_sharing(level) > chip.cores);
}

std::span<const Parameter> parameters() {
    return table();
}

const Parameter* find_parameter(std::string_view key) {
    for (const Parameter& p : table())
        if (p.key == key)
            return &p;
    return nullptr;
}

const std::string& nearest_key(std::string_view key) {
    auto by_distance = [&](const Parameter& a, const Parameter& b) {
        return unlikeness(a.key, key) < unlikeness(b.key, key);
    };
    return std::min_element(table().begin(), table().end(), by_distance)->key;
}

bool alike(const Config& a, const Config& b) {
    return std::all_of(table().begin(), table().end(), [&](const Parameter& p) {
        const bool counts = applies(p, a);
        return counts == applies(p, b) && (!counts || print_value(p, a) == print_value(p, b));
    });
}

bool applies(const Parameter& p, const Config& config) {
    if (p.key == "network.buses")
        return config.network.bus();
    if (p.key.starts_with("network."))
        return p.key == "network.topology" || !config.network.ideal();
    if (p.key == "coherence.directory_ways" && config.coherence.directory_entries == 0)
        return false;
    if (p.key.starts_with("coherence.directory_"))
        return config.coherence.kept() && !config.coherence.snoops();
    if (p.key == "energy.directory_pj")
        return config.coherence.kept() && !config.coherence.snoops();
    if (p.key == "coherence.snoop_cycles" || p.key == "energy.snoop_pj")
        return config.coherence.snoops();
    if (p.key.starts_with("tlb."))
        return p.key == "tlb.entries" || config.tlb.any();
    if (p.key.size() < 3 || p.key[0] != 'l' || p.key[2] != '.')
        return true;
    const auto level = static_cast<unsigned>(p.key[1] - '1');
    const unsigned levels = config.cache_levels();
    return level < levels || (level == levels && p.key.ends_with(".size_bytes"));
}

std::string print_value(const Parameter& p, const Config& config) {
    auto& c = const_cast<Config&>(config); // accessors serve reading and writing; nothing is written here
    if (const auto* k = std::get_if<IntegerKind>(&p.kind))
        return fmt::format("{}", k->at(c));
    if (const auto* r = std::get_if<RealKind>(&p.kind))
        return fmt::format("{:#}", r->at(c));
    if (const auto* t = std::get_if<TextKind>(&p.kind))
        return fmt::format("\"{}\"", t->at(c));
    const std::string& word = std::get<ChoiceKind>(p.kind).at(c);
    return is_number(word) ? word : fmt::format("\"{}\"", word);
}

std::string print_bounds(const Parameter& p) {
    if (const auto* k = std::get_if<IntegerKind>(&p.kind))
        return fmt::format("{} to {}{}{}", k->least, k->most, with_unit(p),
                           k->power_of_two ? ", a power of two" : "");
    if (const auto* r = std::get_if<RealKind>(&p.kind))
        return fmt::format("{} to {}{}", r->least, r->most, with_unit(p));
    if (std::holds_alternative<TextKind>(p.kind))
        return "a text";
    return choices_of(std::get<ChoiceKind>(p.kind));
}

std::string set_integer(const Parameter& p, Config& config, integer value) {
    if (std::holds_alternative<RealKind>(p.kind))
        return set_real(p, config, static_cast<double>(value));
    if (std::holds_alternative<TextKind>(p.kind))
        return fmt::format("{} is a text, not a number", p.key);
    if (const auto* c = std::get_if<ChoiceKind>(&p.kind)) {
        if (c->most_number == 0)
            return fmt::format("{} is one of {}, not a number", p.key, choices_of(*c));
        return set_text(p, config, fmt::format("{}", value));
    }
    const auto* k = std::get_if<IntegerKind>(&p.kind);
    if (value < k->least || value > k->most)
        return fmt::format("{} is {}; it must be from {} to {}{}", p.key, value, k->least, k->most,
                           with_unit(p));
    if (k->power_of_two && (value & (value - 1)) != 0)
        return fmt::format("{} is {}; it must be a power of two", p.key, value);
    k->at(config) = value;
    return "";
}

std::string set_real(const Parameter& p, Config& config, double value) {
    const auto* r = std::get_if<RealKind>(&p.kind);
    if (std::holds_alternative<IntegerKind>(p.kind) && value == std::floor(value) && std::abs(value) < 1e15)
        return set_integer(p, config, static_cast<integer>(value)); // 1e6
    if (r == nullptr)
        return fmt::format("{} is {}; it must be a {}", p.key, value,
                           std::holds_alternative<IntegerKind>(p.kind) ? "whole number" : "word");
    if (!(value >= r->least && value <= r->most))
        return fmt::format("{} is {}; it must be from {} to {}{}", p.key, value, r->least, r->most,
                           with_unit(p));
    r->at(config) = value;
    return "";
}

std::string set_text(const Parameter& p, Config& config, const std::string& value) {
    if (const auto* t = std::get_if<TextKind>(&p.kind)) {
        if (value.find_first_of("\"\\\n") != std::string::npos)
            return fmt::format("{} must be one line without quotes and backslashes", p.key);
        t->at(config) = value;
        return "";
    }
    const auto* c = std::get_if<ChoiceKind>(&p.kind);
    if (c == nullptr) {
        if (p.unit != "bytes")
            return fmt::format("{} is \"{}\"; it must be a number", p.key, value);
        const integer size = binary_size(value);
        if (size == too_large)
            return fmt::format("{} is \"{}\"; it must be from {}", p.key, value, print_bounds(p));
        return size > 0
                   ? set_integer(p, config, size)
                   : fmt::format("{} is \"{}\"; it must be a number, or one of KiB, MiB or GiB, as in \"64 "
                                 "KiB\"",
                                 p.key, value);
    }
    integer number = 0;
    const auto [stop, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    const bool right = error == std::errc{} && stop == value.data() + value.size() && number >= 1 &&
                       number <= c->most_number;
    if (!right && std::find(c->choices.begin(), c->choices.end(), value) == c->choices.end())
        return fmt::format("{} is \"{}\"; it must be one of {}", p.key, value, choices_of(*c));
    c->at(config) = right ? fmt::format("{}", number) : value;
    if (c->sets)
        c->sets(config, value);
    return "";
}

} // namespace sim
