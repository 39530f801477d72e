#!/usr/bin/env bash
# Runs a code and judges its collision log: for continuous integration, which fails when this does.
# usage: check.sh COMMAND CASE.toml LOG.csv [option of edmill audit...]
#
# exit codes: 0 the log is clean, 6 it violates the physics of the case, 7 too little to check, others an error
set -euo pipefail
command=$1
case_file=$2
log=$3
shift 3
rm -f "$log"
bash -c "$command"
edmill audit "$case_file" "$log" --gap-tolerance "${GAP_TOLERANCE:-1e-4}" --json audit.json "$@"
