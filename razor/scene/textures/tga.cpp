// Truevision TGA pictures, by the "TGA File Format Specification", version 2.0 (Truevision, 1991):
// colour-mapped ones, true colours and greys, as they are or in runs, from any corner. What follows the
// texels (areas and footer of version 2.0) is passed over, and so are the picture's name and its place on a
// screen.
//
// Own code, as no library of Debian's serves: stb_image takes all rows from the left, the number of a map's
// first entry for bytes, and what is cut short for zeros; GD knows true colours alone; DevIL and FreeImage
// are kept by nobody; OpenImageIO would bring OpenCV, FFmpeg and what these need.
#include "razor/scene/error.h"
#include "razor/scene/text_file.h"
#include "razor/scene/textures/picture.h"
#include "razor/scene/textures/pyramid_builder.h"
#include "razor/scene/textures/srgb.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

namespace razor {
namespace {

constexpr std::size_t header_bytes = 18;

/// Image types, less runs_bit.
enum : unsigned { type_mapped = 1, type_colour = 2, type_grey = 3, runs_bit = 8 };

unsigned byte_of(std::string_view bytes, std::size_t at) {
    return static_cast<unsigned char>(bytes[at]);
}
unsigned word_of(std::string_view bytes, std::size_t at) {
    return byte_of(bytes, at) | byte_of(bytes, at + 1) << 8U;
}

struct Header {
    /// `bytes`: of the header at least.
    explicit Header(std::string_view bytes)
        : name_bytes(byte_of(bytes, 0)), map_type(byte_of(bytes, 1)), type(byte_of(bytes, 2)),
          first(word_of(bytes, 3)), entries(word_of(bytes, 5)), entry_bits(byte_of(bytes, 7)),
          width(static_cast<int>(word_of(bytes, 12))), height(static_cast<int>(word_of(bytes, 14))),
          bits(byte_of(bytes, 16)), opacity_bits(byte_of(bytes, 17) & 15U),
          from_right((byte_of(bytes, 17) & 16U) != 0), from_top((byte_of(bytes, 17) & 32U) != 0),
          interleaved(byte_of(bytes, 17) >= 64) {}

    unsigned kind() const { return type & ~unsigned{runs_bit}; }
    bool has_runs() const { return (type & runs_bit) != 0; }
    /// Of what colours are stored in.
    unsigned colour_bits() const { return kind() == type_mapped ? entry_bits : bits; }
    std::size_t texel_bytes() const { return (bits + 7) / 8; }
    std::size_t map_bytes() const { return map_type == 0 ? 0 : entries * std::size_t{(entry_bits + 7) / 8}; }

    unsigned name_bytes, map_type, type, first, entries,
        entry_bits; // `first`: what the map's first entry is called
    int width, height;
    unsigned bits, opacity_bits;
    bool from_right, from_top, interleaved;
};

bool is_colour_depth(unsigned bits) {
    return bits == 15 || bits == 16 || bits == 24 || bits == 32;
}

/// Why there is no such picture; nothing where there may be one.
std::string fault_of(const Header& h) {
    const unsigned kind = h.kind();
    if (kind < type_mapped || kind > type_grey)
        return fmt::format("it is of type {}, not 1, 2, 3, 9, 10 or 11", h.type);
    if (h.map_type > 1 || (kind == type_mapped && h.map_type == 0))
        return fmt::format("its type is {}, but its map's {}", h.type, h.map_type);
    if (h.map_type == 1 && !is_colour_depth(h.entry_bits) && (kind == type_mapped || h.entries > 0))
        return fmt::format("its map has {} bits an entry, not 15, 16, 24 or 32", h.entry_bits);
    if (kind == type_mapped && h.bits != 8 && h.bits != 16)
        return fmt::format("it has {} bits a texel, not 8 or 16 to name an entry", h.bits);
    if (kind == type_colour && !is_colour_depth(h.bits))
        return fmt::format("it has {} bits a texel, not 15, 16, 24 or 32 of colour", h.bits);
    if (kind == type_grey && h.bits != 8 && !(h.bits == 16 && h.opacity_bits == 8))
        return fmt::format("it has {} bits a texel, {} of opacity, not 8 of grey, or 8 of each", h.bits,
                           h.opacity_bits);
    // Where there is no room for opacity, some writers say that there is some.
    const unsigned colours = h.colour_bits();
    if (kind != type_grey && h.opacity_bits != 0 &&
        ((colours == 16 && h.opacity_bits != 1) || (colours == 32 && h.opacity_bits != 8)))
        return fmt::format("it has {} bits of opacity in {}", h.opacity_bits, colours);
    if (h.interleaved)
        return "its rows are interleaved";
    return "";
}

/// What stored colours mean.
class Decoder {
public:
    Decoder(const Header& header, bool linear)
        : bits_(header.colour_bits()), grey_(header.kind() == type_grey),
          has_opacity_(header.opacity_bits > 0) {
        const auto fill = [&](auto& table) {
            for (std::size_t i = 0; i < table.size(); ++i) {
                const double value = static_cast<double>(i) / static_cast<double>(table.size() - 1);
                table[i] = static_cast<float>(linear ? value : srgb_to_linear(value));
            }
        };
        fill(fives_);
        fill(eights_);
    }

