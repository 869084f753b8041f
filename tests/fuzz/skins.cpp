// Skins of MD3 models: any text is lines with a surface and a picture or one clear line.
#include "razor/scene/error.h"
#include "razor/scene/models/md3_skin.h"
#include "tests/fuzz/target.h"

const std::vector<std::string>& fuzz::seeds() {
    static const std::vector<std::string> all{
        "// red\nh_head,models/players/imp/head.tga\r\ntag_head,\n\n",
        " h_eyes , eyes ,2",
    };
    return all;
}

bool fuzz::try_bytes(std::string_view bytes) {
    try {
        std::int64_t last = 0;
        for (const razor::Md3SkinLine& line : razor::parse_md3_skin(bytes, "fuzz")) {
            require(!line.surface.empty() && !line.picture.empty() && line.line > last);
            require(line.surface.find_first_of(",\n") == std::string::npos);
            require(line.picture.find('\n') == std::string::npos);
            last = line.line;
        }
    } catch (const razor::UserError& error) {
        require_line(error.what(), "fuzz:");
    }
    return true;
}
