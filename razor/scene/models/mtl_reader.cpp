#include "razor/scene/models/mtl_reader.h"

#include "razor/scene/error.h"
#include "razor/scene/models/mtl_map.h"
#include "razor/scene/models/obj_cursor.h"
#include "razor/scene/ranges.h"
#include "razor/scene/text_file.h"
#include "razor/scene/textures/shared_exponent.h"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace razor {
namespace {

/// What a library says of one material.
struct Statement {
    std::string name;
    std::optional<glm::vec3> kd, ks, ke;
    std::optional<double> ns, ni, d, pr, pm, pc, pcr, ps;
    std::optional<std::int64_t> illum;
    std::optional<MtlMap> map_kd, map_ke, map_pr, map_pm, map_ps, map_d, norm, bump, disp;
};

bool is_black(const glm::vec3& colour) {
    return colour == glm::vec3(0);
}

float part(double value) {
    return static_cast<float>(std::clamp(value, 0.0, 1.0));
}

class LibraryParser {
public:
    LibraryParser(std::string_view text, std::string_view file_name) : cursor_(text, file_name) {}

    std::vector<Statement> read() {
        for (; !cursor_.at_end(); cursor_.next_statement()) {
            const std::string_view keyword = cursor_.word();
            if (keyword == "newmtl")
                statements_.emplace_back().name = cursor_.rest();
            else if (!keyword.empty() && !statements_.empty())
                read_field(keyword, statements_.back());
        }
        return std::move(statements_);
    }
    [[noreturn]] void fail_at(std::int64_t line, std::string_view message) const {
        cursor_.fail_at(line, message);
    }

private:
    void read_field(std::string_view keyword, Statement& s) {
        const std::pair<std::string_view, std::optional<double>*> numbers[] = {
            {"Ns", &s.ns}, {"Ni", &s.ni}, {"Pr", &s.pr},   {"Pm", &s.pm},
            {"Pc", &s.pc}, {"d", &s.d},   {"Pcr", &s.pcr}, {"Ps", &s.ps},
        };
        const std::pair<std::string_view, std::optional<glm::vec3>*> colours[] = {
            {"Kd", &s.kd}, {"Ks", &s.ks}, {"Ke", &s.ke}};
        using Use = MtlMapUse;
        const std::tuple<std::string_view, Use, std::optional<MtlMap>*> maps[] = {
            {"map_Kd", Use::colour, &s.map_kd},   {"map_Ke", Use::colour, &s.map_ke},
            {"map_Pr", Use::scalar, &s.map_pr},   {"map_Pm", Use::scalar, &s.map_pm},
            {"map_Ps", Use::scalar, &s.map_ps},   {"map_d", Use::scalar, &s.map_d},
            {"norm", Use::colour, &s.norm},       {"bump", Use::bump, &s.bump},
            {"map_bump", Use::bump, &s.bump},     {"map_Bump", Use::bump, &s.bump},
            {"disp", Use::displacement, &s.disp},
        };
        for (const auto& [name, value] : numbers)
            if (name == keyword)
                *value = read_number(keyword);
        for (const auto& [name, value] : colours)
            if (name == keyword)
                *value = read_colour(keyword);
        for (const auto& [name, use, value] : maps)
            if (name == keyword)
                read_map(use, *value);
        if (keyword == "Tr")
            s.d = 1 - read_number(keyword);
        if (keyword == "illum")
            s.illum = cursor_.integer(keyword);
    }

    /// `d -halo factor` among them.
    double read_number(std::string_view what) {
        std::string_view word = cursor_.word();
        if (word == "-halo")
            word = cursor_.word();
        if (word.empty())
            cursor_.fail(fmt::format("{} is missing; write a number", what));
        return cursor_.to_number(word, what);
    }

    /// One number stands for all three.
    glm::vec3 read_colour(std::string_view what) {
        glm::vec3 colour(static_cast<float>(read_number(what)));
        for (int c = 1; c < 3 && !cursor_.at_statement_end(); ++c)
            colour[c] = static_cast<float>(read_number(what));
        return glm::clamp(colour, 0.0F, 1e9F);
    }

    void read_map(MtlMapUse use, std::optional<MtlMap>& map) {
        const std::int64_t line = cursor_.line();
        const std::string_view text = cursor_.rest();
        try {
            MtlMap stated = parse_mtl_map(text, use, line);
            if (!stated.file.empty())
                map = std::move(stated);
        } catch (const UserError& error) {
            cursor_.fail_at(line, error.what());
        }
    }

