#!/bin/sh
# through_ccache.sh CCACHE COMPILER ARGS...: compiles, or takes what was compiled before.
# Precompiled headers hold checksums of their headers' bytes, by which g++ knows what was included already. ccache
# would take one that differs in comments alone: then headers are read twice. So their headers are compared whole.
export CCACHE_SLOPPINESS=pch_defines,time_macros # without this ccache takes no source that has such a header
case " $* " in
*" -x c++-header "*) export CCACHE_DEPEND=1 ;;
esac
exec "$@"
