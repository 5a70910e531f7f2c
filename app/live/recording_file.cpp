#include "app/live/recording_file.hpp"

#define XXH_INLINE_ALL
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <xxhash.h>

#include "app/output_file.hpp"
#include "ecs/model_names.hpp"
#include "scenes/file_bytes.hpp"

namespace torsion::engine {
namespace {

using nlohmann::json;

constexpr std::uint32_t kVersion = 2;

struct FileHeader {
  std::array<char, 8> magic = {'T', 'O', 'R', 'S', 'R', 'E', 'C', '\0'};
  std::uint32_t order = 0x01020304;  // reads otherwise on a machine of the other byte order
  std::uint32_t version = kVersion;
  std::uint64_t json_size = 0;  // bytes
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
          {"iterations", recording.settings.iterations},
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
                        head.at("iterations").get<std::uint32_t>()};
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

/// The fixed part of a whole file.
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
  if (header.version != kVersion) {
    return bad(path, fmt::format("recording of version {}, this program reads version {}",
                                 header.version, kVersion));
  }
  const std::uint64_t content = bytes.size() - sizeof header - sizeof(std::uint64_t);
  if (header.json_size > content || (content - header.json_size) % sizeof(InputEntry) != 0) {
    return bad(path, "the recording is damaged: it was cut short or something was added");
  }
  std::uint64_t checksum = 0;
  std::memcpy(&checksum, bytes.data() + bytes.size() - sizeof checksum, sizeof checksum);
  if (checksum != XXH3_64bits(bytes.data(), bytes.size() - sizeof checksum)) {
    return bad(path, "the recording is damaged: its checksum does not fit its content");
  }
  return header;
}

/// Whether materials, models and settings are such as a session can have.
bool head_is_valid(const Recording& recording) {
  const auto bodies = static_cast<std::uint32_t>(recording.picks.size());
  const auto is_valid = [bodies](const BodyPick& pick) {
    return valid(body_entry(0, 0, pick), 0, bodies);
  };
  const Settings& settings = recording.settings;
  return recording.picks.size() == recording.scene_picks.size() &&
         std::ranges::all_of(recording.picks, is_valid) &&
         std::ranges::all_of(recording.scene_picks, is_valid) && settings.iterations >= 1 &&
         settings.iterations <= kMostIterations && settings.grid_side <= kMaxGridSide;
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

}  // namespace

struct RecordingWriter::State {
  OutputFile file;
  XXH3_state_t hash;

  State(OutputFile to, const Recording& head) : file(std::move(to)) {
    XXH3_64bits_reset(&hash);
    const std::string words = to_json(head).dump();
    FileHeader header;
    header.json_size = words.size();
    write(&header, sizeof header);
    write(words.data(), words.size());
  }
  void write(const void* data, std::size_t size) {
    XXH3_64bits_update(&hash, data, size);
    file.write({static_cast<const char*>(data), size});
  }
  Result<Done> end(OutputFile& whole) const {
    const std::uint64_t checksum = XXH3_64bits_digest(&hash);
    whole.write({reinterpret_cast<const char*>(&checksum), sizeof checksum});
    return whole.commit();
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
  return RecordingWriter(std::make_unique<State>(std::move(file).value(), head));
}

Result<RecordingWriter> RecordingWriter::create_unnamed(const Recording& head) {
  Result<OutputFile> file = OutputFile::create_unnamed();
  if (!file) {
    return file.error();
  }
  return RecordingWriter(std::make_unique<State>(std::move(file).value(), head));
}

void RecordingWriter::add(const InputEntry& entry) {
  state_->write(&entry, sizeof entry);
}

std::string RecordingWriter::problem() const {
  return state_->file.problem();
}

Result<Done> RecordingWriter::save_copy(const std::filesystem::path& path) {
  Result<OutputFile> copy = OutputFile::create(path);
  if (!copy) {
    return copy.error();
  }
  const Result<Done> copied = state_->file.copy_to(copy.value());
  return copied ? state_->end(copy.value()) : copied;
}

Result<Done> RecordingWriter::finish() {
  return state_->end(state_->file);
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
  const Result<std::vector<unsigned char>> read =
      read_file_bytes(path, std::numeric_limits<std::uint64_t>::max());
  if (!read) {
    return read.error();
  }
  const std::string bytes(read.value().begin(), read.value().end());
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
  const char* const end = bytes.data() + bytes.size() - sizeof(std::uint64_t);
  recording.entries.resize(static_cast<std::size_t>(end - entries) / sizeof(InputEntry));
  std::memcpy(recording.entries.data(), entries, recording.entries.size() * sizeof(InputEntry));
  if (!head_is_valid(recording)) {
    return bad(path,
               "the recording is damaged: it names materials, models or settings that no "
               "session can have");
  }
  if (!in_order(recording)) {
    return bad(path, "the recording is damaged: its entries are not in order");
  }
  return recording;
}

}  // namespace torsion::engine
