#include "app/view/gui.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <imgui.h>

namespace torsion::engine {
namespace {

// What ImGui writes is what the renderer reads.
static_assert(sizeof(ImDrawVert) == sizeof(OverlayVertex));
static_assert(offsetof(ImDrawVert, pos) == offsetof(OverlayVertex, x));
static_assert(offsetof(ImDrawVert, uv) == offsetof(OverlayVertex, u));
static_assert(offsetof(ImDrawVert, col) == offsetof(OverlayVertex, rgba));

void set_style() {
  ImGui::StyleColorsLight();
  ImGuiStyle& style = ImGui::GetStyle();
  style.AntiAliasedLinesUseTex = false;  // the overlay takes texels as they are
  // Panels are opaque rectangles, so that they can be kept and laid over a picture.
  style.WindowRounding = 0.0F;
  style.PopupRounding = 0.0F;
  style.PopupBorderSize = 0.0F;
  style.FrameRounding = 3.0F;
  style.WindowBorderSize = 0.0F;
  style.Colors[ImGuiCol_WindowBg] = ImVec4(0.98F, 0.98F, 0.985F, 1.0F);
  style.Colors[ImGuiCol_PopupBg] = ImVec4(1.0F, 1.0F, 1.0F, 1.0F);
  style.Colors[ImGuiCol_FrameBg] = ImVec4(0.87F, 0.89F, 0.92F, 1.0F);
  style.Colors[ImGuiCol_TextDisabled] = ImVec4(0.36F, 0.38F, 0.42F, 1.0F);
  style.Colors[ImGuiCol_Text] = ImVec4(0.10F, 0.11F, 0.13F, 1.0F);
}

struct EditKey {
  int window;     // as WindowInput has it
  ImGuiKey edit;  // what it does
};
constexpr std::array kEditKeys = {
    EditKey{kKeyEscape, ImGuiKey_Escape}, EditKey{kKeyEnter, ImGuiKey_Enter},
    EditKey{kKeyTab, ImGuiKey_Tab},       EditKey{kKeyBackspace, ImGuiKey_Backspace},
    EditKey{kKeyDelete, ImGuiKey_Delete}, EditKey{kKeyRight, ImGuiKey_RightArrow},
    EditKey{kKeyLeft, ImGuiKey_LeftArrow}};

/// A key that went down goes up in the next picture.
void press(const std::vector<int>& pressed) {
  ImGuiIO& io = ImGui::GetIO();
  for (const EditKey& key : kEditKeys) {
    const bool down = std::ranges::find(pressed, key.window) != pressed.end();
#if IMGUI_VERSION_NUM >= 18700
    io.AddKeyEvent(key.edit, down);
#else
    io.KeyMap[key.edit] = key.window;
    io.KeysDown[key.window] = down;
#endif
  }
}

/// Numbers are all that is typed.
void type(const std::vector<int>& pressed) {
  for (const int key : pressed) {
    if ((key >= '0' && key <= '9') || key == '.' || key == '-' || key == 'E') {
      ImGui::GetIO().AddInputCharacter(key == 'E' ? 'e' : static_cast<unsigned>(key));
    }
  }
}

}  // namespace

Gui::Gui(std::span<const Image> pictures) {
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // no file beside the scene
  io.LogFilename = nullptr;
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;  // lists of over 65536 vertices
  set_style();
  atlas_ = make_atlas(pictures, cards_);
}

Gui::~Gui() {
  ImGui::DestroyContext();
}

void Gui::begin(const WindowInput& input, double seconds) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(static_cast<float>(input.width), static_cast<float>(input.height));
  io.DeltaTime = static_cast<float>(std::max(seconds, 1e-4));
  io.MousePos = ImVec2(static_cast<float>(input.mouse_x), static_cast<float>(input.mouse_y));
  std::copy(input.buttons.begin(), input.buttons.end(), io.MouseDown);
  io.MouseWheel = static_cast<float>(input.wheel);
  io.KeyShift = input.shift;
  io.KeyAlt = input.alt;
  io.KeyCtrl = input.control;
  press(input.pressed);
  type(input.pressed);
  ImGui::NewFrame();
}

