#pragma once

#include <optional>
#include <string>

#include "app/live/device_link.hpp"
#include "app/run_statistics.hpp"
#include "app/session.hpp"

namespace torsion {

/// What a run wrote, and how it ran.
struct RunFacts {
  std::string trace;                 // where the trace is; empty: there is none
  std::string recording;             // likewise
  std::optional<DeviceView> device;  // of what held the tool at the end
  std::string mode;  // what the system granted a run on the clock; empty: it was not on it
};

/// What a run came to, for a person.
std::string summary_text(const Session& session, const RunStatistics& statistics,
                         const RunFacts& facts);

/// The same as one JSON object.
std::string summary_json(const Session& session, const RunStatistics& statistics,
                         const RunFacts& facts);

}  // namespace torsion
