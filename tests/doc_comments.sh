#!/usr/bin/env bash
# Doc comments that cannot be understood alone, although rustdoc shows each of them by itself: those that
# begin with a pronoun or with a clause in place of a noun, and those with a sentence that leans on another
# comment, such as "The same of ...", "Those of ..." or "Of the ..."; headings that a text follows on their
# line; and comments of any kind wider than 110 characters, code in them apart.
#
#     tests/doc_comments.sh
#     tests/doc_comments.sh crates/slipfront
#
# Takes folders or files, by default all that git knows, and fails when it lists any.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
if [ $# -eq 0 ]; then
  set -- '*.rs' '*.py'
fi

# Files with this ending among the folders or files.
files() {
  local ending=$1
  shift
  git ls-files --cached --others --exclude-standard -- "$@" | grep "\\.$ending\$" || true
}

# Comments of Rust, as `file:line: text` with the lines of each joined; without examples in code and the
# headings of sections. The first lines of docstrings of Python likewise.
comments() {
  files py "$@" | while read -r file; do
    [ ! -f "$file" ] || awk -v file="$file" 'sub(/^ *"""/, "") && $0 != "" { sub(/"""$/, ""); print file ":" NR ": " $0 }' "$file"
  done
  files rs "$@" | while read -r file; do
    [ ! -f "$file" ] || awk -v file="$file" '
      function flush() { if (text != "") print file ":" first ":" text; text = ""; code = 0 }
      match($0, /^[ \t]*\/\/[\/!]/) && $0 !~ /^[ \t]*\/\/\/\// {
        line = substr($0, RSTART + RLENGTH)
        if (line ~ /^ *```/) { code = !code; next }
        if (code || line ~ /^ *#/) next
        if (text == "") first = NR
        text = text (line == "" ? " |" : line)
        next
      }
      { flush() }
      END { flush() }' "$file"
  done
}

pronoun='(It|Its|They|Their|Them|This|These|Those|That|Such|Others?|Same|Whose|Likewise|Also|What)'
pronoun+='|(Whether|When|Where|Why|How|If|While) (it|they|those|its|their|(this|these|that|such) (is|are|can|has|have|was|were|may|must|will|does))'
leaning='The same( of|[.,:;]| as| in| for| by| with| into)|(That|Those|Ones|All|None|Nothing|Both) of|(One|Ones) (that|which)|As (that|those)|Of '
found=0
while IFS= read -r comment; do
  echo "$comment"
  found=$((found + 1))
done < <(comments "$@" | grep -E "^[^:]*:[0-9]+: *(($pronoun)( |,|\.|:|$)|($leaning))|(\.|\|) +(The same( of|\.)|(That|Those|Ones) of|All of (it|them)\.|Of (the|these|those|a|an|its|all) )" || true)
# rustdoc takes the rest of the line for a part of the heading.
while IFS= read -r heading; do
  echo "$heading"
  found=$((found + 1))
done < <(files rs "$@" | xargs -r grep -nE '^ *//[/!] # (Errors|Panics) +[^ ]' || true)
# Rust is ASCII here: a byte is a character.
while IFS= read -r wide; do
  echo "$wide: wider than 110"
  found=$((found + 1))
done < <(files rs "$@" | while read -r file; do
  [ ! -f "$file" ] || awk -v file="$file" '
    !/^[ \t]*\/\// { code = 0; next }
    /^[ \t]*\/\/[\/!]? *```/ { code = !code; next }
    !code && length($0) > 110 { print file ":" FNR }' "$file"
done)
echo "$found comments that cannot be understood alone, or are too wide"
(( found == 0 ))
