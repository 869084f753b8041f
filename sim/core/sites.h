// Dense numbers for places in the source, in the order in which a tile first meets them. Two pointers to the
// same file name are one file, so that numbers depend on no linker.
#pragma once

#include "isa/simulated/port.h"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

namespace sim {

class Sites {
public:
    std::uint32_t number(isa::timing::site where) {
        auto hash = reinterpret_cast<std::uintptr_t>(where.file) / 8 + where.line * 2654435761U;
        Known& k = recent_[hash % recent_.size()];
        if (k.file != where.file || k.line != where.line) [[unlikely]]
            k = {where.file, where.line, find(where)};
        return k.number;
    }

private:
    struct Known {
        const char* file = nullptr;
        std::uint32_t line = 0, number = 0;
    };
    std::uint32_t find(isa::timing::site where) {
        auto next = static_cast<std::uint32_t>(all_.size());
        return all_.try_emplace({where.file, where.line}, next).first->second;
    }

    std::array<Known, 1024> recent_;
    std::map<std::pair<std::string, std::uint32_t>, std::uint32_t> all_;
};

} // namespace sim
