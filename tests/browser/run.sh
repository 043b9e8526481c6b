#!/bin/bash
# Checks the types of the page of the laboratory, and lets a real browser, Debian's Chromium, use it: page and
# server together.
#
#     tests/browser/run.sh
#
# The command is target/debug/slipfront, or the one that SLIPFRONT names. Needs cargo, Node.js 18 or later
# with npm, and Python; installs Chromium where it is missing. Exit status: 2 when something is missing.
#
# With DELAY_MS=300 every message reaches the page up to 300 ms later: tests that do not wait for what they
# look at fail then.

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

if ! [ -x /usr/bin/chromium ]; then
    apt-get update --quiet || exit 2
    apt-get install --yes --quiet chromium || exit 2
fi
[ -n "${SLIPFRONT:-}" ] || cargo build --quiet --locked -p slipfront-cli
npm ci --prefix tests/browser --silent --no-audit --no-fund || exit 2
tests/browser/node_modules/.bin/tsc --project crates/slipfront-lab
node --test --test-reporter=spec crates/slipfront-lab/tests/page/*.test.mjs
node --test --test-reporter=spec tests/browser/main.mjs
