#pragma once

namespace torsion::engine {

/// What a motor can do for long, as far as its heat goes: a winding's loss is the square of its
/// current, and its temperature follows that loss with one time constant (I^2 t; Hanselman,
/// Brushless Motors, 2003, ch. 5).
struct ThermalLimit {
  double continuous = 0.0;  // N or N m: for ever; 0: not known, and nothing is limited
  double time = 10.0;       // s
  double loss = 0.0;        // N^2 or (N m)^2: mean square of what was sent, over `time`
};

/// The most that may be sent now: `largest` while the mean square is under four fifths of what the
/// motor bears for ever, from there down to `continuous` where it is all of that.
double allowed_now(const ThermalLimit& limit, double largest);

/// `sent` was held for `period` [s].
void take_loss(ThermalLimit& limit, double sent, double period);

}  // namespace torsion::engine
