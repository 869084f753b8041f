// What an OpenEXR file says of itself, before anything of the size that it states is allocated.
#pragma once

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfVersion.h>

#include <cstdint>
#include <stdexcept>

namespace razor {

struct ExrHeader {
    int version = 0; // with its flags
    Imf::Header first{};

    std::int64_t width() const {
        return std::int64_t{first.dataWindow().max.x} - first.dataWindow().min.x + 1;
    }
    std::int64_t height() const {
        return std::int64_t{first.dataWindow().max.y} - first.dataWindow().min.y + 1;
    }
};

/// From the beginning of a stream; OpenEXR has checked nothing of it but that it can be read. Throws
/// std::exception.
inline ExrHeader read_exr_header(Imf::IStream& stream) {
    char start[8]{};
    stream.read(start, sizeof start); // magic number and version, of the same byte order as all
    if (!Imf::isImfMagic(start))
        throw std::runtime_error("it does not begin as one");
    ExrHeader header;
    for (int i = 3; i >= 0; --i)
        header.version = header.version << 8 | static_cast<unsigned char>(start[4 + i]);
    header.first.readFrom(stream, header.version);
    return header;
}

} // namespace razor
