#!/usr/bin/env bash
# Runs a solver on problems of the challenge, with the largest step that each allows and with half of it:
#
#     run.sh NAME 'COMMAND' [PROBLEM...]
#
# COMMAND takes the folder of a problem, a folder for answers and `--dt DT`. Answers go into answers/NAME/PROBLEM and, with half
# the step, into half/ there; their difference is the estimate of the error. Without problems it takes all but the design, P12. Needs Python 3 with NumPy; PYTHON names another.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
python=${PYTHON:-python3}
name=$1 command=$2
shift 2
[ $# -gt 0 ] || set -- $(cd problems && ls | grep -v P12)
for problem; do
    step=$("$python" -c "import json; print(json.load(open('problems/$problem/problem.json'))['step_max'])")
    printf '%s %s\n' "$name" "$problem"
    $python $command "problems/$problem" "answers/$name/$problem" --dt "$step"
    $python $command "problems/$problem" "answers/$name/$problem/half" --dt "$("$python" -c "print($step / 2)")"
    "$python" -c "import onset; onset.estimate('answers/$name/$problem')"
done
