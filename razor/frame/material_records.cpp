#include "razor/frame/material_records.h"

#include "razor/frame/displacement.h"
#include "razor/frame/sheen_albedo.h"
#include "razor/scene/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace razor {
namespace {

MaterialRecord material_record(const Material& m) {
    MaterialRecord r{};
    for (int k = 0; k < 3; ++k) {
        r.albedo[k] = m.albedo[k];
        r.emission[k] = m.emission[k];
        r.sheen[k] = m.sheen[k];
    }
    r.metallic = m.metallic;
    r.roughness = m.roughness;
    r.specular = m.specular;
    const float bend = (m.ior - 1) / (m.ior + 1);
    r.normal_reflection = bend * bend;
    r.ior = m.ior;
    r.transmission = m.transmission;
    r.coat = m.coat;
    r.coat_roughness = m.coat_roughness;
    r.normal_scale = m.normal_scale;
    r.bump = m.bump;
    r.one_sided = is_one_sided(m) ? 1 : 0;
    const float rough = std::max(m.sheen_roughness, least_sheen_roughness);
    r.sheen_alpha = rough * rough;
    std::fill(std::begin(r.map), std::end(r.map), -1);
    r.displacement = -1;
    return r;
}

/// In the order of MaterialMap.
std::array<const TextureMap*, map_count> maps_of(const Material& m) {
    return {&m.albedo_map, &m.metallic_map, &m.roughness_map, &m.emission_map, &m.normal_map, &m.bump_map};
}

MapRecord map_record(const TextureMap& map, std::int32_t texture) {
    MapRecord r{};
    const float c = std::cos(map.rotation), s = std::sin(map.rotation);
    const std::array<float, 3> u{c * map.scale.x, -s * map.scale.y, map.offset.x};
    const std::array<float, 3> v{s * map.scale.x, c * map.scale.y, map.offset.y};
    std::copy(u.begin(), u.end(), r.row_u);
    std::copy(v.begin(), v.end(), r.row_v);
    r.texture = texture;
    return r;
}

constexpr std::int32_t wrap_of(Wrap wrap) {
    return wrap == Wrap::repeat ? wrap_repeat : wrap == Wrap::clamp ? wrap_clamp : wrap_mirror;
}

TextureRecord pattern_record(const Pattern& p) {
    TextureRecord r{};
    constexpr std::array kinds{texture_checker,    texture_bricks, texture_noise,
                               texture_turbulence, texture_marble, texture_wood};
    r.kind = kinds[static_cast<std::size_t>(p.kind)];
    r.space = p.space == PatternSpace::object ? texture_of_object : texture_of_surface;
    r.per_cell = static_cast<float>(1 / p.size);
    r.octaves = p.octaves;
    r.gain = p.gain;
    r.amount = p.amount;
    for (int k = 0; k < 3; ++k) {
        r.low[k] = p.low[k];
        r.high[k] = p.high[k];
    }
    return r;
}

class Tables {
public:
    explicit Tables(const Scene& scene)
        : scene_(scene), number_(scene.textures.size(), -1), heights_(number_) {
        t.sheen_albedo.assign(sheen_steps, 0.0F);
        t.sheens = scene.settings.everything;
    }

    void add(const Material& m, bool used) {
        MaterialRecord r = material_record(m);
        const auto maps = maps_of(m);
        bool texcoords = false, points = false;
        for (std::size_t k = 0; used && k < maps.size(); ++k)
            if (maps[k]->texture >= 0) {
                r.map[k] = static_cast<std::int32_t>(t.maps.size());
                t.maps.push_back(map_record(*maps[k], texture(maps[k]->texture)));
                r.map_bits |= 1 << k;
                const std::optional<Pattern>& pattern = pattern_of(*maps[k]);
                if (pattern && pattern->space == PatternSpace::object)
                    points = t.solid = true;
                else
                    texcoords = true;
            }
        if (r.map[map_albedo] >= 0 && m.alpha_cutoff > 0 && !pattern_of(m.albedo_map)) {
            const std::int32_t number = t.maps[static_cast<std::size_t>(r.map[map_albedo])].texture;
            add_opacity(m.albedo_map.texture, t.textures[static_cast<std::size_t>(number)]);
            r.alpha_cutoff = m.alpha_cutoff;
        }
        if (used && has_sheen(m))
            add_sheen(r);
        t.map_bits.push_back(r.map_bits);
        t.needs_texcoords.push_back(texcoords);
        t.needs_points.push_back(points);
        const double bound = used ? displacement_bound(scene_, static_cast<int>(t.materials.size())) : 0;
        t.displaced.push_back(bound > 0);
        if (bound > 0) {
            r.displacement = static_cast<std::int32_t>(t.displacements.size());
            add_displacement(m, bound);
        }
        t.materials.push_back(r);
    }

