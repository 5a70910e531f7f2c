#pragma once

// How much of the window the panel takes.

#include "app/view/view_state.hpp"

namespace torsion::engine {

// Pixels.
inline constexpr double kPanelWidth = 320.0;  // a quarter of the window at first
inline constexpr double kIconsWidth = 40.0;   // of the folded panel

/// Whether the panel is a column of icons: in small windows, unless a person says otherwise.
inline bool folded(const ViewState& state, double width, double height) {
  constexpr double kSmallWidth = 960.0;
  constexpr double kSmallHeight = 560.0;
  return state.folded.value_or(width < kSmallWidth || height < kSmallHeight);
}

/// Columns of the window, from the left, that the panel covers.
inline double covered_columns(const ViewState& state, double width, double height) {
  if (!state.show_panels) {
    return 0.0;
  }
  return folded(state, width, height) ? kIconsWidth : kPanelWidth;
}

}  // namespace torsion::engine
