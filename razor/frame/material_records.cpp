#include "razor/frame/material_records.h"

#include "razor/frame/displacement.h"
#include "razor/frame/sheen_albedo.h"
#include "razor/frame/sheen_roughness.h"
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
    std::fill(std::begin(r.map), std::end(r.map), -1);
    r.displacement = -1;
    return r;
}

/// In the order of MaterialMap.
std::array<const TextureMap*, map_sheen> maps_of(const Material& m) {
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

/// The words of whose levels follow each other from there on.
TextureRecord picture_record(const Texture& texture, const TexturePyramid& of, std::size_t first) {
    const std::vector<TextureLevel>& levels = of.levels;
    TextureRecord r{};
    r.levels = static_cast<std::int32_t>(levels.size());
    r.wrap_u = wrap_of(texture.wrap_u);
    r.wrap_v = wrap_of(texture.wrap_v);
    r.size = std::sqrt(static_cast<float>(levels[0].width) * static_cast<float>(levels[0].height));
    for (std::size_t l = 0; l < levels.size(); ++l) {
        r.width[l] = levels[l].width;
        r.height[l] = levels[l].height;
        r.first[l] = static_cast<std::int32_t>(first);
        first += levels[l].texels.size();
    }
    return r;
}

class Tables {
public:
    explicit Tables(const Scene& scene)
        : scene_(scene), number_(scene.textures.size(), -1), heights_(number_), opacities_(number_),
          opacity_words_(number_) {
        t.sheen_records.resize(1);
        t.sheen_records[0].alpha = 1;
        std::fill(std::begin(t.sheen_records[0].map), std::end(t.sheen_records[0].map), -1);
        t.sheen_albedo.assign(sheen_steps, 0.0F);
        t.sheens = scene.settings.everything ? sheen_rows : sheen_none;
    }

    void add(const Material& m, bool used) {
        MaterialRecord r = material_record(m);
        const auto maps = maps_of(m);
        t.needs_texcoords.push_back(false);
        t.needs_points.push_back(false);
        for (std::size_t k = 0; used && k < maps.size(); ++k)
            if (maps[k]->texture >= 0) {
                r.map[k] = add_map(*maps[k], texture(maps[k]->texture));
                r.map_bits |= 1 << k;
            }
        if (r.map[map_albedo] >= 0 && m.alpha_cutoff > 0 && !pattern_of(m.albedo_map)) {
            const std::int32_t number = t.maps[static_cast<std::size_t>(r.map[map_albedo])].texture;
            add_opacity(m.albedo_map.texture, t.textures[static_cast<std::size_t>(number)]);
            r.alpha_cutoff = m.alpha_cutoff;
        }
        if (used && has_sheen(m))
            add_sheen(m, r);
        t.map_bits.push_back(r.map_bits);
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
    /// Of the material that is added.
    std::int32_t add_map(const TextureMap& map, std::int32_t texture) {
        const std::optional<Pattern>& pattern = pattern_of(map);
        if (pattern && pattern->space == PatternSpace::object)
            t.needs_points.back() = t.solid = true;
        else
            t.needs_texcoords.back() = true;
        t.maps.push_back(map_record(map, texture));
        return static_cast<std::int32_t>(t.maps.size() - 1);
    }

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
        t.textures.push_back(picture_record(texture, of, t.texels));
        for (const TextureLevel& level : of.levels)
            add_words(level.texels);
        return number;
    }
    /// Of a picture's opacity, as of others' colours.
    std::int32_t opacity(int index) {
        const Texture& texture = scene_.textures[static_cast<std::size_t>(index)];
        std::int32_t& number = opacities_[static_cast<std::size_t>(index)];
        if (number < 0) {
            number = static_cast<std::int32_t>(t.textures.size());
            t.textures.push_back(
                picture_record(texture, *texture.pyramid, static_cast<std::size_t>(opacity_words(index))));
        }
        return number;
    }

    void add_sheen(const Material& m, MaterialRecord& of) {
        SheenRecord r{};
        for (int k = 0; k < 3; ++k)
            r.colour[k] = m.sheen[k];
        std::fill(std::begin(r.map), std::end(r.map), -1);
        SheenUse use = sheen_plain;
        if (m.sheen_map.texture >= 0) {
            r.map[0] = add_map(m.sheen_map, texture(m.sheen_map.texture));
            of.map_bits |= map_bit(map_sheen);
            use = sheen_mapped;
        }
        const auto rough = [](float roughness) { return std::clamp(roughness, least_sheen_roughness, 1.0F); };
        float least = rough(m.sheen_roughness), most = least;
        const int index = m.sheen_roughness_map.texture;
        if (index >= 0) {
            const Texture& texture = scene_.textures[static_cast<std::size_t>(index)];
            const RoughnessRange range = sheen_roughness_range(texture);
            least = rough(m.sheen_roughness * range.least);
            most = rough(m.sheen_roughness * range.most);
            if (least < most) { // else it is as if it had no map
                r.map[1] = add_map(m.sheen_roughness_map,
                                   has_roughness_in_opacity(texture) ? opacity(index) : this->texture(index));
                of.map_bits |= map_bit(map_sheen_roughness);
                use = sheen_rows;
            }
        }
        r.roughness = least < most ? m.sheen_roughness : least;
        r.alpha = least * least;
        set_albedo(least, most, r);
        t.sheens = std::max(t.sheens, use);
        of.sheen = static_cast<std::int32_t>(t.sheen_records.size()) * sheen_stride;
        t.sheen_records.push_back(r);
    }
    /// Tables of the same roughnesses are made once.
    void set_albedo(float least, float most, SheenRecord& r) {
        const auto [known, is_new] = sheens_.try_emplace({least, most});
        SheenRows& rows = known->second.rows;
        if (is_new) {
            rows = least < most ? sheen_albedo_rows(least, most) : SheenRows{sheen_albedo(r.alpha)};
            known->second.first = static_cast<std::int32_t>(t.sheen_albedo.size());
            t.sheen_albedo.insert(t.sheen_albedo.end(), rows.albedo.begin(), rows.albedo.end());
        }
        r.table = known->second.first;
        r.first_root = rows.first_root;
        r.per_root = rows.per_root;
        r.last_row = static_cast<float>(rows.last);
    }

    void add_words(const std::vector<std::uint32_t>& words) {
        t.texels += words.size();
        t.words.push_back(&words);
        if (t.texels > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
            throw UserError(
                fmt::format("{}: the textures have more than 2^31 texels together; make some of them smaller",
                            scene_.name));
    }
    /// Levels follow each other as their texels do, so one distance serves them all.
    void add_opacity(int texture, TextureRecord& r) {
        if (r.opacity != 0 ||
            scene_.textures[static_cast<std::size_t>(texture)].pyramid->levels[0].opacity.empty())
            return;
        t.cutouts = true;
        r.opacity = opacity_words(texture) - r.first[0];
    }
    /// The first of them, behind everything that was there.
    std::int32_t opacity_words(int texture) {
        std::int32_t& first = opacity_words_[static_cast<std::size_t>(texture)];
        if (first < 0) {
            first = static_cast<std::int32_t>(t.texels);
            for (const TextureLevel& level :
                 scene_.textures[static_cast<std::size_t>(texture)].pyramid->levels)
                add_words(level.opacity);
        }
        return first;
    }

    const Scene& scene_;
    std::vector<std::int32_t> number_, heights_, opacities_; // of each texture, its records
    std::vector<std::int32_t> opacity_words_;                // and the first of these words
    struct Albedo {
        SheenRows rows;
        std::int32_t first = 0;
    };
    std::map<std::pair<float, float>, Albedo> sheens_; // by the least and the most roughness
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
