#include "razor/image/output_file.h"

#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <atomic>
#include <cerrno>
#include <fcntl.h>
#include <set>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace razor {
namespace {

std::string reason() {
    return std::generic_category().message(errno);
}

/// Whether standard output or error goes to this file, by whatever name (say, /dev/stdout): what they get
/// after a file of that name took its place would be lost.
bool is_standard(const std::filesystem::path& path) {
    struct stat file, standard; // NOLINT: as of POSIX
    if (::stat(path.c_str(), &file) != 0)
        return false;
    for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO})
        if (::fstat(descriptor, &standard) == 0 && standard.st_dev == file.st_dev &&
            standard.st_ino == file.st_ino)
            return true;
    return false;
}

/// A file in a folder that has no name yet, so that nothing is left of it whatever ends the program; null:
/// the file system has none of these.
std::FILE* nameless_file(const std::filesystem::path& folder) {
    if (::access("/proc/self/fd", X_OK) != 0) // by which it gets its name
        return nullptr;
    const int file = ::open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, // NOLINT
                            0666);
    return file < 0 ? nullptr : ::fdopen(file, "wb");
}

} // namespace

OutputFile::OutputFile(const std::filesystem::path& path) {
    std::error_code error;
    // A link stays a link: what it names is replaced.
    path_ = std::filesystem::is_symlink(path, error) ? std::filesystem::weakly_canonical(path, error) : path;
    // Renaming would put a file in the place of a device, or beside a pipe (which has no canonical name).
    if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
        throw UserError(
            fmt::format("{}: is not a regular file; choose another name", printable(path.string(), 1000)));
    if (is_input(path_))
        throw UserError(fmt::format("{}: is one of the files that this is made of; name another output",
                                    printable(path_.string(), 1000)));
    if (is_standard(path_))
        throw UserError(fmt::format("{}: is where standard output or error goes; name another file",
                                    printable(path.string(), 1000)));
    static std::atomic<unsigned> made = 0; // several in a folder, of names as long as there may be
    temporary_ = path_;
    temporary_.replace_filename(fmt::format(".{}-{}.tmp", ::getpid(), ++made));
    file_ = nameless_file(path_.parent_path());
    nameless_ = file_ != nullptr;
    if (!nameless_)
        file_ = std::fopen(temporary_.c_str(), "wbx");
    if (file_ == nullptr && errno == EEXIST) { // left by a killed process of the same number
        std::filesystem::remove(temporary_, error);
        file_ = std::fopen(temporary_.c_str(), "wbx");
    }
    if (file_ == nullptr) {
        fail("cannot be written");
    }
}

OutputFile::~OutputFile() {
    if (file_ != nullptr) {
        std::fclose(file_);
        std::error_code error;
        if (!nameless_)
            std::filesystem::remove(temporary_, error);
    }
}

void OutputFile::write(const void* bytes, std::size_t count) {
    if (std::fwrite(bytes, 1, count, file_) != count) {
        fail("cannot be written");
    }
}

void OutputFile::seek(std::uint64_t position) {
    if (std::fseek(file_, static_cast<long>(position), SEEK_SET) != 0) {
        fail("cannot be written");
    }
}

std::uint64_t OutputFile::position() {
    return static_cast<std::uint64_t>(std::ftell(file_));
}

void OutputFile::commit() {
    if (!failure_.empty()) {
        throw UserError(failure_);
    }
    if (std::fflush(file_) != 0 || std::ferror(file_) != 0) {
        fail("cannot be written");
    }
    if (nameless_) {
        std::error_code error;
        std::filesystem::remove(temporary_, error); // left by a killed process of the same number
        if (::linkat(AT_FDCWD, fmt::format("/proc/self/fd/{}", ::fileno(file_)).c_str(), AT_FDCWD,
                     temporary_.c_str(), AT_SYMLINK_FOLLOW) != 0)
            fail("cannot be written");
        nameless_ = false;
    }
    const int closed = std::fclose(file_);
    file_ = nullptr;
    if (closed != 0 || std::rename(temporary_.c_str(), path_.c_str()) != 0) {
        const std::string cause = reason();
        std::error_code error;
        std::filesystem::remove(temporary_, error);
        throw UserError(fmt::format("{}: cannot be written ({}); choose another place",
                                    printable(path_.string(), 1000), cause));
    }
}

void OutputFile::fail(std::string_view action) {
    failure_ =
        fmt::format("{}: {} ({}); choose another place", printable(path_.string(), 1000), action, reason());
    throw UserError(failure_);
}

void check_writable(const std::filesystem::path& path) {
    const std::string name = printable(path.string(), 1000);
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::directory || !path.has_filename()) {
        throw UserError(fmt::format("{}: is a directory; name a file in it", name));
    }
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    if (!std::filesystem::is_directory(folder, error)) {
        throw UserError(
            fmt::format("{}: no folder {}; make it first", name, printable(folder.string(), 1000)));
    }
    const OutputFile attempt(path); // removed again
}

void check_apart(const std::vector<std::filesystem::path>& outputs) {
    std::set<std::filesystem::path> seen;
    for (const std::filesystem::path& output : outputs) {
        if (output.empty())
            continue;
        std::error_code error;
        const auto name = std::filesystem::weakly_canonical(std::filesystem::absolute(output), error);
        if (!seen.insert(error ? output : name).second)
            throw UserError(fmt::format("{}: is the name of two outputs; name two files",
                                        printable(output.string(), 1000)));
    }
}

void write_text_file(const std::filesystem::path& path, std::string_view text) {
    OutputFile file(path);
    file.write(text.data(), text.size());
    file.commit();
}

} // namespace razor
