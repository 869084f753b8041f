#include "razor/scene/error.h"
#include "razor/scene/text_file.h"
#include "razor/scene/textures/picture.h"
#include "razor/scene/textures/pyramid_builder.h"
#include "razor/scene/textures/srgb.h"

#include <fmt/format.h>

#include <array>
#include <csetjmp>
#include <cstdio> // for jpeglib.h
#include <jerror.h>
#include <jpeglib.h>

namespace razor {
namespace {

constexpr int most_scans = 500; // of a progressive picture; more only serve to take time

/// What libjpeg's C callbacks work on: the first member is what libjpeg knows.
struct Errors {
    jpeg_error_mgr manager;
    std::jmp_buf jump;
    char text[JMSG_LENGTH_MAX] = {};
};

[[noreturn]] void stop(j_common_ptr jpeg) {
    auto& errors = *reinterpret_cast<Errors*>(jpeg->err);
    (*jpeg->err->format_message)(jpeg, errors.text);
    std::longjmp(errors.jump, 1); // NOLINT(cert-err52-cpp)
}

/// Warnings are of damage, but for these, which pictures that are seen everywhere have.
void warn(j_common_ptr jpeg, int level) {
    const int code = jpeg->err->msg_code;
    if (level < 0 && code != JWRN_EXTRANEOUS_DATA && code != JWRN_ADOBE_XFORM && code != JWRN_JFIF_MAJOR)
        stop(jpeg);
}

void count_scans(j_common_ptr jpeg) {
    if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number > most_scans)
        ERREXIT(jpeg, JERR_BAD_PROGRESSION);
}

// Errors jump: only trivially destructible locals in these three.

bool read_header(jpeg_decompress_struct& jpeg, Errors& errors, std::string_view bytes) {
    if (setjmp(errors.jump) != 0) // NOLINT(cert-err52-cpp)
        return false;
    jpeg_create_decompress(&jpeg);
    jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    jpeg_read_header(&jpeg, TRUE);
    return true;
}

bool begin_rows(jpeg_decompress_struct& jpeg, Errors& errors) {
    if (setjmp(errors.jump) != 0) // NOLINT(cert-err52-cpp)
        return false;
    jpeg.out_color_space = jpeg.num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg.dct_method = JDCT_ISLOW;
    jpeg_start_decompress(&jpeg);
    return true;
}

/// The next row, and after the last one what follows.
bool read_row(jpeg_decompress_struct& jpeg, Errors& errors, JSAMPROW row) {
    if (setjmp(errors.jump) != 0) // NOLINT(cert-err52-cpp)
        return false;
    jpeg_read_scanlines(&jpeg, &row, 1);
    if (jpeg.output_scanline == jpeg.output_height)
        jpeg_finish_decompress(&jpeg);
    return true;
}

class JpegReader {
public:
    JpegReader(std::string_view bytes, std::string_view name) : bytes_(bytes), name_(name) {
        jpeg_.err = jpeg_std_error(&errors_.manager);
        errors_.manager.error_exit = stop;
        errors_.manager.emit_message = warn;
    }
    ~JpegReader() { jpeg_destroy_decompress(&jpeg_); }
    JpegReader(const JpegReader&) = delete;
    JpegReader& operator=(const JpegReader&) = delete;

    TexturePyramid read(bool linear, Texels kind) {
        check(read_header(jpeg_, errors_, bytes_));
        check_picture_size(name_, jpeg_.image_width, jpeg_.image_height, bytes_.size());
        if (jpeg_.jpeg_color_space == JCS_CMYK || jpeg_.jpeg_color_space == JCS_YCCK)
            throw UserError(
                fmt::format("{}: a JPEG picture of inks (CMYK), whose colours depend on a printer; "
                            "convert it to RGB",
                            printable(name_, 1000)));
        if (jpeg_.num_components != 1 && jpeg_.num_components != 3)
            throw UserError(fmt::format("{}: a JPEG picture of {} components; convert it to RGB",
                                        printable(name_, 1000), jpeg_.num_components));
        jpeg_progress_mgr progress{};
        progress.progress_monitor = count_scans;
        jpeg_.progress = &progress;
        check(begin_rows(jpeg_, errors_));
        std::array<float, 256> meaning{};
        for (std::size_t i = 0; i < meaning.size(); ++i) {
            const double value = static_cast<double>(i) / 255;
            meaning[i] = static_cast<float>(linear ? value : srgb_to_linear(value));
        }
        const std::size_t width = jpeg_.image_width, channels = jpeg_.num_components == 1 ? 1 : 3;
        std::vector<JSAMPLE> samples(width * channels);
        std::vector<glm::vec4> texels(width, glm::vec4(1));
        PyramidBuilder builder(static_cast<int>(width), static_cast<int>(jpeg_.image_height), kind);
        for (JDIMENSION y = 0; y < jpeg_.image_height; ++y) {
            check(read_row(jpeg_, errors_, samples.data()));
            for (std::size_t x = 0; x < width; ++x)
                for (std::size_t c = 0; c < 3; ++c)
                    texels[x][static_cast<int>(c)] = meaning[samples[x * channels + (channels == 1 ? 0 : c)]];
            builder.add_row(texels);
        }
        return builder.finish();
    }

private:
    void check(bool done) const {
        if (!done)
            throw UserError(fmt::format("{}: not a readable JPEG picture ({}); give another",
                                        printable(name_, 1000), printable(errors_.text, 200)));
    }

    std::string_view bytes_, name_;
    Errors errors_{};
    jpeg_decompress_struct jpeg_{};
};

} // namespace

TexturePyramid decode_jpeg(std::string_view bytes, std::string_view name, bool linear, Texels kind) {
    return JpegReader(bytes, name).read(linear || kind == Texels::heights, kind);
}

} // namespace razor
