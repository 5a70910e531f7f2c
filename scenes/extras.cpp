#include "scenes/extras.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

namespace torsion::engine {
namespace {

constexpr std::string_view kPrefix = "torsion_";

/// Levenshtein's distance: single letters inserted, removed or changed.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, changed});
    }
  }
  return row.back();
}

std::string number_text(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

std::string value_text(const tinygltf::Value& value) {
  if (value.IsString()) {
    return '"' + value.Get<std::string>() + '"';
  }
  if (value.IsNumber()) {
    return number_text(value.GetNumberAsDouble());
  }
  if (value.IsBool()) {
    return value.Get<bool>() ? "true" : "false";
  }
  if (value.IsArray()) {
    return "an array";
  }
  return value.IsObject() ? "an object" : "null";
}

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    words.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

bool fits_number(const SceneKey& key, const tinygltf::Value& value) {
  return value.IsNumber() && key.allows(value.GetNumberAsDouble());
}

bool fits_vector(const SceneKey& key, const tinygltf::Value& value) {
  if (!value.IsArray() || value.ArrayLen() != 3) {
    return false;
  }
  for (const tinygltf::Value& number : value.Get<tinygltf::Value::Array>()) {
    if (!number.IsNumber() || !key.allows(number.GetNumberAsDouble())) {
      return false;
    }
  }
  return true;
}

bool fits(const SceneKey& key, const tinygltf::Value& value) {
  switch (key.kind) {
    case KeyKind::kNumber:
      return fits_number(key, value);
    case KeyKind::kVector:
      return fits_vector(key, value);
    case KeyKind::kFlag:
      return value.IsBool() || (value.IsNumber() && (value.GetNumberAsDouble() == 0.0 ||
                                                     value.GetNumberAsDouble() == 1.0));
    case KeyKind::kText:
      return value.IsString();
    case KeyKind::kWord: {
      const auto words = words_of(key.allowed);
      return value.IsString() && std::ranges::find(words, value.Get<std::string>()) != words.end();
    }
  }
  return false;
}

std::string expected_of(const SceneKey& key, const tinygltf::Value& value) {
  if (key.kind != KeyKind::kWord) {
    return "expected " + std::string(key.allowed);
  }
  const auto words = words_of(key.allowed);
  std::string text = "expected one of";
  for (const std::string_view word : words) {
    text += (word == words.front() ? " " : ", ") + std::string(word);
  }
  const auto meant =
      value.IsString() ? did_you_mean(value.Get<std::string>(), words) : std::nullopt;
  return meant ? text + "; did you mean \"" + *meant + "\"?" : text;
}

const SceneKey* find_key(std::string_view name) {
  const auto* const found = std::ranges::find(kSceneKeys, name, &SceneKey::name);
  return found == kSceneKeys.end() ? nullptr : &*found;
}

/// Keys in which the unknown one is a word: "friction" is in two of them.
std::string keys_with(std::string_view unknown, const std::vector<std::string_view>& known) {
  constexpr std::size_t kShortest = 4;  // letters of a word that says something
  std::string text;
  for (const std::string_view key : known) {
    if (unknown.size() >= kShortest && key.find(unknown) != std::string_view::npos) {
      text += (text.empty() ? "" : " or ") + std::string(kPrefix) + std::string(key);
    }
  }
  return text;
}

void add_unknown(const std::string& name, const tinygltf::Value& value, const std::string& where,
                 const ProblemList& problems) {
  // What all keys begin with makes none of them nearer.
  std::vector<std::string_view> known;
  known.reserve(kSceneKeys.size());
  for (const SceneKey& key : kSceneKeys) {
    known.push_back(key.name.substr(kPrefix.size()));
  }
  const std::string_view unknown = std::string_view(name).substr(kPrefix.size());
  const auto meant = did_you_mean(unknown, known);
  const std::string listed = meant ? std::string(kPrefix) + *meant : keys_with(unknown, known);
  problems.add(where, name, value_text(value), "there is no such key",
               listed.empty() ? "take it out; docs/scenes.md lists the keys that there are"
                              : "did you mean " + listed + "?");
}

std::string_view name_of(Role role) {
  if (role == Role::kPart) {
    return "a mesh below an elastic node or a tool";
  }
  if (role == Role::kScene) {
    return "the scene";
  }
  const auto* const found = std::ranges::find(kRoleNames, role, &RoleName::role);
  return found == kRoleNames.end() ? "a node without a torsion_role" : found->name;
}

std::string roles_text(std::uint32_t roles) {
  std::string text;
  for (const RoleName& name : kRoleNames) {
    if ((roles & bits(name.role)) != 0) {
      text += (text.empty() ? "" : " or ") + std::string(name.name);
    }
  }
  return text.empty() ? std::string(name_of(Role::kScene)) : text;
}

}  // namespace

