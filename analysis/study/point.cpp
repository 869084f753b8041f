#include "analysis/study/point.h"

#include "analysis/study/error.h"
#include "analysis/study/toml_section.h"

#include <boost/uuid/name_generator_sha1.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace analysis {

std::string stated(std::string_view body, std::string_view key) {
    try {
        return parse_toml(body, "a point")[key].value_or(std::string());
    } catch (const StudyError&) {
        return "";
    }
}

std::string point_name(std::string_view body) {
    // A namespace of this project's own, so that no other's names are met.
    constexpr boost::uuids::uuid studies{
        {0x5d, 0x0f, 0x8a, 0x11, 0x2b, 0x6e, 0x4c, 0x37, 0x9e, 0x42, 0x71, 0xd3, 0x60, 0x1a, 0xc8, 0x95}};
    const boost::uuids::name_generator_sha1 generate(studies);
    const boost::uuids::uuid name = generate(body.data(), body.size());
    std::string out;
    for (const unsigned char byte : name)
        out += fmt::format("{:02x}", byte);
    return out;
}

std::vector<Point> resolve_points(const Study& study, const Resolve& resolve) {
    std::vector<Point> points;
    std::set<std::string> known;
    const auto add = [&](Settings settings, const std::string& rival) {
        Point point;
        point.settings = std::move(settings);
        point.rival = rival;
        try {
            point.body = resolve(point);
        } catch (const std::exception& error) {
            point.impossible = study.placed(error.what(), point.settings);
            point.body = fmt::format("impossible = true\nrival = {}\n\n[settings]\n{}",
                                     toml_text(Value(rival)), toml_text(point.settings));
        }
        point.name = point_name(point.body);
        if (known.insert(point.name).second)
            points.push_back(std::move(point));
    };
    for (const Settings& settings : study.points)
        add(settings, "");
    for (const Rival& rival : study.rivals)
        for (const Settings& settings : rival.points)
            add(overlaid(study.common, settings), rival.name);
    return points;
}

const Rival* find_rival(const Study& study, std::string_view name) {
    const auto found = std::find_if(study.rivals.begin(), study.rivals.end(),
                                    [&](const Rival& rival) { return rival.name == name; });
    return found == study.rivals.end() ? nullptr : &*found;
}

} // namespace analysis
