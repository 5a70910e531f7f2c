#include "tests/app/program.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <numbers>
#include <sstream>
#include <thread>
#include <tuple>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/scenes/gltf_builder.hpp"

namespace torsion::engine {
namespace {

using nlohmann::json;
using test::fields_of;
using test::Folder;
using test::Ran;
using test::read_text;
using test::run_torsion;
using test::scene;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

TEST(SimulateTest, TraceHasTheColumnsOfTheGuideAndARowAStep) {
  const Folder folder;
  const std::string trace = folder / "t.csv";
  const Ran ran =
      run_torsion({"simulate", scene("ball_on_cube"), "--trace", trace, "--seconds", "1.5"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const std::vector<std::string> lines = lines_of(read_text(trace));
  ASSERT_EQ(lines.size(), 1501U);
  EXPECT_EQ(lines[0],
            "time_s,tool_x_m,tool_y_m,tool_z_m,tool_qx,tool_qy,tool_qz,tool_qw,regions,cells,"
            "force_x_N,force_y_N,force_z_N,torque_x_Nm,torque_y_Nm,torque_z_Nm,stick_fraction,"
            "energy_J,step_us");
  const std::vector<std::string> first = fields_of(lines[1]);
  const std::vector<std::string> last = fields_of(lines.back());
  ASSERT_EQ(last.size(), 19U);
  EXPECT_EQ(first[0], "0");
  EXPECT_EQ(first[8], "0");  // it starts clear of the body
  EXPECT_EQ(last[0], "1.499");
  EXPECT_EQ(last[8], "1");
  EXPECT_GT(std::stod(last[11]), 1.0);   // pressed: the cube pushes up
  EXPECT_GT(std::stod(last[14]), 0.01);  // turned clockwise: it resists the other way
}

TEST(SimulateTest, TwoRunsAgreeToTheBitButForTheTimes) {
  const Folder folder;
  for (const std::string name : {"a.csv", "b.csv"}) {
    ASSERT_EQ(run_torsion({"simulate", scene("compass_on_ellipsoid"), "--trace", folder / name,
                           "--seconds", "1.2"})
                  .exit_code,
              0);
  }
  const auto without_times = [&](const std::string& name) {
    std::string text;
    for (const std::string& line : lines_of(read_text(folder / name))) {
      text += line.substr(0, line.rfind(',')) + "\n";
    }
    return text;
  };
  EXPECT_EQ(without_times("a.csv"), without_times("b.csv"));
}

TEST(SimulateTest, JsonSummaryGivesTheRun) {
  const Ran ran = run_torsion({"simulate", scene("many_regions"), "--seconds", "1", "--json"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const json summary = json::parse(ran.out);
  EXPECT_EQ(summary["steps"], 1000);
  EXPECT_EQ(summary["most_regions"], 10);
  EXPECT_TRUE(summary["faults"].empty());
}

// Hertz: F = (4/3) E* R^(1/2) d^(3/2) on an area of pi R d.
TEST(SimulateTest, SummaryGivesTheMeanTractionOfABall) {
  for (const auto& [name, modulus, radius] :
       {std::tuple("ball_on_cube", 4e6, 0.03), std::tuple("ball_on_cube_soft", 4e4 / 3.0, 0.03)}) {
    const Ran ran = run_torsion(
        {"simulate", scene(name), "--json", "--contact-model", "mdr", "--body-model", "none"});
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    const json summary = json::parse(ran.out);
    const double force = summary["peak_force_N"];
    const double depth = std::pow(0.75 * force / (modulus * std::sqrt(radius)), 2.0 / 3.0);
    // Of the same force on a sphere, which is no paraboloid (Sneddon 1965), to the second order of
    // a / R, which is the square root of d / R.
    const double expected =
        force / (std::numbers::pi * radius * depth) / modulus * (1.0 + 4.0 / 15.0 * depth / radius);
    EXPECT_NEAR(summary["strain"]["traction_over_modulus"], expected, 0.02 * expected) << name;
    EXPECT_EQ(summary["strain"]["large_share"] > 0.0, expected > 0.2) << name;
    EXPECT_LT(summary["strain"]["tilt_rad"], 1e-5) << name;
  }
}

TEST(SimulateTest, SummaryGivesResidualsAndSweepsOfPatch) {
  const Folder folder;
  const auto run = [&](const char* iterations) {
    const Ran ran = run_torsion({"simulate", scene("ball_on_cube"), "--seconds", "1.2",
                                 "--contact-model", "patch", "--body-model", "none", "--iterations",
                                 iterations, "--json", "--trace", folder / "t.csv"});
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    return json::parse(ran.out).at("patch");
  };
  const json few = run("1");
  std::uint64_t region_steps = 0;
  for (const std::string& line : lines_of(read_text(folder / "t.csv"))) {
    region_steps += line.starts_with("time_s") ? 0U : std::stoul(fields_of(line)[8]);
  }
  EXPECT_GT(region_steps, 0U);
  EXPECT_EQ(few["region_steps"], region_steps);
  const json many = run("20");
  EXPECT_LE(few["iterations"]["mean"], many["iterations"]["mean"]);
  EXPECT_LE(many["iterations"]["most"], 20);
  // More iterations leave less.
  EXPECT_LT(many["residual"]["p99"], few["residual"]["p99"]);
  for (const json& patch : {few, many}) {
    EXPECT_LE(patch["iterations"]["mean"], patch["iterations"]["most"]);
    EXPECT_LE(patch["residual"]["median"], patch["residual"]["p99"]);
    EXPECT_LE(patch["residual"]["p99"], patch["residual"]["largest"]);
  }
}

TEST(SimulateTest, SummaryHasAPatchLineOnlyWherePatchRan) {
  for (const std::string model : {"paper", "patch"}) {
    const std::vector<std::string> words = {"simulate", scene("ball_on_cube"), "--seconds",
                                            "0.6",      "--contact-model",     model};
    const Ran ran = run_torsion(words);
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_EQ(ran.out.find("patch    iterations mean") != std::string::npos, model == "patch")
        << ran.out;
    std::vector<std::string> with_json = words;
    with_json.emplace_back("--json");
    EXPECT_EQ(json::parse(run_torsion(with_json).out).contains("patch"), model == "patch");
  }
}

TEST(SimulateTest, PrintsHowFastItIs) {
  const Ran ran = run_torsion({"simulate", scene("ball_on_cube"), "--json"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const json summary = json::parse(ran.out);
  // Printed, not held against a limit: that is for ./dev bench on a machine that does nothing else.
  std::printf("ball_on_cube: %.1f times real time, median step %.1f us\n",
              summary["times_real_time"].get<double>(), summary["step_us"]["median"].get<double>());
  EXPECT_GT(summary["times_real_time"].get<double>(), 0.0);
  // And what a step saves by leaving drawing to who draws; nothing where nothing ever touches.
  EXPECT_GT(summary["snapshot_us"].get<double>(), 0.0);
  EXPECT_FALSE(
      json::parse(
          run_torsion({"simulate", scene("ball_on_cube"), "--seconds", "0.001", "--json"}).out)
          .contains("snapshot_us"));
}

TEST(SimulateTest, RateSetsTheTimeBetweenRows) {
  const Folder folder;
  ASSERT_EQ(run_torsion({"simulate", scene("ball_on_cube"), "--rate", "4000", "--seconds", "0.01",
                         "--trace", folder / "t.csv"})
                .exit_code,
            0);
  const std::vector<std::string> lines = lines_of(read_text(folder / "t.csv"));
  ASSERT_EQ(lines.size(), 41U);
  EXPECT_EQ(fields_of(lines[2])[0], "0.00025");
}

TEST(SimulateTest, RealtimeRunsOnTheClock) {
  const Ran ran =
      run_torsion({"simulate", scene("ball_on_cube"), "--realtime", "--seconds", "0.5", "--json"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const json summary = json::parse(ran.out);
  // 500 periods of 1 ms cannot be over early; late they may be on a busy machine.
  EXPECT_GE(summary["wall_s"].get<double>(), 0.498);
  EXPECT_LE(summary["rate_Hz"].get<double>(), 1005.0);
  EXPECT_TRUE(summary.contains("missed_deadlines"));
  const Ran fast = run_torsion({"simulate", scene("ball_on_cube"), "--seconds", "0.5", "--json"});
  EXPECT_EQ(json::parse(fast.out)["world_hash"], summary["world_hash"]);
}

std::string without_last_column(const std::string& csv) {
  std::string text;
  for (const std::string& line : lines_of(csv)) {
    text += line.substr(0, line.rfind(',')) + "\n";
  }
  return text;
}

TEST(SimulateTest, AReplayGivesTheBitsOfTheRunOnTheClock) {
  const Folder folder;
  const std::string file = folder / "a.rec";
  const Ran ran = run_torsion({"simulate", scene("ball_on_cube"), "--realtime", "--rate", "2000",
                               "--contact-model", "paper", "--seconds", "0.8", "--record", file,
                               "--trace", folder / "a.csv"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const Ran again = run_torsion(
      {"simulate", scene("ball_on_cube"), "--replay", file, "--trace", folder / "b.csv"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const std::string trace = without_last_column(read_text(folder / "a.csv"));
  EXPECT_EQ(lines_of(trace).size(), 1601U);
  EXPECT_EQ(trace, without_last_column(read_text(folder / "b.csv")));
}

TEST(SimulateTest, ASignalEndsARunOnTheClockAndKeepsWhatThereIs) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Folder folder;
    const auto begun = std::chrono::steady_clock::now();
    test::Process run(
        test::torsion({"simulate", scene("ball_on_cube"), "--contact-model", "mdr", "--body-model",
                       "none", "--realtime", "--seconds", "1000", "--trace", folder / "t.csv",
                       "--record", folder / "r.rec", "--json"}));
    std::this_thread::sleep_for(std::chrono::milliseconds(800));
    run.send(signal);
    const Ran ran = run.wait();
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(20));
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    const auto summary = nlohmann::json::parse(ran.out);
    const std::uint64_t steps = summary.at("steps");
    EXPECT_GT(steps, 0U);
    EXPECT_EQ(summary.at("steps_left"), 1'000'000 - steps);
    const std::string trace = read_text(folder / "t.csv");
    EXPECT_EQ(std::ranges::count(trace, '\n'), static_cast<std::ptrdiff_t>(steps + 1));
    const Ran again =
        run_torsion({"simulate", scene("ball_on_cube"), "--replay", folder / "r.rec", "--json"});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(nlohmann::json::parse(again.out).at("world_hash"), summary.at("world_hash"));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);
  }
}

TEST(SimulateTest, ARunGoesOnWhenTheDiskIsFullAndSaysWhyThereIsNoRecording) {
  const Folder folder;
  // No file may grow beyond 2 MB (units of 512 bytes): 16 s of a recording. What is prepared of the
  // scene is in the cache by then.
  ASSERT_EQ(run_torsion({"simulate", scene("ball_on_cube"), "--seconds", "0.01"}).exit_code, 0);
  std::vector<std::string> words = {"sh", "-c", "trap '' XFSZ; ulimit -f 4000; exec \"$0\" \"$@\""};
  for (const std::string& word :
       test::torsion({"simulate", scene("ball_on_cube"), "--contact-model", "mdr", "--seconds",
                      "20", "--record", folder / "a.rec"})) {
    words.push_back(word);
  }
  const Ran ran = test::Process(words).wait();
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_NE(ran.out.find("20000 steps"), std::string::npos) << ran.out;
  EXPECT_NE(ran.err.find("a.rec: cannot be written: "), std::string::npos) << ran.err;
  EXPECT_TRUE(folder.empty());
}

TEST(SimulateTest, RecordingsOfOtherScenesAndDamagedOnesAreRefused) {
  const Folder folder;
  const std::string file = folder / "a.rec";
  ASSERT_EQ(run_torsion({"simulate", scene("ball_on_cube"), "--seconds", "0.1", "--record", file})
                .exit_code,
            0);
  for (const std::string other : {"two_bodies", "ball_on_cube_soft", "compass_on_ellipsoid"}) {
    const Ran ran = run_torsion({"simulate", scene(other), "--replay", file});
    EXPECT_EQ(ran.exit_code, 1);
    EXPECT_NE(ran.err.find("not the scene of the recording"), std::string::npos) << ran.err;
  }
  test::write_text(file, read_text(file).substr(0, 900));
  const Ran cut = run_torsion({"simulate", scene("ball_on_cube"), "--replay", file});
  EXPECT_EQ(cut.exit_code, 1);
  EXPECT_NE(cut.err.find("damaged"), std::string::npos) << cut.err;
  EXPECT_EQ(
      run_torsion({"simulate", scene("ball_on_cube"), "--replay", file, "--rate", "500"}).exit_code,
      2);
}

TEST(SimulateTest, SeveralToolsWouldHaveColumnsOfTheirOwnAndBodiesShareOneTool) {
  const Folder folder;
  ASSERT_EQ(run_torsion(
                {"simulate", scene("two_bodies"), "--trace", folder / "t.csv", "--seconds", "1.5"})
                .exit_code,
            0);
  const auto last = fields_of(lines_of(read_text(folder / "t.csv")).back());
  EXPECT_EQ(last[8], "2");
}

TEST(CheckTest, SaysWhatRunsAndWhatStaysOff) {
  const Ran brief = run_torsion({"check", scene("ball_on_cube"), "--body-model", "none"});
  EXPECT_EQ(brief.out.find("detect_contacts"), std::string::npos) << brief.out;
  EXPECT_LT(std::ranges::count(brief.out, '\n'), 8) << brief.out;
  const Ran ran =
      run_torsion({"check", scene("ball_on_cube"), "--body-model", "none", "--verbose"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.out.find(brief.out), 0U) << ran.out;
  EXPECT_NE(ran.out.find("no problems"), std::string::npos);
  EXPECT_NE(ran.out.find("on   detect_contacts"), std::string::npos);
  EXPECT_NE(ran.out.find("off  compliance"), std::string::npos);
  EXPECT_NE(ran.out.find("body model none (the command line says so)"), std::string::npos);
}

TEST(AddPhysicsProgramTest, SomebodysFileRunsAfterOneCommand) {
  const Folder folder;
  const std::string asset = test::source_folder() + "/scenes/many_regions.gltf";
  // The slab alone, without what makes it a scene, is somebody's file.
  json document = json::parse(read_text(asset));
  for (json& node : document["nodes"]) {
    node.erase("extras");
  }
  document.erase("animations");
  document["scenes"][0].erase("extras");
  write_text(folder / "asset.gltf", document.dump());
  std::filesystem::copy_file(test::source_folder() + "/scenes/many_regions.bin",
                             folder / "many_regions.bin");
  const std::string out = folder / "scene.glb";
  const Ran unnamed = run_torsion({"add-physics", folder / "asset.gltf", "--out", out});
  EXPECT_EQ(unnamed.exit_code, 1);
  EXPECT_NE(unnamed.err.find("\"slab\""), std::string::npos) << unnamed.err;
  EXPECT_FALSE(std::filesystem::exists(out));
  const Ran added = run_torsion(
      {"add-physics", folder / "asset.gltf", "--out", out, "--body", "slab", "--shape", "box"});
  ASSERT_EQ(added.exit_code, 0) << added.err;
  EXPECT_NE(added.out.find("tool \"ball\""), std::string::npos) << added.out;
  const Ran ran = run_torsion({"simulate", out, "--body-model", "none"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.out.find("FAULTS"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("up to 1 regions"), std::string::npos) << ran.out;
  EXPECT_EQ(run_torsion({"add-physics", asset, "--out", folder / "scene.obj"}).exit_code, 2);
}

TEST(CheckTest, AndTheSummarySayWhatAutoTakesAndWhy) {
  const std::string round = "contact model mdr (auto: one round contact, error of mdr ";
  const std::string soft = "body model compliance (auto: the body is not endless";
  const Ran check = run_torsion({"check", scene("ball_on_cube")});
  EXPECT_NE(check.out.find(round), std::string::npos) << check.out;
  EXPECT_NE(check.out.find(soft), std::string::npos) << check.out;
  const Ran simulate = run_torsion({"simulate", scene("ball_on_cube"), "--seconds", "0.01"});
  EXPECT_NE(simulate.out.find(round), std::string::npos) << simulate.out;
  EXPECT_NE(simulate.out.find(soft), std::string::npos) << simulate.out;
  const Ran mesh = run_torsion({"check", scene("compass_on_ellipsoid")});
  EXPECT_NE(mesh.out.find("contact model patch (auto: a contact with edges or of a mesh"),
            std::string::npos)
      << mesh.out;
}

TEST(CheckTest, JsonNamesBodiesToolsAndSystems) {
  const Ran ran = run_torsion({"check", scene("two_bodies"), "--json"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const json report = json::parse(ran.out);
  EXPECT_TRUE(report["problems"].empty());
  ASSERT_EQ(report["bodies"].size(), 2U);
  EXPECT_EQ(report["bodies"][1]["node"], "soft cube");
  EXPECT_GT(report["bodies"][1]["anchors"].get<int>(), 0);
  ASSERT_EQ(report["tools"].size(), 1U);
  EXPECT_GT(report["tools"][0]["surface_samples"].get<int>(), 1000);
  EXPECT_GT(report["physics_bytes"].get<int>(), 100'000);
  EXPECT_EQ(report["systems"][0]["name"], "couple_tools");
}

#ifdef TORSION_WITH_RENDER
TEST(RenderTest, DrawsOneMomentAFolderAndAVideo) {
  const Folder folder;
  const std::vector<std::string> small = {"--size", "320x180", "--quiet"};
  const auto render = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"render", scene("ball_on_cube_soft")});
    words.insert(words.end(), small.begin(), small.end());
    return run_torsion(words);
  };
  const Ran one = render({"--at", "1.5", "--out", folder / "one.png"});
  EXPECT_EQ(one.exit_code, 0) << one.err;
  EXPECT_EQ(read_text(folder / "one.png").substr(1, 3), "PNG");
  const Ran many = render({"--fps", "4", "--seconds", "1", "--out", folder / "many"});
  EXPECT_EQ(many.exit_code, 0) << many.err;
  EXPECT_EQ(read_text(folder / "many/0003.png").substr(1, 3), "PNG");
  EXPECT_FALSE(std::filesystem::exists(folder / "many/0004.png"));
  const Ran video = render({"--fps", "10", "--seconds", "1", "--out", folder / "v.mp4"});
  EXPECT_EQ(video.exit_code, 0) << video.err;
  EXPECT_EQ(read_text(folder / "v.mp4").substr(4, 4), "ftyp");
}

TEST(RenderTest, ColorsAreWhatTheWordsSayElseTheSceneElseTheTwist) {
  const Folder folder;
  test::GltfBuilder builder = test::good_scene();
  const auto picture = [&](const std::string& of_scene, const std::vector<std::string>& words) {
    builder.document["scenes"][0]["extras"] = nlohmann::json::object();
    if (!of_scene.empty()) {
      builder.document["scenes"][0]["extras"]["torsion_colors"] = of_scene;
    }
    test::write_text(folder / "scene.gltf", builder.text());
    std::vector<std::string> all = {
        "render",  folder / "scene.gltf", "--at",         "0",    "--size", "160x120",
        "--quiet", "--no-overlay",        "--body-model", "none", "--out",  folder / "picture.png"};
    all.insert(all.end(), words.begin(), words.end());
    const Ran ran = run_torsion(all);
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    return read_text(folder / "picture.png");
  };
  const std::string twist = picture("", {"--heat", "twist"});
  const std::string material = picture("", {"--heat", "none"});
  EXPECT_NE(twist, material);
  EXPECT_EQ(picture("", {}), twist);
  EXPECT_EQ(picture("material", {}), material);
  EXPECT_EQ(picture("twist", {}), twist);
  EXPECT_EQ(picture("material", {"--heat", "twist"}), twist);
}
#endif

TEST(ProgramTest, ANewSceneRunsAsItIsWritten) {
  const Folder folder;
  for (const std::string from : {"ball", "disc", "drill", "fingertip", "screwdriver"}) {
    const Ran made = run_torsion({"new", folder / from, "--from", from});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_NE(made.out.find("torsion view"), std::string::npos);
    const Ran checked = run_torsion({"check", folder / (from + ".gltf")});
    EXPECT_EQ(checked.exit_code, 0) << checked.err;
    EXPECT_NE(checked.out.find("no problems\n"), std::string::npos) << checked.out;
    const Ran ran = run_torsion({"simulate", folder / (from + ".gltf"), "--json"});
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    const auto summary = nlohmann::json::parse(ran.out);
    EXPECT_GT(summary["peak_force_N"].get<double>(), 0.01) << from;
    EXPECT_GT(summary["peak_torque_Nm"].get<double>(), 1e-6) << from;
    EXPECT_TRUE(summary["faults"].empty()) << from;
  }
}

TEST(ProgramTest, ANewSceneReplacesNone) {
  const Folder folder;
  test::write_text(folder / "mine.gltf", "{}");
  const Ran refused = run_torsion({"new", folder / "mine"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("is there already"), std::string::npos) << refused.err;
  EXPECT_EQ(test::read_text(folder / "mine.gltf"), "{}");
  const Ran unknown = run_torsion({"new", folder / "other", "--from", "moon"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("screwdriver"), std::string::npos) << unknown.err;
}

}  // namespace
}  // namespace torsion::engine
