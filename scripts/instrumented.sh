# Sourced by fuzz.sh, sanitize.sh and coverage.sh: REPOSITORY, INSTRUMENTED, and a function that builds in there what
# test/instrumented describes (clang, ASan, UBSan, counters), once for all three.
REPOSITORY=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
INSTRUMENTED="$REPOSITORY/build/instrumented"
export PATH="/usr/bin:/bin:/usr/sbin:/sbin:$PATH"
# Allocations of uninstrumented libraries that end with the process are no findings.
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=0 UBSAN_OPTIONS=print_stacktrace=1

# instrumented_configure: installs what is missing, and configures at first (the build does so again where it has to)
instrumented_configure() {
  "$REPOSITORY/scripts/setup.sh" --instrumented >/dev/null
  [ ! -f "$INSTRUMENTED/Makefile" ] || return 0
  mkdir -p "$INSTRUMENTED"
  cmake -S "$REPOSITORY/test/instrumented" -B "$INSTRUMENTED" -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=None \
    -DCMAKE_CXX_COMPILER_LAUNCHER="$(command -v ccache || true)" >"$INSTRUMENTED/configure.log" 2>&1 ||
    { tail -n 20 "$INSTRUMENTED/configure.log" >&2; return 1; }
}

# instrumented_targets REGEX: the names that match, without what the expression's group leaves out
instrumented_targets() { cmake --build "$INSTRUMENTED" --target help | sed -nE "s/^\.\.\. $1\$/\1/p"; }

# instrumented_build TARGET...
instrumented_build() {
  cmake --build "$INSTRUMENTED" --target "$@" -- -j"${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}" >"$INSTRUMENTED/build.log" 2>&1 ||
    { grep -A5 "error:" "$INSTRUMENTED/build.log" | head -n 40 >&2; return 1; }
}
