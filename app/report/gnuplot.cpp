#include "app/report/gnuplot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace torsion::engine {
namespace {

constexpr int kWidth = 560;   // of a plot, in units of its text
constexpr int kHeight = 370;  // without its legend
constexpr int kLegendRow = 19;
constexpr int kLegendColumns = 2;

/// A folder that is gone with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "torsion_plots_XXXXXX").string();
    if (::mkdtemp(name.data()) != nullptr) {
      path_ = name;
    }
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) {
      std::filesystem::remove_all(path_, ignored);
    }
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  TemporaryFolder(TemporaryFolder&&) = delete;
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A text in gnuplot's single quotes.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    result += c == '\'' ? "''" : std::string(1, c);
  }
  return result + "'";
}

std::string style_of(const PlotSeries& series) {
  const std::string line =
      fmt::format("lc rgb '{}' dt {} lw {}", series.color, series.dash, series.width);
  const std::string point = fmt::format("pt {} ps 0.7", series.point);
  switch (series.style) {
    case PlotSeries::Style::kLine:
      return "with lines " + line;
    case PlotSeries::Style::kSteps:
      return "with steps " + line;
    case PlotSeries::Style::kPoints:
      return fmt::format("with points lc rgb '{}' lw 1.2 {}", series.color, point);
    case PlotSeries::Style::kLineWithPoints:
      break;
  }
  return fmt::format("with linespoints {} {}", line, point);
}

std::string data_of(const PlotSeries& series) {
  std::string text;
  for (std::size_t i = 0; i < series.points.size(); ++i) {
    if (std::isfinite(series.points[i].x) && std::isfinite(series.points[i].y)) {
      text += fmt::format("{:.9g} {:.9g}", series.points[i].x, series.points[i].y);
      text += i < series.point_labels.size() ? fmt::format(" \"{}\"\n", series.point_labels[i])
                                             : std::string("\n");
    }
  }
  return text;
}

/// Ticks at 1, 2 and 5 times powers of ten and a range a little wider than the data, for an axis
/// that gnuplot would widen to whole powers of ten.
std::string logarithmic_axis(const Plot& plot, char axis) {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  for (const PlotSeries& series : plot.series) {
    for (const glm::dvec2& point : series.points) {
      const double value = axis == 'x' ? point.x : point.y;
      low = value > 0.0 ? std::min(low, value) : low;
      high = std::max(high, value);
    }
  }
  if (!(low <= high)) {
    return {};
  }
  low /= 1.6;
  high *= 1.6;
  std::string ticks;
  const auto first = static_cast<int>(std::floor(std::log10(low)));
  const auto last = static_cast<int>(std::floor(std::log10(high)));
  for (int decade = first; decade <= last; ++decade) {
    const double power = std::pow(10.0, decade);
    for (const double step : {1.0, 2.0, 5.0}) {
      // Over many decades only their beginnings fit.
      if (step == 1.0 || high < 500.0 * low) {
        ticks += fmt::format("{}{:.6g}", ticks.empty() ? "" : ",", step * power);
      }
    }
  }
  return fmt::format("set logscale {0}\nset {0}range [{1:.6g}:{2:.6g}]\nset {0}tics ({3})\n", axis,
                     low, high, ticks);
}

/// Height with the legend below.
int height_of(const Plot& plot) {
  const auto entries = static_cast<int>(
      std::ranges::count_if(plot.series, [](const PlotSeries& one) { return !one.label.empty(); }));
  return kHeight + kLegendRow * ((entries + kLegendColumns - 1) / kLegendColumns);
}

