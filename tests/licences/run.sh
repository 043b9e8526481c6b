#!/usr/bin/env bash
# Holds all crates to deny.toml, and the licence notices that slipfront ships to the crates that are locked.
# Advisories of RustSec, on vulnerable and abandoned crates, are asked for by cargo-deny, where it is
# installed (cargo install cargo-deny) and can reach them.
#
#     tests/licences/run.sh
#
# Needs cargo and Python 3.11 or later.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
python3 -B tests/licences/tests.py
python3 -B tests/licences/deny.py
python3 -B tests/licences/notices.py --check
if ! command -v cargo-deny > /dev/null; then
    printf 'NOT CHECKED: advisories, since cargo-deny is not installed\n'
    exit
fi
# What is excepted or ignored for one of the workspaces is missing in the other.
unused=(--allow advisory-not-detected --allow license-exception-not-encountered --allow license-not-encountered)
for manifest in Cargo.toml crates/slipfront-mpi/Cargo.toml; do
    deny=(cargo deny --manifest-path "$manifest" --config deny.toml --locked)
    "${deny[@]}" check "${unused[@]}" licenses bans sources
    if "${deny[@]}" fetch db; then
        "${deny[@]}" check "${unused[@]}" advisories
    else
        printf 'NOT CHECKED: advisories for %s, since they cannot be reached\n' "$manifest"
    fi
done
