#!/bin/bash
# Runs a tour of the command in odd environments and below odd paths: the same files must come out everywhere,
# and commands that are printed must work when they are pasted.
#
#     tests/places.sh [SLIPFRONT]
#
# The command is target/debug/slipfront unless another one is given. A locale that is not installed is C; one
# place needs root.

set -uo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
slipfront=$(realpath "${1:-$root/target/debug/slipfront}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$slipfront" "$work/slipfront"
export slipfront=$work/slipfront work
chmod 755 "$work"
places=0 failed=0

cat > "$work/case.toml" <<'TOML'
slider.blocks = [12, 12]
drive.v_star = 0.1
time = { step = 0.4, duration_star = 60 }
output = { snapshots = [20, 50], series = 1 }
TOML
cat > "$work/study.toml" <<'TOML'
base = "case.toml"
[[axes]]
key = "drive.v_star"
list = [0.1, 0.2]
TOML
printf '[base]\nslider.blocks = [4, 4]\ndrive.v_star = 0.2\n[design]\nwish = { least = "static_friction" }\ncoverage = [0, 15]\nruns = 20\n' > "$work/wish.toml"
printf 'base = "case.toml"\n[calibrate]\nx = "time_s"\ny = "friction_force_n"\nnoise = 0.02\nruns = 200\nfiner_runs = 0\nunknowns = { "friction.mu_static" = [0.3, 1.2] }\n' > "$work/fit.toml"
cp "$root/cases/sheet.toml" "$work/sheet.toml"

# The tour, in the present folder; $1 is the beginning of every name.
cat > "$work/tour.sh" <<'SH'
set -eu
cp "$work"/{case,study,wish,fit,sheet}.toml .
"$slipfront" check case.toml
"$slipfront" run case.toml -o "./$1run"
"$slipfront" texture case.toml --set texture.0.shape=cavity --set texture.0.coverage=10 -o "./$1mask.png"
"$slipfront" study study.toml -o "./$1study"
"$slipfront" design wish.toml -o "./$1design"
"$slipfront" calibrate fit.toml "./$1run/series.csv" -o "./$1calibrate"
"$slipfront" converge sheet.toml --set slider.blocks=[10,10] --replicates 1 -o "./$1converge"
"$slipfront" plot "./$1run" -o "./$1plot"
"$slipfront" movie "./$1run" -o "./$1movie.gif"
"$slipfront" export "./$1run" --ro-crate --author A --licence CC-BY-4.0 -o "./$1crate"
"$slipfront" verify "./$1run" "./$1study" "./$1design" "./$1calibrate" "./$1converge"
"$slipfront" verify --rerun "./$1run"
SH

# The tour as it is called by the rest of the words; $1 is the name of the place, $2 the beginning of every
# name.
tour() {
    local place=$1 prefix=$2 folder=$work/places/$1 name
    shift 2
    places=$((places + 1))
    mkdir -p -m 777 "$work/places" "$folder"
    cd "$folder" || exit 1
    if ! "$@" bash "$work/tour.sh" "$prefix" > "$work/said" 2>&1; then
        failed=$((failed + 1))
        printf 'FAILED in %q: %s\n' "$place" "$(tail -n 3 "$work/said")"
    fi
    for name in run study design calibrate converge plot movie.gif mask.png; do
        # Journals have the times of their runs; manifest.json and checksums.json have hashes of these.
        if ! diff -rq -x manifest.json -x '*.jsonl' -x checksums.json "$work/places/plain/$name" "$folder/$prefix$name" > "$work/said"; then
            failed=$((failed + 1))
            printf 'DIFFERS in %q: %s\n' "$place" "$(head -n 2 "$work/said")"
        fi
    done
}

# Pastes commands that are printed, in the present folder: another folder for a run, and the lines of a batch
# script.
paste_commands() {
    local printed
    printed=$("$slipfront" run case.toml --quiet -o "./$1run" 2>&1 | grep -o -e '`--out .*` is free')
    printed=${printed#?}
    if ! eval "$slipfront run case.toml --quiet ${printed%\` is free}" || ! [ -e "./$1run-2/manifest.json" ]; then
        failed=$((failed + 1))
        printf 'CANNOT BE PASTED in %q: %s\n' "$1" "$printed"
    fi
    "$slipfront" study slurm study.toml --tasks 1 -o "./$1slurm" > script
    if ! SLURM_ARRAY_TASK_ID=1 bash script > said 2>&1 || ! eval "$(sed -n 's/^# *\(.* study merge .*\)/\1/p' script)" > said 2>&1; then
        failed=$((failed + 1))
        printf 'NO BATCH SCRIPT in %q: %s\n' "$1" "$(tail -n 1 said)"
    fi
}

tour plain '' env
for locale in de_DE.UTF-8 tr_TR.UTF-8 tr_TR.ISO-8859-9 C; do tour "$locale" '' env LC_ALL="$locale"; done
for columns in 10 0 wide; do tour "columns $columns" '' env COLUMNS="$columns"; done
for mask in 077 000 027; do tour "umask $mask" '' bash -c "umask $mask; exec \"\$@\"" bash; done
tour 'no environment' '' env -i PATH="$PATH" slipfront="$slipfront" work="$work"
tour 'no home' '' env -u HOME
tour 'stdin closed' '' bash -c 'exec "$@" <&-' bash
tour 'all closed' '' bash -c 'exec "$@" <&- >&- 2>&-' bash
[ "$(id -u)" != 0 ] || tour 'user nobody' '' setpriv --reuid 65534 --regid 65534 --clear-groups env -u HOME
for name in 'a b' "it's" 'say "x"' 'größe' '-o' '--' '$HOME `id`' 'a;b&c' '*?[x]' 'back\slash' '!x#y' '~' $'two\nlines' $'a\ttab' '面 🙂' $'no\xfftext'; do
    tour "$name" "$name" env
    paste_commands "$name"
done
echo "$places places, $failed failures"
[ "$failed" = 0 ]
