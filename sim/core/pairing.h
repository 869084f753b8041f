// Which instructions issue in one cycle (core.pairing): ports, each of which takes one instruction a cycle of
// the kinds that it lists. An instruction goes to the free port that takes fewest kinds, so that order within
// a cycle does not matter: compilers put pairs in the order that their pipes want. What describes a core:
//   single issue (Niagara)          core.issue_width = 1, "any"
//   U and V pipe (Pentium, Larrabee) "any | scalar.integer scalar.address load store branch"
//   ports behind a window (Core 2)  "vector.multiply scalar.integer ... | vector.add ... | ... | load |
//   store"
// Not modelled: that a wide store takes a port for its address and one for its data, that only one thread
// issues in a cycle, moves of results between clusters of units.
#pragma once

#include "sim/config/config.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sim {

/// Kinds of instructions: each class, loads and stores, as scalars and as vectors.
inline constexpr std::size_t load_kind = class_count, store_kind = class_count + 1;
inline constexpr std::size_t form_kinds = class_count + 2, issue_kinds = 2 * form_kinds;
inline constexpr auto integer_kind = static_cast<std::size_t>(isa::timing::operation::integer);
constexpr std::size_t vector_kind(std::size_t scalar_kind) {
    return scalar_kind + form_kinds;
}
/// The class whose interval and unit an instruction takes: loads and stores compute addresses.
constexpr std::size_t class_of(std::size_t kind) {
    std::size_t k = kind % form_kinds;
    return k < class_count ? k : integer_kind;
}
/// "add", "load", "branch": of both forms.
std::string_view bare_name(std::size_t kind);
/// "vector.add", "scalar.load", "branch".
std::string kind_name(std::size_t kind);

class Pairing {
public:
    static constexpr std::size_t most_ports = 16;

    /// The text of core.pairing, which has passed `mistake`.
    explicit Pairing(std::string_view text);
    /// What is wrong with the text and how to mend it, or an empty string.
    static std::string mistake(std::string_view text);

    /// 0: every issue slot takes every instruction.
    std::size_t ports() const { return ports_; }
    /// The ports that take instructions of a kind, in the order of preference.
    const std::vector<std::uint8_t>& of(std::size_t kind) const { return of_[kind]; }

private:
    std::size_t ports_ = 0;
    std::array<std::vector<std::uint8_t>, issue_kinds> of_;
};

/// The classes of core.shared_classes: words apart by spaces, or "none".
std::array<bool, class_count> shared_classes(std::string_view text);
/// What is wrong with it, or an empty string.
std::string shared_classes_mistake(std::string_view text);

} // namespace sim