    void add_displacement(const Material& m, double bound) {
        DisplacementRecord d{};
        d.scale = m.displacement_scale;
        d.midlevel = m.displacement_midlevel;
        d.bound = static_cast<float>(bound);
        d.map = static_cast<std::int32_t>(t.maps.size());
        const Texture& texture = scene_.textures[static_cast<std::size_t>(m.displacement_map.texture)];
        t.maps.push_back(map_record(m.displacement_map,
                                    texture.pattern ? this->texture(m.displacement_map.texture)
                                                    : heights(m.displacement_map.texture, *texture.heights)));
        const MapRecord& map = t.maps.back();
        const TextureRecord& record = t.textures[static_cast<std::size_t>(map.texture)];
        const float size = texture.pattern ? record.per_cell : record.size;
        d.footprint = std::abs(map.row_u[0] * map.row_v[1] - map.row_u[1] * map.row_v[0]) * (size * size);
        const float scale = std::abs(m.displacement_scale);
        const HeightRange range = height_range(texture);
        d.range = scale * (range.most - range.least);
        const std::vector<HeightSlopes> slopes = height_slopes(texture);
        for (std::size_t l = 0; l < slopes.size(); ++l) {
            d.slope_u[l] = scale * slopes[l].u;
            d.slope_v[l] = scale * slopes[l].v;
        }
        t.displacements.push_back(d);
    }

    /// Around the horizon it goes on where it ends, at the poles it does not, whatever its texture has
    /// elsewhere.
    void add_sky(const SkyMap& sky) {
        TextureRecord r = t.textures[static_cast<std::size_t>(texture(sky.texture))];
        r.wrap_u = wrap_repeat;
        r.wrap_v = wrap_clamp;
        t.sky_map = static_cast<std::int32_t>(t.maps.size());
        t.maps.push_back(map_record(TextureMap{}, static_cast<std::int32_t>(t.textures.size())));
        t.textures.push_back(r);
    }

    MaterialTables t;

private:
    const std::optional<Pattern>& pattern_of(const TextureMap& map) const {
        return scene_.textures[static_cast<std::size_t>(map.texture)].pattern;
    }

    std::int32_t texture(int index) {
        const Texture& texture = scene_.textures[static_cast<std::size_t>(index)];
        std::int32_t& number = number_[static_cast<std::size_t>(index)];
        if (texture.pattern && number < 0) {
            number = static_cast<std::int32_t>(t.textures.size());
            t.textures.push_back(pattern_record(*texture.pattern));
        }
        if (texture.pattern)
            return number;
        return pyramid(number, texture, *texture.pyramid);
    }
    std::int32_t heights(int index, const TexturePyramid& of) {
        return pyramid(heights_[static_cast<std::size_t>(index)],
                       scene_.textures[static_cast<std::size_t>(index)], of);
    }
    std::int32_t pyramid(std::int32_t& number, const Texture& texture, const TexturePyramid& of) {
        if (number >= 0)
            return number;
        number = static_cast<std::int32_t>(t.textures.size());
        const std::vector<TextureLevel>& levels = of.levels;
        TextureRecord r{};
        r.levels = static_cast<std::int32_t>(levels.size());
        r.wrap_u = wrap_of(texture.wrap_u);
        r.wrap_v = wrap_of(texture.wrap_v);
        r.size = std::sqrt(static_cast<float>(levels[0].width) * static_cast<float>(levels[0].height));
        for (std::size_t l = 0; l < levels.size(); ++l) {
            r.width[l] = levels[l].width;
            r.height[l] = levels[l].height;
            r.first[l] = static_cast<std::int32_t>(t.texels);
            add_words(levels[l].texels);
        }
        t.textures.push_back(r);
        return number;
    }

    /// Tables of one width are made once.
    void add_sheen(MaterialRecord& r) {
        t.sheens = true;
        const auto [known, is_new] =
            sheens_.try_emplace(r.sheen_alpha, static_cast<std::int32_t>(t.sheen_albedo.size()));
        if (is_new) {
            const std::vector<float> table = sheen_albedo(r.sheen_alpha);
            t.sheen_albedo.insert(t.sheen_albedo.end(), table.begin(), table.end());
        }
        r.sheen_table = known->second;
    }

    void add_words(const std::vector<std::uint32_t>& words) {
        t.texels += words.size();
        t.words.push_back(&words);
        if (t.texels > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
            throw UserError(
                fmt::format("{}: the textures have more than 2^31 texels together; make some of them smaller",
                            scene_.name));
    }
    /// Behind everything: levels follow each other as their texels do, so one distance serves them all.
    void add_opacity(int texture, TextureRecord& r) {
        const std::vector<TextureLevel>& levels =
            scene_.textures[static_cast<std::size_t>(texture)].pyramid->levels;
        if (r.opacity != 0 || levels[0].opacity.empty())
            return;
        t.cutouts = true;
        r.opacity = static_cast<std::int32_t>(t.texels) - r.first[0];
        for (const TextureLevel& level : levels)
            add_words(level.opacity);
    }

    const Scene& scene_;
    std::vector<std::int32_t> number_, heights_; // of each texture, its records
    std::map<float, std::int32_t> sheens_;       // by width
};

} // namespace

MaterialTables tabulate_materials(const Scene& scene, const std::vector<bool>& used, bool by_face) {
    Tables tables(scene);
    const bool all = scene.settings.everything;
    bool glossy = all || scene.settings.diffuse_bounces > 0, mapped = all || by_face;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& m = scene.materials[i];
        tables.add(m, used[i]);
        tables.t.one_sided = tables.t.one_sided || (used[i] && is_one_sided(m));
        glossy = glossy || (used[i] && !(is_matte(m) && m.emission == glm::vec3(0)));
        mapped = mapped || tables.t.map_bits.back() != 0;
    }
    if (scene.sky_map.texture >= 0) {
        tables.add_sky(scene.sky_map);
        mapped = true;
    }
    tables.t.look = glossy ? (mapped ? look_glossy_mapped : look_glossy) : mapped ? look_mapped : look_matte;
    return std::move(tables.t);
}

} // namespace razor
