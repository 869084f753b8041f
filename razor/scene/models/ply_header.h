// The header of a PLY file (Turk, "The PLY polygon file format", 1994): of what its elements consist.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace razor {

enum class PlyEncoding : std::uint8_t { ascii, little_endian, big_endian };

/// In files also char, uchar, short, ushort, int, uint, float and double.
enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

constexpr std::size_t size_of(PlyType type) {
    constexpr std::size_t bytes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return bytes[static_cast<std::size_t>(type)];
}
constexpr bool is_real(PlyType type) {
    return type >= PlyType::float32;
}

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    std::optional<PlyType> count{}; // of a list: the type of its length, a whole number's
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties; // no name twice
    std::int64_t line = 0;               // of the header

    /// Null: there is none.
    const PlyProperty* find(std::string_view property) const;
    /// The fewest bytes that one takes.
    std::size_t least_bytes(PlyEncoding encoding) const;
};

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::ascii;
    std::vector<PlyElement> elements; // in the order of the body, no name twice
    std::size_t bytes = 0;            // up to the body
    std::int64_t lines = 0;

    const PlyElement* find(std::string_view element) const;
};

/// Of the bytes of a file, which is called `file_name` in messages. All lines must end as the first one does:
/// in a line feed, a carriage return or both. Throws UserError "file:line: cause; mend".
PlyHeader parse_ply_header(std::string_view file, std::string_view file_name);

} // namespace razor
