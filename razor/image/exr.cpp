#include "razor/image/exr.h"

#include "razor/image/output_file.h"
#include "razor/scene/error.h"
#include "razor/scene/text_file.h"
#include "razor/scene/textures/exr_header.h"
#include "razor/scene/textures/picture_size.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>

namespace razor {
namespace {

/// Lets OpenEXR write through an OutputFile, so that a full disk is noticed.
class OutputStream : public Imf::OStream {
public:
    OutputStream(OutputFile& file, const std::string& name) : Imf::OStream(name.c_str()), file_(file) {}
    void write(const char bytes[], int count) override {
        file_.write(bytes, static_cast<std::size_t>(count));
    }
    std::uint64_t tellp() override { return file_.position(); }
    void seekp(std::uint64_t position) override { file_.seek(position); }

private:
    OutputFile& file_;
};

constexpr std::size_t pixel_bytes = sizeof(float);
static_assert(sizeof(std::uint32_t) == pixel_bytes);

Imf::PixelType type_of(const Plane& plane) {
    return plane.ids.empty() ? Imf::FLOAT : Imf::UINT;
}

/// A view of a plane; OpenEXR wants a non-const pointer for reading and writing alike.
Imf::Slice slice_of(const Plane& plane, int x, int y, std::size_t width) {
    const std::size_t row_bytes = pixel_bytes * width;
    const void* const pixels = plane.ids.empty() ? static_cast<const void*>(plane.values.data())
                                                 : static_cast<const void*>(plane.ids.data());
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast)
    return Imf::Slice::Make(type_of(plane), const_cast<void*>(pixels), {x, y},
                            static_cast<std::int64_t>(width), 1, pixel_bytes, row_bytes);
}

Imath::M44f matrix_of(const std::array<float, 16>& rows) {
    Imath::M44f m;
    std::copy(rows.begin(), rows.end(), &m[0][0]);
    return m;
}
std::array<float, 16> rows_of(const Imath::M44f& m) {
    std::array<float, 16> rows{};
    std::copy_n(&m[0][0], rows.size(), rows.begin());
    return rows;
}

Imath::Box2i box_of(int x, int y, int width, int height) {
    return {{x, y}, {x + width - 1, y + height - 1}};
}

Imf::Header header_of(const Film& film) {
    const PictureWindow window = film.window.value_or(PictureWindow{0, 0, film.width, film.height});
    Imf::Header header(box_of(0, 0, window.width, window.height),
                       box_of(window.x, window.y, film.width, film.height), 1, {0, 0},
                       film.camera ? film.camera->screen_width : 1);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::addChromaticities(header, Imf::Chromaticities()); // Rec. 709
    if (film.camera) {
        Imf::addWorldToCamera(header, matrix_of(film.camera->world_to_camera));
        Imf::addWorldToNDC(header, matrix_of(film.camera->world_to_ndc));
    }
    return header;
}

/// Before anything is allocated of the size that a file states. Throws UserError, or what OpenEXR does.
void check_size(const std::filesystem::path& path, const std::string& name) {
    Imf::StdIFStream stream(path.c_str());
    const ExrHeader header = read_exr_header(stream);
    const std::int64_t width = header.width(), height = header.height();
    if (width > 65536 || height > 65536)
        throw UserError(
            fmt::format("{}: {} x {} pixels are too many; give a smaller picture", name, width, height));
    const std::uint64_t bytes = std::filesystem::file_size(path);
    if (width > 0 && height > 0 && !can_hold(bytes, width, height))
        throw UserError(fmt::format("{}: {} x {} pixels cannot be in {} bytes: it is damaged or cut short; "
                                    "give another picture",
                                    name, width, height, bytes));
}

/// What the header says of window and camera.
void describe(const Imf::Header& header, Film& film) {
    const Imath::Box2i &data = header.dataWindow(), &display = header.displayWindow();
    if (data != display)
        film.window = PictureWindow{data.min.x - display.min.x, data.min.y - display.min.y,
                                    display.max.x - display.min.x + 1, display.max.y - display.min.y + 1};
    if (Imf::hasWorldToCamera(header) && Imf::hasWorldToNDC(header))
        film.camera = PictureCamera{rows_of(Imf::worldToCamera(header)), rows_of(Imf::worldToNDC(header)),
                                    header.screenWindowWidth()};
}

} // namespace

void write_exr(const std::filesystem::path& path, const Film& film, const ImageAttributes& attributes) {
    OutputFile file(path);
    try {
        Imf::Header header = header_of(film);
        const Imath::V2i corner = header.dataWindow().min;
        Imf::FrameBuffer pixels;
        for (const Plane& plane : film.planes) {
            header.channels().insert(plane.name, Imf::Channel(type_of(plane)));
            pixels.insert(plane.name,
                          slice_of(plane, corner.x, corner.y, static_cast<std::size_t>(film.width)));
        }
        for (const auto& [name, value] : attributes) {
            header.insert(name, Imf::StringAttribute(value));
        }
        {
            OutputStream stream(file, path.string());
            Imf::OutputFile exr(stream, header, 0);
            exr.setFrameBuffer(pixels);
            exr.writePixels(film.height);
        }
        file.commit();
    } catch (const UserError&) {
        throw;
    } catch (const std::exception& error) {
        throw UserError(fmt::format("{}: cannot be written ({}); choose another place",
                                    printable(path.string(), 1000), printable(error.what(), 300)));
    }
}

Film read_exr(const std::filesystem::path& path, ImageAttributes* attributes) {
    const std::string name = printable(path.string(), 1000);
    if (!std::filesystem::is_regular_file(path)) {
        throw UserError(fmt::format("{}: no such file; give an OpenEXR picture", name));
    }
    try {
        check_size(path, name);
        Imf::InputFile exr(path.c_str(), 0);
        const Imf::Header& header = exr.header();
        const auto window = header.dataWindow();
        const int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
        Film film(width, height);
        describe(header, film);
        Imf::FrameBuffer pixels;
        for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
            if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1) {
                throw UserError(fmt::format("{}: channel {} is subsampled, which is not read; convert it",
                                            name, printable(channel.name())));
            }
            const bool whole = channel.channel().type == Imf::UINT;
            const Plane& plane = whole ? film.add_ids(channel.name()) : film.add(channel.name());
            pixels.insert(plane.name,
                          slice_of(plane, window.min.x, window.min.y, static_cast<std::size_t>(width)));
        }
        exr.setFrameBuffer(pixels);
        exr.readPixels(window.min.y, window.max.y);
        for (auto at = header.begin(); attributes != nullptr && at != header.end(); ++at) {
            if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&at.attribute())) {
                attributes->emplace_back(at.name(), text->value());
            }
        }
        return film;
    } catch (const UserError&) {
        throw;
    } catch (const std::exception& error) {
        throw UserError(fmt::format("{}: not a readable OpenEXR picture ({}); give another", name,
                                    printable(error.what(), 300)));
    }
}

} // namespace razor
