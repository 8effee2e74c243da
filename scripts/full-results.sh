# Sourced: what lines of `test.sh --full` said of this commit, in build/full/RESULTS.csv: commit, line, seconds, result.
commit=$(git rev-parse --short HEAD 2>/dev/null || echo unknown)
[ -z "$(git status --porcelain 2>/dev/null)" ] || commit+=-dirty
results=build/full/RESULTS.csv

# passed_before LINE: whether it has passed on this very commit. Of a tree with changes nobody knows.
passed_before() {
  [[ $commit != unknown && $commit != *-dirty ]] && grep -qs "^$commit,$1,[0-9]*,passed\$" $results
}

# record LINE SECONDS RESULT: in the place of what was said of it, and of what other commits said of any.
record() {
  mkdir -p build/full
  {
    echo "commit,line,seconds,result"
    grep -s "^$commit," $results | grep -v "^$commit,$1," || true
    echo "$commit,$1,$2,$3"
  } >$results.new
  mv $results.new $results
}
