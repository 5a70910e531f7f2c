#pragma once

#include <string>

#include "app/run_statistics.hpp"
#include "app/session.hpp"

namespace torsion {

/// What a run came to, for a person.
/// @param trace  where the trace is; empty: there is none
std::string summary_text(const Session& session, const RunStatistics& statistics,
                         const std::string& trace);

/// The same as one JSON object.
std::string summary_json(const Session& session, const RunStatistics& statistics,
                         const std::string& trace);

}  // namespace torsion
