#include "razor/scene/models/gltf/materials.h"

#include "razor/scene/error.h"
#include "razor/scene/models/gltf/fields.h"
#include "razor/scene/models/gltf/uri.h"
#include "razor/scene/ranges.h"
#include "razor/scene/text_file.h"
#include "razor/scene/textures/picture.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace razor::gltf {
namespace {

Wrap to_wrap(int code) {
    return code == 33071 ? Wrap::clamp : code == 33648 ? Wrap::mirror : Wrap::repeat;
}

/// The file has v downwards: u' = o + R(-r) (s * u) there. With v = 1 - v' on both sides the turn is the
/// other way round, and a shift makes up for the origin's.
void set_transform(const Fields& transform, TextureMap& map) {
    const auto offset = transform.vector("offset", glm::vec2(0), texcoord_range);
    map.scale = transform.vector("scale", glm::vec2(1), texcoord_range);
    map.rotation = transform.number("rotation", 0, texcoord_range);
    const double c = std::cos(double{map.rotation}), s = std::sin(double{map.rotation});
    map.offset = {static_cast<float>(offset.x + s * map.scale.y),
                  static_cast<float>(1 - offset.y - c * map.scale.y)};
}

} // namespace

class MaterialReader::Impl {
public:
    Impl(const Document& document, const std::filesystem::path& folder, TextureCache& cache)
        : document_(document), folder_(folder), cache_(cache), lists_(Json::parse(document.appearance)) {}

    int use(int number) {
        if (number == none)
            return none;
        const auto [known, is_new] =
            materials_.try_emplace(number, static_cast<int>(result_.materials.size()));
        if (is_new)
            result_.materials.push_back(read(entry_of("materials", "material", number, "a mesh primitive")));
        return known->second;
    }
    ModelMaterials finish() {
        result_.notes.insert(result_.notes.end(), document_.notes->begin(), document_.notes->end());
        return std::move(result_);
    }

private:
    Fields entry_of(const char* list, const char* kind, int number, const std::string& user) const {
        return Fields(document_, &lists_, user).entry(list, kind, number);
    }

    Material read(const Fields& f) {
        constexpr Range weight = unit_range;
        Material m;
        m.name = f.text("name", f.what());
        const Fields pbr = f.object("pbrMetallicRoughness");
        const auto colour = pbr.vector("baseColorFactor", glm::vec4(1), weight);
        m.albedo = glm::vec3(colour);
        m.metallic = pbr.number("metallicFactor", 1, weight);
        m.roughness = pbr.number("roughnessFactor", 1, weight);
        m.specular = f.extension("KHR_materials_specular").number("specularFactor", 1, weight);
        m.ior = index_of_refraction(f);
        m.transmission = f.extension("KHR_materials_transmission").number("transmissionFactor", 0, weight);
        const Fields coat = f.extension("KHR_materials_clearcoat");
        m.coat = coat.number("clearcoatFactor", 0, weight);
        m.coat_roughness = coat.number("clearcoatRoughnessFactor", 0, weight);
        const Fields sheen = f.extension("KHR_materials_sheen");
        m.sheen = sheen.vector("sheenColorFactor", glm::vec3(0), weight);
        m.sheen_roughness =
            sheen.stated() ? sheen.number("sheenRoughnessFactor", 0, weight) : m.sheen_roughness;
        const Fields strength = f.extension("KHR_materials_emissive_strength");
        m.emission = f.vector("emissiveFactor", glm::vec3(0), weight) *
                     strength.number("emissiveStrength", 1, radiance_range);
        m.albedo_map = map(pbr.object("baseColorTexture"), false);
        m.metallic_map = m.roughness_map = map(pbr.object("metallicRoughnessTexture"), true);
        m.emission_map = map(f.object("emissiveTexture"), false);
        m.sheen_map = map(sheen.object("sheenColorTexture"), false);
        m.sheen_roughness_map = map_of_opacity(sheen.object("sheenRoughnessTexture"));
        m.normal_map = map(f.object("normalTexture"), true);
        m.normal_scale = f.object("normalTexture").number("scale", 1, normal_scale_range);
        set_opacity(f, colour.w, m);
        m.two_sided = f.flag("doubleSided") || m.transmission > 0;
        note_passed_over(f, m);
        return m;
    }

    /// 0 stands for a boundless one: the share that is reflected from the front is then specularColorFactor
    /// alone. What reflects as much as its largest colour does has another index.
    float index_of_refraction(const Fields& f) const {
        constexpr double any = std::numeric_limits<double>::max();
        const Fields extension = f.extension("KHR_materials_ior");
        if (extension.real("ior", 1.5, {-any, any}) != 0)
            return extension.number("ior", 1.5F, ior_range);
        const auto colour =
            f.extension("KHR_materials_specular").vector("specularColorFactor", glm::dvec3(1), unit_range);
        const double part = std::max({colour.x, colour.y, colour.z}), root = std::sqrt(part);
        const double ior = root < 1 ? (1 + root) / (1 - root) : any;
        if (ior > ior_range.most)
            document_.note(fmt::format("{}: ior of 0, which reflects {:.4g} of what comes from the front, is "
                                       "taken as {}, the nearest that there is",
                                       f.what(), part, ior_range.most));
        return static_cast<float>(std::min(ior, ior_range.most));
    }

