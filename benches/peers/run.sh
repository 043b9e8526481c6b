#!/bin/bash
# slipfront against LAMMPS, C, Numba and NumPy on the same work, one after another. README.md says what is
# compared.
#
#     benches/peers/run.sh [-r ROUNDS] [SIZE...]
#
# SIZE blocks a side, 25 50 200 unless told; 5 rounds. Needs cargo, gcc, python3 with venv, and LAMMPS
# (Debian's package `lammps`; LMP=/path/of/lmp for another one). NumPy and Numba are put into
# target/peers/venv. Prints the machine and a table in Markdown. Exit status: 1 when the programs do not
# agree, 2 when something is missing.

set -euo pipefail
export LC_ALL=C PYTHONDONTWRITEBYTECODE=1
# One thread each.
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 NUMBA_NUM_THREADS=1

rounds=5
if [ "${1:-}" = -r ]; then
  rounds=${2:-}
  shift $(($# < 2 ? $# : 2))
fi
sizes=("$@")
[ $# -gt 0 ] || sizes=(25 50 200)
for number in "$rounds" "${sizes[@]}"; do
  [[ $number =~ ^[1-9][0-9]*$ ]] || { echo "usage: run.sh [-r ROUNDS] [SIZE...]" >&2; exit 2; }
done
steps=2667 # t* = 8/V* at dt* = 0.1, the usual run

here=$(realpath "$(dirname "$0")")
cd "$here/../.."
built=${CARGO_TARGET_DIR:-$PWD/target}/release
work=$PWD/target/peers
python=$work/venv/bin/python
lmp=${LMP:-lmp}
results=$work/results.tsv

for program in cargo gcc python3 "$lmp"; do
  command -v "$program" > /dev/null || { echo "$program is missing" >&2; exit 2; }
done
mkdir -p "$work"
if ! "$python" -c 'import numpy, numba' 2> /dev/null; then
  python3 -m venv "$work/venv" && "$python" -m pip install --quiet numpy numba || exit 2
fi
cargo build --quiet --release --locked -p slipfront-cli
cargo build --quiet --release --locked -p slipfront --example step_cost
flags=(-std=c11 -Wall -O3 -march=native)
gcc "${flags[@]}" -o "$work/lattice" "$here/lattice.c" -lm
# A square root need not set errno: that changes no number, and lets gcc use SIMD where there is one.
gcc "${flags[@]}" -fno-math-errno -o "$work/lattice_no_errno" "$here/lattice.c" -lm

run_lammps() { # FOLDER STEPS and further arguments
  "$lmp" -nocite -log none -in "$here/lattice.lmp" -var data "$1/lattice.data" -var steps "$2" "${@:3}"
}

record() { # SIZE PROGRAM "mu_s* step nanoseconds", - for what there is not
  printf '%s\t%s\t%s\n' "$1" "$2" "${3// /$'\t'}" >> "$results"
}

machine() {
  lscpu | sed -nE 's/^(Model name|CPU\(s\)|L[123][a-z]* cache): */- \1: /p'
  local set
  for set in avx2 avx512f; do
    grep -qw "$set" /proc/cpuinfo && echo "- $set: yes" || echo "- $set: no"
  done
  echo "- slipfront $(git describe --always --dirty 2> /dev/null || "$built/slipfront" --version), $(rustc --version)"
  "$lmp" -h | sed -nE 's/^Large-scale .* Simulator/- LAMMPS/p; s/^Compiler: /- LAMMPS compiled by /p'
  gcc --version | sed -n '1s/^/- /p'
  "$python" -c 'import platform, numpy, numba
print(f"- Python {platform.python_version()}, NumPy {numpy.__version__}, Numba {numba.__version__}")'
}

ticks() { # of processor time: everybody's, and those of this script with all that it has run
  echo "$(awk '/^cpu / { print $2 + $3 + $4 + $7 + $8 + $9 }' /proc/stat)" \
    "$(awk '{ print $14 + $15 + $16 + $17 }' "/proc/$$/stat")" "$(date +%s.%N)"
}

: > "$results"
machine
echo

for size in "${sizes[@]}"; do
  folder=$work/$size
  "$python" "$here/prepare.py" "$size" "$folder"
  run_lammps "$folder" 400 -var positions "$folder/positions" > "$folder/lammps.out"
  echo "$size x $size blocks"
  "$python" "$here/check_lammps.py" "$size" "$folder" "$folder/positions" 400
  echo
done

before=$(ticks)
for size in "${sizes[@]}"; do
  folder=$work/$size
  surface=("$size" "$folder/mu_s.f64" "$folder/mu_k.f64" "$steps")
  for ((round = 0; round < rounds; round++)); do
    record "$size" slipfront "$("$built/examples/step_cost" "${surface[@]}")"
    record "$size" "slipfront, every block at every step" "$("$built/examples/step_cost" "${surface[@]}" --no-skip)"
    record "$size" "LAMMPS, no friction" \
      "$(run_lammps "$folder" "$steps" | awk '/^Loop time/ { print "-", "-", $4 * 1e9 / $9 / $12 }')"
    record "$size" "C, -O3 -march=native" "$("$work/lattice" "${surface[@]}")"
    record "$size" "C, also -fno-math-errno" "$("$work/lattice_no_errno" "${surface[@]}")"
    record "$size" Numba "$("$python" "$here/lattice.py" numba "${surface[@]}")"
    record "$size" NumPy "$("$python" "$here/lattice.py" numpy "${surface[@]}")"
  done
done
after=$(ticks)

# The command itself, from a case file: for its answer, not for its time.
for size in "${sizes[@]}"; do
  folder=$work/$size
  printf '%s\n' '[slider]' "blocks = [$size, $size]" '[friction]' 'mu_static_field = "mu_s.npy"' \
    'mu_kinetic_field = "mu_k.npy"' '[output]' 'snapshots = []' > "$folder/case.toml"
  "$built/slipfront" run "$folder/case.toml" --force --quiet --json -o "$folder/run" > "$folder/summary.json"
  record "$size" "the command slipfront run" "$("$python" -c 'import json, sys
summary = json.load(sys.stdin)
print(summary["static_friction_star"], round(summary["onset_time_star"] / summary["dt_star"]), "-")' < "$folder/summary.json")"
done

status=0
"$python" "$here/table.py" "$results" || status=$?
echo
read -r all own time <<< "$before"
read -r all_after own_after time_after <<< "$after"
awk -v hz="$(getconf CLK_TCK)" -v cores="$(getconf _NPROCESSORS_ONLN)" -v others="$(((all_after - all) - (own_after - own)))" \
  -v seconds="$(awk "BEGIN { print $time_after - $time }")" \
  'BEGIN { printf "Others took %.0f %% of the processor time of %d cores in these %.0f s.\n", 100 * others / hz / seconds / cores, cores, seconds }'
exit "$status"
