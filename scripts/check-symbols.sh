#!/usr/bin/env bash
# check-symbols.sh LIBRARY: fails unless the shared library gives away exactly the functions of <sightline/sightline.h>.
set -euo pipefail
cd "$(dirname "$0")/.."
declared=$(grep -oE '\bsightline_[a-z_]+\(' include/sightline/sightline.h | tr -d '(' | sort -u)
given=$(nm -D --defined-only "$1" | awk '{print $NF}' | sort -u)
diff <(echo "$declared") <(echo "$given") || { echo "$1 does not export what the header declares"; exit 1; }
echo "$(echo "$given" | wc -l) symbols, all declared"
