#!/usr/bin/env bash
# What the program says of itself: the manual page, the completion of bash, the reference, and the
# demo that needs no file.
# usage: texts_test.sh EDMILL FOLDER
set -euo pipefail
edmill=$1
folder=$2
source_folder=$(cd "$(dirname "$0")/../../.." && pwd)
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"

fail() {
  echo "$1" >&2
  exit 1
}
"$edmill" manual >edmill.1
"$edmill" completion >edmill.bash
commands=$("$edmill" --help | sed -n '/^Subcommands:/,/^$/p' | awk 'NR > 1 && NF {print $1}' | grep -E '^[a-z]+$')
[ "$(wc -l <<<"$commands")" -ge 12 ] || fail "found the commands $commands, expected at least 12"
sed 's/\\-/-/g' edmill.1 >plain
# shellcheck source=/dev/null
source ./edmill.bash
for command in $commands; do
  grep -q "^\.SS \"edmill $command" edmill.1 || fail "edmill.1 does not have '$command'"
  COMP_WORDS=(edmill "${command:0:3}") COMP_CWORD=1
  _edmill
  [[ " ${COMPREPLY[*]} " = *" $command "* ]] || fail "bash does not complete '${command:0:3}' to '$command'"
  for option in $("$edmill" "$command" --help | grep -oE '^ +--[a-z-]+' | tr -d ' ' | grep -v -e '^--help$'); do
    grep -qF -- "$option" plain || fail "edmill.1 does not have $command $option"
    COMP_WORDS=(edmill "$command" "$option") COMP_CWORD=2
    _edmill
    [ "${COMPREPLY[0]:-}" = "$option" ] || fail "bash does not complete $command $option"
  done
done

# After an option, what it can be.
completes() { # words... completion
  local words=("${@:1:$#-1}")
  COMP_WORDS=("${words[@]}") COMP_CWORD=$((${#words[@]} - 1))
  _edmill || true  # bash finds no word of the command's own
  [[ " ${COMPREPLY[*]} " = *" ${!#} "* ]] || fail "bash completes '${words[*]}' to '${COMPREPLY[*]}', expected ${!#}"
}
completes edmill new --mill pm pm100
completes edmill new --mill "" drum
completes edmill new --balls 10x10mm : tung tungsten-carbide
completes edmill new --balls 10x10mm : steel
completes edmill run case.toml --precision flo float128

"$edmill" reference >reference.md
diff "$source_folder/docs/reference.md" reference.md || fail "docs/reference.md is not what 'edmill reference' prints"

"$edmill" machines --markdown >machines.md
diff "$source_folder/docs/machines.md" machines.md || fail "docs/machines.md is not what 'edmill machines --markdown' prints"

"$edmill" demo --quiet --out demo
"$edmill" run "$source_folder/docs/examples/demo.toml" --quiet --out run
cmp demo/final_state.csv run/final_state.csv
grep -q "<html" demo/report.html
echo "manual, completion and demo are complete"
