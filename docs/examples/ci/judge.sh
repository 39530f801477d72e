#!/usr/bin/env bash
# Judges a collision log by the npm package: installs it, audits the log, compares it with a
# reference if there is one. Writes audit.xml and compare.xml (JUnit) and, on GitHub, annotations.
# Settings are environment variables:
#   EDMILL_CASE, EDMILL_LOG   case file and log
#   EDMILL_OPTIONS            of edmill audit (default: --gap-tolerance 1e-4)
#   EDMILL_REFERENCE          a log or the folder of a run to compare with (default: none)
#   EDMILL_COMPARE_OPTIONS    of edmill compare
#   EDMILL_PACKAGE            npm package: a file or a name with its version (default: edmill)
# exit codes: 0 the log is right, 6 it is not, 7 too little data to decide, others an error
set -uo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
npm install --silent --no-audit --no-fund --prefix "$folder" "${EDMILL_PACKAGE:-edmill}" || exit 1
edmill=$folder/node_modules/.bin/edmill

worst=0
judge() { # name, words of the command
  local code=0
  "$edmill" "${@:2}" --junit "$1.xml" || code=$?
  if [ $code != 0 ] && [ -n "${GITHUB_ACTIONS:-}" ]; then
    echo "::error file=$EDMILL_LOG,title=edmill $1::$(sed -n 's/.*<failure message="\([^"]*\)".*/\1/p' "$1.xml" 2>/dev/null | head -n 1), exit code $code"
  fi
  [ $worst != 0 ] || worst=$code
}

# Options are lists of words, so they are split.
# shellcheck disable=SC2086
judge audit audit "$EDMILL_CASE" "$EDMILL_LOG" ${EDMILL_OPTIONS:---gap-tolerance 1e-4}
if [ -n "${EDMILL_REFERENCE:-}" ]; then
  # shellcheck disable=SC2086
  judge compare compare "$EDMILL_REFERENCE" "$EDMILL_LOG" ${EDMILL_COMPARE_OPTIONS:-}
fi
exit $worst
