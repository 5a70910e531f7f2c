#include "app/report/html_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "app/base64.hpp"
#include "app/html_text.hpp"
#include "app/report/gnuplot.hpp"
#include "app/report/html_script.hpp"
#include "app/report/html_style.hpp"
#include "app/report/report_plots.hpp"
#include "ecs/model_names.hpp"
#include "systems/contact/region_wrenches.hpp"

namespace torsion::engine {
namespace {

std::string percent(const std::optional<double>& error) {
  if (!error) {
    return "\u2013";
  }
  const double value = 100.0 * *error;
  return value >= 99.95  ? fmt::format("{:.0f}", value)
         : value >= 9.95 ? fmt::format("{:.1f}", value)
                         : fmt::format("{:#.2g}", value);
}

std::string figure(const std::string& svg, const std::string& caption) {
  return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", svg,
                     html_escaped(caption));
}

std::string machine_html(const Machine& machine) {
  return fmt::format(
      "<p>Measured on {} ({} cores, load {:.2g} at the end), {}, compiled by {} ({}), {}. One "
      "process, one thread; every time is that of a whole step, detection of the contact "
      "included.</p>\n",
      html_escaped(machine.processor), machine.cores, machine.load, html_escaped(machine.system),
      html_escaped(machine.compiler), machine.build, machine.date);
}

constexpr const char* kDefinitions = R"html(<h2>How the errors are defined</h2>
<dl>
<dt>force</dt><dd>The largest |F &minus; F<sub>ref</sub>| over the path, over the largest
|F<sub>ref</sub>|. Which force that is, each case says.</dd>
<dt>torque</dt><dd>The largest |T &minus; T<sub>ref</sub>| over the path, over the largest
|T<sub>ref</sub>|.</dd>
<dt>twist</dt><dd>The norm of the difference between the surface&rsquo;s twist and the
reference&rsquo;s, over the norm of the reference&rsquo;s, both over the surface from the axis to 8
contact radii or the body&rsquo;s edge. The twist at a radius is the angle by which the surface there
has gone around the axis, mean of four directions.</dd>
<dt>step</dt><dd>Wall time of one step with contact: median and 99th percentile over the
path.</dd>
<dt>grid cells</dt><dd>All cells of one region&rsquo;s grid. In a round contact about half of them are
in contact, which <code>--cells</code> counts; the others are the corners of the square and room to
grow.</dd>
<dt>memory</dt><dd>All tables of the physics world, as reserved.</dd>
</dl>
)html";

