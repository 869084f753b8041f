#include "analysis/images/image_file.h"
#include "razor/scene/textures/exr_header.h"
#include "razor/scene/textures/picture_size.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStdIO.h>
#include <fmt/format.h>

#include <algorithm>

namespace analysis {
namespace {

Channel::Kind kind_of(Imf::PixelType type) {
    return type == Imf::UINT   ? Channel::Kind::uint32
           : type == Imf::HALF ? Channel::Kind::float16
                               : Channel::Kind::float32;
}

/// Before anything is allocated of the size that a file states. Throws ImageError, or what OpenEXR does.
void check_size(const std::filesystem::path& path) {
    Imf::StdIFStream stream(path.c_str());
    const razor::ExrHeader header = razor::read_exr_header(stream);
    const std::int64_t width = header.width(), height = header.height();
    if (width > 65536 || height > 65536)
        throw ImageError(fmt::format("{}: {} x {} pixels are too many", path.string(), width, height));
    const std::uint64_t bytes = std::filesystem::file_size(path);
    if (width > 0 && height > 0 && !razor::can_hold(bytes, width, height))
        throw ImageError(fmt::format("{}: {} x {} pixels cannot be in {} bytes: it is damaged or cut short",
                                     path.string(), width, height, bytes));
}

/// Halves are read as 16-bit values into the low half of each word.
Imf::Slice slice_of(Channel& channel, Imf::PixelType type, int x, int y, std::size_t width) {
    return Imf::Slice::Make(type, channel.bits.data(), {x, y}, static_cast<std::int64_t>(width), 1, 4,
                            4 * width);
}

} // namespace

ImageFile read_exr(const std::filesystem::path& path) {
    try {
        check_size(path);
        Imf::InputFile exr(path.c_str(), 0);
        const Imf::Header& header = exr.header();
        const auto window = header.dataWindow();
        const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
        const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
        ImageFile image{static_cast<int>(width), static_cast<int>(height), {}};
        Imf::FrameBuffer pixels;
        for (auto at = header.channels().begin(); at != header.channels().end(); ++at) {
            if (at.channel().xSampling != 1 || at.channel().ySampling != 1) {
                throw ImageError(
                    fmt::format("{}: channel {} is subsampled, which is not read", path.string(), at.name()));
            }
            Channel& channel =
                image.channels.emplace_back(Channel{at.name(), kind_of(at.channel().type), {}});
            channel.bits.resize(static_cast<std::size_t>(width * height));
            pixels.insert(channel.name, slice_of(channel, at.channel().type, window.min.x, window.min.y,
                                                 static_cast<std::size_t>(width)));
        }
        exr.setFrameBuffer(pixels);
        exr.readPixels(window.min.y, window.max.y);
        return image;
    } catch (const ImageError&) {
        throw;
    } catch (const std::exception& error) {
        std::string cause = error.what();
        std::replace(cause.begin(), cause.end(), '\n', ' ');
        throw ImageError(fmt::format("{}: not a readable OpenEXR picture ({})", path.string(), cause));
    }
}

} // namespace analysis
