#!/usr/bin/env bash
# On a full disk: one clear error, exit code 1, earlier files as they were, nothing partial left
# behind.
# usage: disk_full_test.sh EDMILL
# First with a limit on the size of files, which needs no privileges; then on a small tmpfs where
# that can be mounted.
set -euo pipefail
program=$(realpath "$1")
demo=$(realpath "$(dirname "$0")/../../../docs/examples/demo.toml")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

fail() {
  echo "failed: $*"
  exit 1
}
files() { (cd "$1" && find . -type f -exec sha256sum {} + | sort); }

# expect_full NAME OUT [MESSAGE]: OUT was as in OUT.before, the run's code and error are in the
# files code and error.
expect_full() {
  [ "$(cat code)" = 1 ] || fail "$1: exit code $(cat code): $(cat error)"
  grep -q "${3:-the disk may be full}" error || fail "$1: no clear message: $(cat error)"
  [ "$(grep -c . error)" = 1 ] || fail "$1: more than one line: $(cat error)"
  diff before <(files "$2") || fail "$1: files changed"
}
limited() { # KIBIBYTES COMMAND...
  local size=$1
  shift
  (
    ulimit -f "$size"
    "$@"
  ) 2>error && echo 0 >code || echo $? >code
}
limit="the file size limit is reached"
run() { "$program" run "$demo" --quiet --set run.end_time='"2 s"' --out out "$@"; }

all='output=[{type="collisions"},{type="events"},{type="statistics",columns=[{variable="milling_dose",statistics=["sum"]}]}]'
run --set run.seed=2 --set "$all"
files out >before
for type in collisions events iterations; do
  limited 64 run --set "output=[{type=\"$type\"}]"
  expect_full "$type" out "$limit"
done
limited 1 run --set run.start_time='"0 s"'
expect_full "final_state.csv" out "$limit"
limited 4 run --checkpoint "0.1 s simulated"
expect_full "the first checkpoint" out "$limit"

# The disk fills as the log grows: the last checkpoint is kept, and the run resumes when there is
# space.
run --set "$all" && files out >whole
rm -r out && run --set run.seed=2 --set "$all" && files out >before
limited 1000 run --set "$all" --checkpoint "0.1 s simulated"
[ "$(cat code)" = 1 ] && [ -e out/checkpoint ] || fail "no checkpoint: $(cat code error)"
grep -q "$limit" error || fail "no clear message: $(cat error)"
diff before <(files out | grep -v 'checkpoint\|partial') || fail "files of the earlier run changed"
"$program" resume out --quiet
diff <(grep -v summary.json whole) <(files out | grep -v summary.json) || fail "the run did not resume"

if ! unshare -rm true 2>/dev/null && ! unshare -m true 2>/dev/null; then
  echo "skipped: no tmpfs can be mounted here"
  exit 0
fi
mkdir small
space=(unshare -m)
unshare -m true 2>/dev/null || space=(unshare -rm)
export program demo
export -f run fail files expect_full
cat >on_tmpfs.sh <<'INNER'
set -euo pipefail
mount -t tmpfs -o size=256k tmpfs small || { echo "skipped: no tmpfs can be mounted here"; exit 0; }
cd small
"$program" run "$demo" --quiet --out out --set run.end_time='"0.6 s"'
files out >../before
for type in collisions events iterations paraview; do
  "$program" run "$demo" --quiet --out out --set "output=[{type=\"$type\"}]" 2>../error && echo 0 >../code || echo $? >../code
  (cd .. && expect_full "$type on a full tmpfs" small/out)
done
# Not a byte is left for the final files either.
dd if=/dev/zero of=filler bs=1k 2>/dev/null || true
"$program" run "$demo" --quiet --out out 2>../error && echo 0 >../code || echo $? >../code
(cd .. && expect_full "a tmpfs without a byte" small/out)
INNER
"${space[@]}" bash on_tmpfs.sh
echo "a full disk is reported, and nothing is lost"
