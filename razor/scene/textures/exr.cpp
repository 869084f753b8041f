#include "razor/scene/error.h"
#include "razor/scene/text_file.h"
#include "razor/scene/textures/exr_header.h"
#include "razor/scene/textures/picture.h"
#include "razor/scene/textures/pyramid_builder.h"
#include "razor/scene/textures/shared_exponent.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace razor {
namespace {

/// Lets OpenEXR read bytes in memory.
class InputStream : public Imf::IStream {
public:
    InputStream(std::string_view bytes, const std::string& name)
        : Imf::IStream(name.c_str()), bytes_(bytes) {}
    bool read(char to[], int count) override {
        if (count < 0 || static_cast<std::uint64_t>(count) > bytes_.size() - at_)
            throw std::runtime_error("it is cut short");
        std::memcpy(to, bytes_.data() + at_, static_cast<std::size_t>(count));
        at_ += static_cast<std::uint64_t>(count);
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override { at_ = std::min<std::uint64_t>(position, bytes_.size()); }

private:
    std::string_view bytes_;
    std::uint64_t at_ = 0;
};

/// Planes of a texel: red, green, blue, opacity; or one for all colours.
std::vector<const char*> names_of_channels(const Imf::ChannelList& channels, std::string_view name) {
    const auto has = [&](const char* channel) { return channels.findChannel(channel) != nullptr; };
    std::vector<const char*> names;
    if (has("R") || has("G") || has("B"))
        names = {"R", "G", "B"};
    else if (has("Y"))
        names = {"Y", "Y", "Y"};
    else
        throw UserError(
            fmt::format("{}: has neither channels R, G, B nor Y; rename them", printable(name, 1000)));
    if (has("RY") || has("BY"))
        throw UserError(fmt::format("{}: its colours are luminance and chroma; convert it to RGB",
                                    printable(name, 1000)));
    if (has("A"))
        names.push_back("A");
    for (const char* const channel : names) {
        const Imf::Channel* const found = channels.findChannel(channel);
        if (found != nullptr && (found->xSampling != 1 || found->ySampling != 1))
            throw UserError(fmt::format("{}: channel {} is subsampled, which is not read; convert it",
                                        printable(name, 1000), channel));
    }
    return names;
}

TexturePyramid read(std::string_view bytes, const std::string& name, Texels kind) {
    InputStream header_stream(bytes, name), stream(bytes, name);
    { // what is said of the size, before OpenEXR allocates anything of it
        const ExrHeader header = read_exr_header(header_stream);
        if (Imf::isMultiPart(header.version) || Imf::isNonImage(header.version))
            throw UserError(fmt::format("{}: has several parts or deep pixels; give a flat OpenEXR picture",
                                        printable(name, 1000)));
        check_picture_size(name, header.width(), header.height(), bytes.size());
    }
    Imf::InputFile exr(stream, 0);
    const auto window = exr.header().dataWindow();
    const int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
    const std::vector<const char*> names = names_of_channels(exr.header().channels(), name);
    const auto columns = static_cast<std::size_t>(width);
    std::array<std::vector<float>, 4> planes;
    std::vector<glm::vec4> texels(columns, glm::vec4(1));
    PyramidBuilder builder(width, height, kind);
    const bool heights = kind == Texels::heights;
    std::int64_t below_zero = 0;
    float lowest = 0;
    for (int y = window.min.y; y <= window.max.y; ++y) {
        Imf::FrameBuffer row;
        for (std::size_t c = 0; c < names.size(); ++c) {
            if (c > 0 && std::strcmp(names[c], names[0]) == 0)
                continue;
            planes[c].resize(columns);
            row.insert(names[c], Imf::Slice::Make(Imf::FLOAT, planes[c].data(), {window.min.x, y}, width, 1,
                                                  sizeof(float), sizeof(float) * columns));
        }
        exr.setFrameBuffer(row);
        exr.readPixels(y);
        for (std::size_t x = 0; x < columns; ++x) {
            for (std::size_t c = 0; c < names.size(); ++c) {
                const float value = planes[c].empty() ? planes[0][x] : planes[c][x];
                if (!std::isfinite(value))
                    throw UserError(
                        fmt::format("{}: {} of the texel in column {}, row {} is {}; give {} that are finite",
                                    printable(name, 1000), names[c], x, y - window.min.y, value,
                                    heights ? "heights" : "colours"));
                if (!heights && value < 0) {
                    ++below_zero;
                    lowest = std::min(lowest, value);
                }
                texels[x][static_cast<int>(c)] =
                    heights ? value : std::clamp(value, 0.0F, c == 3 ? 1.0F : most_shared);
            }
        }
        builder.add_row(texels);
    }
    TexturePyramid pyramid = builder.finish();
    pyramid.below_zero = below_zero;
    pyramid.lowest = lowest;
    return pyramid;
}

} // namespace

TexturePyramid decode_exr(std::string_view bytes, std::string_view name, Texels kind) {
    try {
        return read(bytes, std::string(name), kind);
    } catch (const UserError&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw UserError(fmt::format("{}: not a readable OpenEXR picture ({}); give another",
                                    printable(name, 1000), printable(error.what(), 300)));
    }
}

} // namespace razor
