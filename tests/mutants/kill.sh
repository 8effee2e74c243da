#!/bin/sh
# kill.sh MUTANT TESTS FILTER: plants one mutant, and of the tests that the filter names one must fail by what it expects,
# not by a crash. Unplanted they pass, as the suite shows.
said=$(SIGHTLINE_MUTANT=$1 "$2" --gtest_brief=1 --gtest_fail_fast --gtest_filter="$3" 2>&1)
if [ $? -eq 1 ] && echo "$said" | grep -m 1 '^\[  FAILED  \]'; then exit 0; fi
echo "$said" | tail -30
echo "$1 survives $3"
exit 1
