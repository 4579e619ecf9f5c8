#!/usr/bin/env bash
# Prints how large the package is: lines, parameters, constants, headers, words. Needs nothing that is built.
#   scripts/count.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
CORE=(mapping registration place graph slam map)

count() { printf '%-72s %s\n' "$1" "$2"; }
in_core() { for module in "${CORE[@]}"; do printf '%s\n' "src/$module" "include/semantic_mht_slam/$module"; done; }
lines_of() { find "$@" \( -name '*.h' -o -name '*.cpp' \) -exec cat {} + | wc -l; }

# Headers below include/ that no file of another module includes.
lonely_headers() {
  local header name module
  find include -name '*.h' | while read -r header; do
    name=${header#include/}
    module=$(cut -d/ -f2 <<<"$name")
    grep -rlF "\"$name\"" src include --include='*.h' --include='*.cpp' |
      grep -qvE "^(src|include/semantic_mht_slam)/$module/" || echo "$name"
  done
}

# shellcheck disable=SC2046
{
  count "lines of C++ outside test" "$(lines_of src include)"
  for module in "${CORE[@]}"; do
    count "  of these, $module" "$(lines_of "src/$module" "include/semantic_mht_slam/$module")"
    count "  and its tests" "$(lines_of "test/$module")"
  done
  count "lines of Python outside test" "$(find src/semantic_mht_slam scripts -name '*.py' -exec cat {} + | wc -l)"
  count "parameters in docs/parameters.md" "$(grep -oE '^\| .[a-z0-9_./]+.' docs/parameters.md | sort -u | wc -l)"
  count "named numeric constants of the core" \
    "$(grep -rhE '^ *(static )?constexpr (double|float|int|long|std::size_t|std::u?int[0-9]+_t) k' $(in_core) | wc -l)"
  count "casts to int, long and std::size_t in the core but mapping" \
    "$(grep -rE 'static_cast<(int|long|std::size_t)>' $(in_core | grep -v mapping) | wc -l)"
  count "public headers" "$(find include -name '*.h' | wc -l)"
  count "  that no other module includes" "$(lonely_headers | wc -l)"
  count "words of docs, without the parameter reference" "$(find docs -name '*.md' ! -name parameters.md -exec cat {} + | wc -w)"
}