std::string script_of(const Plot& plot, const std::string& name) {
  std::string script = fmt::format(
      "reset\n"
      "set terminal svg size {},{} noenhanced font 'sans-serif,14' name '{}'\n"
      "set output '{}.svg'\n"
      "set border 3\nset tics nomirror\nset grid lc rgb '#cccccc' dt 1\n"
      "set key outside bottom center horizontal samplen 2 spacing 1.1 font ',13' maxcolumns {}\n"
      "set format '%g'\nset xlabel {}.\"\\n \" offset 0,0.3\nset ylabel {}\n",
      kWidth, height_of(plot), name, name, kLegendColumns, quoted(plot.x_label),
      quoted(plot.y_label));
  script +=
      plot.logarithmic
          ? logarithmic_axis(plot, 'x') + logarithmic_axis(plot, 'y')
          : std::string("set autoscale xfix\nset offsets graph 0, graph 0.03, graph 0.05, 0\n");
  script += plot.from_zero ? "set yrange [0:]\n" : "";
  std::string draws;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const PlotSeries& series = plot.series[i];
    const std::string data = data_of(series);
    if (data.empty()) {
      continue;
    }
    script += fmt::format("$d{} << END\n{}END\n", i, data);
    draws += draws.empty() ? "" : ", ";
    draws += fmt::format("$d{} using 1:2 {} {}", i, style_of(series),
                         series.label.empty() ? "notitle" : "title " + quoted(series.label));
    if (!series.point_labels.empty()) {
      draws += fmt::format(
          ", $d{} using 1:2:3 with labels left offset 0.6,0.5 font ',11' tc rgb '{}' notitle", i,
          series.color);
    }
  }
  return script + "plot " + draws + "\nunset output\n";
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

/// gnuplot writes a file of its own with names that are the same in every file.
std::string to_inline(std::string svg, const std::string& name, int height) {
  svg.erase(0, svg.find("<svg"));
  const std::size_t head_end = svg.find('>');
  svg.replace(0, head_end + 1,
              fmt::format(R"(<svg viewBox="0 0 {} {}" role="img">)", kWidth, height));
  for (const char* mark : {"gp", "gnuplot_", "textbox", "greybox"}) {
    for (const char quote : {'\'', '"'}) {
      replace_all(svg, fmt::format("id={}{}", quote, mark),
                  fmt::format("id={}{}_{}", quote, name, mark));
      replace_all(svg, fmt::format("href={}#{}", quote, mark),
                  fmt::format("href={}#{}_{}", quote, name, mark));
    }
    replace_all(svg, fmt::format("url(#{}", mark), fmt::format("url(#{}_{}", name, mark));
  }
  replace_all(svg, "xlink:href", "href");
  for (const auto& [begin, end] :
       {std::pair("<title>", "</title>"), std::pair("<desc>", "</desc>")}) {
    for (std::size_t at = svg.find(begin); at != std::string::npos; at = svg.find(begin)) {
      const std::string closing = end;
      svg.erase(at, svg.find(closing, at) + closing.size() - at);
    }
  }
  return svg;
}

/// Runs gnuplot on plots.gp in `folder`; what it says goes to messages.txt there.
Result<Done> run_gnuplot(const std::filesystem::path& folder) {
  const std::string messages = folder / "messages.txt";
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, messages.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  std::array<std::string, 2> words = {"gnuplot", "plots.gp"};
  std::array<char*, 3> arguments = {words[0].data(), words[1].data(), nullptr};
  pid_t process = 0;
  const int failed =
      ::posix_spawnp(&process, "gnuplot", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) {
    return Error{"gnuplot does not start: " + std::generic_category().message(failed) +
                 "; install the package gnuplot-nox"};
  }
  int status = 0;
  if (::waitpid(process, &status, 0) != process || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    return Error{"gnuplot failed: " + text_of(messages)};
  }
  return Done{};
}

}  // namespace

Result<std::vector<std::string>> draw_plots(std::span<const Plot> plots) {
  const TemporaryFolder folder;
  if (folder.path().empty()) {
    return Error{"no folder can be made in " + std::filesystem::temp_directory_path().string()};
  }
  const auto name_of_plot = [](std::size_t i) {
    return fmt::format("plot{}", i + 1);
  };
  {
    std::ofstream script(folder.path() / "plots.gp");
    for (std::size_t i = 0; i < plots.size(); ++i) {
      script << script_of(plots[i], name_of_plot(i));
    }
  }
  const Result<Done> ran = run_gnuplot(folder.path());
  if (!ran) {
    return ran.error();
  }
  std::vector<std::string> drawn;
  for (std::size_t i = 0; i < plots.size(); ++i) {
    drawn.push_back(to_inline(text_of(folder.path() / (name_of_plot(i) + ".svg")), name_of_plot(i),
                              height_of(plots[i])));
  }
  return drawn;
}

Result<Done> try_gnuplot() {
  Plot plot;
  plot.series.emplace_back();
  plot.series[0].points = {{0.0, 0.0}, {1.0, 1.0}};
  const Result<std::vector<std::string>> drawn = draw_plots({&plot, 1});
  return drawn ? Result<Done>(Done{}) : Result<Done>(drawn.error());
}

}  // namespace torsion::engine
