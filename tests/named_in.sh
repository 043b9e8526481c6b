#!/usr/bin/env bash
# Source files that name a thing, such as a law of friction or a shape of texture: about as many change when
# another of its kind is added.
#
#     tests/named_in.sh ageing
#     tests/named_in.sh 'contact.?springs' 8
#
# Takes an extended regular expression, whatever the case of its letters, and fails when there are more files
# than the number that follows. Documents and tests do not count, also those behind `#[cfg(test)]` in a file.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

sources=('crates/*/src/*' 'crates/slipfront-lab/web/*' 'python/src/*' 'python/slipfront/*')
found=0
while read -r file; do
  if sed '/^#\[cfg(test)\]/,$d' "$file" | grep -iE -e "$1" > /dev/null; then
    echo "$file"
    found=$((found + 1))
  fi
done < <(git grep --untracked -liE -e "$1" -- "${sources[@]}" ':!*.md' ':!*/tests.rs' ':!*/tests/*' ':!*/lesson*')
echo "$found files"
(( found <= ${2:-found} ))