/// A table of the larger error of force and torque: a line for each choice of models, a column for
/// each case.
std::string overview_table(std::span<const MeasuredCase> cases) {
  std::vector<std::string> labels;
  for (const MeasuredCase& measured : cases) {
    for (const MeasuredRun& one : measured.runs) {
      const std::string label = label_of(one.run.models);
      if (std::ranges::find(labels, label) == labels.end()) {
        labels.push_back(label);
      }
    }
  }
  std::vector<double> best(cases.size(), std::numeric_limits<double>::infinity());
  for (std::size_t c = 0; c < cases.size(); ++c) {
    for (const MeasuredRun& one : cases[c].runs) {
      best[c] = std::min(best[c], worst_error(one.errors));
    }
  }
  std::string html =
      "<div class=\"wide overview\"><table><caption>The larger of the errors of force and torque "
      "(%)</caption>\n<tr><th>models</th>";
  for (const MeasuredCase& measured : cases) {
    // Long names may break after an underscore.
    std::string heading = html_escaped(measured.reference_case.name);
    for (std::size_t at = heading.find('_'); at != std::string::npos;
         at = heading.find('_', at + 6)) {
      heading.insert(at + 1, "<wbr>");
    }
    html += fmt::format("<th>{}</th>", heading);
  }
  html += "</tr>\n";
  for (const std::string& label : labels) {
    html += fmt::format("<tr><td>{}</td>", html_escaped(label));
    for (std::size_t c = 0; c < cases.size(); ++c) {
      const auto one = std::ranges::find_if(
          cases[c].runs, [&](const MeasuredRun& run) { return label_of(run.run.models) == label; });
      if (one == cases[c].runs.end()) {
        html += "<td>&ndash;</td>";
      } else {
        const double error = worst_error(one->errors);
        html +=
            fmt::format("<td{}>{}</td>", error == best[c] ? " class=\"best\"" : "", percent(error));
      }
    }
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

std::string runs_table(const MeasuredCase& measured) {
  std::string html =
      "<div class=\"wide\"><table>\n<tr><th>contact model</th><th>body model</th><th>grid "
      "cells</th>"
      "<th>anchors</th><th>step, median (\u00b5s)</th><th>99 % (\u00b5s)</th><th>force error "
      "(%)</th>"
      "<th>torque error (%)</th><th>twist error (%)</th><th>memory (KiB)</th></tr>\n";
  const MeasuredRun* before = nullptr;
  for (const MeasuredRun& one : measured.runs) {
    const CaseRun& run = one.run;
    const bool group = before != nullptr && before->run.models.contact != run.models.contact;
    html += fmt::format(
        "<tr{}><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.1f}</td><td>{:.1f}</td>"
        "<td>{}</td><td>{}</td><td>{}</td><td>{:.0f}</td></tr>\n",
        group ? " class=\"group\"" : "", name_of(run.models.contact), name_of(run.models.body),
        run.cells, run.anchors, run.step_us_median, run.step_us_p99, percent(one.errors.force),
        percent(one.errors.torque), percent(one.errors.twist),
        static_cast<double>(run.memory_bytes) / 1024.0);
    before = &one;
  }
  return html + "</table></div>\n";
}

/// What went wrong in runs of a case, in words; empty where nothing did.
std::string faults_html(const MeasuredCase& measured) {
  std::string html;
  for (const MeasuredRun& one : measured.runs) {
    for (const Fault fault : kAllFaults) {
      if (raised(one.run.faults_ever, fault)) {
        html +=
            fmt::format("<p><strong>Fault with {}:</strong> {}</p>\n",
                        html_escaped(label_of(one.run.models)), html_escaped(fault_text(fault)));
      }
    }
  }
  return html;
}

std::vector<Plot> plots_of(const MeasuredCase& measured) {
  std::vector<Plot> plots = {speed_plot(measured), loading_plot(measured)};
  if (measured.reference_case.connected) {
    plots.push_back(loop_plot(measured));
  }
  if (!measured.reference_case.field.radii.empty()) {
    plots.push_back(field_plot(measured));
  }
  return plots;
}

/// What opens a frame in which a case's run plays; empty without one.
std::string run_html(const std::string& name, const std::string& run) {
  return run.empty() ? run
                     : fmt::format(
                           "<details class=\"run\"><summary>The whole path in three "
                           "dimensions: drag to turn it</summary></details>\n"
                           "<script type=\"application/json\" id=\"run-{}\">{}</script>\n",
                           name, run);
}

std::string case_html(const MeasuredCase& measured, const std::string& picture,
                      const std::string& run, std::span<const Plot> plots,
                      std::span<const std::string> svgs) {
  const ReferenceCase& one = measured.reference_case;
  std::string html = fmt::format(
      "<section class=\"case\" id=\"{}\">\n<h2>{}</h2>\n<div class=\"intro\"><div>\n<p>{}</p>\n"
      "<p><strong>Reference.</strong> {}</p>\n<p><strong>Compared.</strong> F: {}.{}</p>\n"
      "<p>The path takes {} steps of 1 ms.</p>\n</div>\n",
      one.name, html_escaped(one.title), html_escaped(one.description), html_escaped(one.reference),
      html_escaped(one.force_meaning),
      one.torque_meaning.empty() ? "" : fmt::format(" T: {}.", html_escaped(one.torque_meaning)),
      std::transform_reduce(one.path.begin(), one.path.end(), 0, std::plus<>{},
                            [](const PathPoint& point) { return point.steps; }));
  if (!picture.empty()) {
    html += fmt::format(
        "<figure><img alt=\"The scene\" src=\"data:image/png;base64,{}\">"
        "<figcaption>The scene at its largest motion, drawn by the "
        "program.</figcaption></figure>\n",
        base64(picture));
  }
  html +=
      "</div>\n" + run_html(one.name, run) + faults_html(measured) + "<div class=\"figures\">\n";
  for (std::size_t i = 0; i < plots.size(); ++i) {
    html += figure(svgs[i], plots[i].caption);
  }
  return html + "</div>\n" + runs_table(measured) + "</section>\n";
}

/// Summary plots: over the cases on a half-space and over those with finite bodies.
std::vector<Plot> overview_plots(std::span<const MeasuredCase> cases) {
  std::vector<Plot> plots;
  for (const bool finite : {false, true}) {
    std::vector<const MeasuredCase*> chosen;
    for (const MeasuredCase& measured : cases) {
      if (measured.reference_case.finite_body == finite) {
        chosen.push_back(&measured);
      }
    }
    if (chosen.empty()) {
      continue;
    }
    Plot plot = speed_plot(chosen);
    plot.caption = fmt::format(
        "Speed against error over all {} cases {}: geometric means of the median step and of the "
        "larger error of force and torque. Numbers at patch: grid cells of a region.",
        chosen.size(), finite ? "with finite bodies" : "on a half-space");
    plots.push_back(std::move(plot));
  }
  return plots;
}

}  // namespace

Result<std::string> html_text(std::span<const MeasuredCase> cases, const ReportViews& views,
                              const Machine& machine) {
  // All plots are drawn by one process.
  const std::vector<Plot> overview = overview_plots(cases);
  std::vector<Plot> all = overview;
  std::vector<std::size_t> first;  // of each case, in `all`
  for (const MeasuredCase& measured : cases) {
    first.push_back(all.size());
    const std::vector<Plot> plots = plots_of(measured);
    all.insert(all.end(), plots.begin(), plots.end());
  }
  first.push_back(all.size());
  const Result<std::vector<std::string>> drawn = draw_plots(all);
  if (!drawn) {
    return drawn.error();
  }
  const std::span<const std::string> svgs = drawn.value();
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>Torsion: speed against error</title>\n<style>{}</style>\n</head>\n<body>\n"
      "<h1>Torsion: speed against error</h1>\n"
      "<p>Every contact model with every body model on scenes whose answer is known: in closed "
      "form "
      "on a half-space, by finite elements with friction for finite bodies.</p>\n",
      kReportStyle);
  html += machine_html(machine) + "<div class=\"figures\">\n";
  for (std::size_t i = 0; i < overview.size(); ++i) {
    html += figure(svgs[i], overview[i].caption);
  }
  html += "</div>\n" + overview_table(cases) + kDefinitions;
  for (std::size_t c = 0; c < cases.size(); ++c) {
    const std::size_t count = first[c + 1] - first[c];
    html += case_html(cases[c], views.pictures[c], views.runs[c],
                      std::span(all).subspan(first[c], count), svgs.subspan(first[c], count));
  }
  if (!views.run_parts.empty()) {
    html += fmt::format(
        "<script type=\"application/json\" id=\"run-parts\">{}</script>\n<script>{}</script>\n",
        views.run_parts, kReportScript);
  }
  return html + "</body>\n</html>\n";
}

}  // namespace torsion::engine
