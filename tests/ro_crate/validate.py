#!/usr/bin/env python3
"""Validates folders as Process Run Crates: validate.py FOLDER... Needs roc-validator of PyPI, and no network.

What a crate must have is required. What it should have is listed, and allowed to be missing only where EXPECTED says why. The context of
RO-Crate 1.1 (CC0) comes from the copy beside this script, which is put into the cache of the validator as if it had been fetched.
Exit status: 0 valid, 1 not, 2 when something is missing.
"""

import io
import json
import pathlib
import subprocess
import sys
import tempfile

import requests
import requests_cache
import urllib3

HERE = pathlib.Path(__file__).parent
CONTEXT = "https://w3id.org/ro/crate/1.1/context"
PROFILE = "process-run-crate-0.5"
VALIDATOR = pathlib.Path(sys.executable).with_name("rocrate-validator")

# Recommendations that are not followed, as the validator says them, with the reason.
NO_ADDRESS = "slipfront has no address to name"
NOT_TOLD = "the user did not tell it, and it is not made up"
NOT_ASKED = "nobody asks the user for it"
NOT_RECORDED = "a study records no times of the runs whose folders it does not keep"
EXPECTED = {
    "The Action SHOULD have an endTime in ISO 8601 format": NOT_RECORDED,
    "The Application SHOULD have a url": NO_ADDRESS,
    "The SoftwareApplication id SHOULD be an absolute URI": NO_ADDRESS,
    "The organization SHOULD have a URL.": NO_ADDRESS,
    "The Action SHOULD have an agent that is a Person or Organization": NOT_TOLD,
    "The Root Data Entity SHOULD have a link to a Contextual Entity representing the `author` of the RO-Crate": NOT_TOLD,
    "The Root Data Entity SHOULD have a link to a Contextual Entity representing the schema_org:license type": NOT_TOLD,
    "The `publisher` property of a `Root Data Entity` SHOULD be an `Organization`": NOT_ASKED,
    "The author SHOULD have a Contextual Entity which specifies the organizational `affiliation`.": NOT_ASKED,
    "The author SHOULD have an organizational affiliation.": NOT_ASKED,
}


class Copy(requests.adapters.BaseAdapter):
    """Answers with the copy of the context."""

    def send(self, request, **_):
        body = io.BytesIO((HERE / "ro-crate-1.1-context.jsonld").read_bytes())
        raw = urllib3.HTTPResponse(body, {"Content-Type": "application/ld+json"}, 200, preload_content=False)
        return requests.adapters.HTTPAdapter().build_response(request, raw)

    def close(self):
        pass


def issues(crate, cache):
    """Complaints of the validator, as pairs of severity and message, and its numbers of checks."""
    command = [VALIDATOR, "-y", "validate", "--offline", "--cache-path", cache, "-p", PROFILE, "-l", "recommended", "-f", "json", crate]
    done = subprocess.run(command, capture_output=True, text=True)
    try:
        report = json.loads(done.stdout)
    except json.JSONDecodeError:
        sys.exit(f"the validator gave no report of {crate}:\n{done.stdout}{done.stderr}")
    checked = report["statistics"]["total_checks_by_severity"]
    if checked["REQUIRED"] == 0 or checked["RECOMMENDED"] == 0:
        sys.exit(f"the validator has checked nothing of {crate}: {checked}")
    return {(issue["severity"], issue["message"]) for issue in report["issues"]}, checked


def main():
    is_valid = True
    with tempfile.TemporaryDirectory() as folder:
        cache = f"{folder}/cache"
        with requests_cache.CachedSession(cache, expire_after=-1) as session:
            session.mount(CONTEXT, Copy())
            session.get(CONTEXT).raise_for_status()
        for crate in sys.argv[1:]:
            found, checked = issues(crate, cache)
            unexpected = [issue for issue in sorted(found) if issue[0] != "RECOMMENDED" or issue[1] not in EXPECTED]
            is_valid &= not unexpected
            print(f"{crate}: {checked['REQUIRED']} required and {checked['RECOMMENDED']} recommended checks")
            for severity, message in sorted(found):
                print(f"  {severity}: {message}", f"({EXPECTED.get(message, 'not expected')})")
    return 0 if is_valid else 1


sys.exit(main())
