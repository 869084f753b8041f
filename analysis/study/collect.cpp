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

Figure find_figure(const std::vector<Figure>& figures, const std::string& name) {
    const auto found = std::find_if(figures.begin(), figures.end(),
                                    [&](const Figure& figure) { return figure.name == name; });
    return found == figures.end() ? Figure{name, name} : *found;
}

CollectedPlot plot_of(const Collection& all, const PlotRequest& request, const std::vector<Figure>& figures) {
    CollectedPlot out{request, {}, {}};
    const Figure x = find_figure(figures, request.x), y = find_figure(figures, request.y);
    out.chart.x_label = x.label;
    out.chart.y_label = y.label;
    std::vector<Trade> trades;
    for (const CollectedPoint& p : all.points)
        trades.push_back({spread_of(p.samples(request.x)), spread_of(p.samples(request.y))});
    const std::vector<Spread> better_x = spreads_of(all.points, x), better_y = spreads_of(all.points, y);
    std::vector<Trade> better;
    for (std::size_t i = 0; i < trades.size(); ++i)
        better.push_back({better_x[i], better_y[i]});
    out.standing = pareto(better);
    std::map<std::string, std::size_t> series;
    for (std::size_t i = 0; i < trades.size(); ++i) {
        if (out.standing[i] == Standing::unknown)
            continue;
        const Point& point = all.points[i].point;
        std::string name = point.rival.empty() ? settings_text(point, all.knobs, request.lines) : point.rival;
        if (name.empty())
            name = request.lines.empty() ? "all points" : "other points";
        const auto [found, fresh] = series.try_emplace(name, out.chart.series.size());
        if (fresh)
            out.chart.series.push_back({name, {}, !point.rival.empty()});
        const Trade& t = trades[i];
        out.chart.series[found->second].marks.push_back(
            {t.x.median, t.y.median, t.x.least, t.x.most, t.y.least, t.y.most,
             out.standing[i] == Standing::front || out.standing[i] == Standing::tied,
             fmt::format("{}: {:.4g}, {:.4g}; {}", settings_text(point, all.knobs), t.x.median, t.y.median,
                         standing_text(out.standing[i]))});
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

json sensitivity_json(const Sensitivity& s) {
    return {{"knob", s.knob},
            {"from", plain_text(s.from)},
            {"to", plain_text(s.to)},
            {"ratio", {{"median", s.ratio.median}, {"least", s.ratio.least}, {"most", s.ratio.most}}},
            {"pairs", s.ratio.count},
            {"sure_pairs", s.sure}};
}

/// Of points in their order, the best first.
Table ranking_table(const Collection& all, const Ranking& ranking) {
    Table out;
    out.columns = {"place"};
    out.columns.insert(out.columns.end(), all.knobs.begin(), all.knobs.end());
    out.columns.insert(out.columns.end(), {ranking.figure.name, "least", "most"});
    for (const std::size_t i : ranking.order) {
        const CollectedPoint& p = all.points[i];
        std::vector<Table::Cell>& row = out.rows.emplace_back();
        row.emplace_back(place_text(ranking.places[i]));
        for (const std::string& key : all.knobs)
            row.emplace_back(value_text(p.point.settings, key));
        const Spread s = spread_of(p.samples(ranking.figure.name));
        for (const double value : {s.median, s.least, s.most})
            row.emplace_back(value);
    }
    return out;
}

void show_ranking(Page& page, const Collection& all, const Ranking& ranking) {
    page.heading(fmt::format("Ranked by {}", ranking.figure.label));
    page.paragraph(ranking.verdict(all.points, all.knobs));
    if (!ranking.order.empty()) {
        page.paragraph("A place such as 2-5: points whose runs overlap are not told apart.");
        page.table("places", ranking_table(all, ranking));
    }
    if (ranking.ratios.empty())
        return;
    page.heading(fmt::format("What each setting does to {}", ranking.figure.label));
    page.paragraph(
        "The ratio between a setting's extreme values where all others are the same: the bar is the median "
        "of all such pairs of points, the line their range. Grey: the runs of no pair lie apart, so that "
        "it may as well be noise.");
    page.drawing(ranking.chart().drawing().str());
}

} // namespace

Collection collect(const Study& study, const std::vector<Point>& points, const Store& store,
                   const std::vector<Figure>& figures, const Views& views) {
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
    for (const std::string& word : views.words)
        if (std::any_of(out.points.begin(), out.points.end(),
                        [&](const CollectedPoint& p) { return p.word(word) != "-"; }))
            out.words.push_back(word);
    for (const PlotRequest& request : study.plots.empty() ? views.plots : study.plots)
        out.plots.push_back(plot_of(out, request, figures));
    const std::vector<std::string>& rank = study.rank.empty() ? views.rank : study.rank;
    for (const std::string& name : rank)
        out.rankings.push_back(ranking_of(out.points, out.knobs, find_figure(figures, name)));
    std::vector<CurveRequest> curves = study.curves;
    if (curves.empty() && views.curves && !rank.empty())
        for (const std::string& knob : curve_knobs(out.points, out.knobs))
            curves.push_back({knob, rank.front()});
    for (const CurveRequest& request : curves)
        out.curves.push_back(curve_of(out.points, out.knobs, request, find_figure(figures, request.y).label));
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
    out.columns.insert(out.columns.end(), words.begin(), words.end());
    for (const CollectedPlot& plot : plots)
        out.columns.push_back(plot_name(plot));
    for (const Ranking& ranking : rankings)
        out.columns.push_back(ranking.figure.name + "_place");
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
        for (const std::string& word : words)
            row.emplace_back(p.word(word));
        for (const CollectedPlot& plot : plots)
            row.emplace_back(standing_text(plot.standing[i]));
        for (const Ranking& ranking : rankings)
            row.emplace_back(place_text(ranking.places[i]));
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
            for (const std::string& word : words)
                one["words"][word] = p.word(word);
            for (const Ranking& ranking : rankings)
                if (const Place& place = ranking.places[i]; place.known())
                    one["places"][ranking.figure.name] = {{"best", place.best}, {"worst", place.worst}};
        }
        list.push_back(std::move(one));
    }
    nlohmann::ordered_json labels = nlohmann::ordered_json::object();
    for (const Figure& figure : figures)
        labels[figure.name] = figure.label;
    nlohmann::ordered_json ratios = nlohmann::ordered_json::object();
    for (const Ranking& ranking : rankings) {
        ratios[ranking.figure.name] = nlohmann::ordered_json::array();
        for (const Sensitivity& one : ranking.ratios)
            ratios[ranking.figure.name].push_back(sensitivity_json(one));
    }
    const nlohmann::ordered_json out{
        {"title", title}, {"knobs", knobs}, {"figures", labels}, {"sensitivity", ratios}, {"points", list}};
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
    for (const Curve& curve : curves)
        if (!curve.chart.series.empty()) {
            page.heading(fmt::format("{} over {}", curve.chart.y.label, curve.request.x));
            page.paragraph("Medians of the runs, in bands as wide as these differ.");
            page.drawing(curve.chart.svg());
        }
    for (const Ranking& ranking : rankings)
        show_ranking(page, *this, ranking);
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
    std::error_code ignored; // writing says what is wrong
    std::filesystem::create_directories(store.folder(), ignored);
    const auto draw = [&](const std::string& name, const Svg& drawing) {
        write(name + ".svg", drawing.file());
        write(name + ".png", png_bytes(rasterised(drawing, 2)));
    };
    write("study.csv", collection.table().csv());
    write("study.json", collection.json());
    for (const CollectedPlot& plot : collection.plots)
        if (!plot.chart.empty())
            draw(plot_name(plot), plot.chart.drawing());
    for (const Curve& curve : collection.curves)
        if (!curve.chart.series.empty())
            draw(fmt::format("curve-{}-{}", curve.request.y, curve.request.x), curve.chart.drawing());
    for (const Ranking& ranking : collection.rankings)
        if (!ranking.ratios.empty())
            draw("sensitivity-" + ranking.figure.name, ranking.chart().drawing());
    write("study.html", collection.html(remarks));
    return written;
}

} // namespace analysis
