// Bad input and wrong usage: what the program says, its exit code, and that nothing is left behind.

#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "tests/app/program.hpp"
#include "tests/scenes/gltf_builder.hpp"

namespace torsion::engine {
namespace {

using test::Folder;
using test::Ran;
using test::run_torsion;
using test::scene;
using test::write_text;

TEST(ProgramUsageTest, WrongUsageIsExitCodeTwo) {
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"fly"},
      {"simulate"},
      {"simulate", scene("ball_on_cube"), "--rate", "0"},
      {"simulate", scene("ball_on_cube"), "--contact-model", "hertz"},
      {"simulate", scene("ball_on_cube"), "--speed", "3"},
      {"export", scene("ball_on_cube"), "--at", "1"},
      {"export", scene("ball_on_cube"), "--at", "1", "--out", "x.obj"},
      {"report", "--quick", "--out", ""},
#ifdef TORSION_WITH_RENDER
      {"render", scene("ball_on_cube"), "--out", "x.png"},
      {"render", scene("ball_on_cube"), "--at", "1", "--out", "x.png", "--size", "12"},
      {"render", scene("ball_on_cube"), "--seconds", "1", "--out", "x.jpg"},
#endif
  };
  for (const auto& words : wrong) {
    const Ran ran = run_torsion(words);
    EXPECT_EQ(ran.exit_code, 2) << testing::PrintToString(words);
    EXPECT_FALSE(ran.err.empty()) << testing::PrintToString(words);
  }
}

TEST(ProgramUsageTest, HelpIsExitCodeZero) {
  EXPECT_EQ(run_torsion({"--help"}).exit_code, 0);
  for (const char* command : {"simulate", "export", "check"}) {
    EXPECT_EQ(run_torsion({command, "--help"}).exit_code, 0) << command;
  }
}

TEST(ProgramBadInputTest, MissingSceneIsNamedAndNothingIsWritten) {
  const Folder folder;
  const Ran ran = run_torsion({"simulate", folder / "none.gltf", "--trace", folder / "t.csv"});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_NE(ran.err.find("none.gltf"), std::string::npos);
  EXPECT_NE(ran.err.find("No such file"), std::string::npos);
  EXPECT_TRUE(folder.empty());
}

TEST(ProgramBadInputTest, EveryCommandRefusesABadScene) {
  const Folder folder;
  write_text(folder / "bad.gltf", R"({"asset": {"version": "1.0"}})");
  const std::vector<std::vector<std::string>> commands = {
      {"check", folder / "bad.gltf"},
      {"simulate", folder / "bad.gltf", "--trace", folder / "t.csv"},
      {"export", folder / "bad.gltf", "--at", "1", "--out", folder / "d.glb"},
#ifdef TORSION_WITH_RENDER
      {"render", folder / "bad.gltf", "--at", "1", "--out", folder / "p.png"},
#endif
  };
  for (const auto& words : commands) {
    const Ran ran = run_torsion(words);
    EXPECT_EQ(ran.exit_code, 1) << words[0];
    EXPECT_NE((ran.err + ran.out).find("asset.version"), std::string::npos) << words[0];
  }
  std::filesystem::remove(folder / "bad.gltf");
  EXPECT_TRUE(folder.empty());
}

// tests/scenes/bad_input_test.cpp holds what each message says; here it is that the program hands
// every kind of fault on: exit code 1, the file named, and no output.
struct Fault {
  const char* name;
  std::function<std::string(test::GltfBuilder&)> spoil;  // returns the file's bytes
};

Fault changed(const char* name, const std::function<void(nlohmann::json&)>& change) {
  return {name, [change](test::GltfBuilder& scene) {
            change(scene.document);
            return scene.text();
          }};
}

Fault with_key(const char* name, std::size_t node, const char* key, const nlohmann::json& value) {
  return changed(name, [=](nlohmann::json& d) { d["nodes"][node]["extras"][key] = value; });
}