    /// Textures of extensions: of these only the factors are read.
    void note_passed_over(const Fields& f, const Material& m) {
        static constexpr std::array<std::pair<const char*, const char*>, 7> unread{
            {{"KHR_materials_specular", "specularTexture"},
             {"KHR_materials_specular", "specularColorTexture"},
             {"KHR_materials_transmission", "transmissionTexture"},
             {"KHR_materials_volume", "thicknessTexture"},
             {"KHR_materials_clearcoat", "clearcoatTexture"},
             {"KHR_materials_clearcoat", "clearcoatRoughnessTexture"},
             {"KHR_materials_clearcoat", "clearcoatNormalTexture"}}};
        std::string found;
        for (const auto& [extension, texture] : unread)
            if (f.extension(extension).has(texture))
                found += fmt::format("{}{}", found.empty() ? "" : ", ", texture);
        if (!found.empty())
            result_.notes.push_back(fmt::format("{}: material '{}': textures that are passed over: {}",
                                                printable(document_.file, 1000), printable(m.name), found));
    }

    static void set_opacity(const Fields& f, float factor, Material& m) {
        const std::string mode = f.text("alphaMode", "OPAQUE");
        if (mode == "OPAQUE")
            return;
        const bool mask = mode == "MASK";
        const float cutoff = mask ? f.number("alphaCutoff", 0.5F, unit_range) : 0.5F;
        if (m.albedo_map.texture != none)
            m.alpha_cutoff = mask ? std::min(cutoff / std::max(factor, 1e-6F), 1.0F) : cutoff;
        if (!mask && factor < 1)
            m.transmission = std::max(m.transmission, 1 - factor);
    }

    TextureMap map(const Fields& info, bool linear) {
        TextureMap result;
        const Fields transform = info.extension("KHR_texture_transform");
        const int instead = transform.index("texCoord");
        if (!info.stated() || (instead == none ? info.index("texCoord") : instead) > 0)
            return result;
        result.texture = use_texture(info.index("index"), linear, info.what());
        if (transform.stated())
            set_transform(transform, result);
        return result;
    }

    /// Opacity is 1 of pictures that have none, and no map says the same.
    TextureMap map_of_opacity(const Fields& info) {
        const TextureMap result = map(info, false);
        const auto index = static_cast<std::size_t>(result.texture);
        return result.texture == none || result_.textures[index].pyramid->levels[0].opacity.empty()
                   ? TextureMap{}
                   : result;
    }

    int use_texture(int number, bool linear, const std::string& user) {
        const auto [known, is_new] =
            textures_.try_emplace({number, linear}, static_cast<int>(result_.textures.size()));
        if (!is_new)
            return known->second;
        const Fields f = entry_of("textures", "texture", number, user);
        if (f.index("source") == none)
            f.fail("has no image in PNG or JPEG");
        const int source = f.index("source"), sampler = f.index("sampler");
        const Fields image = entry_of("images", "image", source, f.what());
        Texture texture;
        texture.name = f.text("name", image.text("name", image.what()));
        texture.linear = linear;
        if (sampler != none) {
            const Fields s = entry_of("samplers", "sampler", sampler, f.what());
            texture.wrap_u = to_wrap(s.index("wrapS"));
            texture.wrap_v = to_wrap(s.index("wrapT"));
        }
        read_image(image, source, texture);
        result_.textures.push_back(std::move(texture));
        return known->second;
    }

    void read_image(const Fields& image, int number, Texture& texture) {
        const std::string uri = image.text("uri", "");
        if (!uri.empty() && !uri.starts_with("data:")) {
            const std::filesystem::path file = folder_ / path_of_uri(uri);
            texture.file = std::filesystem::absolute(file).lexically_normal().string();
            try {
                texture.pyramid = cache_.read(file, texture.linear);
            } catch (const UserError& error) {
                document_.fail(fmt::format("{}: {}", image.what(), error.what()));
            }
            return;
        }
        auto& pyramid = pyramids_[{number, texture.linear}];
        if (!pyramid) {
            const std::optional<std::string> data = data_of_uri(uri);
            if (!uri.empty() && !data)
                image.fail("has a data URI that is not in base64");
            pyramid = std::make_shared<const TexturePyramid>(
                decode_picture(data ? std::string_view(*data) : bytes_of(image),
                               fmt::format("{}: {}", document_.file, image.what()), texture.linear));
        }
        texture.pyramid = pyramid;
    }

    /// Those in its buffer view.
    std::string_view bytes_of(const Fields& image) const {
        const BufferView& view =
            entry(document_, document_.views, image.index("bufferView"), "buffer view", image.what());
        const auto& buffer = entry(document_, document_.buffers, view.buffer, "buffer", image.what());
        if (view.offset > buffer.size() || view.length > buffer.size() - view.offset)
            image.fail("reaches beyond the end of its buffer");
        return {reinterpret_cast<const char*>(buffer.data()) + view.offset, view.length};
    }

    const Document& document_;
    const std::filesystem::path folder_;
    TextureCache& cache_;
    Json lists_;
    ModelMaterials result_;
    std::map<int, int> materials_;                 // by number in the file
    std::map<std::pair<int, bool>, int> textures_; // by number, and whether linear
    std::map<std::pair<int, bool>, std::shared_ptr<const TexturePyramid>> pyramids_; // of images, likewise
};

MaterialReader::MaterialReader(const Document& document, const std::filesystem::path& folder,
                               TextureCache& cache)
    : impl_(std::make_unique<Impl>(document, folder, cache)) {}

MaterialReader::~MaterialReader() = default;

int MaterialReader::use(int material) {
    return impl_->use(material);
}

ModelMaterials MaterialReader::finish() {
    return impl_->finish();
}

} // namespace razor::gltf
