// Addresses over time as a picture: a band a group, time to the right, addresses upwards within a band as far
// as they are touched, the darker the more often (logarithmically).
#pragma once

#include "analysis/plots/png.h"
#include "analysis/traces/address_time.h"

#include <string>
#include <vector>

namespace analysis {

struct AddressPicture {
    struct Band {
        std::uint32_t group;
        std::size_t top, height;   // pixels
        std::uint64_t low, high;   // addresses, of the first page and the last
        std::uint64_t pages, most; // touched; references of its fullest pixel
    };
    Pixels pixels;
    std::vector<Band> bands; // from the top, those with the most references first
    std::uint64_t most = 0;  // references of the fullest pixel of all
};

/// At most so many pixels; bands are as high as they have pages, shrunk if need be, at least four pixels.
AddressPicture draw(const AddressTime& counts, std::size_t width, std::size_t height);

/// The picture with names of bands, axes and what its shades say, as an SVG element. `unit`: of times.
std::string with_legend(const AddressPicture& picture, const AddressTime& counts,
                        const std::vector<std::string>& names, const std::string& unit);

} // namespace analysis
