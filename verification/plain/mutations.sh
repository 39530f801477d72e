#!/usr/bin/env bash
# Wrong versions of plain_mill: plain_mill_test must fail with each.
# usage: mutations.sh EDMILL
set -euo pipefail
edmill=$(realpath "$1")
cd "$(dirname "$0")"
export PYTHONPATH=../../tests/support
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
status=0
mutate() {
  local name=$1 change=$2
  sed "$change" plain_mill.cpp > "$folder/mutant.cpp"
  cmp -s plain_mill.cpp "$folder/mutant.cpp" && { echo "no change: $name"; status=1; return; }
  g++ -O1 -std=gnu++20 -I. "$folder/mutant.cpp" -o "$folder/mutant" -lmpfr -lgmp -lquadmath
  if timeout 120 ./plain_mill_test.py "$edmill" "$folder/mutant" > "$folder/log" 2> "$folder/errors"; then
    echo "NOT FOUND: $name"
    status=1
  else
    echo "found: $name: $(grep -v '^  ' "$folder/log" | sed 's/ (.*): /: /; s/, worst.*//' | paste -sd ';') $(tail -n 1 "$folder/errors" | cut -c1-60)"
  fi
}
mutate "tangential impulse with the wrong sign" 's/(n \* jump - along/(n * jump + along/'
mutate "spin with the wrong sign" 's/cross(n, along) \* (mass_share/cross(n, along) * (-mass_share/'
mutate "wall velocity at the ball's centre" 's/late.velocity(ra - n \* R)/late.velocity(ra)/'
mutate "no least separation speed" 's/slow = fault_.of("least_separation", least_separation_)/slow = T(0)/'
mutate "1 + e in the sliding impulse instead of the actual normal impulse" 's/c_limit \* jump/c_limit * (1 + restitution_) * approach/'
mutate "supplied energy subtracted from the dose" 's/std::max(T(0), T(approach \* approach - leave \* leave))/approach * approach - leave * leave/'
mutate "arm longer by 1e-22 m" 's/mill_.arm = number("arm")/mill_.arm = number("arm") + T("1e-22")/'
exit $status
