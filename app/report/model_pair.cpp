#include "app/report/model_pair.hpp"

#include <array>
#include <span>

#include <fmt/format.h>

#include "ecs/model_names.hpp"
#include "ecs/world.hpp"
#include "systems/contact/law.hpp"

namespace torsion::engine {
namespace {

constexpr std::array<std::uint32_t, 5> kGridSides = {8, 12, 16, 20, 24};
constexpr std::array<std::uint32_t, 3> kQuickGridSides = {8, 12, 16};

}  // namespace

std::vector<ModelPair> model_pairs(const ReferenceCase& reference_case, bool quick) {
  const std::uint32_t side_unless_chosen = Settings{}.grid_side;
  const std::array<std::uint32_t, 1> one = {side_unless_chosen};
  std::vector<ModelPair> pairs;
  // The first of each enum is kAuto.
  for (std::size_t c = 1; c < kContactModelNames.size(); ++c) {
    const auto contact = static_cast<ContactModel>(c);
    std::span<const std::uint32_t> sides = one;
    if (contact == ContactModel::kPatch) {
      sides = quick ? std::span<const std::uint32_t>(kQuickGridSides) : kGridSides;
    }
    for (std::size_t b = 1; b < kBodyModelNames.size(); ++b) {
      const auto body = static_cast<BodyModel>(b);
      if (body != BodyModel::kNone &&
          (!reference_case.finite_body || contact_law(contact).is_of_whole_body)) {
        continue;
      }
      for (const std::uint32_t side : sides) {
        pairs.push_back({contact, body, side});
      }
    }
  }
  return pairs;
}

std::string label_of(const ModelPair& models) {
  const std::string body =
      models.body == BodyModel::kNone ? "" : fmt::format(" + {}", name_of(models.body));
  return models.contact == ContactModel::kPatch
             ? fmt::format("patch {}\u00b2{}", models.grid_side, body)
             : fmt::format("{}{}", name_of(models.contact), body);
}

}  // namespace torsion::engine
