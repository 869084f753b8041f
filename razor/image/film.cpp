#include "razor/image/image.h"

#include <algorithm>

namespace razor {

double Plane::at(std::size_t pixel) const {
    if (ids.empty())
        return double{values[pixel]};
    return ids[pixel] == no_id ? -1.0 : static_cast<double>(ids[pixel]);
}

Plane& Film::add(std::string_view name) {
    return planes.emplace_back(Plane{std::string(name), std::vector<float>(pixel_count())});
}

Plane& Film::add_ids(std::string_view name) {
    return planes.emplace_back(
        Plane{std::string(name), {}, std::vector<std::uint32_t>(pixel_count(), no_id)});
}

const Plane* Film::find(std::string_view name) const {
    const auto found =
        std::find_if(planes.begin(), planes.end(), [&](const Plane& plane) { return plane.name == name; });
    return found == planes.end() ? nullptr : &*found;
}

Plane* Film::find(std::string_view name) {
    return const_cast<Plane*>(std::as_const(*this).find(name));
}

Film make_film(int width, int height) {
    Film film(width, height);
    for (const char* name :
         {"R", "G", "B", "normal.X", "normal.Y", "normal.Z", "depth.Z", "albedo.R", "albedo.G", "albedo.B"}) {
        film.add(name);
    }
    return film;
}

} // namespace razor
