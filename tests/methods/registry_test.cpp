#include <gmock/gmock.h>

#include <set>

#include <sightline/workbench/method.hpp>
#include <sightline/workbench/worlds.hpp>

#include "support/refusal.hpp"

namespace sightline {
namespace {

using testing::HasSubstr;

Scene small_world() {
  return generate_world("regular?columns=3&rows=3&detail=0");
}

std::string refusal(std::string_view specification, const Scene& scene) {
  return test::refusal([&] { return create_method(specification, scene); });
}

TEST(Registry, NamesAreUniqueAndFound) {
  std::set<std::string_view> names;
  for (const MethodInfo& info : all_methods()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_EQ(find_method(info.name), &info);
    EXPECT_FALSE(info.summary.empty());
  }
  EXPECT_EQ(find_method("nonesuch"), nullptr);
}

TEST(Registry, RefusesWithASentence) {
  const Scene scene = small_world();
  EXPECT_THAT(refusal("nonesuch", scene), HasSubstr("expected one of none, vfc-vc"));
  EXPECT_THAT(refusal("vfc-vc?bounds=cube", scene), HasSubstr("sphere|box"));
  EXPECT_THAT(refusal("none?cell=1", scene), HasSubstr("no parameter"));
  EXPECT_THAT(refusal("level-pvs", scene), HasSubstr("lacks a level's PVS"));
  EXPECT_THAT(refusal("none", Scene{}), HasSubstr("holds no object"));
  Scene broken = small_world();
  broken.bounds.min_x[4] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(refusal("vfc-vc", broken), HasSubstr("object 4"));
}

TEST(Registry, GuaranteesFollowTheParameters) {
  const Scene scene = small_world();
  EXPECT_EQ(create_method("vfc-vc", scene)->guarantee(), Guarantee::conservative);
  EXPECT_EQ(create_method("vfc-vc?contribution=exact", scene)->guarantee(), Guarantee::conservative);
  EXPECT_EQ(create_method("vfc-vc?contribution=area", scene)->guarantee(), Guarantee::approximate);
}

}  // namespace
}  // namespace sightline
