#!/usr/bin/env bash
# planted_docs.sh BUILD: the check of documents finds links and paths that lead nowhere, code that does not compile, that
# ends badly or does not configure, commands and options that nobody has; and lets good code of every kind be.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
build=$(realpath "$1")
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree/docs" "$tree/cmake" "$tree/scripts"
cp "$root/CMakeLists.txt" "$root/CMakePresets.json" "$tree"
cp "$root"/cmake/*.cmake "$tree/cmake"
: >"$tree/scripts/there.sh"

cat >"$tree/README.md" <<'END'
# Good
[above](#good), [a part](docs/bad.md#its-second-part), `scripts/there.sh`, [elsewhere](https://example.org/x#y).
```cpp
#include <sightline/view.hpp>
int three() { return 3; }
int main() {
  const int n = three();
}
```
```cpp continues
#include <vector>
const std::vector<int> numbers{n};
if (numbers[0] != 3 || !sightline::make_view({}, 640, 480)) return 1;
```
```c
#include <sightline/sightline.h>
int main(void) { return sightline_version()[0] == 0; }
```
```python
import sightline
n = len(sightline.World())
```
```python continues
assert n == 0
```
```cmake
find_package(sightline REQUIRED)
target_link_libraries(engine PRIVATE sightline::sightline)
```
```sh
cmake --preset release -DSIGHTLINE_WORKBENCH=OFF && cmake --build build/release --target sightline
sightline methods --json x   # as it stands
```
```sh run
sightline generate 'forest?trees=3&size=30' -o forest.glb
```
```cpp
#include <fstream>
if (!std::ifstream("forest.glb")) return 1;  // what the shell made
```
END
"$root/scripts/check-docs.py" "$build" "$tree" >"$tree/said" 2>&1 || true
# The other page is not there yet: nothing else is wrong.
if [ "$(grep -c . "$tree/said")" != 1 ] || ! grep -q '^README.md:2: docs/bad.md#its-second-part leads nowhere' "$tree/said"; then
  echo "the check of documents refused good ones:"
  cat "$tree/said"
  exit 1
fi

cat >"$tree/docs/bad.md" <<'END'
# Its first part
[a](nowhere.md), [b](../README.md#bad), `scripts/not_there.sh`
## Its second part
```cpp
int main() { return undeclared; }
```
```cpp
int main() { return 7; }
```
```c
int main(void) { sightline_nothing(); }
```
```python
raise ValueError("planted")
```
```cmake
find_package(sightline REQUIRED)
target_link_libraries(engine PRIVATE sightline::nothing_of_the_kind)
```
```sh
cmake --preset nobody -DSIGHTLINE_NOTHING=ON
cmake --build build/release --target nothing
sightline paint x
sightline info x --nothing
scripts/not_there.sh
```
```sh run
exit 9
```
```basic
10 GOTO 10
```
END
expected="docs/bad.md:2: nowhere.md leads nowhere
docs/bad.md:2: README.md has no heading #bad
docs/bad.md:2: there is no scripts/not_there.sh
docs/bad.md:4: exit 1: 4.cpp: In function
docs/bad.md:7: exit 7:
docs/bad.md:10: exit 1:
docs/bad.md:13: exit 1: Traceback
docs/bad.md:16: does not configure:
docs/bad.md:21: there is no preset nobody
docs/bad.md:21: there is no option SIGHTLINE_NOTHING
docs/bad.md:22: there is no target nothing
docs/bad.md:23: sightline has no command paint
docs/bad.md:24: sightline info has no option --nothing
docs/bad.md:25: there is no scripts/not_there.sh
docs/bad.md:27: exit 9:
docs/bad.md:30: expected a block of cpp"
failed=0
if "$root/scripts/check-docs.py" "$build" "$tree" >"$tree/said" 2>&1; then
  echo "the check of documents let everything pass"
  exit 1
fi
while read -r line; do
  grep -qF -- "$line" "$tree/said" || { echo "the check of documents did not say: $line"; failed=1; }
done <<<"$expected"
if [ "$(grep -cE '^(docs|README)\S*: ' "$tree/said")" != "$(wc -l <<<"$expected")" ]; then
  echo "the check of documents says other than what was planted"
  failed=1
fi
[ $failed = 0 ] || { cat "$tree/said"; exit 1; }
echo "the check of documents finds what does not hold"