    ObjCursor cursor_;
    std::vector<Statement> statements_;
};

/// Makes a material of a statement, and textures of its maps.
class Converter {
public:
    Converter(const LibraryParser& library, const std::filesystem::path& folder, TextureCache& cache,
              ModelMaterials& result)
        : library_(library), folder_(folder), cache_(cache), result_(result) {}

    Material convert(const Statement& s) {
        Material m;
        m.name = s.name;
        set_phong(s, m);
        if (s.pm || s.pr) {
            m.specular = s.ks && is_black(*s.ks) ? 0.0F : 1.0F;
            m.metallic = part(s.pm.value_or(0));
        }
        if (s.pr)
            m.roughness = part(*s.pr);
        m.coat = part(s.pc.value_or(0));
        m.coat_roughness = part(s.pcr.value_or(0));
        m.sheen = glm::vec3(part(s.ps.value_or(0)));
        set_maps(s, m);
        return m;
    }

    /// After all: which options were not read, or nothing.
    std::string note() const {
        constexpr std::size_t shown = 4;
        std::string text;
        for (std::size_t i = 0; i < std::min(passed_over_.size(), shown); ++i)
            text += (i > 0 ? ", " : "") + passed_over_[i];
        if (passed_over_.size() > shown)
            text += fmt::format(" and {} more", passed_over_.size() - shown);
        return text;
    }

private:
    static void set_phong(const Statement& s, Material& m) {
        const glm::vec3 ks = glm::min(s.ks.value_or(glm::vec3(0)), 1.0F);
        const double ns = s.ns.value_or(0), opacity = part(s.d.value_or(1));
        const std::int64_t illum = s.illum.value_or(2);
        m.albedo = s.kd ? glm::min(*s.kd, 1.0F) : m.albedo;
        m.emission = s.ke.value_or(glm::vec3(0));
        if (illum >= 2 && !is_black(ks) && ns > 0)
            m.specular = 1;
        if (ns > 0)
            m.roughness = part(std::sqrt(std::sqrt(2 / (ns + 2))));
        if (s.ni && *s.ni > 1)
            m.ior = static_cast<float>(std::min(*s.ni, 3.0));
        if (opacity < 1) {
            m.transmission = static_cast<float>(1 - opacity);
            m.specular = 1;
            m.ior = static_cast<float>(std::clamp(s.ni.value_or(1.5), 1.0, 3.0));
            m.roughness = s.ns ? m.roughness : 0.0F;
        } else if ((illum == 3 || illum == 5) && !is_black(ks)) {
            m.metallic = 1;
            m.roughness = 0;
            m.albedo = ks;
        }
    }

    void set_maps(const Statement& s, Material& m) {
        if (s.map_kd) {
            m.albedo_map = use(*s.map_kd, false);
            m.albedo = is_black(m.albedo) ? glm::vec3(1) : m.albedo;
            if (!s.kd)
                m.albedo = glm::vec3(1);
            if (s.map_d && s.map_d->file == s.map_kd->file)
                m.alpha_cutoff = 0.5F;
        }
        if (s.map_ke) {
            m.emission_map = use(*s.map_ke, false);
            m.emission = is_black(m.emission) ? glm::vec3(1) : m.emission;
        }
        if (s.map_pm) {
            m.metallic_map = use(*s.map_pm, true);
            m.metallic = m.metallic == 0 ? 1 : m.metallic;
            m.specular = 1;
        }
        if (s.map_pr) {
            m.roughness_map = use(*s.map_pr, true);
            m.roughness = s.pr && *s.pr > 0 ? m.roughness : 1;
            m.specular = 1;
        }
        if (s.map_ps) {
            m.sheen_map = use(*s.map_ps, true);
            m.sheen = has_sheen(m) ? m.sheen : glm::vec3(1);
        }
        if (s.bump)
            set_bump(*s.bump, m);
        if (s.norm)
            m.normal_map = use(*s.norm, true);
        if (s.disp && s.disp->gain != 0) {
            m.displacement_map = use(*s.disp, true);
            m.displacement_scale = static_cast<float>(s.disp->gain);
            m.displacement_midlevel = static_cast<float>(-s.disp->base / s.disp->gain);
            read_heights(*s.disp, result_.textures[static_cast<std::size_t>(m.displacement_map.texture)]);
        }
    }