    glm::vec4 operator()(const unsigned char* at) const {
        const auto opacity = [&](unsigned value, unsigned most) {
            return has_opacity_ ? static_cast<float>(value) / static_cast<float>(most) : 1.0F;
        };
        if (grey_)
            return glm::vec4(glm::vec3(eights_[at[0]]), bits_ == 16 ? opacity(at[1], 255) : 1.0F);
        if (bits_ > 16)
            return {eights_[at[2]], eights_[at[1]], eights_[at[0]], bits_ == 32 ? opacity(at[3], 255) : 1.0F};
        const unsigned word = at[0] | unsigned{at[1]} << 8U;
        return {fives_[word >> 10U & 31U], fives_[word >> 5U & 31U], fives_[word & 31U],
                bits_ == 16 ? opacity(word >> 15U, 1) : 1.0F};
    }

private:
    unsigned bits_;
    bool grey_, has_opacity_;
    std::array<float, 32> fives_{};
    std::array<float, 256> eights_{};
};

class TgaReader {
public:
    TgaReader(std::string_view bytes, std::string_view name) : bytes_(bytes), name_(name) {
        if (bytes.size() < header_bytes)
            fail("it is cut short");
    }

    TexturePyramid read(bool linear, Texels kind) {
        const Header h(bytes_);
        if (const std::string fault = fault_of(h); !fault.empty())
            fail(fault);
        check_picture_size(name_, h.width, h.height, bytes_.size());
        const std::size_t begin = header_bytes + h.name_bytes + h.map_bytes();
        if (begin > bytes_.size())
            fail("it is cut short");
        const Decoder decode(h, linear);
        std::vector<glm::vec4> map;
        if (h.kind() == type_mapped)
            for (std::size_t at = header_bytes + h.name_bytes; at < begin; at += h.map_bytes() / h.entries)
                map.push_back(decode(reinterpret_cast<const unsigned char*>(bytes_.data()) + at));
        const std::string_view stored = bytes_.substr(begin);
        std::unique_ptr<unsigned char[]> unpacked;
        if (h.has_runs())
            unpacked = unpack(stored, h);
        else if (stored.size() / h.texel_bytes() / static_cast<std::size_t>(h.width) <
                 static_cast<std::size_t>(h.height))
            fail("it is cut short");
        const unsigned char* const texels =
            unpacked ? unpacked.get() : reinterpret_cast<const unsigned char*>(stored.data());

        const auto width = static_cast<std::size_t>(h.width), height = static_cast<std::size_t>(h.height);
        PyramidBuilder builder(h.width, h.height, kind);
        std::vector<glm::vec4> row(width);
        for (std::size_t y = 0; y < height; ++y) {
            const std::size_t stored_row = h.from_top ? y : height - 1 - y;
            for (std::size_t x = 0; x < width; ++x) {
                const unsigned char* const texel = texels + (stored_row * width + x) * h.texel_bytes();
                row[h.from_right ? width - 1 - x : x] =
                    h.kind() == type_mapped ? entry(map, h, texel) : decode(texel);
            }
            builder.add_row(row);
        }
        return builder.finish();
    }

private:
    [[noreturn]] void fail(std::string_view cause) const {
        throw UserError(
            fmt::format("{}: not a readable TGA picture ({}); give another", printable(name_, 1000), cause));
    }

    glm::vec4 entry(const std::vector<glm::vec4>& map, const Header& h, const unsigned char* texel) const {
        const unsigned number = h.bits == 16 ? texel[0] | unsigned{texel[1]} << 8U : texel[0];
        if (number < h.first || number - h.first >= map.size())
            fail(fmt::format("a texel names entry {}, but its map has {} from {} on", number, map.size(),
                             h.first));
        return map[number - h.first];
    }

    /// Packets of up to 128 texels: one so many times, or each; they may go on in the next row.
    std::unique_ptr<unsigned char[]> unpack(std::string_view packets, const Header& h) const {
        const std::size_t size = h.texel_bytes(),
                          count = static_cast<std::size_t>(h.width) * static_cast<std::size_t>(h.height);
        if (packets.size() < (count + 127) / 128 * (1 + size))
            fail("it is cut short"); // before all that is allocated
        auto texels = std::make_unique_for_overwrite<unsigned char[]>(count * size);
        unsigned char* to = texels.get();
        for (std::size_t left = count; left > 0;) {
            const unsigned code = packets.empty() ? 0 : byte_of(packets, 0);
            const std::size_t length = (code & 127U) + 1, taken = (code < 128 ? length : 1) * size;
            if (packets.size() < 1 + taken)
                fail("it is cut short");
            if (length > left)
                fail("a run goes on behind the last texel");
            const char* const from = packets.data() + 1;
            for (std::size_t i = 0; i < length; ++i, to += size)
                std::copy_n(from + (code < 128 ? i * size : 0), size, to);
            packets.remove_prefix(1 + taken);
            left -= length;
        }
        return texels;
    }

    std::string_view bytes_, name_;
};

} // namespace

bool may_be_tga(std::string_view bytes) {
    if (bytes.size() < header_bytes)
        return false;
    const Header header(bytes);
    return fault_of(header).empty() && header.width > 0 && header.height > 0;
}

TexturePyramid decode_tga(std::string_view bytes, std::string_view name, bool linear, Texels kind) {
    return TgaReader(bytes, name).read(linear || kind == Texels::heights, kind);
}

} // namespace razor
