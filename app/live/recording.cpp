#include "app/live/recording.hpp"

#define XXH_INLINE_ALL
#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <xxhash.h>

#include "app/output_file.hpp"
#include "ecs/hash.hpp"
#include "ecs/model_names.hpp"

namespace torsion {
namespace {

using nlohmann::json;

constexpr std::uint32_t kVersion = 2;

struct FileHeader {
  std::array<char, 8> magic = {'T', 'O', 'R', 'S', 'R', 'E', 'C', '\0'};
  std::uint32_t order = 0x01020304;  // reads otherwise on a machine of the other byte order
  std::uint32_t version = kVersion;
  std::uint64_t json_size = 0;  // bytes
  std::uint64_t entries = 0;    // version 1 only, whose writer knew; else the file's size says it
};

json to_json(const std::vector<BodyPick>& picks) {
  json bodies = json::array();
  for (const BodyPick& pick : picks) {
    bodies.push_back({{"contact_model", name_of(pick.contact)},
                      {"body_model", name_of(pick.body)},
                      {"youngs_modulus_Pa", pick.elasticity.youngs_modulus},
                      {"poisson_ratio", pick.elasticity.poisson_ratio},
                      {"density_kg_m3", pick.elasticity.density},
                      {"static_friction", pick.friction.static_friction},
                      {"dynamic_friction", pick.friction.dynamic_friction}});
  }
  return bodies;
}

json to_json(const Recording& recording) {
  return {{"scene", recording.scene},
          {"rate_Hz", recording.rate},
          {"grid_side", recording.settings.grid_side},
          {"sweeps", recording.settings.sweeps},
          {"tools", recording.tools},
          {"world_hash", fmt::format("{:016x}", recording.world_hash)},
          {"scene_bodies", to_json(recording.scene_picks)},
          {"bodies", to_json(recording.picks)}};
}

BodyPick pick_from(const json& body) {
  BodyPick pick;
  pick.contact = contact_model_named(body.at("contact_model").get<std::string>()).value();
  pick.body = body_model_named(body.at("body_model").get<std::string>()).value();
  pick.elasticity = {body.at("youngs_modulus_Pa").get<double>(),
                     body.at("poisson_ratio").get<double>(),
                     body.at("density_kg_m3").get<double>()};
  pick.friction = {body.at("static_friction").get<double>(),
                   body.at("dynamic_friction").get<double>()};
  return pick;
}

/// Throws json::exception, bad_optional_access or invalid_argument where something is missing.
Recording from_json(const json& head) {
  Recording recording;
  recording.scene = head.at("scene").get<std::string>();
  recording.rate = head.at("rate_Hz").get<double>();
  recording.settings = {head.at("grid_side").get<std::uint32_t>(),
                        head.at("sweeps").get<std::uint32_t>()};
  recording.tools = head.at("tools").get<std::vector<std::string>>();
  recording.world_hash = std::stoull(head.at("world_hash").get<std::string>(), nullptr, 16);
  for (const json& body : head.at("scene_bodies")) {
    recording.scene_picks.push_back(pick_from(body));
  }
  for (const json& body : head.at("bodies")) {
    recording.picks.push_back(pick_from(body));
  }
  return recording;
}

Error bad(const std::filesystem::path& path, const std::string& what) {
  return Error{path.string() + ": " + what};
}

/// The fixed part and the sizes that it promises.
Result<FileHeader> read_header(const std::string& bytes, const std::filesystem::path& path) {
  FileHeader header;
  const FileHeader expected;
  if (bytes.size() < sizeof header + sizeof(std::uint64_t) ||
      std::memcmp(bytes.data(), expected.magic.data(), expected.magic.size()) != 0) {
    return bad(path, "not a recording of torsion (--record makes one)");
  }
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.order != expected.order) {
    return bad(path, "recorded on a machine of the other byte order");
  }
  if (header.version == 0 || header.version > kVersion) {
    return bad(path, fmt::format("recording of version {}, this program reads up to version {}",
                                 header.version, kVersion));
  }
  const std::uint64_t content = bytes.size() - sizeof header - sizeof(std::uint64_t);
  if (header.version > 1 && header.json_size <= content) {
    header.entries = (content - header.json_size) / sizeof(InputEntry);
  }
  const bool fits = header.json_size <= content &&
                    header.entries <= (content - header.json_size) / sizeof(InputEntry) &&
                    header.json_size + header.entries * sizeof(InputEntry) == content;
  if (!fits) {
    return bad(path, "the recording is damaged: it was cut short or something was added");
  }
  std::uint64_t checksum = 0;
  std::memcpy(&checksum, bytes.data() + bytes.size() - sizeof checksum, sizeof checksum);
  if (checksum != XXH3_64bits(bytes.data(), bytes.size() - sizeof checksum)) {
    return bad(path, "the recording is damaged: its checksum does not fit its content");
  }
  return header;
}

bool same(const BodyPick& a, const BodyPick& b) {
  return body_entry(0, 0, a).values == body_entry(0, 0, b).values;
}

/// Entries must be in the order of steps, with a pose for every tool in every step.
bool in_order(const Recording& recording) {
  const auto tools = static_cast<std::uint32_t>(recording.tools.size());
  std::uint64_t step = 0;
  std::uint32_t tool = 0;
  for (const InputEntry& entry : recording.entries) {
    if (!valid(entry, tools, static_cast<std::uint32_t>(recording.picks.size())) ||
        entry.step != step || (entry.kind == InputKind::kPose && entry.index != tool) ||
        (entry.kind != InputKind::kPose && tool != 0)) {
      return false;
    }
    if (entry.kind == InputKind::kPose && ++tool == tools) {
      tool = 0;
      ++step;
    }
  }
  return tool == 0;
}

PrepareOptions options_of(const Recording& recording) {
  PrepareOptions options;
  options.rate = recording.rate;
  options.settings = recording.settings;
  return options;
}

Result<Done> rebuild(const Recording& recording, const std::vector<BodyPick>& picks,
                     Session& session, bool quiet) {
  apply_picks(picks, session.scene);
  PrepareOptions options = options_of(recording);
  options.expected_poses = expected_poses(session.scene);
  Result<Simulation> made = prepare_with_bar(session.scene, options, quiet);
  if (!made) {
    return made.error();
  }
  carry_over(session.simulation.world, made.value().world);
  session.simulation = std::move(made).value();
  return Done{};
}

}  // namespace

