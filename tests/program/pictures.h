// Pictures compared bit for bit, with messages.
#pragma once

#include "razor/image/exr.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace razor {

inline void expect_same_picture(const std::filesystem::path& a, const std::filesystem::path& b) {
    const Film left = read_exr(a), right = read_exr(b);
    ASSERT_EQ(left.planes.size(), right.planes.size());
    for (const Plane& plane : left.planes) {
        EXPECT_EQ(right.find(plane.name)->values, plane.values) << a << " " << b << " " << plane.name;
        EXPECT_EQ(right.find(plane.name)->ids, plane.ids) << a << " " << b << " " << plane.name;
    }
}

} // namespace razor
