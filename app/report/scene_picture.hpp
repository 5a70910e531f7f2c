#pragma once

#include "app/report/reference_case.hpp"
#include "ecs/result.hpp"

namespace torsion::engine {

/// The scene where the tool has moved farthest, by the program's own renderer, as a PNG file's
/// bytes. Fails where there is no device to draw on.
Result<std::string> scene_picture(const ReferenceCase& reference_case);

/// The whole path with the models of the picture, for a frame of the page: run_page_data().
Result<std::string> scene_run(const ReferenceCase& reference_case);

}  // namespace torsion::engine
