#include "app/report/model_pair.hpp"

#include <array>
#include <span>

#include <fmt/format.h>

#include "ecs/world.hpp"

namespace torsion {
namespace {

constexpr std::array kContactModels = {ContactModel::kPaper, ContactModel::kMdr,
                                       ContactModel::kPatch};
constexpr std::array kBodyModels = {BodyModel::kNone, BodyModel::kSkeleton};
constexpr std::array<std::uint32_t, 5> kGridSides = {8, 12, 16, 20, 24};
constexpr std::array<std::uint32_t, 2> kQuickGridSides = {8, 12};

}  // namespace

std::vector<ModelPair> model_pairs(const ReferenceCase& reference_case, bool quick) {
  const std::uint32_t side_unless_chosen = Settings{}.grid_side;
  const std::array<std::uint32_t, 1> one = {side_unless_chosen};
  std::vector<ModelPair> pairs;
  for (const ContactModel contact : kContactModels) {
    std::span<const std::uint32_t> sides = one;
    if (contact == ContactModel::kPatch) {
      sides = quick ? std::span<const std::uint32_t>(kQuickGridSides) : kGridSides;
    }
    for (const BodyModel body : kBodyModels) {
      if (body != BodyModel::kNone && !reference_case.finite_body) {
        continue;
      }
      for (const std::uint32_t side : sides) {
        pairs.push_back({contact, body, side});
      }
    }
  }
  return pairs;
}

const char* report_name(ContactModel model) {
  switch (model) {
    case ContactModel::kPaper:
      return "paper";
    case ContactModel::kMdr:
      return "mdr";
    case ContactModel::kPatch:
      return "patch";
    case ContactModel::kAuto:
      break;
  }
  return "auto";
}

const char* report_name(BodyModel model) {
  switch (model) {
    case BodyModel::kNone:
      return "none";
    case BodyModel::kSkeleton:
      return "skeleton";
    case BodyModel::kAuto:
      break;
  }
  return "auto";
}

std::string label_of(const ModelPair& models) {
  const std::string body =
      models.body == BodyModel::kNone ? "" : fmt::format(" + {}", report_name(models.body));
  return models.contact == ContactModel::kPatch
             ? fmt::format("patch {0}\u00d7{0}{1}", models.grid_side, body)
             : report_name(models.contact) + body;
}

}  // namespace torsion
