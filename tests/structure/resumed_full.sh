#!/usr/bin/env bash
# `test.sh --full`, begun again, leaves out what has passed on this commit, and nothing else.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
git init -q .
echo "/build/" >.gitignore
change() { git add . && git -c user.name=test -c user.email=test@example.org commit -q --allow-empty -m "$1"; }
ask() { bash -c '. "$0"/scripts/full-results.sh; '"$1" "$root"; }
expect() {
  local said=no
  ask "passed_before $1" && said=yes
  [ $said = "$2" ] || { echo "full results: $3" >&2; exit 1; }
}

change one
expect gate no "a line that never ran counts as passed"
ask 'record gate 5 passed; record web 7 failed'
expect gate yes "a line that passed is run again"
expect web no "a line that failed is not run again"
expect gat no "a line is taken for another"
ask 'record web 8 passed'
[ "$(grep -c ',web,' build/full/RESULTS.csv)" = 1 ] || { echo "full results: a line stands there twice" >&2; exit 1; }
echo "change" >file
expect gate no "a line that passed before a change counts after it"
change two
expect gate no "a line that passed on another commit counts"
ask 'record answers 1 passed'
[ "$(wc -l <build/full/RESULTS.csv)" = 2 ] || { echo "full results: lines of another commit stay" >&2; exit 1; }
