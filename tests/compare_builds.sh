#!/usr/bin/env bash
# Compares the results of two builds of slipfront, byte for byte: every case under cases/, every study under
# cases/studies, the whole paper and the exact answers of the family. Pictures and manifests are left out:
# those change with the drawing, these with time and place.
#
#   tests/compare_builds.sh OLD_PROGRAM NEW_PROGRAM [FOLDER]
#
# Results are kept in FOLDER, which must be new; without one they are removed. Fails if any file differs or is
# missing.
set -euo pipefail
old=$(realpath "$1")
new=$(realpath "$2")
folder=${3:-}
if [[ -z $folder ]]; then
    folder=$(mktemp -d)
    trap 'rm -rf "$folder"' EXIT
fi
folder=$(realpath -m "$folder")
mkdir -p "$folder"
cd "$(dirname "${BASH_SOURCE[0]}")/.."

produce() {
    local program=$1 out=$2
    for case in cases/*.toml; do
        "$program" run --quiet "$case" --out "$out/run/$(basename "$case" .toml)"
    done
    for study in cases/studies/*.toml; do
        "$program" study --quiet "$study" --out "$out/study/$(basename "$study" .toml)" > "$out/$(basename "$study").txt"
    done
    "$program" paper --quiet --out "$out/paper" > "$out/paper.txt"
    "$program" family --docs "$out/family" > "$out/family.txt"
}

mkdir -p "$folder/old" "$folder/new"
produce "$old" "$folder/old"
produce "$new" "$folder/new"

# What a run, a study, the paper and the family answer with.
results() {
    find "$1" -type f \( -name '*.csv' -o -name '*.nc' -o -name 'summary.json' -o -name '*.txt' -o -name '*.md' \) -printf '%P\n' | sort
}
# A file, of runs.csv without the identities of the runs.
without_identity() {
    if [[ $2 == */runs.csv ]]; then
        sed -E 's/,[0-9a-f]{12},(done|failed),/,\1,/' "$folder/$1/$2"
    else
        cat "$folder/$1/$2"
    fi
}
equal=0
different=0
while read -r file; do
    if cmp --quiet <(without_identity old "$file") <(without_identity new "$file"); then
        equal=$((equal + 1))
    else
        different=$((different + 1))
        echo "differs: $file"
    fi
done < <({ results "$folder/old"; results "$folder/new"; } | sort -u)
echo "$equal files are the same bytes, $different differ"
[[ $equal -gt 0 && $different -eq 0 ]]
