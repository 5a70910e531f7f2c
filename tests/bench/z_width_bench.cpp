// The Z-width of emulated devices: the stiffest virtual wall that does not shake, by virtual
// damping. With a file's name it draws docs/images/z_width.png by gnuplot.

#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "tests/systems/hold/z_width.hpp"

namespace {

using torsion::engine::test::kWallDevices;
using torsion::engine::test::largest_stable_stiffness;
using torsion::engine::test::passive_stiffness;
using torsion::engine::test::WallDevice;

struct Row {
  double damping;  // B, N s/m; in turning N m s/rad
  double passive;  // K, N/m; in turning N m/rad
  double free;
  double held;
};

constexpr const char* kLabels =
    "set ylabel 'K, N/m'\nset label 1 'held' at graph 0.06,0.76\n"
    "set label 2 'pushed' at graph 0.42,0.17\nset label 3 'passive' at graph 0.3,0.06";
constexpr std::size_t kFirstTurning = 3;  // of the devices: those before it translate

std::vector<Row> rows_of(const WallDevice& device) {
  std::vector<Row> rows;
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0, 2.0, 3.0, 4.0}) {
    const double damping = share * device.damping;
    rows.push_back({damping, passive_stiffness(device, damping),
                    largest_stable_stiffness(device, damping, false),
                    largest_stable_stiffness(device, damping, true)});
  }
  return rows;
}

void draw(const std::string& path, const std::vector<std::vector<Row>>& all) {
  std::FILE* const gnuplot = ::popen("gnuplot", "w");
  if (gnuplot == nullptr) {
    return;
  }
  std::fprintf(gnuplot,
               "set terminal pngcairo size 1400,340 background '#ffffff' font 'sans,12'\n"
               "set output '%s'\nset multiplot layout 1,%zu\nset grid\nset yrange [0:*]\n"
               "set xtics 1\nunset key\n",
               path.c_str(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const WallDevice& device = kWallDevices[i];
    std::fprintf(gnuplot, "set title '%s'\nset xlabel 'B / b, b = %g'\n%s\n", device.name,
                 device.damping,
                 i == 0               ? kLabels
                 : i == kFirstTurning ? "set ylabel 'K, N m/rad'"
                                      : "unset ylabel; unset label");
    std::fprintf(gnuplot,
                 "plot '-' using 1:2 with filledcurves x1 fc '#a9cdeb',"
                 "'-' using 1:2 with lines lw 2 lc '#c0392b',"
                 "'-' using 1:2 with lines lw 2 lc '#2c3e50'\n");
    for (const double Row::*column : {&Row::passive, &Row::free, &Row::held}) {
      for (const Row& row : all[i]) {
        std::fprintf(gnuplot, "%g %g\n", row.damping / device.damping, row.*column);
      }
      std::fprintf(gnuplot, "e\n");
    }
  }
  ::pclose(gnuplot);
}

}  // namespace

int main(int count, char** arguments) {
  std::vector<std::vector<Row>> all;
  for (const WallDevice& device : kWallDevices) {
    std::printf("%s, b = %g: largest K\n      B    passive    pushed      held\n", device.name,
                device.damping);
    all.push_back(rows_of(device));
    for (const Row& row : all.back()) {
      std::printf("%7.4f %10.4g %9.4g %9.4g\n", row.damping, row.passive, row.free, row.held);
    }
  }
  if (count > 1) {
    draw(arguments[1], all);
  }
  return 0;
}
