// Pictures as bytes, for tests of what reads them: PNG of every kind, JPEG, OpenEXR.
#pragma once

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <cstdio>
#include <cstring>
#include <jpeglib.h>
#include <png.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

namespace razor {

struct PngKind {
    int depth = 8, colour = PNG_COLOR_TYPE_RGB;
    bool interlaced = false;
    std::vector<png_color> palette{};
    std::vector<png_byte> palette_opacity{};
    int transparent_grey = -1; // this one value
};

/// `samples`: as PNG stores them, row after row, each row whole bytes.
inline std::string png_of(unsigned width, unsigned height, const PngKind& kind,
                          const std::vector<std::uint8_t>& samples) {
    std::string bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(
        png, &bytes,
        [](png_structp p, png_bytep data, std::size_t count) {
            static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<const char*>(data), count);
        },
        nullptr);
    png_set_IHDR(png, info, width, height, kind.depth, kind.colour,
                 kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (!kind.palette.empty())
        png_set_PLTE(png, info, kind.palette.data(), static_cast<int>(kind.palette.size()));
    if (!kind.palette_opacity.empty())
        png_set_tRNS(png, info, kind.palette_opacity.data(), static_cast<int>(kind.palette_opacity.size()),
                     nullptr);
    if (kind.transparent_grey >= 0) {
        png_color_16 key{};
        key.gray = static_cast<png_uint_16>(kind.transparent_grey);
        png_set_tRNS(png, info, nullptr, 0, &key);
    }
    const std::size_t row = samples.size() / height;
    std::vector<png_bytep> rows;
    std::vector<std::uint8_t> copy = samples;
    for (std::size_t y = 0; y < height; ++y)
        rows.push_back(copy.data() + y * row);
    png_set_rows(png, info, rows.data());
    png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

/// Of 1 (grey), 3 (RGB) or 4 (CMYK) components.
inline std::string jpeg_of(unsigned width, unsigned height, int components,
                           const std::vector<std::uint8_t>& samples, bool progressive = false) {
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* memory = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &memory, &size);
    jpeg.image_width = width;
    jpeg.image_height = height;
    jpeg.input_components = components;
    jpeg.in_color_space = components == 1 ? JCS_GRAYSCALE : components == 3 ? JCS_RGB : JCS_CMYK;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 98, TRUE);
    if (progressive)
        jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    std::vector<std::uint8_t> copy = samples;
    while (jpeg.next_scanline < height) {
        JSAMPROW row =
            copy.data() + std::size_t{jpeg.next_scanline} * width * static_cast<unsigned>(components);
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    std::string bytes(reinterpret_cast<const char*>(memory), size);
    jpeg_destroy_compress(&jpeg);
    std::free(memory);
    return bytes;
}

using ExrPlanes = std::vector<std::pair<std::string, std::vector<float>>>;

class StringStream : public Imf::OStream {
public:
    StringStream() : Imf::OStream("memory") {}
    void write(const char bytes[], int count) override {
        const auto n = static_cast<std::size_t>(count);
        text.resize(std::max(text.size(), at_ + n));
        std::memcpy(text.data() + at_, bytes, n);
        at_ += n;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t position) override { at_ = position; }
    std::string text;

private:
    std::size_t at_ = 0;
};

/// Its first texel at (x, y) of the picture's plane.
inline std::string exr_of(int width, int height, ExrPlanes planes, int x = 0, int y = 0) {
    using Box = Imath::Box2i;
    const Box window({x, y}, {x + width - 1, y + height - 1});
    Imf::Header header(window, window);
    Imf::FrameBuffer pixels;
    for (auto& [name, values] : planes) {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        pixels.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(), {x, y}, width, 1, sizeof(float),
                                             sizeof(float) * static_cast<std::size_t>(width)));
    }
    StringStream stream;
    {
        Imf::OutputFile file(stream, header, 0);
        file.setFrameBuffer(pixels);
        file.writePixels(height);
    }
    return stream.text;
}

} // namespace razor
