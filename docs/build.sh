#!/usr/bin/env bash
# Builds the book as a site, target/book: all pages with a search, the laboratory as one file, the references
# of Rust and of Python.
#
#     docs/build.sh
#
# Installs mdBook into target/mdbook and pdoc into target/venv where they are missing. Needs the Rust
# toolchain with rustup, and python3 with venv. SLIPFRONT names another command than target/debug/slipfront.
# Exit status: 1 also when a link of the site leads nowhere.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
mdbook_version=0.5.4
book=$PWD/target/book
# The pages as they stand in the repository, with the files that they link to: mdBook takes one folder.
source=$PWD/target/book.source
pages=$source/src

mdbook=target/mdbook/bin/mdbook
[ -x "$mdbook" ] || mdbook=$(command -v mdbook) || {
    cargo install mdbook --version "$mdbook_version" --locked --quiet --no-default-features --features search --root target/mdbook
    mdbook=target/mdbook/bin/mdbook
}

# The contents of the book as those of the site: a part for each line that ends with a colon, a chapter for
# each link; the second and later links of an entry are chapters below its first.
contents() {
    printf '# Summary\n\n[slipfront](README.md)\n[Contents](docs/README.md)\n'
    sed -n -e '/^## /q' -e 's/^\([A-Z].*\):$/\n# \1\n/p' -e '/^\(    \|[0-9]\)/p' docs/README.md | awk '
        /^(#|$)/ { print; next }
        {
            indent = /^[0-9]/ ? "" : "    "
            while (match($0, /\[[^]]*\]\([^)]*\.md\)/)) {
                split(substr($0, RSTART + 1, RLENGTH - 2), part, /\]\(/)
                $0 = substr($0, RSTART + RLENGTH)
                path = sub(/^\.\.\//, "", part[2]) ? part[2] : "docs/" part[2]
                printf "%s- [%s](%s)\n", indent, toupper(substr(part[1], 1, 1)) substr(part[1], 2), path
                indent = "    "
            }
        }'
    printf '\n# Files\n\n- [Cases](cases/README.md)\n- [Notebooks](python/examples/README.md)\n'
}

# A page for a folder that is linked to: its files, with the first sentence of those that begin with a
# comment.
files_of() {
    printf '# %s\n\n' "$2"
    for file in "$1"/*.* "$1"/*/*.toml; do
        [ -f "$file" ] || continue
        sentence=$(sed '/^#/!Q; s/^# *//' "$file" | tr '\n' ' ' | sed 's/\(Fig\|Eq\)\. /\1.\n/g; s/\. .*/./; s/\n/ /g; s/[*_]/\\&/g')
        printf -- '- [`%s`](%s)%s\n' "$file" "${file#"$1"/}" "${sentence:+: $sentence}"
    done
}

rm -rf "$book" "$source"
mkdir -p "$pages"
cp -r docs/site/. "$source"
cp -r --parents README.md ARCHITECTURE.md CHANGELOG.md CITATION.cff CODE_OF_CONDUCT.md CONTRIBUTING.md LICENSE-APACHE LICENSE-MIT \
    ROADMAP.md SECURITY.md deny.toml \
    benches/instructions.txt benches/peers cases challenge/README.md challenge/RESULTS.md \
    crates/slipfront-cli/THIRD-PARTY-NOTICES.txt crates/slipfront-paper/cases/claims.toml \
    crates/slipfront/src/friction/needs.rs docs python/examples "$pages"
rm -r "$pages/docs/site" "$pages/docs/build.sh"
files_of cases Cases > "$pages/cases/README.md"
files_of python/examples Notebooks > "$pages/python/examples/README.md"
# A README.md becomes the first page of its folder, and so does the list of the files of a folder that is
# linked to.
find "$pages" -name '*.md' -exec sed -i -e 's#](\([^):]*\)README\.md#](\1index.md#g' \
    -e 's#](\(\(\.\./\)*\(cases\|python/examples\)\))#](\1/index.md)#g' {} +
contents > "$pages/SUMMARY.md"
{
    printf '(() => {\nconst CASES = [%s];\n' "$(printf "'%s', " cases/*.toml | sed "s#cases/##g; s#\.toml'#'#g")"
    sed 's/^export //' crates/slipfront-lab/web/link.js
    cat docs/site/cases.js
    printf '})();\n'
} > "$source/cases.js"
"$mdbook" build --dest-dir "$book" "$source"

[ -n "${SLIPFRONT:-}" ] || cargo build --quiet --locked -p slipfront-cli
crates/slipfront-wasm/build.sh
"${SLIPFRONT:-target/debug/slipfront}" lab --single "$book/lab.html"

cargo doc --workspace --lib --no-deps --locked --quiet
mkdir "$book/api"
cp -r target/doc "$book/api/rust"

tests/venv.sh
bin=target/venv/bin
"$bin/pip" install --quiet --disable-pip-version-check pdoc==16.0.0
(. target/venv/bin/activate && maturin develop --quiet --profile dev --manifest-path python/Cargo.toml)
# A star import leaves `map` and `open` out, the page does not.
"$bin/python" - "$book/api/python" << 'EOF'
import pathlib, sys
import pdoc, slipfront
slipfront.__all__ += ["map", "open"]
pdoc.render.configure(docformat="numpy", template_directory=pathlib.Path("docs/site/pdoc"))
pdoc.pdoc("slipfront", output_directory=pathlib.Path(sys.argv[1]))
EOF

python3 docs/site/links.py "$book"
printf 'target/book/index.html is the first page\n'
