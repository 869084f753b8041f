#include "razor/api/mesh_file.h"

#include "razor/frame/diced_mesh.h"
#include "razor/image/output_file.h"
#include "razor/native/targets.h"
#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <iterator>
#include <map>
#include <vector>

namespace razor::api {
namespace {

/// Names in OBJ files end at blanks.
std::string word(const std::string& name) {
    std::string text = name.empty() ? "mesh" : name;
    for (char& c : text)
        if (static_cast<unsigned char>(c) <= ' ' || c == 0x7f)
            c = '_';
    return text;
}

void stop_if(const std::atomic<bool>* cancel) {
    if (cancel != nullptr && cancel->load())
        throw Cancelled();
}

/// Texts are written as they grow, so that a mesh is in memory once.
class Writer {
public:
    Writer(const std::string& path, const std::atomic<bool>* cancel) : cancel_(cancel), file_(path) {}
    template <class... Values> void line(fmt::format_string<Values...> form, Values&&... values) {
        fmt::format_to(std::back_inserter(text_), form, std::forward<Values>(values)...);
        text_.push_back('\n');
        if (text_.size() > 1 << 20)
            flush();
    }
    void commit() {
        flush();
        file_.commit();
    }

private:
    void flush() {
        stop_if(cancel_);
        file_.write(text_.data(), text_.size());
        text_.clear();
    }
    const std::atomic<bool>* cancel_;
    OutputFile file_;
    fmt::memory_buffer text_;
};

} // namespace

MeshFigures write_mesh_file(const std::filesystem::path& file, const razor::Scene& scene,
                            const std::string& isa, const std::atomic<bool>* cancel) {
    Frame frame(scene, {});
    stop_if(cancel);
    frame.dice_all(native_target(isa));
    stop_if(cancel);
    const std::vector<DicedInstance> objects = diced_mesh(frame, [&] { stop_if(cancel); });

    Writer out(file.string(), cancel);
    out.line("# razor {}: {}, as its camera sees it", version(), word(scene.name));
    std::map<std::string, int> used;
    MeshFigures written;
    long long normals = 0;
    for (const DicedInstance& object : objects) {
        const std::string name = word(scene.meshes[static_cast<std::size_t>(object.mesh)].name);
        const int number = ++used[name];
        out.line("o {}", number == 1 ? name : fmt::format("{}.{}", name, number));
        for (const glm::dvec3& p : object.points)
            out.line("v {:.12g} {:.12g} {:.12g}", p.x, p.y, p.z);
        for (const glm::vec3& n : object.normals)
            out.line("vn {:.6g} {:.6g} {:.6g}", n.x, n.y, n.z);
        auto corner = object.corners.begin();
        for (const int size : object.face_sizes) {
            std::string face = "f";
            for (int k = 0; k < size; ++k, ++corner) // from 1
                fmt::format_to(std::back_inserter(face), " {}//{}", written.points + corner->point + 1,
                               normals + corner->normal + 1);
            out.line("{}", face);
        }
        written.points += static_cast<long long>(object.points.size());
        normals += static_cast<long long>(object.normals.size());
        written.faces += static_cast<long long>(object.face_sizes.size());
    }
    out.commit();
    return written;
}

} // namespace razor::api
