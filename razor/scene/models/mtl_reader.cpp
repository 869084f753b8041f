#include "razor/scene/models/mtl_reader.h"

#include "razor/scene/error.h"
#include "razor/scene/models/obj_cursor.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace razor {
namespace {

/// A map statement: options, then a file's name, which may hold blanks.
struct MapStatement {
    std::string file;
    std::int64_t line = 0;
    glm::vec2 scale{1, 1}, offset{0, 0};
    bool clamp = false;
};

/// What a library says of one material.
struct Statement {
    std::string name;
    std::optional<glm::vec3> kd, ks, ke;
    std::optional<double> ns, ni, d, pr, pm, pc, pcr, ps;
    std::optional<std::int64_t> illum;
    std::optional<MapStatement> map_kd, map_ke, map_pr, map_pm, map_d, norm;
};

bool is_black(const glm::vec3& colour) {
    return colour == glm::vec3(0);
}

std::optional<double> to_number(std::string_view word) {
    double value = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || stop != word.data() + word.size() || !std::isfinite(value))
        return std::nullopt;
    return value;
}

/// Takes the first word off.
std::string_view take_word(std::string_view& text) {
    const std::string_view word = text.substr(0, text.find_first_of(" \t"));
    text.remove_prefix(word.size());
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    return word;
}

/// Up to three numbers, of which the first two count.
void take_numbers(std::string_view& text, glm::vec2& values) {
    for (int i = 0; i < 3; ++i) {
        std::string_view behind = text;
        const std::optional<double> number = to_number(take_word(behind));
        if (!number || behind.empty())
            return;
        if (i < 2)
            values[i] = static_cast<float>(*number);
        text = behind;
    }
}

MapStatement parse_map(std::string_view text, std::int64_t line) {
    MapStatement map;
    map.line = line;
    while (text.starts_with('-')) {
        const std::string_view option = take_word(text);
        if (option == "-s") {
            take_numbers(text, map.scale);
        } else if (option == "-o") {
            take_numbers(text, map.offset);
        } else if (option == "-clamp") {
            map.clamp = take_word(text) == "on";
        } else if (option == "-t") {
            glm::vec2 turbulence{};
            take_numbers(text, turbulence);
        } else if (option == "-mm") {
            take_word(text);
            take_word(text);
        } else { // of one value each: -blendu, -blendv, -bm, -boost, -cc, -imfchan, -texres, -type
            take_word(text);
        }
    }
    map.file = text;
    return map;
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
        const std::pair<std::string_view, std::optional<MapStatement>*> maps[] = {
            {"map_Kd", &s.map_kd}, {"map_Ke", &s.map_ke}, {"map_Pr", &s.map_pr},
            {"map_Pm", &s.map_pm}, {"map_d", &s.map_d},   {"norm", &s.norm},
        };
        for (const auto& [name, value] : numbers)
            if (name == keyword)
                *value = read_number(keyword);
        for (const auto& [name, value] : colours)
            if (name == keyword)
                *value = read_colour(keyword);
        for (const auto& [name, value] : maps)
            if (name == keyword)
                read_map(*value);
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

    void read_map(std::optional<MapStatement>& map) {
        const std::int64_t line = cursor_.line();
        MapStatement stated = parse_map(cursor_.rest(), line);
        if (!stated.file.empty())
            map = std::move(stated);
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
        if (s.norm)
            m.normal_map = use(*s.norm, true);
    }

    TextureMap use(const MapStatement& map, bool linear) {
        Texture texture;
        const std::filesystem::path file = find_beside(folder_, map.file);
        if (file.empty())
            library_.fail_at(map.line, fmt::format("the texture '{}' is not there; put it beside the library",
                                                   printable(map.file, 200)));
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
