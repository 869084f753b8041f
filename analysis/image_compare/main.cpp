// razor-image-compare A B: 0 where the pictures are identical bit for bit, 1 where they differ, 2 on a
// mistake.
#include "analysis/image_compare/compare.h"

#include <fmt/format.h>

#include <cstdio>
#include <string_view>

int main(int argc, char** argv) {
    if (argc == 2 && std::string_view(argv[1]) == "--help") {
        fmt::print("razor-image-compare A B: compares two OpenEXR or PNG pictures bit for bit\n"
                   "Exit code 0: identical; 1: different; 2: a picture cannot be read.\n");
        return 0;
    }
    if (argc != 3) {
        fmt::print(stderr, "razor-image-compare: give two pictures: razor-image-compare A B\n");
        return 2;
    }
    try {
        const analysis::Comparison result =
            analysis::compare(analysis::read_image(argv[1]), analysis::read_image(argv[2]));
        fmt::print("{}", result.report);
        return result.identical ? 0 : 1;
    } catch (const std::exception& error) {
        fmt::print(stderr, "razor-image-compare: {}\n", error.what());
        return 2;
    }
}
