// Files that are no scene: missing, of another kind, outside of their folder, cut off.

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "scenes/load_gltf.hpp"
#include "tests/scenes/gltf_builder.hpp"

namespace torsion::engine::test {
namespace {

std::string problems_of_file(const std::string& bytes, const std::string& name) {
  const LoadedScene loaded = load_text(bytes, name);
  EXPECT_FALSE(loaded.scene.has_value());
  return to_text(loaded.problems);
}

TEST(BadFileTest, MissingFileIsNamed) {
  const LoadedScene loaded = load_gltf("/nowhere/scene.gltf");
  ASSERT_EQ(loaded.problems.size(), 1U);
  const std::string text = to_text(loaded.problems);
  EXPECT_NE(text.find("/nowhere/scene.gltf"), std::string::npos) << text;
  EXPECT_NE(text.find("No such file"), std::string::npos) << text;
}

TEST(BadFileTest, FolderIsNoScene) {
  const TestFolder folder;
  const LoadedScene loaded = load_gltf(folder.path());
  EXPECT_NE(to_text(loaded.problems).find("not a regular file"), std::string::npos);
}

TEST(BadFileTest, PipeIsRefusedWithoutWaiting) {
  const TestFolder folder;
  const std::filesystem::path pipe = folder.path() / "pipe.gltf";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const LoadedScene loaded = load_gltf(pipe);
  EXPECT_NE(to_text(loaded.problems).find("not a regular file"), std::string::npos);
}

TEST(BadFileTest, PipeAsBufferIsRefusedWithoutWaiting) {
  const TestFolder folder;
  ASSERT_EQ(::mkfifo((folder.path() / "pipe.bin").c_str(), 0600), 0);
  GltfBuilder scene = good_scene();
  scene.document["buffers"] = {{{"byteLength", 640}, {"uri", "pipe.bin"}}};
  const LoadedScene loaded = load_gltf(folder.write("scene.gltf", scene.text()));
  EXPECT_NE(to_text(loaded.problems).find("not a regular file"), std::string::npos)
      << to_text(loaded.problems);
}

TEST(BadFileTest, LinkOutOfTheFolderIsRefused) {
  const TestFolder folder;
  const TestFolder other;
  GltfBuilder scene = good_scene();
  scene.document["buffers"] = {{{"byteLength", scene.bytes().size()}, {"uri", "link.bin"}}};
  std::filesystem::create_symlink(other.write("secret.bin", scene.bytes()),
                                  folder.path() / "link.bin");
  const LoadedScene loaded = load_gltf(folder.write("scene.gltf", scene.text()));
  EXPECT_FALSE(loaded.scene.has_value());
  EXPECT_NE(to_text(loaded.problems).find("in the folder of the scene"), std::string::npos)
      << to_text(loaded.problems);
}

TEST(BadFileTest, ExternalBufferBesideTheSceneIsRead) {
  const TestFolder folder;
  GltfBuilder scene = good_scene();
  scene.document["buffers"] = {{{"byteLength", scene.bytes().size()}, {"uri", "a%20b.bin"}}};
  (void)folder.write("a b.bin", scene.bytes());
  const LoadedScene loaded = load_gltf(folder.write("scene.gltf", scene.text()));
  EXPECT_TRUE(loaded.scene.has_value()) << to_text(loaded.problems);
}

TEST(BadFileTest, EveryCutOfABinaryFileIsRefused) {
  const std::string whole = good_scene().glb();
  for (std::size_t length = 0; length < whole.size(); length += 37) {
    const std::string text = problems_of_file(whole.substr(0, length), "scene.glb");
    EXPECT_NE(text.find("scene.glb: "), std::string::npos) << length;
  }
  const std::string text = problems_of_file(whole.substr(0, whole.size() - 4), "scene.glb");
  EXPECT_NE(text.find("cut off or damaged"), std::string::npos) << text;
}

TEST(BadFileTest, EveryCutOfATextIsRefused) {
  const std::string whole = good_scene().text();
  for (std::size_t length = 0; length < whole.size(); length += 37) {
    const std::string text = problems_of_file(whole.substr(0, length), "scene.gltf");
    EXPECT_NE(text.find("not valid JSON"), std::string::npos) << length << ' ' << text;
  }
}

}  // namespace
}  // namespace torsion::engine::test
