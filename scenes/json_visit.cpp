#include "scenes/json_visit.hpp"

namespace torsion::engine {
namespace {

using Seen = std::function<void(const nlohmann::json&, const std::string&)>;

void visit(const nlohmann::json& at, std::string_view pattern, const std::string& place,
           const Seen& seen) {
  if (pattern.empty()) {
    seen(at, place);
    return;
  }
  const std::size_t slash = pattern.find('/');
  const std::string_view step = pattern.substr(0, slash);
  const std::string_view rest =
      slash == std::string_view::npos ? std::string_view{} : pattern.substr(slash + 1);
  const std::string dot = place.empty() ? "" : place + ".";
  if (step == "[]" && at.is_array()) {
    for (std::size_t i = 0; i < at.size(); ++i) {
      visit(at[i], rest, place + "[" + std::to_string(i) + "]", seen);
    }
  } else if (step == "*" && at.is_object()) {
    for (const auto& [key, value] : at.items()) {
      visit(value, rest, dot + key, seen);
    }
  } else if (at.is_object() && at.contains(step)) {
    visit(at[std::string(step)], rest, dot + std::string(step), seen);
  }
}

}  // namespace

void visit_json(const nlohmann::json& document, std::string_view pattern, const Seen& seen) {
  visit(document, pattern, "", seen);
}

std::string shown(const nlohmann::json& value) {
  constexpr std::size_t kLongest = 80;
  std::string text = value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  if (text.size() > kLongest) {
    text.resize(kLongest - 3);
    text += "...";
  }
  return text;
}

}  // namespace torsion::engine
