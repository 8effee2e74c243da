#!/usr/bin/env bash
# The check of figures finds one that no row stands behind, one that its row contradicts, rows and papers that nobody has,
# and a page of measurements that was made by hand or of other rows; and lets figures that are tied, published or given be.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT

# fresh: the documents as they are, where the check finds nothing.
fresh() {
  rm -rf "$tree/sightline"
  mkdir -p "$tree/sightline/benchmarks"
  cp -r "$root/README.md" "$root/CONTRIBUTING.md" "$root/docs" "$root/scripts" "$tree/sightline"
  cp -r "$root/benchmarks/results" "$tree/sightline/benchmarks"
  cd "$tree/sightline"
}

# found SENTENCE: the check fails and says so.
found() {
  if scripts/check-figures.sh >../said 2>&1; then
    echo "the check of figures did not find: $1"
    exit 1
  fi
  grep -qF -- "$1" ../said || { echo "the check of figures did not say: $1"; cat ../said; exit 1; }
}

fresh
cat >>docs/guides/c.md <<'END'
A setting of <!--given-->20 ms, a paper's <!--paper le-cpu-ratio-->1.45 times, 30 boxes, `4 ms` as code.
END
scripts/check-figures.sh >/dev/null || { echo "the check of figures refused good ones"; exit 1; }

for figure in "12 ms" "3.5 times" "1,000,000 boxes in 4 seconds" "80 %" "114 M triangles/s"; do
  fresh
  echo "It takes $figure." >>docs/guides/c.md
  found "reads like a measurement"
done
fresh
echo "It takes <!--fig world world/1000000-->1 ns." >>README.md
found "README.md: figures are not those of the CSVs"
fresh
echo "It takes <!--fig world no/such/row-->1 ns." >>docs/architecture.md
found "world.csv has no row 'no/such/row'"
fresh
echo "They print <!--paper nobody-->2 times." >>docs/architecture.md
found "published.csv has no key 'nobody'"
fresh
sed -i 's/^| \*\*World\*\* | [0-9.]*/&9/' docs/measurements.md
found "docs/measurements.md is not what the CSVs make it"
fresh
sed -i 's|^world,1000000,µs,[0-9.]*|world,1000000,µs,1|' benchmarks/results/*/world.csv
found "docs/measurements.md is not what the CSVs make it"
fresh
echo "A cull takes 7 ms." >>scripts/figures/page.md
found "scripts/figures/page.md:"
echo "the check of figures finds what no measurement stands behind"
