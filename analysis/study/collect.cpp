#include "analysis/study/collect.h"

#include "analysis/plots/page.h"
#include "analysis/plots/raster.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>
#include <map>

namespace analysis {
namespace {

using json = nlohmann::ordered_json;

std::string standing_text(Standing standing) {
    switch (standing) {
    case Standing::front:
        return "front";
    case Standing::tied:
        return "tied";
    case Standing::dominated:
        return "dominated";
    case Standing::unknown:
        break;
    }
    return "-";
}

std::string value_text(const Settings& settings, const std::string& key) {
    const auto found = settings.find(key);
    return found == settings.end() ? "-" : plain_text(found->second);
}

/// "lod recursive, samples 4": of some settings, or of all but these.
std::string settings_text(const Point& point, const std::vector<std::string>& knobs,
                          const std::vector<std::string>& chosen) {
    std::string out = point.rival;
    for (const std::string& key : knobs)
        if (std::find(chosen.begin(), chosen.end(), key) != chosen.end() && point.settings.contains(key))
            out += fmt::format("{}{} {}", out.empty() ? "" : ", ", key, value_text(point.settings, key));
    return out;
}

/// What points of the collection differ in: the study's knobs, and its rivals'.
std::vector<std::string> all_knobs(const Study& study) {
    std::vector<std::string> out = study.knobs;
    for (const Rival& rival : study.rivals)
        for (const Settings& point : rival.points)
            for (const auto& [key, value] : point)
                if (std::find(out.begin(), out.end(), key) == out.end())
                    out.push_back(key);
    return out;
}

std::string label_of(const std::vector<Figure>& figures, const std::string& name) {
    const auto found = std::find_if(figures.begin(), figures.end(),
                                    [&](const Figure& figure) { return figure.name == name; });
    return found == figures.end() ? name : found->label;
}

CollectedPlot plot_of(const Collection& all, const PlotRequest& request, const std::vector<Figure>& figures) {
    CollectedPlot out{request, {}, {}};
    out.chart.x_label = label_of(figures, request.x);
    out.chart.y_label = label_of(figures, request.y);
    std::vector<Trade> trades;
    for (const CollectedPoint& p : all.points)
        trades.push_back({spread_of(p.samples(request.x)), spread_of(p.samples(request.y))});
    out.standing = pareto(trades);
    std::map<std::string, std::size_t> series;
    for (std::size_t i = 0; i < trades.size(); ++i) {
        if (out.standing[i] == Standing::unknown)
            continue;
        const Point& point = all.points[i].point;
        std::string name = point.rival.empty() ? settings_text(point, all.knobs, request.lines) : point.rival;
        name = name.empty() ? "all points" : name;
        const auto [found, fresh] = series.try_emplace(name, out.chart.series.size());
        if (fresh)
            out.chart.series.push_back({name, {}, !point.rival.empty()});
        const Trade& t = trades[i];
        out.chart.series[found->second].marks.push_back(
            {t.x.median, t.y.median, t.x.least, t.x.most, t.y.least, t.y.most,
             out.standing[i] == Standing::front || out.standing[i] == Standing::tied,
             fmt::format("{}: {:.4g}, {:.4g}; {}", settings_text(point, all.knobs, all.knobs), t.x.median,
                         t.y.median, standing_text(out.standing[i]))});
        if (out.standing[i] == Standing::front && t.x.median > 0 && t.y.median > 0)
            out.chart.front.emplace_back(t.x.median, t.y.median);
    }
    for (ScatterChart::Series& one : out.chart.series)
        std::stable_sort(one.marks.begin(), one.marks.end(),
                         [](const ScatterChart::Mark& a, const ScatterChart::Mark& b) { return a.x < b.x; });
    std::sort(out.chart.front.begin(), out.chart.front.end());
    return out;
}

json spread_json(const std::vector<double>& samples) {
    const Spread s = spread_of(samples);
    return {{"median", s.median}, {"least", s.least},           {"most", s.most},
            {"mean", s.mean},     {"half_width", s.half_width}, {"count", s.count}};
}

json settings_json(const Settings& settings) {
    json out = json::object();
    for (const auto& [key, value] : settings)
        std::visit([&, name = key](const auto& concrete) { out[name] = concrete; }, value);
    return out;
}

std::string plot_name(const CollectedPlot& plot) {
    return fmt::format("{}-{}", plot.request.y, plot.request.x);
}

} // namespace

std::vector<double> CollectedPoint::samples(const std::string& figure) const {
    if (!measured())
        return {};
    for (const Samples* const all : {&result->values, &result->host})
        if (const auto found = all->find(figure); found != all->end())
            return found->second;
    return {};
}

Collection collect(const Study& study, const std::vector<Point>& points, const Store& store,
                   const std::vector<Figure>& figures, const std::vector<PlotRequest>& plots) {
    Collection out;
    out.title = study.title;
    out.knobs = all_knobs(study);
    for (const Point& point : points) {
        out.points.push_back({point, store.read_result(point)});
        const std::optional<Result>& result = out.points.back().result;
        out.missing += result ? 0 : 1;
        out.failed += result && !result->failed.empty() ? 1 : 0;
    }
    for (const Figure& figure : figures)
        if (std::any_of(out.points.begin(), out.points.end(),
                        [&](const CollectedPoint& p) { return !p.samples(figure.name).empty(); }))
            out.figures.push_back(figure);
    for (const PlotRequest& request : study.plots.empty() ? plots : study.plots)
        out.plots.push_back(plot_of(out, request, figures));
    return out;
}

Table Collection::table() const {
    Table out;
    const bool rivals = std::any_of(points.begin(), points.end(),
                                    [](const CollectedPoint& p) { return !p.point.rival.empty(); });
    if (rivals)
        out.columns.emplace_back("rival");
    out.columns.insert(out.columns.end(), knobs.begin(), knobs.end());
    for (const Figure& figure : figures)
        for (const char* part : {"", "_least", "_most"})
            out.columns.push_back(figure.name + part);
    for (const CollectedPlot& plot : plots)
        out.columns.push_back(plot_name(plot));
    out.columns.emplace_back("state");
    out.columns.emplace_back("point");
    for (std::size_t i = 0; i < points.size(); ++i) {
        const CollectedPoint& p = points[i];
        std::vector<Table::Cell>& row = out.rows.emplace_back();
        if (rivals)
            row.emplace_back(p.point.rival);
        for (const std::string& key : knobs)
            row.emplace_back(value_text(p.point.settings, key));
        for (const Figure& figure : figures) {
            const Spread s = spread_of(p.samples(figure.name));
            for (const double value : {s.median, s.least, s.most})
                row.emplace_back(value);
        }
        for (const CollectedPlot& plot : plots)
            row.emplace_back(standing_text(plot.standing[i]));
        row.emplace_back(!p.result ? "missing" : p.measured() ? "measured" : "failed: " + p.result->failed);
        row.emplace_back(p.point.name);
    }
    return out;
}

std::string Collection::json() const {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const CollectedPoint& p = points[i];
        nlohmann::ordered_json one{
            {"point", p.point.name}, {"rival", p.point.rival}, {"settings", settings_json(p.point.settings)}};
        if (!p.result) {
            one["state"] = "missing";
        } else if (!p.measured()) {
            one["state"] = "failed";
            one["failed"] = p.result->failed;
        } else {
            one["state"] = "measured";
            for (const Figure& figure : figures)
                if (const std::vector<double> samples = p.samples(figure.name); !samples.empty())
                    one["figures"][figure.name] = spread_json(samples);
            for (const CollectedPlot& plot : plots)
                one["standing"][plot_name(plot)] = standing_text(plot.standing[i]);
        }
        list.push_back(std::move(one));
    }
    nlohmann::ordered_json labels = nlohmann::ordered_json::object();
    for (const Figure& figure : figures)
        labels[figure.name] = figure.label;
    const nlohmann::ordered_json out{
        {"title", title}, {"knobs", knobs}, {"figures", labels}, {"points", list}};
    return out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string Collection::html(const std::vector<std::string>& remarks) const {
    Page page(title);
    page.paragraph(fmt::format("{} points; {} measured, {} failed, {} missing.", points.size(),
                               points.size() - failed - missing, failed, missing));
    for (const std::string& remark : remarks)
        page.paragraph(remark);
    for (const CollectedPlot& plot : plots) {
        page.heading(fmt::format("{} over {}", plot.chart.y_label, plot.chart.x_label));
        if (plot.chart.empty()) {
            page.paragraph("No point has both figures above zero.");
            continue;
        }
        page.paragraph(
            "Medians, with the least and the greatest of the runs. Filled: on the Pareto front (the "
            "grey steps), or no further from it than the runs of a point differ; rings: dominated.");
        page.drawing(plot.chart.drawing().str());
        std::size_t tied = 0;
        for (std::size_t i = 0; i < points.size(); ++i)
            tied += plot.standing[i] == Standing::tied ? 1 : 0;
        page.paragraph(
            fmt::format("{} points on the front, {} tied with it.", plot.chart.front.size(), tied));
    }
    page.table("all points", table());
    return page.html();
}

std::vector<std::string> write_collection(const Collection& collection, const Store& store,
                                          const std::vector<std::string>& remarks) {
    std::vector<std::string> written;
    const auto write = [&](const std::string& name, std::string_view text) {
        write_whole(store.folder() / name, text);
        written.push_back((store.folder() / name).string());
    };
    write("study.csv", collection.table().csv());
    write("study.json", collection.json());
    for (const CollectedPlot& plot : collection.plots) {
        if (plot.chart.empty())
            continue;
        const Svg drawing = plot.chart.drawing();
        write(plot_name(plot) + ".svg", drawing.file());
        write(plot_name(plot) + ".png", png_bytes(rasterised(drawing, 2)));
    }
    write("study.html", collection.html(remarks));
    return written;
}

} // namespace analysis
