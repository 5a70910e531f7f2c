#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "app/live/device_link.hpp"
#include "app/run_statistics.hpp"
#include "app/session.hpp"

namespace torsion::engine {

/// What a run wrote, and how it ran.
struct RunFacts {
  std::string trace;                 // where the trace is; empty: there is none
  std::string recording;             // likewise
  std::string page;                  // likewise, that plays the run
  std::string problem;               // why there is no recording though one was asked for
  std::optional<DeviceView> device;  // of what held the tool at the end
  std::uint64_t steps_left = 0;      // that a signal has kept the run from
  std::string mode;  // what the system granted a run on the clock; empty: it was not on it
};

/// How a run on the clock kept its time, histograms and all, lines for a person.
/// @param mode  what the system granted its thread
std::string clock_text(const RunStatistics& statistics, const std::string& mode);

/// The same as keys of an object, in which "step_us" is an object.
void add_clock(nlohmann::ordered_json& json, const RunStatistics& statistics,
               const std::string& mode);

/// What a run came to, for a person.
std::string summary_text(const Session& session, const RunStatistics& statistics,
                         const RunFacts& facts);

/// The same as one JSON object.
std::string summary_json(const Session& session, const RunStatistics& statistics,
                         const RunFacts& facts);

}  // namespace torsion::engine
