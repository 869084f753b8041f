#include "analysis/study/claim.h"

#include "analysis/study/error.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <unistd.h>

namespace analysis {
namespace {

namespace fs = std::filesystem;

std::string host_name() {
    std::array<char, 256> name{};
    return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "?";
}

} // namespace

Claims::Claims(const Store& store)
    : folder_(store.folder() / "claims"), own_(fmt::format("{} {}\n", host_name(), getpid())) {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error)
        throw StudyError(fmt::format("{}: no folder can be made ({}); choose another place", folder_.string(),
                                     error.message()));
}

Claims::~Claims() {
    std::error_code ignored;
    for (const auto& [name, touched] : mine_)
        fs::remove(file_of(name), ignored);
    fs::remove(folder_, ignored); // if nobody else has any
}

fs::path Claims::file_of(const std::string& name) const {
    return folder_ / name;
}

bool Claims::make(const std::string& name) const {
    const fs::path file = file_of(name);
    // Another who was done may have taken the empty folder away: then once more.
    for (int trial = 0; trial < 2; ++trial) {
        const int made = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
        if (made >= 0) {
            // Where nothing can be written the claim's owner is unknown, and it grows old by its time.
            const bool written = ::write(made, own_.data(), own_.size()) == static_cast<ssize_t>(own_.size());
            ::close(made);
            static_cast<void>(written);
            return true;
        }
        if (errno == EEXIST)
            return false;
        std::error_code ignored;
        if (errno == ENOENT)
            fs::create_directories(folder_, ignored);
    }
    throw StudyError(
        fmt::format("{}: cannot be made ({}); check the folder", file.string(), std::strerror(errno)));
}

std::optional<fs::file_time_type> Claims::dead_since(const std::string& name) {
    const fs::path file = file_of(name);
    std::error_code error;
    const fs::file_time_type touched = fs::last_write_time(file, error);
    if (error)
        return fs::file_time_type{}; // gone by now
    std::ifstream in(file);
    std::string host;
    pid_t process = 0;
    if (in >> host >> process && host == host_name() && ::kill(process, 0) != 0 && errno == ESRCH)
        return touched;
    const Clock::time_point now = Clock::now();
    const auto [found, fresh] = others_.try_emplace(name, Seen{touched, now});
    if (!fresh && found->second.touched != touched)
        found->second = {touched, now};
    return now - found->second.since > patience ? std::optional(touched) : std::nullopt;
}

/// A dead claim, touched then. Another may have done so meanwhile and have a claim of its own: that is put
/// back.
void Claims::take_away(const std::string& name, fs::file_time_type touched) const {
    const fs::path file = file_of(name);
    fs::path aside = file;
    aside += fmt::format(".{}.{}", host_name(), getpid());
    std::error_code error;
    fs::rename(file, aside, error);
    if (error)
        return;
    if (fs::last_write_time(aside, error) != touched)
        fs::create_hard_link(aside, file, error);
    fs::remove(aside, error);
}

bool Claims::take(const Point& point) {
    bool made = make(point.name);
    if (!made)
        if (const auto touched = dead_since(point.name)) {
            take_away(point.name, *touched);
            made = make(point.name);
        }
    if (made)
        mine_[point.name] = Clock::now();
    return made;
}

void Claims::release(const Point& point) {
    std::error_code ignored;
    fs::remove(file_of(point.name), ignored);
    mine_.erase(point.name);
}

void Claims::keep() {
    const Clock::time_point now = Clock::now();
    for (auto& [name, touched] : mine_)
        if (now - touched > beat) {
            std::error_code ignored;
            fs::last_write_time(file_of(name), fs::file_time_type::clock::now(), ignored);
            touched = now;
        }
}

} // namespace analysis
