#include "app/view/legend.hpp"

#include <vector>

#include <fmt/format.h>
#include <imgui.h>

#include "app/view/panel_style.hpp"
#include "render/colormap.hpp"
#include "render/heat_scale.hpp"

namespace torsion::engine {
namespace {

constexpr ImU32 kLegendPaper = IM_COL32(250, 250, 252, 225);
constexpr ImU32 kLegendInk = IM_COL32(25, 28, 33, 255);
constexpr float kLegendWidth = 236.0F;  // pixels
constexpr float kPad = 8.0F;

struct Row {
  ImU32 color;
  std::string words;
  bool dot = false;
};

std::vector<Row> rows_of(const ViewState& state) {
  std::vector<Row> rows;
  const DrawOptions& draw = state.draw;
  if (draw.arrows && draw.full_force > 0.0) {
    rows.push_back({kForceInk, fmt::format("force, full arrow {:.3g} N", draw.full_force)});
    rows.push_back(
        {kTorqueInk, fmt::format("{}, full arc {:.3g} N m", draw.torque_parts ? "r x F" : "torque",
                                 draw.full_torque)});
    if (draw.torque_parts) {
      rows.push_back({kCoupleInk, fmt::format("couple, full arc {:.3g} N m", draw.full_couple)});
    }
  }
  if (state.show_cells) {
    rows.push_back({kSticksInk, "sticks", true});
    rows.push_back({kSlipsInk, "slips", true});
  }
  return rows;
}

void draw_bar(ImDrawList& list, const DrawOptions& draw, ImVec2 at, float line) {
  constexpr int kSteps = 64;
  const HeatScale scale = heat_scale(draw.heat_map, draw.heat_limit);
  list.AddText(at, kLegendInk, scale.title.c_str());
  at.y += line + 1.0F;
  const float width = kLegendWidth - 2.0F * kPad;
  for (int i = 0; i < kSteps; ++i) {
    const glm::dvec3 color = 255.0 * heat_color(draw.heat_map, (i + 0.5) / kSteps);
    list.AddRectFilled(ImVec2(at.x + width * static_cast<float>(i) / kSteps, at.y),
                       ImVec2(at.x + width * static_cast<float>(i + 1) / kSteps, at.y + 10.0F),
                       IM_COL32(static_cast<int>(color.x), static_cast<int>(color.y),
                                static_cast<int>(color.z), 255));
  }
  for (const float share : {0.0F, 0.5F, 1.0F}) {
    const std::string number = fmt::format("{:.3g}", scale.value_at(static_cast<double>(share)));
    const float text_width = ImGui::CalcTextSize(number.c_str()).x;
    list.AddText(ImVec2(at.x + share * (width - text_width), at.y + 11.0F), kLegendInk,
                 number.c_str());
  }
}

void draw_row(ImDrawList& list, const Row& row, const ImVec2& at, float line) {
  const float middle = at.y + 0.5F * line;
  if (row.dot) {
    list.AddCircleFilled(ImVec2(at.x + 8.0F, middle), 4.0F, kSticksInk);
    list.AddCircleFilled(ImVec2(at.x + 8.0F, middle), 3.0F, row.color);
  } else {
    list.AddRectFilled(ImVec2(at.x, middle - 3.0F), ImVec2(at.x + 16.0F, middle + 3.0F), row.color);
  }
  list.AddText(ImVec2(at.x + 22.0F, at.y), kLegendInk, row.words.c_str());
}

}  // namespace

void draw_legend(const ViewState& state, const glm::dvec2& picture) {
  const std::vector<Row> rows = rows_of(state);
  const bool bar = state.draw.heat_map != HeatMap::kNone;
  if (rows.empty() && !bar) {
    return;
  }
  const float line = ImGui::GetTextLineHeight();
  const float bar_height = bar ? 2.0F * line + 14.0F : 0.0F;
  const float height = bar_height + line * static_cast<float>(rows.size()) + 2.0F * kPad;
  const ImVec2 low(static_cast<float>(picture.x) - kLegendWidth - 6.0F, 6.0F);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddRectFilled(low, ImVec2(low.x + kLegendWidth, low.y + height), kLegendPaper);
  ImVec2 at(low.x + kPad, low.y + kPad);
  if (bar) {
    draw_bar(list, state.draw, at, line);
    at.y += bar_height;
  }
  for (const Row& row : rows) {
    draw_row(list, row, at, line);
    at.y += line;
  }
}

}  // namespace torsion::engine
