// What Highway's library has beside its headers: the choice among vector targets, of which a port has one.
#include <hwy/highway.h>

namespace hwy {

std::int64_t SupportedTargets() {
  return HWY_STATIC_TARGET;
}
void SetSupportedTargetsForTest(std::int64_t) {}
ChosenTarget& GetChosenTarget() {
  static ChosenTarget chosen;
  return chosen;
}

}  // namespace hwy
