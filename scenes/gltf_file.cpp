#include "scenes/gltf_file.hpp"

#include <algorithm>
#include <cstring>
#include <exception>
#include <span>

#include <nlohmann/json.hpp>

#include "scenes/file_bytes.hpp"
#include "scenes/gltf_content.hpp"
#include "scenes/gltf_extents.hpp"
#include "scenes/gltf_structure.hpp"

namespace torsion::engine {
namespace {

using nlohmann::json;
using Bytes = std::vector<unsigned char>;

constexpr std::uint32_t kGlbMagic = 0x46546C67;   // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr int kDeepestNesting = 64;

std::uint32_t word_at(std::span<const unsigned char> bytes, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, sizeof word);
  return word;
}

/// The parts of a file: all of a .gltf is JSON.
struct Parts {
  std::span<const unsigned char> json;
  std::optional<std::size_t> binary_bytes;  // of a .glb's binary chunk
};

/// Framing of a .glb (glTF 2.0, section 4.4): header, JSON chunk, perhaps one binary chunk.
std::optional<Parts> parts_of(std::span<const unsigned char> bytes, const ProblemList& problems) {
  if (bytes.size() < 4 || word_at(bytes, 0) != kGlbMagic) {
    return Parts{bytes, std::nullopt};
  }
  const auto cut = [&](const std::string& what) {
    problems.add("", "", "", what, "export the file again: it was cut off or damaged");
    return std::nullopt;
  };
  if (bytes.size() < 20) {
    return cut("a .glb has at least 20 bytes, this one has " + std::to_string(bytes.size()));
  }
  if (word_at(bytes, 4) != 2) {
    problems.add("", "GLB version", std::to_string(word_at(bytes, 4)), "expected 2");
    return std::nullopt;
  }
  if (word_at(bytes, 8) != bytes.size()) {
    return cut("its header says " + std::to_string(word_at(bytes, 8)) + " bytes, it has " +
               std::to_string(bytes.size()));
  }
  Parts parts;
  std::size_t at = 12;
  for (int chunk = 0; at < bytes.size(); ++chunk) {
    const std::size_t left = bytes.size() - at;
    if (left < 8 || word_at(bytes, at) > left - 8 || word_at(bytes, at) % 4 != 0) {
      return cut("chunk " + std::to_string(chunk) + " does not end within the file");
    }
    const std::size_t length = word_at(bytes, at);
    const std::uint32_t kind = word_at(bytes, at + 4);
    if ((chunk == 0) != (kind == kJsonChunk) || (kind == kBinaryChunk && chunk != 1)) {
      return cut("expected a JSON chunk and then at most one binary chunk");
    }
    if (kind == kJsonChunk) {
      parts.json = bytes.subspan(at + 8, length);
    } else if (kind == kBinaryChunk) {
      parts.binary_bytes = length;
    }
    at += 8 + length;
  }
  return parts;
}

/// Parsers call themselves for every level, so a deep file would overflow the stack.
bool nested_too_deep(std::span<const unsigned char> text) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const unsigned char byte = text[i];
    if (in_string) {
      i += byte == '\\' ? 1 : 0;
      in_string = byte != '"';
    } else if (byte == '"') {
      in_string = true;
    } else if (byte == '{' || byte == '[') {
      depth += 1;
      if (depth > kDeepestNesting) {
        return true;
      }
    } else if (byte == '}' || byte == ']') {
      depth -= 1;
    }
  }
  return false;
}

std::optional<json> parse_json(std::span<const unsigned char> text, const ProblemList& problems) {
  if (nested_too_deep(text)) {
    problems.add("", "", "",
                 "is nested deeper than " + std::to_string(kDeepestNesting) + " levels");
    return std::nullopt;
  }
  try {
    return json::parse(text.begin(), text.end());
  } catch (const json::exception& error) {
    problems.add("", "", "", std::string("is not valid JSON: ") + error.what(),
                 "export the file again: it was cut off or damaged");
    return std::nullopt;
  }
}

