#!/usr/bin/env bash
# Every C and C++ file is as clang-format 14 lays it out, and no file that people write is longer than 500 lines.
# usage: check-format.sh [--fix], which lays them out
set -euo pipefail
cd "$(dirname "$0")/.."
failed=0

mapfile -t sources < <(git ls-files --cached --others --exclude-standard '*.cpp' '*.hpp' '*.c' '*.h')
case ${1:-} in
  --fix) clang-format-14 -i "${sources[@]}" ;;
  *) printf '%s\0' "${sources[@]}" | xargs -0 -n 16 -P "$(nproc)" clang-format-14 --dry-run --Werror || failed=1 ;;
esac

while read -r lines file; do
  [ "$lines" -le 500 ] || { echo "$file: $lines lines, expected at most 500"; failed=1; }
done < <(git ls-files -z --cached --others --exclude-standard | grep -zvE '\.(csv|svg|png|json)$' |
           xargs -0 wc -l | grep -v ' total$')
[ $failed = 0 ] && echo "every file is laid out and at most 500 lines long"
exit $failed
