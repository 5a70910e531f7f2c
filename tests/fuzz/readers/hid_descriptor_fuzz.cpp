// A device's report descriptor, and reports as it describes them.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "device/protocols/space_mouse.hpp"
#include "device/protocols/wheel.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const torsion::engine::Bytes bytes(data, size);
  const std::size_t cut = size > 0 ? std::min<std::size_t>(data[0] * std::size_t{4}, size) : 0;
  const auto reports = torsion::engine::parse_hid_descriptor(bytes.first(cut));
  const auto layout = reports ? torsion::engine::space_mouse_layout(*reports) : std::nullopt;
  torsion::engine::SpaceMouseState state;
  for (const auto& one : {layout, std::optional(torsion::engine::usual_space_mouse_layout())}) {
    if (one) {
      torsion::engine::take_space_mouse_report(*one, bytes.subspan(cut), state);
    }
  }
  if (const auto wheel = reports ? torsion::engine::wheel_layout(*reports) : std::nullopt) {
    torsion::engine::WheelState turned;
    torsion::engine::take_wheel_report(*wheel, bytes.subspan(cut), turned);
    static_cast<void>(torsion::engine::decode_wheel_load(*wheel, bytes.subspan(cut)));
    static_cast<void>(torsion::engine::encode_wheel_effect(*wheel, 1, 0.05));
    static_cast<void>(torsion::engine::encode_wheel_torque(*wheel, 1, 1.0));
    static_cast<void>(torsion::engine::encode_wheel_start(*wheel, 1));
    static_cast<void>(torsion::engine::encode_wheel_reset(*wheel));
    static_cast<void>(torsion::engine::encode_wheel_create(*wheel));
  }
  return 0;
}
