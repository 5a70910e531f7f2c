#pragma once

// How much of the window the panel takes.

#include "app/view/view_state.hpp"

namespace torsion::engine {

// Pixels.
inline constexpr float kPanelWidth = 320.0F;  // a quarter of the window at first
inline constexpr float kIconsWidth = 40.0F;   // of the folded panel

/// Whether the panel is a column of icons: in small windows, unless a person says otherwise.
inline bool folded(const ViewState& state, float width, float height) {
  constexpr float kSmallWidth = 960.0F;
  constexpr float kSmallHeight = 560.0F;
  return state.folded.value_or(width < kSmallWidth || height < kSmallHeight);
}

/// Columns of the window, from the left, that the panel covers.
inline float covered_columns(const ViewState& state, float width, float height) {
  if (!state.show_panels) {
    return 0.0F;
  }
  return folded(state, width, height) ? kIconsWidth : kPanelWidth;
}

}  // namespace torsion::engine