std::string called(std::string_view kind, std::string_view array, std::size_t row,
                   const std::string& name) {
  return name.empty() ? std::string(array) + "[" + std::to_string(row) + "]"
                      : std::string(kind) + " \"" + name + '"';
}

std::optional<std::string> did_you_mean(std::string_view word,
                                        const std::vector<std::string_view>& known) {
  std::optional<std::string> best;
  std::size_t least = (word.size() + 2) / 3 + 1;  // a third of its letters may be wrong
  for (const std::string_view candidate : known) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

void NodeKeys::add(const tinygltf::Value& extras, const std::string& where,
                   const ProblemList& problems) {
  if (!extras.IsObject()) {
    return;
  }
  for (const std::string& name : extras.Keys()) {
    if (!name.starts_with(kPrefix)) {
      continue;
    }
    const tinygltf::Value& value = extras.Get(name);
    const SceneKey* key = find_key(name);
    if (key == nullptr) {
      add_unknown(name, value, where, problems);
    } else if (!fits(*key, value)) {
      problems.add(where, name, value_text(value), expected_of(*key, value));
    } else {
      entries_.insert_or_assign(name, Entry{value, where});
    }
  }
}

void NodeKeys::check_role(Role role, const ProblemList& problems) const {
  for (const auto& [name, entry] : entries_) {
    const SceneKey* key = find_key(name);
    if ((key->roles & bits(role)) == 0) {
      problems.add(
          entry.where, name, value_text(entry.value),
          "belongs to " + roles_text(key->roles) + ", but this is " + std::string(name_of(role)),
          key->roles == bits(Role::kScene) ? "move it to the extras of the scene"
          : role == Role::kScene           ? "move it to such a node"
                                 : "move it to such a node, or set this node's torsion_role");
    }
  }
}

std::optional<double> NodeKeys::number(const std::string& key) const {
  const auto found = entries_.find(key);
  return found == entries_.end() ? std::nullopt
                                 : std::optional(found->second.value.GetNumberAsDouble());
}

std::optional<std::string> NodeKeys::text(const std::string& key) const {
  const auto found = entries_.find(key);
  return found == entries_.end() ? std::nullopt
                                 : std::optional(found->second.value.Get<std::string>());
}

std::optional<bool> NodeKeys::flag(const std::string& key) const {
  const auto found = entries_.find(key);
  if (found == entries_.end()) {
    return std::nullopt;
  }
  const tinygltf::Value& value = found->second.value;
  return value.IsBool() ? value.Get<bool>() : value.GetNumberAsDouble() != 0.0;
}

std::optional<glm::dvec3> NodeKeys::vector(const std::string& key) const {
  const auto found = entries_.find(key);
  if (found == entries_.end()) {
    return std::nullopt;
  }
  const tinygltf::Value& value = found->second.value;
  return glm::dvec3(value.Get(0).GetNumberAsDouble(), value.Get(1).GetNumberAsDouble(),
                    value.Get(2).GetNumberAsDouble());
}

std::string NodeKeys::where(const std::string& key) const {
  const auto found = entries_.find(key);
  return found == entries_.end() ? std::string{} : found->second.where;
}

Role role_of(const tinygltf::Value& extras) {
  if (!extras.IsObject() || !extras.Has("torsion_role") || !extras.Get("torsion_role").IsString()) {
    return Role::kNone;
  }
  const auto* const found =
      std::ranges::find(kRoleNames, extras.Get("torsion_role").Get<std::string>(), &RoleName::name);
  return found == kRoleNames.end() ? Role::kNone : found->role;
}

}  // namespace torsion::engine
