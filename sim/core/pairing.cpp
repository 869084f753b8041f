#include "sim/core/pairing.h"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>

namespace sim {
namespace {

using Kinds = std::array<bool, issue_kinds>;

/// Cuts `text` at `separator`; spaces around the parts go, and with them empty parts where spaces separate.
std::vector<std::string_view> parts(std::string_view text, char separator) {
    std::vector<std::string_view> out;
    for (;;) {
        std::size_t end = std::min(text.find(separator), text.size());
        std::string_view part = text.substr(0, end);
        while (!part.empty() && part.front() == ' ')
            part.remove_prefix(1);
        while (!part.empty() && part.back() == ' ')
            part.remove_suffix(1);
        if (separator != ' ' || !part.empty())
            out.push_back(part);
        if (end == text.size())
            return out;
        text.remove_prefix(end + 1);
    }
}

bool is_memory(std::size_t kind) {
    return kind % form_kinds >= load_kind;
}

constexpr std::size_t vector_branch = vector_kind(branch_class); // there is none

/// Adds what a word stands for; false if nothing.
bool add(Kinds& kinds, std::string_view word) {
    bool known = false;
    for (std::size_t kind = 0; kind < issue_kinds; ++kind) {
        std::string_view form = kind < form_kinds ? "scalar" : "vector";
        bool computes = !is_memory(kind) && kind != branch_class;
        bool meant = word == "any" || word == bare_name(kind) || (word == form && computes) ||
                     (word == "memory" && is_memory(kind)) ||
                     (kind != branch_class && word == fmt::format("{}.{}", form, bare_name(kind)));
        if (!meant || kind == vector_branch)
            continue;
        kinds[kind] = true;
        known = true;
    }
    return known;
}

std::string parse(std::string_view text, std::vector<Kinds>& ports) {
    for (std::string_view port : parts(text, '|')) {
        Kinds& kinds = ports.emplace_back();
        if (port.empty())
            return "has a port that takes nothing; name its kinds between two |";
        for (std::string_view word : parts(port, ' '))
            if (!add(kinds, word))
                return fmt::format(
                    "names \"{}\"; a port takes any, scalar, vector, memory, load, store, branch "
                    "or classes of [latency], which may begin with scalar. or vector.",
                    word);
    }
    return "";
}

} // namespace

std::string_view bare_name(std::size_t kind) {
    std::size_t k = kind % form_kinds;
    return k == load_kind ? "load" : k == store_kind ? "store" : class_names[k];
}

std::string kind_name(std::size_t kind) {
    if (kind == branch_class)
        return class_names[branch_class];
    return fmt::format("{}.{}", kind < form_kinds ? "scalar" : "vector", bare_name(kind));
}

std::string Pairing::mistake(std::string_view text) {
    std::vector<Kinds> ports;
    if (text == "any")
        return "";
    if (std::string wrong = parse(text, ports); !wrong.empty())
        return wrong;
    if (ports.size() > most_ports)
        return fmt::format("has {} ports; make it at most {}", ports.size(), most_ports);
    for (std::size_t kind = 0; kind < issue_kinds; ++kind)
        if (kind != vector_branch &&
            std::none_of(ports.begin(), ports.end(), [kind](const Kinds& k) { return k[kind]; }))
            return fmt::format("has no port for {}; add it to one", kind_name(kind));
    return "";
}

Pairing::Pairing(std::string_view text) {
    if (text == "any")
        return;
    std::vector<Kinds> ports;
    parse(text, ports);
    ports_ = ports.size();
    std::vector<std::uint8_t> order(ports_);
    std::iota(order.begin(), order.end(), std::uint8_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::uint8_t a, std::uint8_t b) {
        return std::count(ports[a].begin(), ports[a].end(), true) <
               std::count(ports[b].begin(), ports[b].end(), true);
    });
    for (std::size_t kind = 0; kind < issue_kinds; ++kind)
        for (std::uint8_t port : order)
            if (ports[port][kind])
                of_[kind].push_back(port);
}

std::array<bool, class_count> shared_classes(std::string_view text) {
    std::array<bool, class_count> out{};
    for (std::string_view word : parts(text, ' '))
        for (std::size_t c = 0; c < out.size(); ++c)
            out[c] = out[c] || word == class_names[c];
    return out;
}

std::string shared_classes_mistake(std::string_view text) {
    if (text == "none")
        return "";
    std::vector<std::string_view> words = parts(text, ' ');
    if (words.empty())
        return "names no class; write none";
    for (std::string_view word : words)
        if (std::find(class_names.begin(), class_names.end(), word) == class_names.end())
            return fmt::format("names \"{}\", which is no class of [latency]; names stand apart by spaces",
                               word);
    return "";
}

} // namespace sim
