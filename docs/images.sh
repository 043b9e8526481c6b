#!/usr/bin/env bash
# Draws the pictures of runs and studies in docs/images again, by the commands beside them in the guides. Those
# of the laboratory's page are drawn by UPDATE=1 tests/browser/run.sh, and textures by `slipfront texture`.
#
#     docs/images.sh PROGRAM         PROGRAM is a built command `slipfront`
#     docs/images.sh PROGRAM large   with the square centimetre, which takes minutes and 8 GB of memory
set -euo pipefail
program=$(realpath "$1")
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
cd "$work"
cp -r "$root/cases" .
slipfront() { "$program" "$@" > /dev/null; }
image() { cp "$1" "$root/docs/images/$2"; }

slipfront run --quiet
image results/baseline/friction.png baseline-friction.png
slipfront run --set 'slider.blocks=[50,50]' -o results/untextured --quiet
slipfront run --set 'slider.blocks=[50,50]' --set texture.0.shape=cavity --set texture.0.coverage=10 \
  -o results/cavity --quiet
slipfront plot results/untextured results/cavity
image results/overlay/friction.png getting-started-overlay.png

slipfront run cases/circle.toml -o circle --quiet
slipfront run cases/circle.toml --set 'texture=[]' -o untextured --quiet
slipfront plot untextured circle -o circle-overlay
image circle-overlay/friction.png circle-friction.png
image circle/stress.png circle-stress.png
slipfront movie circle -o circle-movie.gif
image circle-movie.gif circle-movie.gif

slipfront run cases/groove_across.toml --set 'output.snapshots=[68.7]' --quiet
image results/groove_across/stress.png stress-groove-across.png
slipfront run cases/groove_along.toml --set 'output.snapshots=[73.9]' --quiet
image results/groove_along/stress.png stress-groove-along.png

for case in gear graded hierarchical_dimples edge_driven_chain burridge_knopoff; do
  slipfront run "cases/$case.toml" --quiet
done
image results/gear/stress.png family-gear.png
image results/graded/stress.png family-graded.png
image results/hierarchical_dimples/stress.png family-dimples.png
image results/edge_driven_chain/precursors.png family-precursors.png
image results/burridge_knopoff/events.png burridge-knopoff-events.png

slipfront study cases/studies/friction_polar.toml --quiet
image results/friction_polar/friction_polar.png friction_polar.png
slipfront study cases/studies/size_and_speed.toml --quiet
image results/size_and_speed/static_reduction_percent.png size_and_speed.png
image results/size_and_speed/static_reduction_percent_map.png size_and_speed_map.png

# The files of a tutorial, which its page contains.
file_of() { awk -v first="^# $2[: ]?" '/^```/ { inside = 0 } $0 ~ first { inside = 1 } inside' "$root/docs/guide/tutorials/$1.md" > "$2"; }
for file in pad.toml dimples.toml; do file_of laser-workshop "$file"; done
slipfront study dimples.toml --quiet
image results/dimples/static_friction_star.png tutorial-dimples.png
file_of testers-record rig.toml
slipfront calibrate rig.toml cases/calibrations/tribometer.csv --quiet
slipfront plot results/rig --picture band-1 --width 80 --height 42 --format png -o band
image band/band-1.png tutorial-record.png
for file in film.toml orientation.toml; do file_of thesis "$file"; done
slipfront study orientation.toml --quiet
slipfront plot results/orientation --picture static_reduction_percent --width 89 --font-size 8 --format png -o figures
image figures/static_reduction_percent.png tutorial-thesis.png

if [ "${2:-}" = large ]; then
  slipfront run "$root/benches/large/square_centimetre.toml" --quiet
  image results/square_centimetre/stress.png square-centimetre.png
fi
