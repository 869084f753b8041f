#include "tests/materials/parts.h"

#include "razor/native/render.h"

namespace razor::test {

Parts parts_of(Scene scene, int seeds, const std::string& target) {
    Parts all;
    std::vector<glm::dvec3> squares(16, glm::dvec3(0));
    for (int seed = 0; seed < seeds; ++seed) {
        scene.settings.seed = seed;
        RenderOptions options;
        options.threads = 2;
        options.isa = target;
        const Film film = render_native(scene, options).film;
        std::vector<glm::dvec3> one(16, glm::dvec3(0));
        const int width = scene.settings.width, height = scene.settings.height;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const auto p = static_cast<std::size_t>(y * width + x);
                one[static_cast<std::size_t>(y * 4 / height * 4 + x * 4 / width)] +=
                    glm::dvec3(film.find("R")->values[p], film.find("G")->values[p],
                               film.find("B")->values[p]) *
                    (16.0 / (width * height));
            }
        for (std::size_t k = 0; k < 16; ++k) {
            all.mean[k] += one[k] / double(seeds);
            squares[k] += one[k] * one[k] / double(seeds);
        }
    }
    for (std::size_t k = 0; k < 16; ++k)
        all.variance[k] = (squares[k] - all.mean[k] * all.mean[k]) / double(seeds - 1);
    return all;
}

} // namespace razor::test