/// That each buffer has its bytes: embedded, in the .glb, or in a file in the scene's folder.
void check_buffer_sources(const json& document, const Parts& parts,
                          const std::filesystem::path& folder, const ProblemList& problems) {
  const json& buffers = document.contains("buffers") ? document["buffers"] : json::array();
  for (std::size_t row = 0; row < buffers.size(); ++row) {
    const std::string place = "buffers[" + std::to_string(row) + "]";
    const std::uint64_t wanted = buffers[row].value("byteLength", std::uint64_t{0});
    if (!buffers[row].contains("uri")) {
      if (row != 0 || !parts.binary_bytes) {
        problems.add("", place + ".uri", "", "is missing");
      } else if (*parts.binary_bytes < wanted) {
        problems.add("", place + ".byteLength", std::to_string(wanted),
                     "expected at most " + std::to_string(*parts.binary_bytes) +
                         ", the size of the binary chunk");
      }
      continue;
    }
    const std::string uri = buffers[row]["uri"].get<std::string>();
    if (uri.starts_with("data:")) {
      continue;
    }
    const Result<std::filesystem::path> path = path_inside(folder, uri);
    if (!path) {
      problems.add("", place + ".uri", '"' + uri.substr(0, 80) + '"',
                   "expected a data URI or a file in the folder of the scene",
                   "put the file beside the scene and name it alone");
      continue;
    }
    const Result<Bytes> bytes = read_file_bytes(path.value());
    if (!bytes) {
      problems.add("", place + ".uri", '"' + uri + '"', bytes.error().text);
    } else if (bytes.value().size() < wanted) {
      problems.add(
          "", place + ".byteLength", std::to_string(wanted),
          "expected at most " + std::to_string(bytes.value().size()) + ", the size of " + uri,
          "export the scene again: the file was cut off");
    }
  }
}

// tinygltf's file access, kept inside the scene's folder, to which user_data points.

Result<std::filesystem::path> inside(const std::string& name, void* user_data) {
  const auto& folder = *static_cast<const std::filesystem::path*>(user_data);
  const std::filesystem::path relative = std::filesystem::path(name).lexically_relative(folder);
  return path_inside(folder, relative.empty() ? name : relative.string());
}

bool file_exists(const std::string& name, void* user_data) {
  const auto path = inside(name, user_data);
  return path.ok() && std::filesystem::is_regular_file(path.value());
}

std::string same_path(const std::string& name, void*) {
  return name;
}

bool read_file(Bytes* out, std::string* error, const std::string& name, void* user_data) {
  const auto path = inside(name, user_data);
  Result<Bytes> bytes = path.ok() ? read_file_bytes(path.value()) : Result<Bytes>(path.error());
  if (!bytes) {
    *error = bytes.error().text;
    return false;
  }
  *out = std::move(bytes).value();
  return true;
}

/// tinygltf asks for it from version 2.9 on.
[[maybe_unused]] bool file_size(std::size_t* size, std::string* error, const std::string& name,
                                void* user_data) {
  Bytes bytes;
  if (!read_file(&bytes, error, name, user_data)) {
    return false;
  }
  *size = bytes.size();
  return true;
}

bool write_nothing(std::string* error, const std::string&, const Bytes&, void*) {
  *error = "a scene is not written to";
  return false;
}

tinygltf::FsCallbacks callbacks_for(std::filesystem::path& folder) {
  tinygltf::FsCallbacks callbacks{};
  callbacks.FileExists = file_exists;
  callbacks.ExpandFilePath = same_path;
  callbacks.ReadWholeFile = read_file;
  callbacks.WriteWholeFile = write_nothing;
  callbacks.user_data = &folder;
  [](auto& of_this_version) {
    if constexpr (requires { of_this_version.GetFileSizeInBytes; }) {
      of_this_version.GetFileSizeInBytes = file_size;
    }
  }(callbacks);
  return callbacks;
}

/// Image decoders are where hostile files aim: what only simulates never runs one. Bytes are kept
/// as they are.
bool keep_encoded(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
  image->image.assign(bytes, bytes + size);
  image->as_is = true;
  return true;
}

