#include "app/live/measured_traits.hpp"

#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/live/device_choice.hpp"
#include "app/output_file.hpp"

namespace torsion::engine {
namespace {

namespace fs = std::filesystem;

struct Entry {
  const char* name;
  double MeasuredTraits::*value;
};

constexpr std::array<Entry, 6> kEntries = {{{"mass_kg", &MeasuredTraits::mass},
                                            {"damping_N_s_per_m", &MeasuredTraits::damping},
                                            {"inertia_kg_m2", &MeasuredTraits::inertia},
                                            {"turn_damping_N_m_s", &MeasuredTraits::turn_damping},
                                            {"delay_s", &MeasuredTraits::delay},
                                            {"weight_N", &MeasuredTraits::weight}}};

Result<MeasuredTraits> read(const fs::path& path) {
  std::ifstream file(path);
  const auto json = nlohmann::json::parse(file, nullptr, false);
  if (!json.is_object()) {
    return Error{path.string() +
                 ": is no JSON object; measure the device again (torsion devices --measure) or "
                 "take the file away"};
  }
  MeasuredTraits traits;
  for (const Entry& entry : kEntries) {
    const auto found = json.find(entry.name);
    if (found == json.end()) {
      continue;
    }
    const double value = found->is_number() ? found->get<double>() : std::nan("");
    if (!(value >= 0.0 && std::isfinite(value))) {
      return Error{
          fmt::format("{}: {} is {}; expected a number that is not negative. Measure the "
                      "device again (torsion devices --measure) or take the file away",
                      path.string(), entry.name, found->dump())};
    }
    traits.*entry.value = value;
  }
  return traits;
}

}  // namespace

fs::path measured_traits_file(DeviceKind kind) {
  return user_data_folder() / "devices" / (std::string(word_of(kind)) + ".json");
}

Result<std::array<MeasuredTraits, kDeviceKinds>> load_measured_traits() {
  std::array<MeasuredTraits, kDeviceKinds> all;
  for (std::uint32_t kind = 0; kind < kDeviceKinds; ++kind) {
    const fs::path path = measured_traits_file(static_cast<DeviceKind>(kind));
    std::error_code missing;
    if (!fs::exists(path, missing)) {
      continue;
    }
    Result<MeasuredTraits> one = read(path);
    if (!one) {
      return one.error();
    }
    all[kind] = one.value();
  }
  return all;
}

Result<Done> save_measured_traits(DeviceKind kind, const MeasuredTraits& traits) {
  const fs::path path = measured_traits_file(kind);
  std::error_code failed;
  fs::create_directories(path.parent_path(), failed);
  nlohmann::ordered_json json;
  for (const Entry& entry : kEntries) {
    json[entry.name] = traits.*entry.value;
  }
  auto file = OutputFile::create(path);
  if (!file) {
    return file.error();
  }
  file.value().write(json.dump(2) + "\n");
  return file.value().commit();
}

}  // namespace torsion::engine
