#!/usr/bin/env bash
# Dependencies point one way: each room of src/ includes only those that its line below allows.
set -euo pipefail
cd "$(dirname "$0")/../../src"

declare -A allowed=(
  [base]=""
  [model]="base"
  [dynamics]="base model"
  [engine]="base model dynamics"
  [io]="base model"
  [casefile]="base model io"
  [run]="base model dynamics engine io casefile"
  [output]="base model engine io casefile run"
  [study]="base model io casefile"
  [check]="base model dynamics io casefile study" # never the engine: a judge that shares its code proves nothing
  [plot]=""
  [report]="base model io casefile study plot"
  [cli]="base model dynamics engine io casefile run output study check report instances"
  [instances]="base model dynamics engine io casefile run output report cli" # where everything meets every scalar
)

status=0
for room in */; do
  room=${room%/}
  if [ -z "${allowed[$room]+known}" ]; then
    echo "unknown room '$room': add it to $0"
    status=1
    continue
  fi
  while IFS=: read -r file line text; do
    used=$(sed -E 's|.*"([a-z_]+)/.*|\1|' <<<"$text")
    case " $room ${allowed[$room]} " in
      *" $used "*) ;;
      *)
        echo "$file:$line: '$room' must not depend on '$used'"
        status=1
        ;;
    esac
  done < <(grep -rnE '#include "' "$room" || true)
done
[ $status = 0 ] && echo "every include follows the layers"
exit $status
