// Tables of instances: any text is rows of files that are there, or one clear line.
#include "razor/scene/error.h"
#include "razor/scene/instance_table.h"
#include "tests/fuzz/target.h"

const std::vector<std::string>& fuzz::seeds() {
    static const std::vector<std::string> all{
        "m.obj 1 2 30\nm.obj -1e3 .5 -90 # c\n\n# d\nm.obj 0 0 0\n",
        "m.obj 1 2 30\r\n\tm.obj\t4\t5\t6\r\n",
    };
    return all;
}

bool fuzz::try_bytes(std::string_view bytes) {
    static const File model("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    try {
        const razor::InstanceTable table = razor::parse_instance_table(bytes, "fuzz", model.folder());
        require(!table.rows.empty() && !table.files.empty());
        for (const razor::InstanceRow& row : table.rows)
            require(row.line >= 1 && row.file >= 0 &&
                    static_cast<std::size_t>(row.file) < table.files.size());
    } catch (const razor::UserError& error) {
        require_line(error.what());
    }
    return true;
}
