#!/usr/bin/env bash
# The search of `slipfront design` beside others. README.md says what is compared.
#
#     benches/rivals/run.sh [--runs N] [--sigma S] [--threads N] [START...]
#
# Needs cargo and python3 with venv; the other searches are put into target/rivals/venv. Exit status: 1 when
# another search finds more than the own by more than 0.1 points, 2 when something is missing.
set -euo pipefail
here=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
cd "$here/../.."
venv=$PWD/target/rivals/venv
if ! cmp --silent "$venv/made" "$here/requirements.txt"; then
  python3 -m venv --clear "$venv" || exit 2
  "$venv/bin/pip" install --quiet --disable-pip-version-check -r "$here/requirements.txt" || exit 2
  cp "$here/requirements.txt" "$venv/made"
fi
VIRTUAL_ENV=$venv "$venv/bin/maturin" develop --quiet --release --manifest-path python/Cargo.toml || exit 2
exec "$venv/bin/python" "$here/rivals.py" "$@"
