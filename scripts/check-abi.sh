#!/usr/bin/env bash
# check-abi.sh PRINTER SHARED [--renew]: what programs that are already compiled rely on stays as it is: PRINTER (of
# tests/c/print_abi.c) and the C functions that SHARED exports say what tests/c/abi.txt says. --renew writes that file.
set -euo pipefail
cd "$(dirname "$0")/.."
written=tests/c/abi.txt
found=$("$1"; nm -D --defined-only "$2" | awk '$NF !~ /^_Z/ { print "function " $NF }' | sort -u)

# Nothing of the headers is forgotten.
headers=(include/sightline/sightline.h include/sightline/c/*.h)
for type in $(sed -nE 's/^typedef struct (\w+) \{$/\1/p' "${headers[@]}"); do
  grep -q "^struct $type:" <<<"$found" || { echo "tests/c/print_abi.c does not print $type"; exit 1; }
done
for name in $(cat "${headers[@]}" | grep -oP '\bSIGHTLINE_[A-Z_]+(?= = \d)|^#define \KSIGHTLINE_[A-Z_]+(?= [(\d])'); do
  [[ $name == SIGHTLINE_VERSION_* ]] || grep -q "^value $name:" <<<"$found" ||
    { echo "tests/c/print_abi.c does not print $name"; exit 1; }
done

if [ "${3:-}" = --renew ]; then
  echo "$found" >$written
elif ! diff $written <(echo "$found"); then
  echo "The C ABI differs from $written. Where that breaks nobody, as a function or the end of a versioned struct does:"
  echo "  scripts/check-abi.sh $1 $2 --renew"
  exit 1
fi
echo "the C ABI is that of $written: $(grep -c ^function $written) functions, $(grep -c ^struct $written) structs"
