#!/usr/bin/env bash
# Lines of each crate outside of its tests, documents and generated files: Rust, and what the laboratory's
# page and the Python package are made of. The first figure counts all lines, the second those with code: no
# blank lines, no comments, no docstrings.
#
#     benches/lines.sh [REVISION]
#
# Test modules stand at the ends of files, so that what follows `#[cfg(test)]` and a module is left out.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
revision=${1:-HEAD}

git ls-tree -r --format='%(objectmode) %(path)' "$revision" |
    # Links lead to a file that is counted where it stands.
    sed -n 's/^100[0-9]* //p' |
    grep -E '^(crates/[^/]+/(src|web|build\.rs|hash_sources\.rs)|python/(src|slipfront))' |
    grep -E '\.(rs|js|css|html|py|pyi|sh)$' |
    grep -vE '/(tests|vendor)/|/(tests|testing|for_tests|page_types)\.rs$' |
    while read -r file; do
        crate=$(sed -E 's,^(crates/[^/]+|python)/.*,\1,' <<< "$file")
        lines=$(git show "$revision:$file" | awk -v kind="${file##*.}" '
            /^#\[cfg\(test\)\]$/ { held = 1; next }
            held && /^mod [a-z_]+ \{$/ { tests = 1 }
            tests { next }
            { n += 1 + held; code += held; held = 0 }
            /^[ \t]*$/ { next }
            # Texts between three quotes that begin a line are docstrings.
            kind ~ /^py/ && (inside || /^[ \t]*"""/) {
                quotes = gsub(/"""/, "")
                if (quotes % 2) inside = !inside
                next
            }
            kind == "rs" && /^[ \t]*\/\// { next }
            kind ~ /^(py|pyi|sh)$/ && /^[ \t]*#/ { next }
            kind ~ /^(js|css)$/ && (inside || /^[ \t]*\/\*/) { inside = !/\*\//; next }
            kind == "js" && /^[ \t]*\/\// { next }
            kind == "html" && (inside || /^[ \t]*<!--/) { inside = !/-->/; next }
            { code += 1 }
            END { print n + 0, code + 0 }')
        echo "$crate ${file##*.} $lines"
    done |
    awk '
        { sum[$1] += $3; code[$1] += $4; all += $3; of_all += $4 }
        $2 == "rs" { rust += $3; of_rust += $4 }
        END {
            for (crate in sum) printf "%-24s %6d %6d\n", crate, sum[crate], code[crate]
            printf "~%-23s %6d %6d\n", "Rust", rust, of_rust
            printf "~%-23s %6d %6d\n", "all", all, of_all
        }' |
    sort | sed 's/^~\(.*\)$/\1 /; 1i crate                     lines   code'