    /// Normals that somebody wrote as a bump map have heights of nothing.
    void set_bump(const MtlMap& map, Material& m) {
        const TextureMap used = use(map, true);
        const TexturePyramid& pyramid = *result_.textures[static_cast<std::size_t>(used.texture)].pyramid;
        const double height = map.bump * map.gain;
        if (holds_normals(pyramid)) {
            m.normal_map = used;
            m.normal_scale =
                static_cast<float>(std::clamp(height, normal_scale_range.least, normal_scale_range.most));
        } else if (height != 0) {
            m.bump_map = used;
            m.bump = static_cast<float>(height);
        }
    }
    static bool holds_normals(const TexturePyramid& pyramid) {
        const glm::vec3 mean = unpack_shared_exponent(pyramid.levels.back().texels.front());
        return std::abs(mean.x - 0.5F) < 0.1F && std::abs(mean.y - 0.5F) < 0.1F && mean.z > 0.75F;
    }

    void read_heights(const MtlMap& map, Texture& texture) {
        try {
            texture.heights = cache_.read(texture.file, true, Texels::heights);
        } catch (const UserError& error) {
            library_.fail_at(map.line, error.what());
        }
    }

    TextureMap use(const MtlMap& map, bool linear) {
        for (const std::string& option : map.passed_over)
            passed_over_.push_back(fmt::format("{} (line {})", printable(option), map.line));
        Texture texture;
        const std::filesystem::path file = find_beside(folder_, map.file);
        std::error_code error;
        if (file.empty())
            library_.fail_at(map.line, fmt::format("the texture '{}' is {}", printable(map.file, 200),
                                                   std::filesystem::is_directory(folder_ / map.file, error)
                                                       ? "a directory; name a picture"
                                                       : "not there; put it beside the library"));
        texture.name = file.stem().string();
        texture.file = std::filesystem::absolute(file).lexically_normal().string();
        texture.linear = linear;
        texture.wrap_u = texture.wrap_v = map.clamp ? Wrap::clamp : Wrap::repeat;
        auto& textures = result_.textures;
        auto known = std::find_if(textures.begin(), textures.end(), [&](const Texture& t) {
            return t.file == texture.file && t.linear == linear && t.wrap_u == texture.wrap_u;
        });
        if (known == textures.end()) {
            try {
                texture.pyramid = cache_.read(texture.file, linear);
            } catch (const UserError& error) {
                library_.fail_at(map.line, error.what());
            }
            known = textures.insert(textures.end(), std::move(texture));
        }
        return {
            .texture = static_cast<int>(known - textures.begin()), .scale = map.scale, .offset = map.offset};
    }

    const LibraryParser& library_;
    const std::filesystem::path& folder_;
    TextureCache& cache_;
    ModelMaterials& result_;
    std::vector<std::string> passed_over_;
};

} // namespace

MtlReader::MtlReader(const std::vector<std::string>& wanted, TextureCache& textures)
    : wanted_(wanted), textures_(textures) {}

void MtlReader::read(const std::filesystem::path& file) {
    const std::string text = read_text_file(file, "an MTL file");
    LibraryParser library(text, file.string());
    const std::vector<Statement> statements = library.read();
    const std::filesystem::path folder = file.parent_path();
    Converter converter(library, folder, textures_, result_);
    for (const Statement& statement : statements) {
        const auto is_known = [&](const Material& m) { return m.name == statement.name; };
        if (std::find(wanted_.begin(), wanted_.end(), statement.name) != wanted_.end() &&
            std::none_of(result_.materials.begin(), result_.materials.end(), is_known))
            result_.materials.push_back(converter.convert(statement));
    }
    if (const std::string passed_over = converter.note(); !passed_over.empty())
        result_.notes.push_back(fmt::format("{}: options of maps that are passed over: {}",
                                            printable(file.string(), 1000), passed_over));
}

std::filesystem::path find_beside(const std::filesystem::path& folder, std::string_view name) {
    std::string with_slashes(name);
    std::replace(with_slashes.begin(), with_slashes.end(), '\\', '/');
    const std::filesystem::path candidates[] = {folder / std::string(name), folder / with_slashes,
                                                folder / std::filesystem::path(with_slashes).filename()};
    for (const std::filesystem::path& file : candidates) {
        std::error_code error;
        if (!name.empty() && std::filesystem::is_regular_file(file, error))
            return file;
    }
    return {};
}

} // namespace razor
