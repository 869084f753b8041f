// The tiles of the picture that a stream's references were for last: the next one is mostly among them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace traces {

/// At first all are none (0). The last one used is first.
class RecentTiles {
public:
    static constexpr std::uint32_t most = 15;

    /// From 1 on; 0: it is not there.
    std::uint32_t place_of(std::uint32_t tile) const {
        const auto* const found = std::find(all_.begin(), all_.end(), tile);
        return found == all_.end() ? 0 : static_cast<std::uint32_t>(found - all_.begin() + 1);
    }
    std::uint32_t at(std::uint32_t place) const { return all_[place - 1]; }
    std::uint32_t last() const { return all_[0]; }
    /// It comes to be the first, in the room of the one at `place`, or of the last.
    void use(std::uint32_t tile, std::uint32_t place) {
        const auto end = all_.begin() + (place == 0 ? most : place);
        std::copy_backward(all_.begin(), end - 1, end);
        all_[0] = tile;
    }

private:
    std::array<std::uint32_t, most> all_{};
};

} // namespace traces
