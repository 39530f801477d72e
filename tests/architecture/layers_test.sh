#!/usr/bin/env bash
# Dependencies point one way: each module includes only those that its line below allows.
set -euo pipefail
cd "$(dirname "$0")/../.."

declare -A allowed=(
  [core]=""
  [numerics]="core"
  [model]="core numerics"
  [casefile]="core model"
  [dynamics]="core numerics model"
  [engine]="core numerics model dynamics"
  [record]="core model"
  [observe]="core numerics model dynamics engine record"
  [setup]="core numerics model casefile record"
  [report]="core record"
  [plot]=""
  [outputs]="core numerics model casefile record engine observe"
  [driver]="core model casefile record setup engine observe"
  [sweep]="core model casefile record"
  [certify]="core model casefile setup engine"
  [compare]="core record sweep"
  [audit]="core numerics model casefile dynamics record"
  [page]="core model casefile record sweep plot"
  [app]="core numerics model casefile record setup dynamics engine observe outputs report driver sweep certify compare audit page"
)

status=0
for folder in include/edmill/*/ src/*/; do
  module=$(basename "$folder")
  [ "$module" = instances ] && continue # where everything meets
  if [ -z "${allowed[$module]+known}" ]; then
    echo "unknown module '$module': add it to $0"
    status=1
    continue
  fi
  while IFS=: read -r file line text; do
    used=$(sed -E 's|.*"edmill/([a-z_]+)/.*|\1|' <<<"$text")
    [ "$used" = "$module" ] && continue
    case " ${allowed[$module]} " in
      *" $used "*) ;;
      *)
        echo "$file:$line: module '$module' must not depend on '$used'"
        status=1
        ;;
    esac
  done < <(grep -rnE '#include "edmill/[a-z_]+/' "$folder" || true)
  # instances.hpp gathers every scalar: only the application needs it.
  if [ "$module" != app ] && grep -rn '#include "edmill/instances.hpp"' "$folder"; then
    echo "module '$module' must not include edmill/instances.hpp"
    status=1
  fi
done
[ $status = 0 ] && echo "every include follows the layers"
exit $status
