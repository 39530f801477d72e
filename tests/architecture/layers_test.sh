#!/usr/bin/env bash
# Dependencies point one way: each room of src/ includes only those that its line below allows.
set -euo pipefail
cd "$(dirname "$0")/../../src"

declare -A allowed=(
  [base]=""
  [model/parts]="base" # what laws, motions and vessels tell of themselves
  [model/laws]="base model/parts"
  [model/motions]="base model/parts"
  [model/vessels]="base model/parts"
  [model/stop_rules]="base model/parts"
  [model]="base model/parts model/laws model/motions model/vessels model/stop_rules"
  [dynamics]="base model model/parts"
  [engine]="base model model/parts dynamics"
  [io]="base model model/parts"
  [casefile]="base model model/parts io"
  [run]="base model model/parts dynamics engine io casefile"
  [api]="base model model/parts engine io casefile run output"
  [tangent]="base model dynamics" # motions nearby
  [output]="base model model/parts engine io casefile run tangent"
  [study]="base model model/parts io casefile"
  [compare]="base model model/parts io study"
  [audit]="base model model/parts dynamics io casefile compare" # never the engine: a judge that shares its code proves nothing
  [identify]="base model model/parts model/motions io casefile audit run" # fits what an audit measures; logs without states are run again
  [prove]="base model model/parts model/motions casefile run" # arithmetic of its own; the engine only tells where to look
  [plot]="base"
  [machines]="base casefile" # cases of mills that one can buy
  [dem]="base model model/parts io casefile compare identify plot" # decks, dumps and contacts of DEM codes
  [report]="base model model/parts io casefile study plot"
  [app]="base model model/parts dynamics engine io casefile run output study compare audit identify prove report plot tangent instances instances/tools" # prints no result, knows no exit code
  [cli]="base model model/parts io casefile run app cli/commands"
  [cli/commands]="base model io casefile compare dem report machines app cli" # one file each, which main.cpp lists
  [instances]="base model model/parts dynamics engine io casefile run output api" # the core in every scalar
  [instances/tools]="base io casefile report app instances" # and what is around it
  [python]="base model machines api casefile compare dem io prove report app run instances" # a program like those of users, and the commands
  [python/edmill]=""
  [core_alone]="app base casefile cli dynamics io model output report run" # a program of the core for any machine, and what stands for libraries
  [browser]="base model model/parts io casefile output audit compare identify api" # the mill in a browser
)

status=0
for room in $(find . -mindepth 1 -type d -printf "%P\n" | sort); do
  if [ -z "${allowed[$room]+known}" ]; then
    echo "unknown room '$room': add it to $0"
    status=1
    continue
  fi
  while IFS=: read -r file line text; do
    [[ $text =~ \"(.+)/[^/]*\" ]] || continue
    used=${BASH_REMATCH[1]}
    [ "$used" = edmill ] && continue # what users include, of plain types
    case " $room ${allowed[$room]} " in
      *" $used "*) ;;
      *)
        echo "$file:$line: '$room' must not depend on '$used'"
        status=1
        ;;
    esac
  done < <(grep -snE '#include "' "$room"/*.[ch]pp || true)
done
[ $status = 0 ] && echo "every include follows the layers"
exit $status
