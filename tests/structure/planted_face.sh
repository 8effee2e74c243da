#!/usr/bin/env bash
# The check of the library's face finds a function, a member, a constant and a macro that nobody described, a function
# that does not say its cost, and a public function or alias that shows a type of the library's inside; and lets what is
# private show it.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir "$tree/library"
cp -r "$root/include" "$tree"
for folder in "$root"/library/*/; do mkdir "$tree/library/$(basename "$folder")"; done
face=$tree/include/sightline

cat >"$face/planted.hpp" <<'END'
#pragma once
#include <sightline/world.hpp>
namespace sightline {
namespace world {
struct Chunk;
}
bool undescribed_function(int);
inline constexpr int kUndescribed = 1;
/// Says what it does. Errors: none. Threads, Allocates: as World.
bool costless(int);
/// An inner type's other name.
using Alias = const world::Chunk*;
/// A class.
///
/// Unless a function says otherwise: Errors: none. Cost: constant. Threads: any.
class Planted {
public:
  Planted(const Planted&);
  explicit Planted(int);
  /// A part of the inside. Allocates: nothing.
  const world::Chunk& chunk() const;
  /// Fine. Allocates: nothing.
  int fine() const;
  float undescribed_member;
  int wide, high;  ///< pixels

private:
  bool hidden(const world::Chunk&);
  const world::Chunk* chunk_;
};
}  // namespace sightline
END
cat >"$face/c/planted.h" <<'END'
#include <sightline/c/status.h>
#define SIGHTLINE_PLANTED 7
typedef struct sightline_planted {
  int bare;
} sightline_planted;
SIGHTLINE_API int sightline_undescribed(int value);
END
sed -i 's|#include <sightline/c/world.h>|&\n#include <sightline/c/planted.h>|' "$face/sightline.h"

expected="undescribed_function has no doc comment
undescribed_function does not say: Errors, Cost, Threads, Allocates
kUndescribed has no doc comment
costless does not say: Cost
Alias shows world::Chunk, which is the library's own
Planted::Planted has no doc comment
Planted::Planted does not say: Allocates
Planted::chunk shows world::Chunk, which is the library's own
Planted::undescribed_member has no doc comment
SIGHTLINE_PLANTED has no doc comment
sightline_planted has no doc comment
sightline_planted::bare has no doc comment
sightline_undescribed has no doc comment"
if found=$("$root/scripts/check-face.py" "$tree"); then
  echo "the check of the face let everything pass"
  exit 1
fi
found=$(sed 's/^[^ ]*: //' <<<"$found" | sort -u)
if [ "$found" != "$(sort -u <<<"$expected")" ]; then
  echo "the check of the face found otherwise than was planted:"
  diff <(sort -u <<<"$expected") <(echo "$found") || true
  exit 1
fi
echo "the check of the face finds what has no manual and what shows the inside"
