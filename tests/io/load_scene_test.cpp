// What a user may type, and the one sentence for what cannot be loaded.
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sightline/workbench/io.hpp>

#include "sample_files.hpp"

namespace sightline {
namespace {

using namespace samples;
using testing::HasSubstr;

std::string refusal_to_load(const std::string& specification) {
  return error_of([&] { load_scene(specification); });
}

TEST(LoadScene, World) {
  EXPECT_EQ(load_scene("world:forest?trees=10").name, "world:forest?trees=10");
}

TEST(LoadScene, EachKindOfFile) {
  const TemporaryFolder folder;
  write(folder / "a.bsp", to_bsp(two_rooms()));
  write(folder / "a.pk3", to_pk3("maps/a.bsp", to_bsp(two_rooms())));
  write(folder / "a.gltf", to_bytes(one_triangle()));
  write(folder / "a.glb", to_glb(one_triangle(), {}));
  EXPECT_EQ(load_scene((folder / "a.bsp").string()).size(), 6u);
  EXPECT_EQ(load_scene((folder / "a.pk3").string() + ":maps/a.bsp").size(), 6u);
  EXPECT_EQ(load_scene((folder / "a.gltf").string()).size(), 1u);
  EXPECT_EQ(load_scene((folder / "a.glb").string()).size(), 1u);
  write(folder / "A.GLB", to_glb(one_triangle(), {}));
  EXPECT_EQ(load_scene((folder / "A.GLB").string()).size(), 1u);
  write(folder / "empty.glb", {});
  EXPECT_THAT(refusal_to_load((folder / "empty.glb").string()),
              HasSubstr("is empty, expected a GLB or JSON"));
  write(folder / "words.glb", to_bytes(std::string("no model")));
  EXPECT_THAT(refusal_to_load((folder / "words.glb").string()),
              HasSubstr("nor a GLB, which begins with glTF"));
}

TEST(LoadScene, ArchivesAreFoundInTheDataFolders) {
  const TemporaryFolder folder;
  write(folder / "only-here.pk3", to_pk3("maps/a.bsp", to_bsp(two_rooms())));
  ASSERT_EQ(setenv("SIGHTLINE_DATA", ("/nowhere:" + folder.path().string()).c_str(), 1), 0);
  EXPECT_EQ(load_scene("only-here.pk3:maps/a.bsp").size(), 6u);
  EXPECT_THAT(refusal_to_load("nor-here.pk3:maps/a.bsp"), HasSubstr("nor-here.pk3"));
  unsetenv("SIGHTLINE_DATA");
  EXPECT_THAT(refusal_to_load("only-here.pk3:maps/a.bsp"), HasSubstr("only-here.pk3"));
}

TEST(LoadScene, OneSentenceForEachMistake) {
  const TemporaryFolder folder;
  for (const char* ending : {".bsp", ".gltf", ".glb"}) {
    const std::string missing = (folder / ("missing" + std::string(ending))).string();
    EXPECT_EQ(refusal_to_load(missing), missing + ": no such file");
    const std::string empty = (folder / ("empty" + std::string(ending))).string();
    write(empty, {});
    EXPECT_THAT(refusal_to_load(empty), HasSubstr(empty + ": "));
    const std::string is_folder = (folder / ("folder" + std::string(ending))).string();
    std::filesystem::create_directory(is_folder);
    EXPECT_THAT(refusal_to_load(is_folder), HasSubstr("not a regular file"));
  }
  EXPECT_THAT(refusal_to_load((folder / "missing.pk3").string() + ":maps/a.bsp"), HasSubstr("no such file"));
  std::filesystem::create_directory(folder / "folder.pk3");
  EXPECT_THAT(refusal_to_load((folder / "folder.pk3").string() + ":maps/a.bsp"),
              HasSubstr("not a regular file"));
  write(folder / "empty.pk3", {});
  EXPECT_THAT(refusal_to_load((folder / "empty.pk3").string() + ":maps/a.bsp"),
              HasSubstr("not a readable zip archive"));
  std::filesystem::create_symlink("round.pk3", folder / "round.pk3");
  EXPECT_THAT(refusal_to_load((folder / "round.pk3").string() + ":maps/a.bsp"), HasSubstr("cannot be read"));
  EXPECT_THAT(refusal_to_load(""), HasSubstr("no scene given"));
  EXPECT_THAT(refusal_to_load("scene.obj"), HasSubstr("not a kind of scene"));
  EXPECT_THAT(refusal_to_load("a.pk3"), HasSubstr("expected archive.pk3:maps/name.bsp"));
  EXPECT_THAT(refusal_to_load("world:atlantis"), HasSubstr("atlantis"));
  EXPECT_THAT(refusal_to_load("world:forest?trees=-1"), HasSubstr("trees"));
  EXPECT_THAT(refusal_to_load(std::string("a\0.bsp", 6)), HasSubstr("zero byte"));
}

}  // namespace
}  // namespace sightline