std::vector<Fault> faults() {
  using nlohmann::json;
  return {
      {"cut_off.glb",
       [](test::GltfBuilder& scene) {
         return scene.glb().substr(0, scene.glb().size() / 2);
       }},
      {"nan_position.gltf",
       [](test::GltfBuilder& scene) {
         const float nan = std::numeric_limits<float>::quiet_NaN();
         scene.bytes().replace(0, 4, std::string(reinterpret_cast<const char*>(&nan), 4));
         return scene.text();
       }},
      {"no_area.gltf",
       [](test::GltfBuilder& scene) {
         scene.bytes().replace(0, 96, std::string(96, '\0'));
         return scene.text();
       }},
      {"index_out_of_range.gltf",
       [](test::GltfBuilder& scene) {
         scene.bytes()[96] = 8;
         return scene.text();
       }},
      changed("accessor_out_of_range.gltf", [](json& d) { d["accessors"][0]["count"] = 9; }),
      changed("huge_count.gltf", [](json& d) { d["accessors"][0]["count"] = 2147483648; }),
      changed("open_mesh.gltf", [](json& d) { d["accessors"][1]["count"] = 30; }),
      changed("cycle.gltf", [](json& d) { d["nodes"][1]["children"] = {1}; }),
      changed("outside.gltf",
              [](json& d) {
                d["buffers"] = {{{"byteLength", 640}, {"uri", "../../../etc/hostname"}}};
              }),
      changed("no_motion.gltf", [](json& d) { d.erase("animations"); }),
      changed("no_keys.gltf",
              [](json& d) {
                d["accessors"][4]["count"] = 0;
                d["accessors"][5]["count"] = 0;
              }),
      changed("no_body.gltf", [](json& d) { d["nodes"][0]["extras"].erase("torsion_role"); }),
      with_key("misspelt_key.gltf", 0, "torsion_young_modulus", 1e5),
      with_key("unknown_key.gltf", 0, "torsion_colour", "red"),
      with_key("wrong_type.gltf", 0, "torsion_density", "heavy"),
      with_key("zero_modulus.gltf", 0, "torsion_youngs_modulus", 0),
      with_key("poisson.gltf", 0, "torsion_poisson_ratio", 0.51),
      changed("static_below_dynamic.gltf",
              [](json& d) {
                d["nodes"][0]["extras"]["torsion_static_friction"] = 0.3;
                d["nodes"][0]["extras"]["torsion_dynamic_friction"] = 0.4;
              }),
      with_key("no_such_model.gltf", 0, "torsion_contact_model", "hertz"),
  };
}

TEST(ProgramBadInputTest, EveryFaultOfASceneIsExitCodeOneWithoutOutput) {
  for (const Fault& fault : faults()) {
    const Folder folder;
    test::GltfBuilder scene = test::good_scene();
    write_text(folder / fault.name, fault.spoil(scene));
    const Ran checked = run_torsion({"check", folder / fault.name});
    EXPECT_EQ(checked.exit_code, 1) << fault.name;
    EXPECT_NE(checked.out.find(fault.name), std::string::npos) << fault.name << checked.out;
    const Ran ran = run_torsion({"simulate", folder / fault.name, "--trace", folder / "out/t.csv"});
    EXPECT_EQ(ran.exit_code, 1) << fault.name;
    EXPECT_NE(ran.err.find(fault.name), std::string::npos) << fault.name << ran.err;
    EXPECT_EQ(ran.out, "") << fault.name;
    EXPECT_FALSE(std::filesystem::exists(folder / "out")) << fault.name;
  }
}

TEST(ProgramBadInputTest, TheSceneWithoutAFaultRuns) {
  const Folder folder;
  write_text(folder / "good.gltf", test::good_scene().text());
  EXPECT_EQ(run_torsion({"check", folder / "good.gltf"}).exit_code, 0);
  EXPECT_EQ(run_torsion({"simulate", folder / "good.gltf", "--quiet"}).exit_code, 0);
}

TEST(ProgramBadInputTest, SceneWithoutMotionNeedsALength) {
  const Folder folder;
  test::GltfBuilder scene = test::good_scene();
  scene.document.erase("animations");
  scene.node("block")["extras"]["torsion_device"] = "mouse";
  write_text(folder / "held.gltf", scene.text());
  const Ran endless = run_torsion({"simulate", folder / "held.gltf"});
  EXPECT_EQ(endless.exit_code, 1);
  EXPECT_NE(endless.err.find("--seconds"), std::string::npos) << endless.err;
  EXPECT_EQ(run_torsion({"simulate", folder / "held.gltf", "--seconds", "0.1"}).exit_code, 0);
  const Ran checked = run_torsion({"check", folder / "held.gltf"});
  EXPECT_NE(checked.out.find("\"mouse\" holds it in a session (view)"), std::string::npos);
}

TEST(ProgramUsageTest, ModelThatIsNotThereIsRefusedWithThoseThatAre) {
  const Ran ran = run_torsion({"simulate", scene("ball_on_cube"), "--contact-model", "hertz"});
  EXPECT_NE(ran.err.find("no model \"hertz\"; it has auto, paper, mdr, patch"), std::string::npos)
      << ran.err;
}

TEST(ProgramBadInputTest, OutputThatCannotBeWrittenIsSaidAndLeavesNothing) {
  const Folder folder;
  write_text(folder / "file", "not a folder");
  const std::vector<std::vector<std::string>> commands = {
      {"simulate", scene("ball_on_cube"), "--seconds", "0.1", "--trace", folder / "file/t.csv"},
      {"export", scene("ball_on_cube"), "--at", "0", "--out", folder / "file/d.glb"},
#ifdef TORSION_WITH_RENDER
      {"render", scene("ball_on_cube"), "--at", "0", "--out", folder / "file/p.png"},
      {"render", scene("ball_on_cube"), "--seconds", "0.1", "--out", folder / "file/v.mp4"},
      {"render", scene("ball_on_cube"), "--seconds", "0.1", "--out", folder / "file/many"},
#endif
  };
  for (const auto& words : commands) {
    const Ran ran = run_torsion(words);
    EXPECT_EQ(ran.exit_code, 1) << testing::PrintToString(words);
    EXPECT_NE(ran.err.find("file/"), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find("cannot be written"), std::string::npos) << ran.err;
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

}  // namespace
}  // namespace torsion::engine