Recording recording_head(const SceneDescription& scene, const std::vector<BodyPick>& picks,
                         const PrepareOptions& options, const World& world) {
  Recording recording;
  recording.scene = scene.path;
  recording.rate = options.rate;
  recording.settings = options.settings;
  recording.scene_picks = picks_of(scene, {});
  recording.picks = picks;
  for (const ToolDescription& tool : scene.tools) {
    recording.tools.push_back(tool.node);
  }
  recording.world_hash = hash(world);
  return recording;
}

Recording begin_recording(const Session& session, const PrepareOptions& options) {
  return recording_head(session.scene, picks_of(session.scene, options), options,
                        session.simulation.world);
}

std::uint64_t steps_in(const Recording& recording) {
  return recording.entries.empty() ? 0 : recording.entries.back().step + 1;
}

struct RecordingWriter::State {
  OutputFile file;
  XXH3_state_t hash;

  explicit State(OutputFile to) : file(std::move(to)) { XXH3_64bits_reset(&hash); }
  void write(const void* data, std::size_t size) {
    XXH3_64bits_update(&hash, data, size);
    file.write({static_cast<const char*>(data), size});
  }
};

RecordingWriter::RecordingWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
RecordingWriter::RecordingWriter(RecordingWriter&&) noexcept = default;
RecordingWriter& RecordingWriter::operator=(RecordingWriter&&) noexcept = default;
RecordingWriter::~RecordingWriter() = default;

