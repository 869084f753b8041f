#include "analysis/study/store.h"

#include "analysis/study/error.h"
#include "traces/error.h"
#include "traces/io/sink.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>

namespace analysis {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

/// What is no number is null.
json samples_json(const Samples& samples) {
    json out = json::object();
    for (const auto& [figure, values] : samples) {
        json list = json::array();
        for (const double value : values)
            list.push_back(std::isfinite(value) ? json(value) : json(nullptr));
        out[figure] = std::move(list);
    }
    return out;
}

Samples read_samples(const json& from) {
    Samples out;
    for (const auto& [figure, values] : from.items())
        for (const json& value : values)
            out[figure].push_back(value.is_null() ? std::numeric_limits<double>::quiet_NaN()
                                                  : value.get<double>());
    return out;
}

} // namespace

void write_whole(const fs::path& file, std::string_view text) {
    try {
        const auto sink = traces::open_sink(file.string());
        sink->write(text);
        sink->commit();
    } catch (const traces::Error& error) {
        throw StudyError(error.what());
    }
}

Store::Store(fs::path folder) : folder_(std::move(folder)) {}

void Store::make_folders() const {
    std::error_code error;
    for (const char* part : {"points", "results"}) {
        fs::create_directories(folder_ / part, error);
        if (error)
            throw StudyError(fmt::format("{}: no folder can be made ({}); choose another place",
                                         (folder_ / part).string(), error.message()));
    }
}

fs::path Store::result_file(const Point& point) const {
    return folder_ / "results" / (point.name + ".json");
}

bool Store::is_done(const Point& point) const {
    std::error_code ignored;
    return fs::exists(result_file(point), ignored);
}

void Store::write_point(const Point& point) const {
    make_folders();
    const fs::path file = folder_ / "points" / (point.name + ".toml");
    std::error_code ignored;
    if (!fs::exists(file, ignored))
        write_whole(file, point.body);
}

void Store::write_result(const Point& point, const Result& result, std::string_view program) const {
    make_folders();
    json out{{"program", program}, {"point", point.body}};
    if (!result.failed.empty()) {
        out["failed"] = result.failed;
    } else {
        out["values"] = samples_json(result.values);
        if (!result.details.is_null())
            out["details"] = result.details;
    }
    out["host"] = samples_json(result.host);
    // Messages may hold bytes that are no text.
    write_whole(result_file(point), out.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
}

std::optional<Result> Store::read_result(const Point& point) const {
    const fs::path file = result_file(point);
    std::ifstream in(file, std::ios::binary);
    if (!in)
        return {};
    try {
        const json from = json::parse(in);
        if (from.at("point") != point.body)
            throw StudyError(fmt::format("{}: is the result of another point; remove it", file.string()));
        Result result;
        result.host = read_samples(from.at("host"));
        if (const auto failed = from.find("failed"); failed != from.end()) {
            result.failed = failed->get<std::string>();
            return result;
        }
        result.values = read_samples(from.at("values"));
        result.details = from.value("details", json());
        return result;
    } catch (const json::exception&) {
        throw StudyError(
            fmt::format("{0}: is damaged; remove {0}, and its point is measured again", file.string()));
    }
}

void Store::forget_result(const Point& point) const {
    std::error_code ignored;
    fs::remove(result_file(point), ignored);
}

} // namespace analysis