std::optional<tinygltf::Model> parse_gltf(const Bytes& bytes, bool binary, std::string text,
                                          std::filesystem::path folder,
                                          const ProblemList& problems) {
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks(callbacks_for(folder));
  loader.SetImageLoader(keep_encoded, nullptr);
  tinygltf::Model model;
  std::string errors;
  std::string warnings;
  bool good = false;
  try {
    const auto size = static_cast<unsigned int>(binary ? bytes.size() : text.size());
    good = binary ? loader.LoadBinaryFromMemory(&model, &errors, &warnings, bytes.data(), size,
                                                folder.string())
                  : loader.LoadASCIIFromString(&model, &errors, &warnings, text.data(), size,
                                               folder.string());
  } catch (const std::exception& error) {
    errors += error.what();
  }
  if (!good) {
    std::ranges::replace(errors, '\n', ' ');
    problems.add("", "", "", "cannot be read as glTF: " + errors);
    return std::nullopt;
  }
  return model;
}

/// tinygltf cuts whole numbers to 32 bits and drops nulls: puts those of extras back as the file
/// has them, so that 200000000000 Pa is read and a null is not taken for a missing key.
void restore_extras(const json& from, tinygltf::Value& extras) {
  if (!from.is_object() || !from.contains("extras") || !from["extras"].is_object()) {
    return;
  }
  tinygltf::Value::Object members =
      extras.IsObject() ? extras.Get<tinygltf::Value::Object>() : tinygltf::Value::Object{};
  for (const auto& [name, value] : from["extras"].items()) {
    if (value.is_number()) {
      members.insert_or_assign(name, tinygltf::Value(value.get<double>()));
    } else if (value.is_null()) {
      members.insert_or_assign(name, tinygltf::Value());
    }
  }
  extras = tinygltf::Value(std::move(members));
}

template <class Element>
void restore_extras(const json& document, const char* array, std::vector<Element>& elements) {
  for (std::size_t row = 0; row < elements.size(); ++row) {
    restore_extras(document[array][row], elements[row].extras);
  }
}

/// That every buffer really got its bytes.
void check_buffer_bytes(const tinygltf::Model& model, const json& document,
                        const ProblemList& problems) {
  for (std::size_t row = 0; row < model.buffers.size(); ++row) {
    const std::uint64_t wanted = document["buffers"][row].value("byteLength", std::uint64_t{0});
    if (model.buffers[row].data.size() < wanted) {
      problems.add("", "buffers[" + std::to_string(row) + "].byteLength", std::to_string(wanted),
                   "expected at most " + std::to_string(model.buffers[row].data.size()) +
                       ", the bytes that are there");
    }
  }
}

}  // namespace

std::optional<tinygltf::Model> read_gltf_file(const std::filesystem::path& path,
                                              std::vector<Problem>& found) {
  const ProblemList problems{path.string(), found};
  const std::size_t before = found.size();
  const auto clean = [&] {
    return found.size() == before;
  };
  const Result<Bytes> bytes = read_file_bytes(path);
  if (!bytes) {
    problems.add("", "", "", bytes.error().text, "give the path of a .gltf or .glb file");
    return std::nullopt;
  }
  const std::optional<Parts> parts = parts_of(bytes.value(), problems);
  std::optional<json> document = parts ? parse_json(parts->json, problems) : std::nullopt;
  if (!document) {
    return std::nullopt;
  }
  check_gltf_structure(*document, problems);
  if (clean()) {
    check_gltf_extents(*document, problems);
  }
  const std::filesystem::path folder =
      path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  if (clean()) {
    check_buffer_sources(*document, *parts, folder, problems);
  }
  if (!clean()) {
    return std::nullopt;
  }
  const bool binary = parts->json.data() != bytes.value().data();
  std::optional<tinygltf::Model> model =
      parse_gltf(bytes.value(), binary, document->dump(), folder, problems);
  if (model) {
    restore_extras(*document, "nodes", model->nodes);
    restore_extras(*document, "meshes", model->meshes);
    restore_extras(*document, "materials", model->materials);
    check_buffer_bytes(*model, *document, problems);
  }
  if (model && clean()) {
    check_gltf_content(*model, problems);
  }
  return clean() ? std::move(model) : std::nullopt;
}

}  // namespace torsion::engine
