#include <sightline/workbench/parameters.hpp>

#include <gmock/gmock.h>

#include "support/refusal.hpp"

namespace sightline {
namespace {

using testing::HasSubstr;

constexpr ParameterInfo kDeclared[]{
    {"trees", "how many", "100", 1, 1000, true},
    {"size", "metres", "2.5", 0, 10},
    {"kind", "which", "oak", 0, 0, false, "oak|fir"},
};

Parameters parse(std::string_view text) {
  return parse_parameters("world", text, kDeclared);
}

TEST(Parameters, TakeTheirDefaults) {
  const Parameters p = parse("forest");
  EXPECT_EQ(p.count("trees"), 100u);
  EXPECT_EQ(p.number("size"), 2.5);
  EXPECT_EQ(p.word("kind"), "oak");
  EXPECT_EQ(specified_name("forest?a=b"), "forest");
}

TEST(Parameters, TakeWhatIsGiven) {
  const Parameters p = parse("forest?kind=fir&trees=7");
  EXPECT_EQ(p.count("trees"), 7u);
  EXPECT_EQ(p.word("kind"), "fir");
  EXPECT_NO_THROW(parse("forest?"));
}

TEST(Parameters, SayWhatIsWrong) {
  const auto refused = [](std::string_view text) { return test::refusal([&] { return parse(text); }); };
  EXPECT_THAT(refused("forest?leaves=3"), HasSubstr("'leaves'"));
  EXPECT_THAT(refused("forest?leaves=3"), HasSubstr("trees, size, kind"));
  EXPECT_THAT(refused("forest?trees"), HasSubstr("key=value"));
  EXPECT_THAT(refused("forest?trees=0"), HasSubstr("from 1 to 1000"));
  EXPECT_THAT(refused("forest?trees=2.5"), HasSubstr("whole number"));
  for (const char* bad : {"forest?trees=", "forest?trees=1x", "forest?trees=nan", "forest?size=inf",
                          "forest?size=1e999", "forest?trees=-1", "forest?&", "forest?=3"}) {
    EXPECT_NE(refused(bad), "") << bad;
  }
  EXPECT_THAT(refused("forest?kind=elm"), HasSubstr("oak|fir"));
  EXPECT_THAT(refused("forest?kind=oak|fir"), HasSubstr("expected one of"));
}

}  // namespace
}  // namespace sightline
