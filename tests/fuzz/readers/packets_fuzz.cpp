// What devices with motors say, cut into transfers anywhere.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "device/protocols/falcon.hpp"
#include "device/protocols/falcon_kinematics.hpp"
#include "device/protocols/moteus.hpp"
#include "device/protocols/odrive.hpp"
#include "device/protocols/wooden_haptics.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  torsion::engine::Bytes rest(data, size);
  torsion::engine::FalconStream falcon;
  torsion::engine::OdriveStream odrive;
  torsion::engine::OdriveStream version;
  torsion::engine::MoteusStream moteus;
  bool versioned = false;
  while (!rest.empty()) {
    const std::size_t length = std::min<std::size_t>(rest[0] % 64 + 1, rest.size());
    const torsion::engine::Bytes transfer = rest.first(length);
    rest = rest.subspan(length);
    const std::string_view text(reinterpret_cast<const char*>(transfer.data()), transfer.size());
    if (const auto input = torsion::engine::take_ftdi_packet(falcon, transfer)) {
      torsion::engine::falcon_forward(torsion::engine::falcon_joint_angles(*input),
                                      {0.0, 0.0, 0.115});
    }
    torsion::engine::take_odrive_bytes(odrive, text);
    torsion::engine::take_moteus_bytes(moteus, text, [](std::string_view line) {
      static_cast<void>(torsion::engine::decode_moteus_reply(line));
      static_cast<void>(torsion::engine::decode_moteus_register_map(line));
    });
    versioned = versioned || torsion::engine::take_odrive_version(version, text).has_value();
    if (const auto input = torsion::engine::decode_wooden(transfer)) {
      const auto geometry = torsion::engine::wooden_haptics_2015();
      torsion::engine::wooden_currents(geometry,
                                       torsion::engine::wooden_body_angles(geometry, *input),
                                       glm::dvec3(1.0, -2.0, 3.0));
    }
  }
  return 0;
}
