// The exported glTF, read back and looked at as any other program would.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <numbers>
#include <sstream>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include "tests/app/program.hpp"
#include "tests/scenes/gltf_builder.hpp"

namespace torsion::engine {
namespace {

using test::Folder;
using test::Ran;
using test::run_torsion;
using test::scene;

/// @param path  of a scene
tinygltf::Model exported_file(const std::string& path, const std::string& time,
                              const std::string& file) {
  const Folder folder;
  const Ran ran = run_torsion({"export", path, "--at", time, "--out", folder / file});
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  tinygltf::Model model;
  tinygltf::TinyGLTF reader;
  std::string errors;
  std::string warnings;
  const bool binary = file.ends_with(".glb");
  EXPECT_TRUE(binary ? reader.LoadBinaryFromFile(&model, &errors, &warnings, folder / file)
                     : reader.LoadASCIIFromFile(&model, &errors, &warnings, folder / file))
      << errors;
  EXPECT_EQ(warnings, "");
  return model;
}

tinygltf::Model exported(const std::string& name, const std::string& time,
                         const std::string& file) {
  return exported_file(scene(name), time, file);
}

const tinygltf::Accessor& attribute(const tinygltf::Model& model, std::size_t mesh,
                                    const std::string& name) {
  const auto& attributes = model.meshes.at(mesh).primitives.at(0).attributes;
  return model.accessors.at(static_cast<std::size_t>(attributes.at(name)));
}

template <class Row>
std::vector<Row> rows_of(const tinygltf::Model& model, const tinygltf::Accessor& accessor) {
  const auto& view = model.bufferViews.at(static_cast<std::size_t>(accessor.bufferView));
  std::vector<Row> rows(accessor.count);
  EXPECT_EQ(view.byteLength, rows.size() * sizeof(Row));
  std::memcpy(rows.data(), model.buffers.at(0).data.data() + view.byteOffset, view.byteLength);
  return rows;
}

/// What the validator asks of any mesh: bounds that are those of the positions, unit normals, as
/// many rows in each attribute, indices in range.
void expect_sound(const tinygltf::Model& model, std::size_t mesh) {
  const tinygltf::Accessor& position = attribute(model, mesh, "POSITION");
  glm::dvec3 lowest(1e9);
  glm::dvec3 highest(-1e9);
  for (const glm::vec3& row : rows_of<glm::vec3>(model, position)) {
    lowest = glm::min(lowest, glm::dvec3(row));
    highest = glm::max(highest, glm::dvec3(row));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(position.minValues.at(i), lowest[static_cast<int>(i)]);
    EXPECT_EQ(position.maxValues.at(i), highest[static_cast<int>(i)]);
  }
  for (const glm::vec3& normal : rows_of<glm::vec3>(model, attribute(model, mesh, "NORMAL"))) {
    // Three roundings of float in a length of 1.
    ASSERT_NEAR(glm::length(normal), 1.0F, 4e-7F);
  }
  const tinygltf::Primitive& primitive = model.meshes[mesh].primitives[0];
  for (const auto& [name, row] : primitive.attributes) {
    EXPECT_EQ(model.accessors.at(static_cast<std::size_t>(row)).count, position.count) << name;
  }
  const auto& indices = model.accessors.at(static_cast<std::size_t>(primitive.indices));
  for (const std::uint32_t index : rows_of<std::uint32_t>(model, indices)) {
    ASSERT_LT(index, position.count);
  }
}

TEST(ExportTest, BinaryFileHoldsTheTwistedBodyAndItsRestShape) {
  const tinygltf::Model model = exported("ball_on_cube_soft", "2.0", "d.glb");
  ASSERT_EQ(model.nodes.size(), 2U);
  expect_sound(model, 0);
  expect_sound(model, 1);
  const auto rest = rows_of<glm::vec3>(model, attribute(model, 0, "_REST_POSITION"));
  const auto moved = rows_of<glm::vec3>(model, attribute(model, 0, "POSITION"));
  const auto twist = rows_of<float>(model, attribute(model, 0, "_TWIST_ANGLE"));
  double largest = 0.0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const glm::vec3 size = glm::abs(rest[i]);
    EXPECT_NEAR(std::max({size.x, size.y, size.z}), 0.05F, 1e-7F);  // on the cube of 0.1 m
    if (rest[i] == glm::vec3(0.0F, -0.05F, 0.0F)) {
      EXPECT_EQ(moved[i], rest[i]);  // the fixed point
    }
    if (rest[i] == glm::vec3(0.0F, 0.05F, 0.0F)) {
      EXPECT_NEAR(moved[i].y, 0.04F, 1e-4F);  // below the ball, which is 10 mm into the cube
    }
    largest = std::max(largest, static_cast<double>(std::abs(twist[i])));
  }
  // The ball has turned by 60 degrees: nothing turns farther; the rim of the contact slips, and
  // the middle of it, where it sticks longest, has turned nearly as far.
  const double turned = std::numbers::pi / 3.0;
  EXPECT_GT(largest, 0.9 * turned);
  EXPECT_LT(largest, turned + 1e-6);
}

TEST(ExportTest, TextFileOfSeveralBodiesAndATool) {
  const tinygltf::Model model = exported("two_bodies", "1.5", "d.gltf");
  ASSERT_EQ(model.nodes.size(), 3U);
  EXPECT_EQ(model.nodes[0].name, "firm cube");
  EXPECT_EQ(model.nodes[2].name, "bar");
  for (std::size_t mesh = 0; mesh < 3; ++mesh) {
    expect_sound(model, mesh);
  }
  EXPECT_FALSE(model.meshes[2].primitives[0].attributes.contains("_TWIST_ANGLE"));
}

TEST(ExportTest, BeforeContactTheBodyIsAtRest) {
  const tinygltf::Model model = exported("compass_on_ellipsoid", "0", "d.glb");
  EXPECT_EQ(rows_of<glm::vec3>(model, attribute(model, 0, "POSITION")),
            rows_of<glm::vec3>(model, attribute(model, 0, "_REST_POSITION")));
}

std::vector<double> column_of(const std::string& csv, const std::string& name) {
  std::istringstream stream(csv);
  std::string line;
  std::getline(stream, line);
  std::vector<std::string> names;
  std::istringstream header(line);
  for (std::string word; std::getline(header, word, ',');) {
    names.push_back(word);
  }
  const auto column = std::ranges::find(names, name) - names.begin();
  std::vector<double> values;
  while (std::getline(stream, line)) {
    std::istringstream row(line);
    std::string word;
    for (std::ptrdiff_t i = 0; i <= column; ++i) {
      std::getline(row, word, ',');
    }
    values.push_back(std::stod(word));
  }
  return values;
}

TEST(ExportTest, ARecordingBecomesAnAnimationThatPlaysBack) {
  const Folder folder;
  for (const std::string ending : {".gltf", ".glb"}) {
    // The compass' tool stands below other nodes, and is scaled.
    ASSERT_EQ(run_torsion({"simulate", scene("compass_on_ellipsoid"), "--seconds", "1.2",
                           "--record", folder / "a.rec", "--trace", folder / "a.csv"})
                  .exit_code,
              0);
    const std::string out = folder / ("played" + ending);
    const Ran ran = run_torsion(
        {"export", scene("compass_on_ellipsoid"), "--replay", folder / "a.rec", "--out", out});
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    const Ran played = run_torsion({"simulate", out, "--trace", folder / "b.csv"});
    ASSERT_EQ(played.exit_code, 0) << played.err;
    const std::string first = test::read_text(folder / "a.csv");
    const std::string second = test::read_text(folder / "b.csv");
    for (const char* column : {"tool_x_m", "tool_y_m", "tool_qx", "force_y_N", "torque_y_Nm"}) {
      const std::vector<double> a = column_of(first, column);
      const std::vector<double> b = column_of(second, column);
      ASSERT_NEAR(static_cast<double>(a.size()), static_cast<double>(b.size()), 1.0);
      double largest = 0.0;
      for (const double value : a) {
        largest = std::max(largest, std::abs(value));
      }
      // Keys are floats, 6e-8 of a tenth of a metre: against depths of 1e-3 m, 1e-5 of the force.
      // What sticks and slips may differ by a cell, a hundredth; and a grid be laid anew a step
      // sooner or later, which matters as much as a step does there.
      for (std::size_t i = 1; i + 1 < std::min(a.size(), b.size()); ++i) {
        const double step = std::max(std::abs(a[i + 1] - a[i]), std::abs(a[i] - a[i - 1]));
        ASSERT_NEAR(a[i], b[i], 0.01 * largest + step + 1e-9) << column << " row " << i;
      }
    }
  }
}

TEST(ExportTest, WantsAMomentOrARecording) {
  const Folder folder;
  EXPECT_EQ(run_torsion({"export", scene("ball_on_cube"), "--out", folder / "a.glb"}).exit_code, 2);
}

TEST(ExportTest, ACubeOfEightCornersShowsItsDent) {
  // A ball of 10 mm pressed 3 mm into the top of a cube of 100 mm whose mesh is its six faces.
  test::GltfBuilder builder = test::good_scene();
  builder.node("block")["extras"]["torsion_shape"] = "sphere";
  builder.document.erase("animations");
  builder.add_motion(1, "translation", {0.0F, 1.0F}, {0.0F, 0.13F, 0.0F, 0.0F, 0.107F, 0.0F});
  const Folder folder;
  test::write_text(folder / "cube.gltf", builder.text());
  const Ran ran =
      run_torsion({"export", folder / "cube.gltf", "--at", "1", "--out", folder / "out.gltf"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  tinygltf::Model model;
  tinygltf::TinyGLTF reader;
  std::string errors;
  std::string warnings;
  ASSERT_TRUE(reader.LoadASCIIFromFile(&model, &errors, &warnings, folder / "out.gltf")) << errors;
  const auto places = rows_of<glm::vec3>(model, attribute(model, 0, "POSITION"));
  EXPECT_GT(places.size(), 1000U);
  EXPECT_LT(places.size(), 30'000U);
  // The file has places in the body's frame: its top is at 50 mm, and under the ball 3 mm lower.
  float middle = 1.0F;
  float rim = 0.0F;
  for (const glm::vec3& place : places) {
    const float from_axis = std::hypot(place.x, place.z);
    middle = from_axis < 1.5e-3F && place.y > 0.0F ? std::min(middle, place.y) : middle;
    rim = std::max(rim, from_axis > 0.04F ? place.y : 0.0F);
  }
  EXPECT_NEAR(middle, 0.047F, 3e-4F);
  EXPECT_NEAR(rim, 0.05F, 3e-4F);
}

TEST(ExportTest, ARunIsAtEveryMomentWhatIsExportedAtThatMoment) {
  const Folder folder;
  const Ran ran = run_torsion({"export", scene("ball_on_cube_soft"), "--animate", "--fps", "4",
                               "--seconds", "2", "--out", folder / "run.glb"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  tinygltf::Model run;
  tinygltf::TinyGLTF reader;
  std::string errors;
  std::string warnings;
  ASSERT_TRUE(reader.LoadBinaryFromFile(&run, &errors, &warnings, folder / "run.glb")) << errors;
  EXPECT_EQ(warnings, "");
  constexpr std::size_t kMoments = 9;  // 0, 0.25, ... 2 s
  const tinygltf::Primitive& body = run.meshes.at(0).primitives.at(0);
  ASSERT_EQ(body.targets.size(), kMoments);
  ASSERT_EQ(run.animations.size(), 1U);
  const auto channel = [&](int node, const std::string& path) {
    const auto& channels = run.animations[0].channels;
    const auto found = std::ranges::find_if(channels, [&](const tinygltf::AnimationChannel& one) {
      return one.target_node == node && one.target_path == path;
    });
    EXPECT_NE(found, channels.end()) << path;
    return run.animations[0].samplers.at(static_cast<std::size_t>(found->sampler));
  };
  const auto accessor = [&](int row) -> const tinygltf::Accessor& {
    return run.accessors.at(static_cast<std::size_t>(row));
  };
  const tinygltf::AnimationSampler weights = channel(0, "weights");
  EXPECT_EQ(weights.interpolation, "LINEAR");
  const auto times = rows_of<float>(run, accessor(weights.input));
  const auto keys = rows_of<float>(run, accessor(weights.output));
  const auto places = rows_of<glm::vec3>(run, accessor(channel(1, "translation").output));
  const auto rest = rows_of<glm::vec3>(run, attribute(run, 0, "POSITION"));
  ASSERT_EQ(times.size(), kMoments);
  ASSERT_EQ(keys.size(), kMoments * kMoments);
  for (std::size_t moment = 0; moment < kMoments; ++moment) {
    EXPECT_FLOAT_EQ(times[moment], 0.25F * static_cast<float>(moment));
    for (std::size_t target = 0; target < kMoments; ++target) {
      EXPECT_EQ(keys[moment * kMoments + target], target == moment ? 1.0F : 0.0F);
    }
  }
  // 1.5 s, in the middle of the turn, by the other way.
  constexpr std::size_t kMiddle = 6;
  const tinygltf::Model once = exported("ball_on_cube_soft", "1.5", "once.gltf");
  const auto deformed = rows_of<glm::vec3>(once, attribute(once, 0, "POSITION"));
  const auto moved = rows_of<glm::vec3>(run, accessor(body.targets[kMiddle].at("POSITION")));
  ASSERT_EQ(deformed.size(), rest.size());
  float farthest = 0.0F;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    ASSERT_LT(glm::length(rest[i] + moved[i] - deformed[i]), 1e-7F);
    farthest = std::max(farthest, glm::length(moved[i]));
  }
  EXPECT_GT(farthest, 5e-3F);
  const std::vector<double>& placed = once.nodes.at(1).translation;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(places[kMiddle][static_cast<int>(axis)], placed[axis], 1e-7);
  }
}

TEST(ExportTest, ABodyThatTurnsUnderAToolThatStaysTurnsInTheFileToo) {
  // A ball stands 2 mm deep in a cube that turns by 30 degrees in a second.
  test::GltfBuilder builder = test::good_scene();
  builder.node("block")["extras"]["torsion_shape"] = "sphere";
  builder.node("block")["translation"] = {0.0, 0.108, 0.0};
  builder.document.erase("animations");
  const auto s = static_cast<float>(std::sin(std::numbers::pi / 12.0));
  const auto c = static_cast<float>(std::cos(std::numbers::pi / 12.0));
  builder.add_motion(0, "rotation", {0.0F, 1.0F}, {0.0F, 0.0F, 0.0F, 1.0F, 0.0F, s, 0.0F, c});
  const Folder folder;
  test::write_text(folder / "turns.gltf", builder.text());
  const Ran summary = run_torsion({"simulate", folder / "turns.gltf", "--json"});
  ASSERT_EQ(summary.exit_code, 0) << summary.err;
  const auto felt = nlohmann::json::parse(summary.out);
  EXPECT_TRUE(felt["faults"].empty());
  EXPECT_GT(felt["peak_torque_Nm"].get<double>(), 1e-3);
  const Ran ran = run_torsion(
      {"export", folder / "turns.gltf", "--animate", "--fps", "4", "--out", folder / "run.gltf"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  tinygltf::Model run;
  tinygltf::TinyGLTF reader;
  std::string errors;
  std::string warnings;
  ASSERT_TRUE(reader.LoadASCIIFromFile(&run, &errors, &warnings, folder / "run.gltf")) << errors;
  const auto& channels = run.animations.at(0).channels;
  const auto turns = std::ranges::find_if(channels, [](const tinygltf::AnimationChannel& channel) {
    return channel.target_node == 0 && channel.target_path == "rotation";
  });
  ASSERT_NE(turns, channels.end());
  const int output = run.animations[0].samplers.at(static_cast<std::size_t>(turns->sampler)).output;
  const auto keys = rows_of<glm::vec4>(run, run.accessors.at(static_cast<std::size_t>(output)));
  ASSERT_EQ(keys.size(), 5U);
  EXPECT_NEAR(keys[4].y, s, 1e-6F);
  EXPECT_NEAR(keys[2].y, std::sin(std::numbers::pi / 24.0), 1e-6);
}

TEST(ExportTest, ARunOfTooManyMomentsIsRefused) {
  const Folder folder;
  const Ran ran = run_torsion({"export", scene("ball_on_cube_soft"), "--animate", "--fps", "1000",
                               "--out", folder / "run.glb"});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_NE(ran.err.find("fewer a second"), std::string::npos) << ran.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "run.glb"));
}

TEST(ExportTest, MaterialsAndTexturesGoWithTheirMeshes) {
  const tinygltf::Model model = exported("looks/finger_on_lid", "0", "look.glb");
  const tinygltf::Mesh& jar = model.meshes.at(0);
  ASSERT_EQ(jar.primitives.size(), 3U);  // the lid's top, its rim, the pot
  const auto material_of = [&](std::size_t primitive) -> const tinygltf::Material& {
    return model.materials.at(static_cast<std::size_t>(jar.primitives.at(primitive).material));
  };
  EXPECT_NEAR(material_of(0).pbrMetallicRoughness.roughnessFactor, 0.45, 1e-6);
  EXPECT_NEAR(material_of(2).pbrMetallicRoughness.roughnessFactor, 0.18, 1e-6);
  EXPECT_EQ(material_of(1).pbrMetallicRoughness.baseColorTexture.index, -1);
  const int texture = material_of(0).pbrMetallicRoughness.baseColorTexture.index;
  ASSERT_GE(texture, 0);
  EXPECT_EQ(jar.primitives[0].attributes.count("TEXCOORD_0"), 1U);
  // Decoded by tinygltf's own reader: the picture of the file beside the scene.
  const tinygltf::Image& image = model.images.at(
      static_cast<std::size_t>(model.textures.at(static_cast<std::size_t>(texture)).source));
  EXPECT_EQ(image.width, 256);
  EXPECT_EQ(image.height, 256);
  const tinygltf::Material& skin =
      model.materials.at(static_cast<std::size_t>(model.meshes.at(1).primitives.at(0).material));
  EXPECT_EQ(skin.extensions.count("KHR_materials_diffuse_transmission"), 1U);
  EXPECT_EQ(model.images.size(), 2U);  // the skin's once, for three parts
}

TEST(ExportTest, VertexColorsGoWithTheirMesh) {
  test::GltfBuilder builder = test::good_scene();
  builder.document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
      builder.add_floats(std::vector<float>(24, 0.25F), "VEC3");
  const Folder folder;
  test::write_text(folder / "scene.gltf", builder.text());
  const tinygltf::Model model = exported_file(folder / "scene.gltf", "0", "painted.glb");
  // The body is cut into more triangles, whose new vertices lie between.
  const std::vector<glm::vec3> colors = rows_of<glm::vec3>(model, attribute(model, 0, "COLOR_0"));
  EXPECT_EQ(colors.size(), attribute(model, 0, "POSITION").count);
  EXPECT_GT(colors.size(), 8U);
  for (const glm::vec3& color : colors) {
    EXPECT_EQ(color, glm::vec3(0.25F));
  }
  EXPECT_EQ(model.meshes.at(1).primitives.at(0).attributes.count("COLOR_0"), 0U);
}

}  // namespace
}  // namespace torsion::engine
