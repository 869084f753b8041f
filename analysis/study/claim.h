// Who measures which point of a folder just now, so that several programs on one folder (on one host or many)
// spare each other's work. Claims are files claims/NAME with a host's name and a process's number. Nothing
// depends on them: results appear whole, and equal points have equal results, so that where a claim is lost
// or wrongly taken for dead a point is measured twice, and no worse comes of it.
#pragma once

#include "analysis/study/store.h"

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace analysis {

class Claims {
public:
    /// Throws StudyError where no folder can be made.
    explicit Claims(const Store& store);
    ~Claims();
    Claims(const Claims&) = delete;
    Claims& operator=(const Claims&) = delete;

    /// Whether the point is this process's now. False: another has it, who is alive as far as is known. Dead
    /// are processes of this host that do not exist, and whoever has not touched the file while this object
    /// watched it for `patience`. Throws StudyError.
    bool take(const Point& point);
    void release(const Point& point);
    /// Touches this process's claims, if that is due: to be called more often than every `beat`.
    void keep();

    static constexpr std::chrono::seconds beat{10}, patience{60};

private:
    using Clock = std::chrono::steady_clock;
    struct Seen {
        std::filesystem::file_time_type touched; // by whatever clock the file's disk has
        Clock::time_point since;                 // by this host's
    };

    std::filesystem::path file_of(const std::string& name) const;
    bool make(const std::string& name) const;
    /// When the claim was touched last, if it is dead.
    std::optional<std::filesystem::file_time_type> dead_since(const std::string& name);
    void take_away(const std::string& name, std::filesystem::file_time_type touched) const;

    std::filesystem::path folder_;
    std::string own_; // what this process's claims hold
    std::map<std::string, Seen> others_;
    std::map<std::string, Clock::time_point> mine_; // when last touched
};

} // namespace analysis