Result<RecordingWriter> RecordingWriter::create(const std::filesystem::path& path,
                                                const Recording& head) {
  Result<OutputFile> file = OutputFile::create(path);
  if (!file) {
    return file.error();
  }
  auto state = std::make_unique<State>(std::move(file).value());
  const std::string words = to_json(head).dump();
  FileHeader header;
  header.json_size = words.size();
  state->write(&header, sizeof header);
  state->write(words.data(), words.size());
  return RecordingWriter(std::move(state));
}

void RecordingWriter::add(const InputEntry& entry) {
  state_->write(&entry, sizeof entry);
}

std::string RecordingWriter::problem() const {
  return state_->file.problem();
}

Result<Done> RecordingWriter::finish() {
  const std::uint64_t checksum = XXH3_64bits_digest(&state_->hash);
  state_->file.write({reinterpret_cast<const char*>(&checksum), sizeof checksum});
  return state_->file.commit();
}

Result<Done> save_recording(const Recording& recording, const std::filesystem::path& path) {
  Result<RecordingWriter> writer = RecordingWriter::create(path, recording);
  if (!writer) {
    return writer.error();
  }
  for (const InputEntry& entry : recording.entries) {
    writer.value().add(entry);
  }
  return writer.value().finish();
}

Result<Recording> load_recording(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return bad(path, "cannot be read");
  }
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const Result<FileHeader> header = read_header(bytes, path);
  if (!header) {
    return header.error();
  }
  const char* const head = bytes.data() + sizeof(FileHeader);
  const char* const entries = head + header.value().json_size;
  Recording recording;
  try {
    recording = from_json(json::parse(head, entries));
  } catch (const std::exception& error) {
    return bad(path, std::string("the recording is damaged: ") + error.what());
  }
  recording.entries.resize(header.value().entries);
  std::memcpy(recording.entries.data(), entries, recording.entries.size() * sizeof(InputEntry));
  if (recording.picks.size() != recording.scene_picks.size() || !in_order(recording)) {
    return bad(path, "the recording is damaged: its entries are not in order");
  }
  return recording;
}

Result<Session> open_recorded(const std::filesystem::path& scene, const Recording& recording,
                              bool quiet) {
  Result<Session> opened = open_scene(scene);
  if (!opened) {
    return opened.error();
  }
  Session& session = opened.value();
  std::vector<std::string> tools;
  for (const ToolDescription& tool : session.scene.tools) {
    tools.push_back(tool.node);
  }
  if (tools != recording.tools ||
      !std::ranges::equal(picks_of(session.scene, {}), recording.scene_picks, same)) {
    return Error{
        fmt::format("{}: not the scene of the recording, which was made of {}: it has "
                    "other tools, bodies or materials",
                    scene.string(), recording.scene)};
  }
  apply_picks(recording.picks, session.scene);
  PrepareOptions options = options_of(recording);
  options.expected_poses = expected_poses(session.scene);
  Result<Simulation> made = prepare_with_bar(session.scene, options, quiet);
  if (!made) {
    return Error{scene.string() + ": " + made.error().text};
  }
  session.simulation = std::move(made).value();
  if (hash(session.simulation.world) != recording.world_hash) {
    return Error{fmt::format(
        "{}: not as it was when recorded (from {}): the scene has changed since, or another "
        "version of torsion recorded it",
        scene.string(), recording.scene)};
  }
  return opened;
}

Result<Done> replay_inputs(Replay& replay, Session& session, bool quiet) {
  const Recording& recording = *replay.recording;
  std::vector<BodyPick> picks;
  for (std::uint32_t set = 0; set < session.tool_poses.size(); ++replay.next) {
    TORSION_ASSERT(replay.next < recording.entries.size());
    const InputEntry& entry = recording.entries[replay.next];
    if (entry.kind == InputKind::kPose) {
      session.tool_poses[entry.index] = pose_of(entry);
      ++set;
    } else if (entry.kind == InputKind::kBody) {
      if (picks.empty()) {
        picks = picks_of(session.scene, {});
      }
      picks[entry.index] = pick_of(entry);
    } else if (!picks.empty()) {
      const Result<Done> done = rebuild(recording, picks, session, quiet);
      if (!done) {
        return done.error();
      }
    }
  }
  return Done{};
}

}  // namespace torsion