void Gui::append(const ImDrawCmd& command, const ImDrawList& from, std::uint32_t base_vertex) {
  const auto left = static_cast<std::int32_t>(std::floor(command.ClipRect.x));
  const auto top = static_cast<std::int32_t>(std::floor(command.ClipRect.y));
  const auto right = static_cast<std::int32_t>(std::ceil(command.ClipRect.z));
  const auto bottom = static_cast<std::int32_t>(std::ceil(command.ClipRect.w));
  if (right <= left || bottom <= top) {
    return;
  }
  list_.clips.push_back({static_cast<std::uint32_t>(list_.indices.size()), command.ElemCount, left,
                         top, static_cast<std::uint32_t>(right - left),
                         static_cast<std::uint32_t>(bottom - top)});
  for (unsigned i = 0; i < command.ElemCount; ++i) {
    const ImDrawIdx index = from.IdxBuffer[static_cast<int>(command.IdxOffset + i)];
    list_.indices.push_back(base_vertex + command.VtxOffset + index);
  }
}

/// A window of ImGui's covers a rectangle, which its first command fills: set_style() sees to it.
void Gui::append_panel(const ImDrawList& from) {
  ImVec2 lowest(1e9F, 1e9F);
  ImVec2 highest(-1e9F, -1e9F);
  for (const ImDrawCmd& command : from.CmdBuffer) {
    for (unsigned i = 0; i < command.ElemCount; ++i) {
      const ImDrawIdx index = from.IdxBuffer[static_cast<int>(command.IdxOffset + i)];
      const ImVec2& at = from.VtxBuffer[static_cast<int>(command.VtxOffset + index)].pos;
      const float x = std::clamp(at.x, command.ClipRect.x, command.ClipRect.z);
      const float y = std::clamp(at.y, command.ClipRect.y, command.ClipRect.w);
      lowest = ImVec2(std::min(lowest.x, x), std::min(lowest.y, y));
      highest = ImVec2(std::max(highest.x, x), std::max(highest.y, y));
    }
  }
  const auto left = static_cast<std::int32_t>(std::lround(lowest.x));
  const auto top = static_cast<std::int32_t>(std::lround(lowest.y));
  const auto right = static_cast<std::int32_t>(std::lround(highest.x));
  const auto bottom = static_cast<std::int32_t>(std::lround(highest.y));
  if (right > left && bottom > top) {
    list_.panels.push_back({left, top, static_cast<std::uint32_t>(right - left),
                            static_cast<std::uint32_t>(bottom - top)});
  }
}

const OverlayDrawList& Gui::end() {
  ImGui::Render();
  const ImDrawData& data = *ImGui::GetDrawData();
  list_.vertices.clear();
  list_.indices.clear();
  list_.clips.clear();
  list_.panels.clear();
  std::size_t marks = 0;
  for (int i = 0; i < data.CmdListsCount; ++i) {
    const ImDrawList& from = *data.CmdLists[i];
    if (&from != ImGui::GetBackgroundDrawList()) {
      append_panel(from);
    }
    const auto base_vertex = static_cast<std::uint32_t>(list_.vertices.size());
    const auto* vertices = reinterpret_cast<const OverlayVertex*>(from.VtxBuffer.Data);
    list_.vertices.insert(list_.vertices.end(), vertices, vertices + from.VtxBuffer.Size);
    for (const ImDrawCmd& command : from.CmdBuffer) {
      append(command, from, base_vertex);
    }
    marks = list_.panels.empty() ? list_.clips.size() : marks;
  }
  list_.panel_clips = list_.clips.size() - marks;
  return list_;
}

bool Gui::has_keyboard() {
  return ImGui::GetIO().WantTextInput;
}

bool Gui::has_mouse() {
  return ImGui::GetIO().WantCaptureMouse;
}

}  // namespace torsion::engine
