#pragma once

#include <functional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace torsion::engine {

/// Calls `seen` with every value that a pattern such as "nodes/[]/children/[]" leads to, and with
/// its place as nodes[3].children[0]. "[]" stands for each element of an array, "*" for each member
/// of an object; what is not there or of another kind is passed over.
void visit_json(const nlohmann::json& document, std::string_view pattern,
                const std::function<void(const nlohmann::json&, const std::string&)>& seen);

/// A value as it stands in the file, cut to a readable length.
std::string shown(const nlohmann::json& value);

}  // namespace torsion::engine
