#include "razor/program/export_command.h"

#include "razor/frame/diced_mesh.h"
#include "razor/image/output_file.h"
#include "razor/native/targets.h"
#include "razor/program/arguments.h"
#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <iterator>
#include <map>

namespace razor {
namespace {

/// Names in OBJ files end at blanks.
std::string word(const std::string& name) {
    std::string text = name.empty() ? "mesh" : name;
    for (char& c : text)
        if (static_cast<unsigned char>(c) <= ' ' || c == 0x7f)
            c = '_';
    return text;
}

/// Texts are written as they grow, so that a mesh is in memory once.
class Writer {
public:
    explicit Writer(const std::string& path) : file_(path) {}
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
        file_.write(text_.data(), text_.size());
        text_.clear();
    }
    OutputFile file_;
    fmt::memory_buffer text_;
};

} // namespace

void ExportCommand::add_to(CLI::App& app) {
    command_ = app.add_subcommand("export-mesh", "write the diced mesh of a scene as an OBJ file");
    scene_.add_to(*command_, "scene");
    command_->add_option("-o,--output", output_, "the mesh")->type_name("FILE.obj")->required();
    command_->add_option("--isa", isa_, "instruction set: auto, plain, sse4, avx2 or avx512")
        ->type_name("NAME");
}

int ExportCommand::run() const {
    if (!output_.ends_with(".obj"))
        throw UserError(fmt::format("{}: the mesh is written as OBJ only; end the name in .obj",
                                    printable(output_, 1000)));
    const KernelTable& kernels = native_target(isa_);
    const Scene scene = build_scene(scene_.describe());
    check_writable(output_);
    Frame frame(scene, {});
    frame.dice_all(kernels);

    Writer out(output_);
    out.line("# razor {}: {}, as its camera sees it", version(), word(scene.name));
    std::map<std::string, int> used;
    long long points = 1, normals = 1, faces = 0;
    for (const DicedInstance& object : diced_mesh(frame)) {
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
            for (int k = 0; k < size; ++k, ++corner)
                fmt::format_to(std::back_inserter(face), " {}//{}", points + corner->point,
                               normals + corner->normal);
            out.line("{}", face);
        }
        points += static_cast<long long>(object.points.size());
        normals += static_cast<long long>(object.normals.size());
        faces += static_cast<long long>(object.face_sizes.size());
    }
    out.commit();
    fmt::print("{}: {} points, {} faces\n", output_, points - 1, faces);
    return 0;
}

} // namespace razor
