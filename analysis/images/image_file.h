// Pictures as files hold them, for exact comparison: every channel's bits, unconverted.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace analysis {

/// One channel. All widths are kept in 32-bit words.
struct Channel {
    enum class Kind : std::uint8_t { float32, float16, uint32, uint8, uint16 };

    std::string name;
    Kind kind = Kind::float32;
    std::vector<std::uint32_t> bits; // width * height, rows from the top

    /// The value of pixel `i` as a number.
    double value(std::size_t i) const;
};

struct ImageFile {
    int width = 0, height = 0;
    std::vector<Channel> channels; // sorted by name

    /// The channel of that name, or null.
    const Channel* find(std::string_view name) const;
};

/// A file that cannot be read; what() is one line.
class ImageError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Reads an OpenEXR (first part, unsubsampled) or PNG file, whichever its first bytes say. Throws ImageError.
ImageFile read_image(const std::filesystem::path& path);

ImageFile read_exr(const std::filesystem::path& path);
ImageFile read_png(const std::filesystem::path& path);

} // namespace analysis
