#!/usr/bin/env bash
# Lines of each crate outside of its tests, documents and generated files: Rust, and what the laboratory's page and the Python package
# are made of.
#
#     benches/lines.sh [REVISION]
#
# Test modules stand at the ends of files, so that what follows `#[cfg(test)]` and a module is left out.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
revision=${1:-HEAD}

git ls-tree -r --name-only "$revision" |
    grep -E '^(crates/[^/]+/(src|web|build\.rs|hash_sources\.rs)|python/(src|slipfront))' |
    grep -E '\.(rs|js|css|html|py|pyi|sh)$' |
    grep -vE '/(tests|vendor)/|/tests\.rs$' |
    while read -r file; do
        crate=$(sed -E 's,^(crates/[^/]+|python)/.*,\1,' <<< "$file")
        lines=$(git show "$revision:$file" | awk '
            /^#\[cfg\(test\)\]$/ { held = 1; next }
            held && /^mod [a-z_]+ \{$/ { tests = 1 }
            tests { next }
            { n += 1 + held; held = 0 }
            END { print n + 0 }')
        echo "$crate $lines"
    done |
    awk '{ sum[$1] += $2; all += $2 } END { for (crate in sum) printf "%-24s %6d\n", crate, sum[crate]; printf "%-24s %6d\n", "~", all }' |
    sort | sed 's/^~ */all                     /'
